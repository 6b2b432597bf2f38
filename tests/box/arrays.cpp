// The table's ray-box kernels on arrays: any length and alignment, bad numbers in one lane, infinite rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "answers.hpp"
#include "cases.hpp"

namespace raylanes::testing {
namespace {

using Results = std::vector<BoxResult>;

TEST(BoxArrays, of_any_length_and_alignment_are_as_if_one_by_one) {
  Random random(5);
  const auto [rays, boxes] = scene_around_one_box(33, random);
  for (const Path* path : supported_paths()) {
    const BoxKernels& kernels = path->kernels.traversal.box;
    Results by_ray, by_box;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      by_ray.push_back(many_rays(kernels, {&rays[i], 1}, {&boxes[0], 1})[0]);
      by_box.push_back(many_boxes(kernels, {&rays[0], 1}, {&boxes[i], 1})[0]);
    }
    for (std::size_t n = 0; n <= 2 * static_cast<std::size_t>(path->lanes) + 1; ++n)
      for (const Place place : {Place::before_guard, Place::after_guard}) {
        SCOPED_TRACE(std::string(path->name) + ", n = " + std::to_string(n));
        const Results a = many_rays(kernels, std::span(rays).first(n), {&boxes[0], 1}, place);
        const Results b = many_boxes(kernels, {&rays[0], 1}, std::span(boxes).first(n), place);
        EXPECT_TRUE(std::equal(a.begin(), a.end(), by_ray.begin()));
        EXPECT_TRUE(std::equal(b.begin(), b.end(), by_box.begin()));
      }
  }
}

// Input k of 12: origin, direction, lo, hi.
void spoil(Ray& ray, Box& box, std::size_t k, float value) {
  Float3* const inputs[] = {&ray.origin, &ray.direction, &box.lo, &box.hi};
  (*inputs[k / 3])[k % 3] = value;
}

TEST(BoxArrays, a_nan_in_any_input_is_a_miss_and_disturbs_no_other_lane) {
  constexpr std::size_t n = 19;
  const Ray good_ray = make_ray({0.5f, 0.25f, 5}, {0, 0.125f, -1});
  for (const Path* path : supported_paths()) {
    const BoxResult good = many_rays(path->kernels.traversal.box, {&good_ray, 1}, {&unit_box, 1})[0];
    ASSERT_NE(good.hit, 0u);
    for (std::size_t k = 0; k < 12; ++k) {
      const std::size_t lane = (k * 7) % n;
      std::vector<Ray> rays(n, good_ray);
      std::vector<Box> boxes(n, unit_box);
      spoil(rays[lane], boxes[lane], k, nan);
      Results expected(n, good);
      expected[lane] = box_missed;
      SCOPED_TRACE(std::string(path->name) + ", input " + std::to_string(k));
      if (k < 6) {
        EXPECT_EQ(many_rays(path->kernels.traversal.box, rays, {&unit_box, 1}), expected);
        EXPECT_EQ(many_boxes(path->kernels.traversal.box, {&rays[lane], 1}, boxes), Results(n, box_missed));
      } else {
        EXPECT_EQ(many_boxes(path->kernels.traversal.box, {&good_ray, 1}, boxes), expected);
        EXPECT_EQ(many_rays(path->kernels.traversal.box, rays, {&boxes[lane], 1}), Results(n, box_missed));
      }
    }
  }
}

TEST(BoxArrays, an_infinite_ray_is_a_miss) {
  for (const Path* path : supported_paths())
    for (std::size_t k = 0; k < 6; ++k)
      for (const float value : {infinity, -infinity}) {
        Ray ray = make_ray({0.5f, 0.25f, 5}, {0, 0.125f, -1});
        Box box{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
        spoil(ray, box, k, value);
        EXPECT_EQ(many_rays(path->kernels.traversal.box, {&ray, 1}, {&box, 1})[0], box_missed)
            << path->name << " input " << k;
      }
}

}  // namespace
}  // namespace raylanes::testing
