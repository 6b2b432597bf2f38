// All box forms on any number of rays and boxes, with lanes left out by a mask.
#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "answers.hpp"

namespace raylanes::testing {
namespace {

using Results = std::vector<BoxResult>;

TEST(BoxForms, of_any_count_and_with_inactive_lanes) {
  Random random(203);
  std::vector<Box> boxes;
  std::vector<Ray> rays;
  for (int i = 0; i < 35; ++i) {
    boxes.push_back(random_box(random, 0.1));
    rays.push_back(grazing_ray(boxes[0], 2, false, random));
  }
  for (const BoxVariant& variant : all_variants<BoxTest>()) {
    const Results whole = answers(variant, rays, boxes);
    for (const Place place : {Place::before_guard, Place::after_guard})
      for (const std::size_t n : {1u, 3u, 5u, 7u, 8u, 9u, 15u, 16u, 17u, 33u}) {
        const Results part = answers(variant, std::span(rays).first(n), std::span(boxes).first(n), place);
        for (std::size_t i = 0; i < n * n; ++i)
          ASSERT_EQ(part[i], whole[i / n * 35 + i % n]) << variant.name();
      }
    const std::uint8_t active[5] = {0x35, 0xff, 0xff, 0x00, 0x02};
    std::vector<Box> spoiled = boxes;
    for (std::size_t i = 0; i < 35; ++i)
      if (!is_set(active, i)) spoiled[i] = {{nan, nan, nan}, {nan, nan, nan}};
    BoxColumns columns(spoiled);
    BoxHitColumns out(35);
    const BoxResult before = out[0];
    intervals(variant.kernels(), rays[0], columns_of(columns).data(), 35, out.arrays(), active);
    for (std::size_t i = 0; i < 35; ++i)
      ASSERT_EQ(out[i], is_set(active, i) ? whole[i * 35] : before) << variant.name();
  }
}

}  // namespace
}  // namespace raylanes::testing
