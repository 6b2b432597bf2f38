// Square roots on every path: correct rounding, the bounds and special values of the classic forms, equality
// of the paths, and what lies around the arrays.
#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "../dispatch/table.hpp"
#include "generators.hpp"
#include "guarded_array.hpp"
#include "supported_paths.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t method_count = sqrt_method_names.size();
constexpr auto exact_method = static_cast<std::size_t>(SqrtMethod::correctly_rounded);
constexpr std::uint32_t least_normal = 0x00800000, infinity_bits = 0x7f800000;

float from_bits(std::uint64_t bits) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
}
std::uint32_t to_bits(float x) {
  return std::bit_cast<std::uint32_t>(x);
}

bool exhaustive() {
  const char* value = std::getenv("RAYLANES_EXHAUSTIVE");
  return value != nullptr && std::string_view(value) == "1";
}

std::vector<float> roots(SqrtFunction function, const std::vector<float>& x) {
  std::vector<float> y(x.size());
  function(x.data(), y.data(), x.size());
  return y;
}

// Index of the first element whose bits differ, or the size.
std::size_t first_difference(const std::vector<float>& a, const std::vector<float>& b) {
  const auto same = [](float p, float q) { return to_bits(p) == to_bits(q); };
  return static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), same).first - a.begin());
}

// Every function's results have the bits of the first's, for each method of [first, last).
void expect_same_bits(const std::vector<float>& x, std::size_t first, std::size_t last) {
  for (std::size_t method = first; method < last; ++method) {
    const std::vector<float> expected = roots(paths().front().table.sqrt[method], x);
    for (const Path* path : supported_paths()) {
      const std::size_t i = first_difference(roots(path->table.sqrt[method], x), expected);
      ASSERT_EQ(i, x.size()) << path->name << ' ' << sqrt_method_names[method] << " of bits " << std::hex
                             << to_bits(x[i]);
    }
  }
}

// r is the root of a, a > 0, rounded to nearest: no tie is possible. In integers: with r = m·2^e the halves
// between r and its neighbours are (2m±1)·2^(e-1).
bool is_rounded_root(float r, float a) {
  int root_exponent = 0, exponent = 0;
  const auto root = static_cast<std::uint64_t>(std::ldexp(std::frexp(r, &root_exponent), 24));
  const auto value = static_cast<std::uint64_t>(std::ldexp(std::frexp(a, &exponent), 24));
  // a = value·2^(exponent-24), (r ± ulp/2)² = (2·root ± 1)²·2^(2·(root_exponent-25)).
  const int shift = exponent - 24 - 2 * (root_exponent - 25);
  if (shift < 0 || shift > 38) return false;
  const std::uint64_t scaled = value << shift;
  return (2 * root - 1) * (2 * root - 1) < scaled && scaled < (2 * root + 1) * (2 * root + 1);
}

bool is_correct_root(float r, float a) {
  if (std::isnan(a) || a < 0) return std::isnan(r);
  if (a == 0 || std::isinf(a)) return to_bits(r) == to_bits(a);
  return to_bits(r) == to_bits(std::sqrt(a));
}

// Bit patterns in blocks: all of them, or every 251st and all near the borders of binades, where the mantissa
// is 0, and those of the special values lie.
template <class Check>
void sweep(Check check) {
  constexpr std::size_t block = 1 << 16;
  std::vector<float> x;
  const auto add = [&](std::uint64_t bits) {
    x.push_back(from_bits(bits));
    if (x.size() == block) check(x), x.clear();
  };
  const std::uint64_t step = exhaustive() ? 1 : (quick() ? 65521 : 251);
  for (std::uint64_t bits = 0; bits < 0x100000000; bits += step) add(bits);
  const std::uint64_t reach = exhaustive() ? 0 : (quick() ? 4 : 0x1000);
  for (std::uint64_t border = 0; reach > 0 && border <= 0x100000000; border += least_normal)
    for (std::uint64_t offset = 0; offset < 2 * reach; ++offset) add(border - reach + offset);
  check(x);
}

TEST(CorrectlyRoundedRoot, equals_ieee_square_root) {
  for (const Path* path : supported_paths()) {
    SCOPED_TRACE(path->name);
    sweep([&](const std::vector<float>& x) {
      const std::vector<float> y = roots(path->table.sqrt[exact_method], x);
      for (std::size_t i = 0; i < x.size(); ++i)
        ASSERT_TRUE(is_correct_root(y[i], x[i])) << std::hex << to_bits(x[i]) << " gave " << to_bits(y[i]);
    });
    if (HasFatalFailure()) return;
  }
}

TEST(CorrectlyRoundedRoot, lies_within_half_an_ulp_by_integers) {
  Random random(1);
  std::vector<float> x{from_bits(1), from_bits(least_normal - 1), from_bits(least_normal),
                       from_bits(infinity_bits - 1)};
  const int samples = quick() ? 2000 : 1000000;
  for (int i = 0; i < samples; ++i)
    x.push_back(from_bits(static_cast<std::uint32_t>(random.real(1, infinity_bits))));
  for (const Path* path : supported_paths()) {
    const std::vector<float> y = roots(path->table.sqrt[exact_method], x);
    for (std::size_t i = 0; i < x.size(); ++i)
      ASSERT_TRUE(is_rounded_root(y[i], x[i])) << path->name << std::hex << ' ' << to_bits(x[i]);
  }
  EXPECT_FALSE(is_rounded_root(std::nextafter(2.0f, 3.0f), 4.0f));
  EXPECT_FALSE(is_rounded_root(std::nextafter(1.5f, 0.0f), 2.25f));
}

struct Worst {
  double ulp = 0, relative = 0;
};

// Errors against the root in double, in units of the last place of the binade of the root.
void measure(const std::vector<float>& x, const std::vector<float>& y, Worst& worst) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double root = std::sqrt(static_cast<double>(x[i]));
    const double error = std::abs(static_cast<double>(y[i]) - root);
    worst.relative = std::max(worst.relative, error / root);
    worst.ulp = std::max(worst.ulp, std::ldexp(error, 23 - std::ilogb(root)));
  }
}

// The least errors that the true constants make, just below the largest of [1, 4), so that a wrong constant
// is found in either direction; and the documented largest relative errors with the unit of their last digit.
constexpr double least_worst_ulp[] = {408332.0, 6794.0, 2.693, 0.7499};
constexpr double relative_error[] = {3.52e-2, 6.41e-4, 2.92e-7, 8.94e-8};
constexpr double last_digit[] = {0.01e-2, 0.01e-4, 0.01e-7, 0.01e-8};

// Arguments at which 2 and 3 steps are worst; the others are worst at the ends of binades.
constexpr std::uint32_t worst_bits[] = {0x40000055, 0x406d131a};

TEST(ClassicRoot, errors_on_1_to_4_are_the_documented_ones) {
  constexpr std::uint32_t one = 0x3f800000, four = 0x40800000;
  const std::uint32_t step = quick() ? 4093 : 1;
  std::vector<float> x{from_bits(worst_bits[0]), from_bits(worst_bits[1])};
  for (std::uint32_t bits = one; bits < four; bits += step) x.push_back(from_bits(bits));
  for (std::size_t steps = 0; steps < 4; ++steps) {
    SCOPED_TRACE(sqrt_method_names[steps]);
    Worst worst;
    measure(x, roots(paths().front().table.sqrt[steps], x), worst);
    EXPECT_LE(worst.ulp, sqrt_method_max_ulp[steps]);
    EXPECT_LE(worst.relative, relative_error[steps] + last_digit[steps]);
    // A sample holds the worst arguments in ULP, of 2 and 3 steps, only.
    if (step == 1 || steps >= 2) {
      EXPECT_GE(worst.ulp, least_worst_ulp[steps]);
    }
    if (step == 1) {
      EXPECT_GE(worst.relative, relative_error[steps] - last_digit[steps]);
    }
  }
  expect_same_bits(x, 0, exact_method);
}

TEST(ClassicRoot, keeps_its_bounds_in_all_binades) {
  Random random(2);
  std::vector<float> x;
  for (std::uint32_t binade = least_normal; binade < infinity_bits; binade += least_normal)
    for (int i = 0; i < (quick() ? 8 : 1000); ++i)
      x.push_back(from_bits(binade + static_cast<std::uint32_t>(random.integer(0, 0x7fffff))));
  for (const Path* path : supported_paths()) {
    for (std::size_t steps = 0; steps < 4; ++steps) {
      Worst worst;
      measure(x, roots(path->table.sqrt[steps], x), worst);
      EXPECT_LE(worst.ulp, sqrt_method_max_ulp[steps]) << path->name << ' ' << sqrt_method_names[steps];
    }
  }
}

// What each method gives, from the contract, for numbers that are not normal and positive.
bool is_documented_special(float root, float a) {
  if (std::abs(a) < from_bits(least_normal)) return root == 0 && std::signbit(root) == std::signbit(a);
  if (std::isnan(a) || a < 0) return std::isnan(root);
  return std::isinf(a) && root == a;
}

TEST(ClassicRoot, special_values_are_the_documented_ones) {
  std::vector<float> specials{0.0f, -0.0f, infinity, -infinity, -1.0f, -4.0f};
  for (const std::uint32_t bits : {1u, 2u, 0x00400000u, 0x007ffffeu, 0x007fffffu}) {
    specials.push_back(from_bits(bits));
    specials.push_back(from_bits(bits | 0x80000000u));
  }
  for (const std::uint32_t bits : {0x7f800001u, 0x7fbfffffu, 0x7fc00000u, 0x7fffffffu, 0xff800001u,
                                   0xffc00000u, 0xffffffffu, 0x80800000u, 0xff7fffffu})
    specials.push_back(from_bits(bits));
  for (const Path* path : supported_paths()) {
    for (std::size_t method = 0; method < exact_method; ++method) {
      const std::vector<float> y = roots(path->table.sqrt[method], specials);
      for (std::size_t i = 0; i < y.size(); ++i)
        EXPECT_TRUE(is_documented_special(y[i], specials[i]))
            << path->name << ' ' << sqrt_method_names[method] << " of bits " << std::hex
            << to_bits(specials[i]) << " gave " << to_bits(y[i]);
      const float ends[] = {from_bits(least_normal), from_bits(infinity_bits - 1)};
      Worst worst;
      measure({ends[0], ends[1]}, roots(path->table.sqrt[method], {ends[0], ends[1]}), worst);
      EXPECT_LE(worst.ulp, sqrt_method_max_ulp[method]) << path->name << ' ' << sqrt_method_names[method];
    }
  }
}

TEST(Roots, have_the_same_bits_on_every_path) {
  std::vector<float> x;
  const std::uint64_t step = quick() ? 1000003 : 10007;
  for (std::uint64_t bits = 0; bits < 0x100000000; bits += step) x.push_back(from_bits(bits));
  for (std::uint64_t border = 0; border <= 0x100000000; border += least_normal)
    for (std::uint64_t offset = 0; offset < 4; ++offset) x.push_back(from_bits(border - 2 + offset));
  expect_same_bits(x, 0, method_count);
}

// Numbers of all kinds, some in each register.
std::vector<float> mixed_numbers(std::size_t n) {
  const float kinds[] = {2.0f, 0.0f, 3.7e5f, nan, 1e-41f, -1.0f, infinity, 1.5e-20f, -0.0f, 7.0f};
  std::vector<float> x;
  for (std::size_t i = 0; i < n; ++i) x.push_back(kinds[i % std::size(kinds)] * (i % 7 == 0 ? 1.25f : 1.0f));
  return x;
}

std::vector<float> one_by_one(SqrtFunction function, const std::vector<float>& x) {
  std::vector<float> y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) function(&x[i], &y[i], 1);
  return y;
}

void expect_touches_its_elements_only(SqrtFunction function, std::size_t n, Place place) {
  const std::vector<float> x = mixed_numbers(n);
  const std::vector<float> expected = one_by_one(function, x);
  GuardedArray<float> in(n, place), out(n, place), both(n, place);
  in.fill(x), both.fill(x);
  function(in.data(), out.data(), n);
  function(both.data(), both.data(), n);
  EXPECT_TRUE(in.holds(x)) << "input changed";
  EXPECT_TRUE(out.holds(expected)) << "differs from one by one";
  EXPECT_TRUE(both.holds(expected)) << "in place differs";
  EXPECT_TRUE(in.is_intact() && out.is_intact() && both.is_intact()) << "written outside";
}

TEST(Roots, of_any_length_and_alignment_touch_their_elements_only) {
  for (const Path* path : supported_paths())
    for (std::size_t method = 0; method < method_count; ++method)
      for (std::size_t n = 0; n <= 3 * static_cast<std::size_t>(path->table.lanes) + 1; ++n)
        // Flush with the rear guard the address is 0, 4, 8 … bytes off an aligned one as n varies.
        for (const Place place : {Place::before_guard, Place::after_guard}) {
          SCOPED_TRACE(std::string(path->name) + ' ' + std::string(sqrt_method_names[method]) +
                       ", n = " + std::to_string(n));
          expect_touches_its_elements_only(path->table.sqrt[method], n, place);
        }
}

TEST(Roots, leave_rounding_and_flush_modes_alone) {
  const unsigned flags = 0x3f;  // sticky exception flags, which any arithmetic sets
  const std::vector<float> x = mixed_numbers(37);
  for (const Path* path : supported_paths())
    for (std::size_t method = 0; method < method_count; ++method) {
      const unsigned before = _mm_getcsr() & ~flags;
      roots(path->table.sqrt[method], x);
      EXPECT_EQ(_mm_getcsr() & ~flags, before) << path->name << ' ' << sqrt_method_names[method];
    }
}

TEST(KernelTable, states_the_lanes_of_its_path) {
  for (const Path* path : supported_paths()) EXPECT_EQ(path->table.lanes, path->lanes) << path->name;
}

}  // namespace
}  // namespace raylanes::testing
