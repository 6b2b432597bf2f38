// All box forms at the extremes: every place and direction of one axis, named cases, bad numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "box_answers.hpp"
#include "box_cases.hpp"
#include "box_judge.hpp"

namespace raylanes::testing {
namespace {

using oracle::exact_interval;

// A direction below 2^-126 answers as zero does, or as it is; the directional form takes any below 2^-96 so.
// On a face of the box it may answer for a box larger by its padding.
void check_table_ray(const BoxVariant& variant, const Ray& ray, FloatMode mode) {
  const Box& box = unit_box;
  Ray still = ray, flushed = ray;
  for (float& d : still.direction)
    if (std::abs(d) < 0x1p-95f) d = 0;
  for (float& d : flushed.direction)
    if (std::abs(d) < 0x1p-126f) d = 0;
  const BoxResult result = answers(variant, {&ray, 1}, {&box, 1})[0];
  const bool hit = result.hit != 0;
  const bool exactly = exact_interval(ray, box).hit, stands = exact_interval(still, box).hit;
  const bool padded = variant.test == BoxTest::directional && exact_interval(still, enlarged(box, ray)).hit;
  const bool must_hit = exact_interval(mode == FloatMode::flush ? flushed : ray, box).hit;
  const bool allowed = hit ? exactly || stands || padded : !must_hit;
  EXPECT_TRUE(allowed) << variant.name() << (hit ? " hits o " : " misses o ") << ray.origin[0] << ' '
                       << ray.origin[1] << ' ' << ray.origin[2] << " d " << ray.direction[0] << ' '
                       << ray.direction[1] << ' ' << ray.direction[2];
}

TEST(BoxFormExtremes, every_place_and_direction_of_one_axis) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    SCOPED_TRACE(name_of(mode));
    for (const BoxVariant& variant : all_variants<BoxTest>())
      for (int axis = 0; axis < 3; ++axis)
        for (const AxisState& next : axis_states)
          for (const AxisState& last : axis_states)
            for (const Ray& ray : rays_of_one_axis(axis, next, last)) {
              // The contract wants one component of at least FLT_MIN.
              const float d = ray.direction[axis];
              if (next.direction == 0 && last.direction == 0 && d != 0 && std::abs(d) < 0x1p-126f) continue;
              check_table_ray(variant, ray, mode);
            }
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
  float* const inputs[] = {ray.origin, ray.direction, box.lo, box.hi};
  if (k < 12)
    inputs[k / 3][k % 3] = value;
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
