// Roots of doubles on every path: correct rounding by integers, bounds, special values, lengths. Nobody can
// try all inputs, so the hard ones are constructed.
#include "../support/random_input.hpp"
#include "root_inputs.hpp"
#include "rounded_root.hpp"

namespace raylanes::testing {
namespace {

using Limits = std::numeric_limits<double>;

void add_with_neighbours(std::vector<double>& x, double a) {
  for (const double near : {std::nextafter(a, 0.0), a, std::nextafter(a, Limits::infinity())})
    if (near > 0 && near <= Limits::max()) x.push_back(near);
}

// Positive finite numbers: powers of two from the least subnormal on, perfect squares, numbers with roots
// that are hard to round, each with its neighbours; the ends of the ranges; random ones in every binade.
std::vector<double> numbers() {
  Random random(7);
  std::vector<double> x{Limits::denorm_min(), std::nextafter(Limits::min(), 0.0), Limits::max()};
  // Numbers at which the square of a root that is too large overflows.
  for (int i = 1; i < 1000; ++i) x.push_back(Limits::max() * (1 - i * 1e-6));
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
  std::erase_if(x, [](double a) { return !std::isnormal(a); });
  return x;
}

TEST(HardRoots, are_many_and_rounded_as_they_say) {
  const std::vector<HardRoot> list = hard_roots();
  EXPECT_GE(list.size(), 150u);
  for (const HardRoot& hard : list) {
    EXPECT_TRUE(is_rounded_root(hard.root, hard.number)) << hard.number;
    EXPECT_FALSE(is_rounded_root(std::nextafter(hard.root, 0.0), hard.number)) << hard.number;
    EXPECT_FALSE(is_rounded_root(std::nextafter(hard.root, HUGE_VAL), hard.number)) << hard.number;
    // Within 2^-46 ULP of the middle of two doubles: arithmetic of 64 bits, that of x86, takes it for the middle.
    if (std::numeric_limits<long double>::digits != 64) continue;
    const long double root = std::sqrt(static_cast<long double>(hard.number));
    EXPECT_EQ(std::fabs(root - static_cast<long double>(hard.root)), 0.5L) << hard.number;
  }
}

TEST(HardRoots, of_floats_are_many_and_near_the_middle_of_two) {
  const std::vector<float> list = hard_float_roots();
  EXPECT_GE(list.size(), 700u);
  for (const float a : list) {
    const double root = std::ldexp(std::sqrt(static_cast<double>(a)), 23);
    EXPECT_LE(std::fabs(root - std::floor(root) - 0.5), 0x1p-15) << a;
  }
}

TEST(DoubleRoots, that_promise_it_are_correctly_rounded_by_integers) {
  const std::vector<double> x = numbers();
  for (const NamedRoot<double>& root : all_roots<double>()) {
    if (!root.is_sqrt() || root.promise->max_ulp != 0.5) continue;
    const std::vector<double> y = results(root.function, x);
    for (std::size_t i = 0; i < x.size(); ++i)
      ASSERT_TRUE(is_rounded_root(y[i], x[i])) << root.name << " of " << std::hexfloat << x[i];
  }
}

// The domain in which reciprocals are promised, and roots by any method.
bool is_promised(const NamedRoot<double>& root, double a) {
  return std::isnormal(a) && (!root.is_reciprocal() || a < 0x1p1021);
}

TEST(DoubleRoots, keep_their_bounds_and_come_near_them) {
  const std::vector<double> x = normal_numbers();
  for (const NamedRoot<double>& root : all_roots<double>()) {
    const std::vector<double> y = results(root.function, x);
    Worst worst;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!is_promised(root, x[i])) continue;
      const double before = worst.ulp;
      measure_one(y[i], root.exact(static_cast<long double>(x[i])), worst);
      // The reference has 64 bits and up to two roundings: it is right to 2^-10 ULP.
      if (worst.ulp > before) {
        ASSERT_LE(worst.ulp, root.max_ulp() + 0x1p-10) << root.name << " of " << std::hexfloat << x[i];
      }
    }
    // Estimates are promised as their instruction set does, and AVX-512 gives two bits more.
    if (!quick() && root.promise->reproducible) {
      EXPECT_GE(worst.ulp, 0.9 * root.max_ulp()) << root.name;
    }
    std::printf("%s: %.6g of %.6g ULP, relative %.4g\n", root.name.c_str(), worst.ulp, root.max_ulp(),
                worst.relative);
  }
}

std::vector<double> specials(const NamedRoot<double>& root) {
  std::vector<double> x;
  for (const double a :
       {0.0, Limits::denorm_min(), 0x1p-1050, 0x1.8p-1023, std::nextafter(Limits::min(), 0.0),
        Limits::infinity(), Limits::quiet_NaN(), Limits::signaling_NaN()})
    x.push_back(a), x.push_back(-a);
  if (!root.is_reciprocal())
    for (const double a : {Limits::min(), 1.0, 4.0, 1e300, Limits::max()}) x.push_back(-a);
  return x;
}

// Alone, and in every place among ordinary numbers, which stay what they are without it.
TEST(DoubleRoots, special_values_are_those_of_ieee_754_in_every_place) {
  const std::vector<double> ordinary(70, 2.25);
  for (const NamedRoot<double>& root : all_roots<double>()) {
    const double usual = results(root.function, ordinary)[0];
    for (const double special : specials(root)) {
      const double expected = ieee(root, special);
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

}  // namespace
}  // namespace raylanes::testing
