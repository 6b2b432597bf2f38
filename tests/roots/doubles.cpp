// Roots of doubles on every path: correct rounding by integers, bounds, special values, lengths. Nobody can
// try all inputs, so the hard ones are constructed.
#include <gtest/gtest.h>

#include <limits>

#include <raylanes/roots.hpp>

#include "../support/float_modes.hpp"
#include "../support/guarded_array.hpp"
#include "../support/random_input.hpp"
#include "roots.hpp"
#include "rounded_root.hpp"

namespace raylanes::testing {
namespace {

using Limits = std::numeric_limits<double>;

struct NamedDoubleRoot {
  std::string name;  // path and method
  const RootMethod* promise;
  DoubleArrayFunction function;
  bool has_fma;

  double max_ulp() const { return has_fma ? promise->max_ulp : promise->max_ulp_without_fma; }
};

std::vector<NamedDoubleRoot> all_double_roots() {
  std::vector<NamedDoubleRoot> list;
  for (const Path* path : supported_paths())
    for (std::size_t m = 0; m < double_sqrt_methods.size(); ++m)
      list.push_back({std::string(path->name) + ' ' + std::string(double_sqrt_methods[m].name),
                      &double_sqrt_methods[m], path->kernels.roots.sqrt_double[m], path->has_fma()});
  return list;
}

std::vector<double> results(DoubleArrayFunction function, const std::vector<double>& x) {
  std::vector<double> y(x.size());
  function(x.data(), y.data(), x.size());
  return y;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (a != a && b != b);
}

void add_with_neighbours(std::vector<double>& x, double a) {
  for (const double near : {std::nextafter(a, 0.0), a, std::nextafter(a, Limits::infinity())})
    if (near > 0 && near <= Limits::max()) x.push_back(near);
}

// Positive finite numbers: powers of two from the least subnormal on, perfect squares, numbers with roots
// that are hard to round, each with its neighbours; the ends of the ranges; random ones in every binade.
std::vector<double> numbers() {
  Random random(7);
  std::vector<double> x{Limits::denorm_min(), std::nextafter(Limits::min(), 0.0), Limits::max()};
  const int step = quick() ? 37 : 1;
  for (int e = -1074; e < 1024; e += step) add_with_neighbours(x, std::ldexp(1.0, e));
  for (int i = 0; i < (quick() ? 100 : 20000); ++i) {
    const double root = std::floor(random.real(1.0, 0x1p26));
    add_with_neighbours(x, std::ldexp(root * root, 2 * random.integer(-560, 480)));
  }
  for (const HardRoot& hard : hard_roots())
    for (const int scale : {-560, -510, -52, 0, 457})
      add_with_neighbours(x, std::ldexp(hard.number, 2 * scale));
  for (int e = -1074; e < 1024; e += step)
    for (int i = 0; i < (quick() ? 1 : 20); ++i) x.push_back(std::ldexp(random.real(1.0, 2.0), e));
  for (int i = 0; i < (quick() ? 500 : 200000); ++i) x.push_back(random.real(1.0, 4.0));
  return x;
}

// Those for which bounds are promised.
std::vector<double> normal_numbers() {
  std::vector<double> x = numbers();
  int exponent = 0;
  std::erase_if(x, [&](double a) {
    return !std::isnormal(a) || (std::frexp(a, &exponent) == 0.5 && has_wrong_estimates());
  });
  return x;
}

TEST(HardRoots, are_many_and_rounded_as_they_say) {
  const std::vector<HardRoot> list = hard_roots();
  EXPECT_GE(list.size(), 150u);
  for (const HardRoot& hard : list) {
    EXPECT_TRUE(is_rounded_root(hard.root, hard.number)) << hard.number;
    EXPECT_FALSE(is_rounded_root(std::nextafter(hard.root, 0.0), hard.number)) << hard.number;
    EXPECT_FALSE(is_rounded_root(std::nextafter(hard.root, HUGE_VAL), hard.number)) << hard.number;
    // Within 2^-46 ULP of the middle of two doubles: arithmetic of 64 bits takes it for the middle.
    const long double root = std::sqrt(static_cast<long double>(hard.number));
    EXPECT_EQ(std::fabs(root - static_cast<long double>(hard.root)), 0.5L) << hard.number;
  }
}

TEST(DoubleRoots, that_promise_it_are_correctly_rounded_by_integers) {
  const std::vector<double> x = numbers();
  for (const NamedDoubleRoot& root : all_double_roots()) {
    if (root.promise->max_ulp != 0.5) continue;
    const std::vector<double> y = results(root.function, x);
    for (std::size_t i = 0; i < x.size(); ++i)
      ASSERT_TRUE(is_rounded_root(y[i], x[i])) << root.name << " of " << std::hexfloat << x[i];
  }
}

TEST(DoubleRoots, keep_their_bounds_and_come_near_them) {
  const std::vector<double> x = normal_numbers();
  std::vector<long double> exact, per_ulp;
  for (const double a : x) {
    exact.push_back(std::sqrt(static_cast<long double>(a)));
    per_ulp.push_back(std::ldexp(1.0L, 52 - std::ilogb(exact.back())));
  }
  for (const NamedDoubleRoot& root : all_double_roots()) {
    const std::vector<double> y = results(root.function, x);
    long double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const long double ulp = std::fabs(static_cast<long double>(y[i]) - exact[i]) * per_ulp[i];
      worst = std::max(worst, ulp);
      // The reference has 64 bits, so it is right to 2^-11 ULP.
      ASSERT_LE(ulp, static_cast<long double>(root.max_ulp()) + 0x1p-10L)
          << root.name << " of " << std::hexfloat << x[i];
    }
    if (!quick() && root.promise->reproducible) {
      EXPECT_GE(worst, 0.6L * static_cast<long double>(root.max_ulp())) << root.name;
    }
  }
}

TEST(DoubleRoots, of_reproducible_methods_have_the_same_bits_on_every_path) {
  const std::vector<double> x = numbers();
  const auto& scalar = paths().front().kernels.roots.sqrt_double;
  for (const Path* path : supported_paths())
    for (std::size_t m = 0; m < double_sqrt_methods.size(); ++m) {
      if (!double_sqrt_methods[m].reproducible) continue;
      EXPECT_EQ(results(path->kernels.roots.sqrt_double[m], x), results(scalar[m], x))
          << path->name << ' ' << double_sqrt_methods[m].name;
    }
}

std::vector<double> specials() {
  std::vector<double> x;
  for (const double a :
       {0.0, Limits::denorm_min(), 0x1p-1050, 0x1.8p-1023, std::nextafter(Limits::min(), 0.0),
        Limits::infinity(), Limits::quiet_NaN(), Limits::signaling_NaN()})
    x.push_back(a), x.push_back(-a);
  for (const double a : {Limits::min(), 1.0, 4.0, 1e300, Limits::max()}) x.push_back(-a);
  return x;
}

// Alone, and in every place among ordinary numbers, which stay what they are without it.
TEST(DoubleRoots, special_values_are_those_of_ieee_754_in_every_place) {
  const std::vector<double> ordinary(70, 2.25);
  for (const NamedDoubleRoot& root : all_double_roots()) {
    const double usual = results(root.function, ordinary)[0];
    for (const double special : specials()) {
      const double expected = std::sqrt(special);
      EXPECT_TRUE(same_bits(results(root.function, {special})[0], expected))
          << root.name << " of " << special;
      for (std::size_t place = 0; place < ordinary.size(); ++place) {
        std::vector<double> expected_roots(ordinary.size(), usual), x = ordinary;
        x[place] = special, expected_roots[place] = expected;
        const std::vector<double> y = results(root.function, x);
        ASSERT_TRUE(std::equal(y.begin(), y.end(), expected_roots.begin(),
                               [](double a, double b) { return same_bits(a, b); }))
            << root.name << " of " << special << " in place " << place;
      }
    }
  }
}

// Between pages that may not be touched, flush with the rear one or one element behind the front one.
TEST(DoubleRoots, of_any_length_and_alignment_touch_their_elements_only) {
  for (std::size_t n = 0; n < 200; n += quick() ? 7 : 1)
    for (const Place place : {Place::before_guard, Place::after_guard}) {
      GuardedArray<double> in(n, place), out(n, place), both(n, place);
      std::vector<double> x(n), single(n);
      for (std::size_t i = 0; i < n; ++i)
        x[i] = i % 11 == 10 && n % 2 == 1 ? -1.0 : 0.5 + static_cast<double>(i);
      for (const NamedDoubleRoot& root : all_double_roots()) {
        SCOPED_TRACE(root.name + ", n = " + std::to_string(n));
        for (std::size_t i = 0; i < n; ++i) root.function(&x[i], &single[i], 1);
        in.fill(x), both.fill(x);
        root.function(in.data(), out.data(), n);
        root.function(both.data(), both.data(), n);
        EXPECT_TRUE(in.holds(x)) << "input changed";
        const auto same = [](double a, double b) { return same_bits(a, b); };
        EXPECT_TRUE(std::equal(single.begin(), single.end(), out.data(), same)) << "differs from one by one";
        EXPECT_TRUE(std::equal(single.begin(), single.end(), both.data(), same)) << "in place differs";
        EXPECT_TRUE(in.is_intact() && out.is_intact() && both.is_intact()) << "written outside";
      }
    }
}

// With subnormals off, those are zeros, and nothing else changes; the modes stay as they are.
TEST(DoubleRoots, with_subnormals_off_take_them_as_zero) {
  std::vector<double> x, zeroed;
  for (int i = 0; i < 300; ++i) {
    x.push_back(i % 5 == 0 ? std::ldexp(1.0 + i, -1060) : 0.35 + 1.7 * i);
    zeroed.push_back(i % 5 == 0 ? 0.0 : x.back());
  }
  for (const NamedDoubleRoot& root : all_double_roots()) {
    const std::vector<double> expected = results(root.function, zeroed);
    std::vector<double> y;
    {
      const FloatModeScope mode(FloatMode::flush);
      y = results(root.function, x);
    }
    EXPECT_EQ(y, expected) << root.name;
  }
}

TEST(DoubleGrades, keep_their_bounds_on_every_path) {
  const std::vector<double> x = normal_numbers();
  std::vector<double> y(x.size());
  for (const Path* path : supported_paths()) {
    force_path(path->name);
    for (std::size_t g = 0; g < sqrt_grade_names.size(); ++g) {
      sqrt(x, y, static_cast<SqrtGrade>(g));
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double exact = std::sqrt(x[i]);
        ASSERT_LE(std::abs(y[i] - exact), sqrt_grade_relative_error[g] * exact)
            << path->name << ' ' << sqrt_grade_names[g] << " of " << std::hexfloat << x[i];
      }
    }
  }
  unforce_path();
}

}  // namespace
}  // namespace raylanes::testing
