// Roots on every path: correct rounding, the bounds of all methods, special values, equality of the paths.
#include <gtest/gtest.h>

#include "../support/random_input.hpp"
#include "roots.hpp"
#include "rounded_root.hpp"

namespace raylanes::testing {
namespace {

// The sqrt methods that promise the correctly rounded root.
std::vector<NamedRoot> exact_roots() {
  std::vector<NamedRoot> list = all_roots();
  std::erase_if(list, [](const NamedRoot& r) { return r.exact != exact_root || r.promise->max_ulp != 0.5; });
  return list;
}

bool is_correct_root(float r, float a) {
  if (std::isnan(a) || a < 0) return std::isnan(r);
  if (a == 0 || std::isinf(a)) return to_bits(r) == to_bits(a);
  return to_bits(r) == to_bits(std::sqrt(a));
}

TEST(CorrectlyRoundedRoot, is_promised_by_three_methods_on_every_path) {
  EXPECT_EQ(exact_roots().size(), 3 * supported_paths().size());
}

TEST(CorrectlyRoundedRoot, equals_ieee_square_root) {
  for (const NamedRoot& root : exact_roots()) {
    SCOPED_TRACE(root.name);
    sweep([&](const std::vector<float>& x) {
      const std::vector<float> y = results(root.function, x);
      std::size_t i = 0;
      while (i < x.size() && is_correct_root(y[i], x[i])) ++i;
      ASSERT_EQ(i, x.size()) << std::hex << to_bits(x[i]) << " gave " << to_bits(y[i]);
    });
    if (HasFatalFailure()) return;
  }
}

// In the range where blocks take the short way, and in every place of a block: some go through the divider.
TEST(CorrectlyRoundedRoot, lies_within_half_an_ulp_by_integers_in_every_place) {
  Random random(1);
  std::vector<float> x{from_bits(1), from_bits(least_normal - 1), from_bits(least_normal),
                       from_bits(infinity_bits - 1)};
  const int samples = quick() ? 2000 : 300000;
  for (int i = 0; i < samples; ++i)
    x.push_back(from_bits(static_cast<std::uint32_t>(random.real(0x18800000, infinity_bits))));
  for (const NamedRoot& root : exact_roots())
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

// The largest relative errors of the course report's form, with the unit of their last digit, and arguments
// at which 2 and 3 steps are worst; the others are worst at the ends of binades.
constexpr double relative_error[] = {3.52e-2, 6.41e-4, 2.92e-7, 8.94e-8};
constexpr double last_digit[] = {0.01e-2, 0.01e-4, 0.01e-7, 0.01e-8};
constexpr double least_worst_ulp[] = {408332.0, 6794.0, 2.693, 0.7499};
constexpr std::uint32_t worst_bits[] = {0x40000055, 0x406d131a};

TEST(ClassicRoot, errors_on_1_to_4_are_the_documented_ones) {
  constexpr std::uint32_t one = 0x3f800000, four = 0x40800000;
  const std::uint32_t step = quick() ? 4093 : 1;
  std::vector<float> x{from_bits(worst_bits[0]), from_bits(worst_bits[1])};
  for (std::uint32_t bits = one; bits < four; bits += step) x.push_back(from_bits(bits));
  for (std::size_t steps = 0; steps < 4; ++steps) {
    SCOPED_TRACE(sqrt_methods[steps].name);
    Worst worst;
    measure(x, results(paths().front().kernels.roots.sqrt[steps], x), exact_root, worst);
    EXPECT_LE(worst.ulp, sqrt_methods[steps].max_ulp);
    EXPECT_LE(worst.relative, relative_error[steps] + last_digit[steps]);
    // A sample holds the worst arguments in ULP, of 2 and 3 steps, only.
    if (step == 1 || steps >= 2) {
      EXPECT_GE(worst.ulp, least_worst_ulp[steps]);
    }
    if (step == 1) {
      EXPECT_GE(worst.relative, relative_error[steps] - last_digit[steps]);
    }
  }
}

// On [1, 4) the error repeats in every pair of binades: a wrong constant of any bit trick or polynomial shows
// as an error that is larger than promised, and a promise that nothing comes near would hide one.
TEST(Roots, promises_are_kept_and_close_on_1_to_4) {
  const std::uint32_t step = quick() ? 4093 : 7;
  std::vector<float> x;
  for (std::uint32_t bits = 0x3f800000; bits < 0x40800000; bits += step) x.push_back(from_bits(bits));
  for (const NamedRoot& root : all_roots()) {
    Worst worst;
    measure(x, results(root.function, x), root.exact, worst);
    EXPECT_LE(worst.ulp, root.max_ulp()) << root.name;
    // Estimates are promised as their instruction set does, and AVX-512 gives two bits more.
    if (step == 7 && root.promise->reproducible) {
      EXPECT_GE(worst.ulp, 0.75 * root.max_ulp()) << root.name;
    }
  }
}

TEST(Roots, keep_their_bounds_in_all_binades) {
  Random random(2);
  for (const NamedRoot& root : all_roots()) {
    std::vector<float> x;
    const bool reciprocal = root.exact == exact_reciprocal;
    const std::uint32_t end = reciprocal ? 0x7e800000u : infinity_bits;
    for (std::uint32_t binade = least_normal; binade < end; binade += least_normal)
      for (int i = 0; i < (quick() ? 8 : 300); ++i) {
        const std::uint32_t bits = binade + static_cast<std::uint32_t>(random.integer(0, 0x7fffff));
        x.push_back(from_bits(reciprocal && i % 2 == 1 ? bits | 0x80000000u : bits));
      }
    for (std::uint32_t bits = end - (quick() ? 100 : 5000); bits < end; ++bits) x.push_back(from_bits(bits));
    Worst worst;
    measure(x, results(root.function, x), root.exact, worst);
    EXPECT_LE(worst.ulp, root.max_ulp()) << root.name;
  }
}

// IEEE 754 for everything that is no normal number or has no root, whatever the method.
float ieee(const NamedRoot& root, float a) {
  if (root.exact == exact_reciprocal) return 1.0f / a;
  return root.exact == exact_root ? std::sqrt(a) : 1.0f / std::sqrt(a);
}

TEST(Roots, special_values_are_those_of_ieee_754) {
  std::vector<float> specials{0.0f, -0.0f, infinity, -infinity};
  for (const std::uint32_t bits :
       {1u, 2u, 0x00400000u, 0x007ffffeu, 0x007fffffu, 0x7f800001u, 0x7fbfffffu, 0x7fc00000u, 0x7fffffffu}) {
    specials.push_back(from_bits(bits));
    specials.push_back(from_bits(bits | 0x80000000u));
  }
  for (const NamedRoot& root : all_roots()) {
    std::vector<float> x = specials;
    if (estimates_subnormals()) std::erase_if(x, [](float a) { return std::fpclassify(a) == FP_SUBNORMAL; });
    if (root.exact != exact_reciprocal)
      for (const float negative : {-1.0f, -4.0f, -3e38f, -from_bits(least_normal)}) x.push_back(negative);
    // Alone, and each in the midst of a block of ordinary numbers, in every place.
    const std::vector<float> alone = results(root.function, x);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const float expected = ieee(root, x[i]);
      std::vector<float> block(130, 2.25f);
      block[i * 7 % 130] = x[i];
      const std::vector<float> y = results(root.function, block);
      for (const float found : {alone[i], y[i * 7 % 130]})
        EXPECT_TRUE(root.promise->unchecked || to_bits(found) == to_bits(expected) ||
                    (std::isnan(found) && std::isnan(expected)))
            << root.name << " of bits " << std::hex << to_bits(x[i]) << " gave " << to_bits(found);
      Worst rest;
      for (std::size_t k = 0; k < y.size(); ++k)
        if (k != i * 7 % 130) measure({2.25f}, {y[k]}, root.exact, rest);
      EXPECT_LE(rest.ulp, root.max_ulp()) << root.name << ": a neighbour is wrong";
    }
  }
}

// Tests of whole blocks take minima and maxima, which pass over NaN and must not forget what came before it.
TEST(Roots, special_values_are_seen_before_and_behind_nan_in_the_same_lane) {
  for (const NamedRoot& root : all_roots()) {
    if (root.promise->unchecked) continue;
    const auto lanes = static_cast<std::size_t>(root.path->lanes);
    for (const float special : {0.0f, -infinity, infinity})
      for (const std::size_t first : {std::size_t{0}, lanes - 1})
        for (const std::size_t distance : {lanes, 2 * lanes, 5 * lanes})
          for (const bool nan_first : {false, true}) {
            std::vector<float> x(16 * lanes, 2.25f);
            x[first] = nan_first ? nan : special;
            x[first + distance] = nan_first ? special : nan;
            const std::vector<float> y = results(root.function, x);
            for (const std::size_t i : {first, first + distance})
              EXPECT_TRUE(same_bits(y[i], ieee(root, x[i]))) << root.name << " of " << x[i] << " beside NaN";
          }
  }
}

TEST(Roots, of_reproducible_methods_have_the_same_bits_on_every_path) {
  std::vector<float> x;
  const std::uint64_t step = quick() ? 1000003 : 10007;
  for (std::uint64_t bits = 0; bits < 0x100000000; bits += step) x.push_back(from_bits(bits));
  for (std::uint64_t border = 0; border <= 0x100000000; border += least_normal)
    for (std::uint64_t offset = 0; offset < 4; ++offset) x.push_back(from_bits(border - 2 + offset));
  if (has_wrong_estimates())
    std::erase_if(x, [](float a) { return to_bits(a) % least_normal == 0 && std::isnormal(a); });
  const std::vector<NamedRoot> scalar = roots_of(paths().front());
  for (const Path* path : supported_paths()) {
    const std::vector<NamedRoot> list = roots_of(*path);
    for (std::size_t r = 0; r < list.size(); ++r) {
      if (!list[r].promise->reproducible) continue;
      const std::size_t i = first_difference(results(list[r].function, x), results(scalar[r].function, x));
      ASSERT_EQ(i, x.size()) << list[r].name << " of bits " << std::hex << to_bits(x[i]);
    }
  }
}

TEST(ClassicRoot, has_the_same_bits_in_all_its_forms) {
  std::vector<float> x;
  for (std::uint64_t bits = 0; bits < 0x100000000; bits += quick() ? 1000003 : 65537)
    x.push_back(from_bits(bits));
  constexpr auto first_form = static_cast<std::size_t>(SqrtMethod::classic_0_one_at_a_time);
  for (const Path* path : supported_paths())
    for (std::size_t form = first_form; form < sqrt_methods.size(); ++form) {
      const std::size_t steps = (form - first_form) % 4;
      const auto& table = path->kernels.roots.sqrt;
      EXPECT_TRUE(sqrt_methods[form].name.starts_with(sqrt_methods[steps].name));
      EXPECT_EQ(first_difference(results(table[form], x), results(table[steps], x)), x.size())
          << path->name << ' ' << sqrt_methods[form].name;
    }
}

}  // namespace
}  // namespace raylanes::testing
