// Roots of floats: special values, alone and in company.
#include "../support/estimate_fault.hpp"
#include "../support/random_input.hpp"
#include "root_inputs.hpp"

namespace raylanes::testing {
namespace {

TEST(Roots, special_values_are_those_of_ieee_754) {
  std::vector<float> specials{0.0f, -0.0f, infinity, -infinity};
  for (const std::uint32_t bits :
       {1u, 2u, 0x00400000u, 0x007ffffeu, 0x007fffffu, 0x7f800001u, 0x7fbfffffu, 0x7fc00000u, 0x7fffffffu}) {
    specials.push_back(from_bits(bits));
    specials.push_back(from_bits(bits | 0x80000000u));
  }
  for (const NamedRoot<float>& root : all_roots<float>()) {
    std::vector<float> x = specials;
    if (estimates_subnormals()) std::erase_if(x, [](float a) { return std::fpclassify(a) == FP_SUBNORMAL; });
    if (!root.is_reciprocal())
      for (const float negative : {-1.0f, -4.0f, -3e38f, -from_bits(min_normal)}) x.push_back(negative);
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
        if (k != i * 7 % 130) measure<float>({2.25f}, {y[k]}, root.exact, rest);
      EXPECT_LE(rest.ulp, root.max_ulp()) << root.name << ": a neighbour is wrong";
    }
  }
}

// Tests of whole blocks take minima and maxima, which pass over NaN and must not forget what came before it.
TEST(Roots, special_values_are_seen_before_and_behind_nan_in_the_same_lane) {
  for (const NamedRoot<float>& root : all_roots<float>()) {
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

}  // namespace
}  // namespace raylanes::testing
