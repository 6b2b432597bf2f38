// The table's ray-box kernels at the extremes: every place and direction of one axis, and named cases.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "answers.hpp"
#include "cases.hpp"
#include "judge.hpp"

namespace raylanes::testing {
namespace {

using oracle::exact_interval;
using oracle::ExactInterval;

// A component below 2^-126 may have an infinite reciprocal. The test may then answer for a component of zero,
// which moves the ray by less than 2^-126·t, but must not miss what the exact ray meets.
std::string tiny_direction_fault(const BoxResult& result, const Ray& ray, const Box& box) {
  Ray flushed = ray;
  for (float& d : flushed.direction)
    if (std::abs(d) < 0x1p-126f) d = 0;
  const bool hit = result.hit != 0, exactly = exact_interval(ray, box).hit;
  if (exactly && !hit) return "missed";
  return hit == exactly || hit == exact_interval(flushed, box).hit ? "" : "hit";
}

bool has_tiny_direction(const Ray& ray) {
  return std::any_of(ray.direction.begin(), ray.direction.end(),
                     [](float d) { return d != 0 && std::abs(d) < 0x1p-126f; });
}

TEST(BoxTable, every_place_and_direction_of_one_axis) {
  const Box& box = unit_box;
  std::size_t hits = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const AxisState& next : axis_states)
      for (const AxisState& last : axis_states)
        for (const Ray& ray : rays_of_one_axis(axis, next, last)) {
          const ExactInterval exact = exact_interval(ray, box);
          hits += exact.hit;
          for (const Path* path : supported_paths()) {
            const BoxResult result = many_rays(path->kernels.traversal.box, {&ray, 1}, {&box, 1})[0];
            ASSERT_EQ(result, many_boxes(path->kernels.traversal.box, {&ray, 1}, {&box, 1})[0]) << path->name;
            const std::string wrong =
                has_tiny_direction(ray) ? tiny_direction_fault(result, ray, box) : fault(result, exact);
            ASSERT_EQ(wrong, "") << path->name << " axis " << axis << " o " << ray.origin[axis] << " d "
                                 << ray.direction[axis] << " others " << next.origin << ' ' << next.direction
                                 << ' ' << last.origin << ' ' << last.direction;
          }
        }
  EXPECT_GT(hits, 500u);
}

TEST(Boxes, named_cases) {
  for (const Path* path : supported_paths())
    for (const BoxCase& c : box_cases()) {
      const BoxResult result = many_rays(path->kernels.traversal.box, {&c.ray, 1}, {&c.box, 1})[0];
      EXPECT_EQ(result.hit, c.hit ? hit_flag : 0) << path->name << ": " << c.name;
      EXPECT_EQ(result, many_boxes(path->kernels.traversal.box, {&c.ray, 1}, {&c.box, 1})[0])
          << path->name << ": " << c.name;
      EXPECT_EQ(exact_interval(c.ray, c.box).hit, c.hit) << "the oracle: " << c.name;
      if (!c.hit) {
        EXPECT_EQ(result, box_missed) << path->name << ": " << c.name;
      }
    }
}

TEST(Boxes, entry_and_exit_are_clipped_to_the_segment) {
  const Ray whole = make_ray({0, 0, 5}, {0, 0, -1}), part = make_ray({0, 0, 5}, {0, 0, -1}, 4.5f, 5.5f);
  for (const Path* path : supported_paths()) {
    const BoxResult all = many_rays(path->kernels.traversal.box, {&whole, 1}, {&unit_box, 1})[0];
    EXPECT_EQ(all.entry, 4) << path->name;
    EXPECT_GE(all.exit, 6) << path->name;
    EXPECT_LE(all.exit, 6 * (1 + 12 * 0x1p-24)) << path->name;
    EXPECT_EQ(many_rays(path->kernels.traversal.box, {&part, 1}, {&unit_box, 1})[0],
              (BoxResult{4.5f, 5.5f, hit_flag}));
  }
}

}  // namespace
}  // namespace raylanes::testing
