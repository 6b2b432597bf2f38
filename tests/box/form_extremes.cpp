// All box forms at the extremes: every place and direction of one axis, named cases, bad numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "answers.hpp"
#include "cases.hpp"
#include "judge.hpp"

namespace raylanes::testing {
namespace {

using oracle::exact_interval;

// What may be said of a ray and unit_box. A direction below 2^-126 answers as zero does, or as it is; the
// directional form takes any below 2^-96 so, and on a face it may answer for a box larger by its padding.
struct TableAnswer {
  bool may_hit, may_hit_padded, must_hit, must_hit_flushed;
};

Ray without_directions_below(float least, Ray ray) {
  for (float& d : ray.direction)
    if (std::abs(d) < least) d = 0;
  return ray;
}

TableAnswer table_answer(const Ray& ray) {
  const Ray still = without_directions_below(0x1p-95f, ray);
  const bool exactly = exact_interval(ray, unit_box).hit;
  const bool may_hit = exactly || exact_interval(still, unit_box).hit;
  return {may_hit, may_hit || exact_interval(still, enlarged(unit_box, ray)).hit, exactly,
          exact_interval(without_directions_below(0x1p-126f, ray), unit_box).hit};
}

// Those of one axis that have a component of at least FLT_MIN, as the contract wants, or no direction.
std::vector<Ray> usable_rays(int axis, const AxisState& next, const AxisState& last) {
  std::vector<Ray> rays = rays_of_one_axis(axis, next, last);
  const bool still = next.direction == 0 && last.direction == 0;
  std::erase_if(rays, [&](const Ray& ray) {
    const float d = ray.direction[axis];
    return still && d != 0 && std::abs(d) < 0x1p-126f;
  });
  return rays;
}

void check_table(const std::vector<Ray>& rays) {
  std::vector<TableAnswer> allowed;
  for (const Ray& ray : rays) allowed.push_back(table_answer(ray));
  for (const BoxVariant& variant : all_variants<BoxTest>())
    for (const FloatMode mode : float_modes) {
      const auto results = answers(variant, rays, {&unit_box, 1}, mode);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const TableAnswer& a = allowed[i];
        const bool may = variant.test == BoxTest::directional ? a.may_hit_padded : a.may_hit;
        const bool must = mode == FloatMode::flush ? a.must_hit_flushed : a.must_hit;
        const bool hit = results[i].hit != 0;
        ASSERT_TRUE(hit ? may : !must)
            << variant.name() << ' ' << name_of(mode) << (hit ? " hits o " : " misses o ")
            << rays[i].origin[0] << ' ' << rays[i].origin[1] << ' ' << rays[i].origin[2] << " d "
            << rays[i].direction[0] << ' ' << rays[i].direction[1] << ' ' << rays[i].direction[2];
      }
    }
}

TEST(BoxFormExtremes, every_place_and_direction_of_one_axis) {
  for (int axis = 0; axis < 3; ++axis)
    for (const AxisState& next : axis_states)
      for (const AxisState& last : axis_states) {
        check_table(usable_rays(axis, next, last));
        if (HasFatalFailure()) return;
      }
}

TEST(BoxFormExtremes, named_cases) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    for (const BoxVariant& variant : all_variants<BoxTest>())
      for (const BoxCase& c : box_cases()) {
        if (variant.test == BoxTest::directional && c.far) continue;
        const BoxResult result = answers(variant, {&c.ray, 1}, {&c.box, 1})[0];
        EXPECT_EQ(result.hit, c.hit ? hit_flag : 0)
            << variant.name() << ' ' << name_of(mode) << ": " << c.name;
        if (!c.hit) {
          EXPECT_EQ(result, box_missed) << variant.name() << ' ' << name_of(mode) << ": " << c.name;
        }
      }
  }
}

// Input k of 14: origin, direction, lo, hi, tmin, tmax.
void spoil(Ray& ray, Box& box, std::size_t k, float value) {
  Float3* const inputs[] = {&ray.origin, &ray.direction, &box.lo, &box.hi};
  if (k < 12)
    (*inputs[k / 3])[k % 3] = value;
  else
    (k == 12 ? ray.tmin : ray.tmax) = value;
}

// Boxes and ends of segments may be infinite; origins and directions may not.
TEST(BoxFormExtremes, a_bad_number_anywhere_is_a_miss_and_disturbs_no_other_lane) {
  for (const FloatMode mode : float_modes)
    for (const BoxVariant& variant : all_variants<BoxTest>())
      // Along each axis, so that each gets to be the last, which is checked by the order of operands alone.
      for (int along = 0; along < 3; ++along)
        for (std::size_t k = 0; k < 14; ++k)
          for (const float bad : {nan, -nan, infinity, -infinity}) {
            if (k >= 6 && std::isinf(bad)) continue;
            Ray ray = make_ray({0.1f, 0.2f, 0.3f}, {0.1f, -0.2f, 0.15f});
            ray.direction[along] = 1;
            std::vector<Ray> rays(3, ray);
            std::vector<Box> boxes(3, unit_box);
            spoil(rays[1], boxes[1], k, bad);
            const auto results = answers(variant, rays, boxes, mode);
            for (std::size_t i = 0; i < 9; ++i) {
              const bool spoiled = k < 6 || k >= 12 ? i % 3 == 1 : i / 3 == 1;
              ASSERT_EQ(results[i].hit, spoiled ? 0 : hit_flag)
                  << variant.name() << ' ' << name_of(mode) << " input " << k << " = " << bad;
            }
          }
}

}  // namespace
}  // namespace raylanes::testing
