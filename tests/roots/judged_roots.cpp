// Roots of floats on every path: correct rounding, and the bounds of all methods.
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/roots.hpp"
#include "../support/random_input.hpp"
#include "root_inputs.hpp"
#include "rounded_root.hpp"

namespace raylanes::testing {
namespace {

// The sqrt methods that promise the correctly rounded root.
std::vector<NamedRoot<float>> exact_roots() {
  std::vector<NamedRoot<float>> list = all_roots<float>();
  std::erase_if(list, [](const NamedRoot<float>& r) { return !r.is_sqrt() || r.promise->max_ulp != 0.5; });
  return list;
}

bool is_correct_root(float r, float a) {
  if (std::isnan(a) || a < 0) return std::isnan(r);
  if (a == 0 || std::isinf(a)) return to_bits(r) == to_bits(a);
  return to_bits(r) == to_bits(std::sqrt(a));
}

TEST(CorrectlyRoundedRoot, is_promised_by_three_methods_on_every_path) {
  // Beside that of two passes, which wide paths have.
  const auto wide =
      std::ranges::count_if(supported_paths(), [](const Path* path) { return path->lanes == 16; });
  EXPECT_EQ(exact_roots().size(), 3 * supported_paths().size() + static_cast<std::size_t>(wide));
}

void expect_correct_roots(const NamedRoot<float>& root, const std::vector<float>& x) {
  const std::vector<float> y = results(root.function, x);
  std::size_t i = 0;
  while (i < x.size() && is_correct_root(y[i], x[i])) ++i;
  ASSERT_EQ(i, x.size()) << root.name << ' ' << std::hex << to_bits(x[i]) << " gave " << to_bits(y[i]);
}

TEST(CorrectlyRoundedRoot, equals_ieee_square_root) {
  for (const NamedRoot<float>& root : exact_roots()) {
    sweep([&](const std::vector<float>& x) { expect_correct_roots(root, x); });
    if (HasFatalFailure()) return;
  }
}

// Two binades hold all significands and both parities of exponents: the text for normal numbers does the same in each
// pair, times a power of two.
TEST(CorrectlyRoundedRoot, equals_ieee_square_root_for_all_floats_of_1_to_4) {
  std::vector<float> x;
  const std::uint32_t step = by_level(4093u, 251u, 1u);
  for (std::uint32_t bits = 0x3f800000; bits < 0x40800000; bits += step) x.push_back(from_bits(bits));
  for (const NamedRoot<float>& root : exact_roots()) expect_correct_roots(root, x);
}

// In the range where blocks take the short way, and in every place of a block: some go through the divider.
TEST(CorrectlyRoundedRoot, lies_within_half_an_ulp_by_integers_in_every_place) {
  Random random(1);
  std::vector<float> x{from_bits(1), from_bits(min_normal - 1), from_bits(min_normal),
                       from_bits(infinity_bits - 1)};
  const int samples = quick() ? 2000 : 300000;
  for (int i = 0; i < samples; ++i)
    x.push_back(from_bits(static_cast<std::uint32_t>(random.real(0x18800000, infinity_bits))));
  for (const NamedRoot<float>& root : exact_roots())
    for (std::size_t shift = 0; shift < 64; shift += quick() ? 21 : 8) {
      const std::vector<float> shifted(x.begin() + static_cast<std::ptrdiff_t>(shift), x.end());
      const std::vector<float> y = results(root.function, shifted);
      for (std::size_t i = 0; i < y.size(); ++i)
        ASSERT_TRUE(is_rounded_root(y[i], shifted[i])) << root.name << std::hex << ' ' << to_bits(shifted[i]);
    }
  EXPECT_FALSE(is_rounded_root(std::nextafter(2.0f, 3.0f), 4.0f));
  EXPECT_FALSE(is_rounded_root(std::nextafter(1.5f, 0.0f), 2.25f));
  EXPECT_FALSE(is_rounded_root(1.0f, std::nextafter(1.0f, 0.0f)));  // the gap is half as wide below 1
}

// In all positive binades: a double is far more precise than where a float's reciprocal root turns.
TEST(ReciprocalRootInDouble, is_correctly_rounded) {
  for (const NamedRoot<float>& root : all_roots<float>()) {
    if (root.promise->name != "in_double") continue;
    SCOPED_TRACE(root.name);
    sweep([&](const std::vector<float>& x) {
      const std::vector<float> y = results(root.function, x);
      std::size_t i = 0;
      while (i < x.size() && (!(x[i] > 0 && std::isfinite(x[i])) || is_rounded_reciprocal_root(y[i], x[i])))
        ++i;
      ASSERT_EQ(i, x.size()) << std::hex << to_bits(x[i]) << " gave " << to_bits(y[i]);
    });
    if (HasFatalFailure()) return;
  }
  EXPECT_FALSE(is_rounded_reciprocal_root(std::nextafter(0.5f, 1.0f), 4.0f));
  EXPECT_FALSE(is_rounded_reciprocal_root(std::nextafter(0.5f, 0.0f), 4.0f));
}

// The largest relative error of the course report's form, to its last digit, and an argument that is worst in ULP.
TEST(ClassicRoot, errors_on_1_to_4_are_the_documented_ones) {
  constexpr double relative_error = 2.92e-7, last_digit = 0.01e-7;
  constexpr std::uint32_t one = 0x3f800000, four = 0x40800000;
  const std::uint32_t step = quick() ? 4093 : 1;
  std::vector<float> x{from_bits(0x40000055)};
  for (std::uint32_t bits = one; bits < four; bits += step) x.push_back(from_bits(bits));
  constexpr auto method = static_cast<std::size_t>(SqrtMethod::classic_2);
  Worst worst;
  measure(x, results(kernels_of(paths().front()).roots.sqrt.by[method], x), exact_root<double>, worst);
  EXPECT_LE(worst.ulp, sqrt_methods[method].promise.max_ulp);
  EXPECT_GE(worst.ulp, 2.693);
  EXPECT_LE(worst.relative, relative_error + last_digit);
  if (step == 1) {
    EXPECT_GE(worst.relative, relative_error - last_digit);
  }
}

// On [1, 4) the error repeats in every pair of binades: a wrong constant of any bit trick or polynomial shows
// as an error that is larger than promised, and a promise that nothing comes near would hide one.
TEST(Roots, promises_are_kept_and_close_on_1_to_4) {
  const std::uint32_t step = by_level(4093u, 29u, 7u);
  std::vector<float> x;
  for (std::uint32_t bits = 0x3f800000; bits < 0x40800000; bits += step) x.push_back(from_bits(bits));
  for (const NamedRoot<float>& root : all_roots<float>()) {
    Worst worst;
    measure(x, results(root.function, x), root.exact, worst);
    EXPECT_LE(worst.ulp, root.max_ulp()) << root.name;
    // Estimates are promised as their instruction set does, and AVX-512 gives two bits more.
    if (step < 4093 && root.promise->reproducible) {
      EXPECT_GE(worst.ulp, 0.75 * root.max_ulp()) << root.name;
    }
  }
}

TEST(Roots, keep_their_bounds_in_all_binades) {
  Random random(2);
  for (const NamedRoot<float>& root : all_roots<float>()) {
    std::vector<float> x;
    const bool reciprocal = root.is_reciprocal();
    const std::uint32_t end = reciprocal ? 0x7e800000u : infinity_bits;
    for (std::uint32_t binade = min_normal; binade < end; binade += min_normal)
      for (int i = 0; i < (quick() ? 8 : 300); ++i) {
        const std::uint32_t bits = binade + static_cast<std::uint32_t>(random.integer(0, 0x7fffff));
        x.push_back(from_bits(reciprocal && i % 2 == 1 ? bits | 0x80000000u : bits));
      }
    for (std::uint32_t bits = end - (quick() ? 100 : 5000); bits < end; ++bits) x.push_back(from_bits(bits));
    // The least numbers, whose estimates may pass for estimates of subnormals: some 2^-9 of a binade.
    for (std::uint32_t offset = 0; offset < 0x6000; offset += quick() ? 61 : 1)
      x.push_back(from_bits(min_normal + offset));
    Worst worst;
    measure(x, results(root.function, x), root.exact, worst);
    EXPECT_LE(worst.ulp, root.max_ulp()) << root.name;
  }
}

}  // namespace
}  // namespace raylanes::testing
