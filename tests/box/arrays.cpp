// All box tests over arrays: any length, alignment and mask.
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "answers.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t most = 40;

class BoxArraysOf : public ::testing::TestWithParam<BoxTest> {
 protected:
  BoxArraysOf() {
    Random random(203);
    scene_ = scene_around_one_box(most, random);
  }

  struct Inputs {
    RayColumns rays;
    BoxColumns boxes;
  };

  // n elements between guard pages, with a mask of their own; each answer as if asked alone, and what takes no part, or
  // lies behind, left as it was.
  void check(const BoxVariant& variant, Inputs& inputs, Place place, LaneBits active) {
    const std::size_t n = inputs.rays.size();
    const std::string name =
        variant.name() + ", n = " + std::to_string(n) + (active != nullptr ? ", masked" : "");
    auto& [rays, boxes] = inputs;
    const BoxRow& row = variant.kernels();
    IntervalColumns of_rays(n, place), of_boxes(n, place), any_ray(n, place), any_box(n, place), before(n);
    row.intervals_of_rays(rays.arrays(), scene_.boxes[0].lo.data(), active, of_rays.bits(), of_rays.from(),
                          of_rays.to());
    row.intervals_of_boxes(scene_.rays[0], columns_of(boxes).data(), n, active, of_boxes.bits(),
                           of_boxes.from(), of_boxes.to());
    row.any_of_rays(rays.arrays(), scene_.boxes[0].lo.data(), active, any_ray.bits());
    row.any_of_boxes(scene_.rays[0], columns_of(boxes).data(), n, active, any_box.bits());
    for (std::size_t i = 0; i < n; ++i) {
      const bool takes_part = active == nullptr || is_set({active, (n + 7) / 8}, i);
      ASSERT_EQ(of_rays[i], takes_part ? by_ray_[i] : before[i]) << name << " ray " << i;
      ASSERT_EQ(of_boxes[i], takes_part ? by_box_[i] : before[i]) << name << " box " << i;
      ASSERT_EQ(any_ray.is_hit(i), of_rays.is_hit(i)) << name << " ray " << i;
      ASSERT_EQ(any_box.is_hit(i), of_boxes.is_hit(i)) << name << " box " << i;
    }
    for (IntervalColumns* out : {&of_rays, &of_boxes, &any_ray, &any_box})
      ASSERT_TRUE(out->are_intact()) << name;
  }

  BoxScene scene_;
  std::vector<BoxResult> by_ray_, by_box_;
};

TEST_P(BoxArraysOf, any_length_alignment_and_mask_are_as_if_one_by_one) {
  for (const BoxVariant& variant : all_variants<BoxTest>()) {
    if (variant.test != GetParam()) continue;
    by_ray_.clear(), by_box_.clear();
    for (std::size_t i = 0; i < most; ++i) {
      by_ray_.push_back(answers(variant, {&scene_.rays[i], 1}, {&scene_.boxes[0], 1})[0]);
      by_box_.push_back(answers(variant, {&scene_.rays[0], 1}, {&scene_.boxes[i], 1})[0]);
    }
    Random random(206);
    for (const Place place : {Place::before_guard, Place::after_guard})
      for (std::size_t n = 0; n <= most; ++n) {
        Inputs inputs{RayColumns(std::span(scene_.rays).first(n), place),
                      BoxColumns(std::span(scene_.boxes).first(n), place)};
        check(variant, inputs, place, nullptr);
        for (const std::vector<std::uint8_t>& mask : masks_for(n, random)) {
          GuardedArray<std::uint8_t> guarded(mask.size(), place);
          guarded.fill(mask);
          check(variant, inputs, place, guarded.data());
        }
        if (HasFatalFailure()) return;
      }
  }
}
INSTANTIATE_TEST_SUITE_P(Each, BoxArraysOf,
                         ::testing::Values(BoxTest::conservative, BoxTest::plain, BoxTest::directional));

// A ray that hits nothing has its bits written too, and no others.
TEST(BoxArrays, of_an_invalid_ray_are_missed_where_they_take_part) {
  const Ray invalid = make_ray({0, 0, 0}, {0, 0, 0});
  const std::vector<Box> boxes(most, {{-1, -1, -1}, {1, 1, 1}});
  Random random(208);
  for (const BoxVariant& variant : all_variants<BoxTest>())
    for (std::size_t n = 0; n <= most; ++n)
      for (const std::vector<std::uint8_t>& mask : masks_for(n, random)) {
        BoxColumns columns(std::span<const Box>(boxes).first(n), Place::before_guard);
        IntervalColumns out(n, Place::before_guard), before(n);
        variant.kernels().any_of_boxes(invalid, columns_of(columns).data(), n, mask.data(), out.bits());
        for (std::size_t i = 0; i < n; ++i)
          ASSERT_EQ(out.is_hit(i), is_set(mask, i) ? false : before.is_hit(i)) << variant.name() << ' ' << i;
        ASSERT_TRUE(out.are_intact()) << variant.name();
      }
}

// What takes no part is not even looked at: here it lies on pages that may not be.
TEST(BoxArrays, of_inactive_elements_may_be_nowhere) {
  const Ray ray = make_ray({0.5f, 0.25f, 5}, {0, 0.125f, -1});
  const std::vector<Box> boxes(3, {{-1, -1, -1}, {1, 1, 1}});
  const std::vector<Ray> rays(3, ray);
  // Elements 29, 30, 31 exist; or 0, 1, 2 of 32.
  for (const bool at_end : {false, true}) {
    const Place place = at_end ? Place::after_guard : Place::before_guard;
    BoxColumns three_boxes(boxes, place);
    RayColumns three_rays(rays, place);
    IntervalColumns of_boxes(32), of_rays(32);
    std::vector<const float*> columns = columns_of(three_boxes);
    RayArrays arrays = three_rays.arrays();
    arrays.size = 32;
    std::vector<std::uint8_t> mask{0, 0, 0, 0};
    mask[at_end ? 3 : 0] = at_end ? 0xe0 : 0x07;
    if (at_end) {
      // There is one element before these, then a page that may not be looked at.
      for (const float*& column : columns) column -= 29;
      for (std::size_t axis = 0; axis < 3; ++axis) arrays.origin[axis] -= 29, arrays.direction[axis] -= 29;
      arrays.tmin -= 29, arrays.tmax -= 29;
    }
    for (const BoxVariant& variant : all_variants<BoxTest>()) {
      const BoxRow& row = variant.kernels();
      row.intervals_of_boxes(ray, columns.data(), 32, mask.data(), of_boxes.bits(), of_boxes.from(),
                             of_boxes.to());
      row.intervals_of_rays(arrays, boxes[0].lo.data(), mask.data(), of_rays.bits(), of_rays.from(),
                            of_rays.to());
      row.any_of_boxes(ray, columns.data(), 32, mask.data(), of_boxes.bits());
      row.any_of_rays(arrays, boxes[0].lo.data(), mask.data(), of_rays.bits());
      for (std::size_t i = at_end ? 29 : 0; i < (at_end ? 32u : 3u); ++i)
        EXPECT_TRUE(of_boxes.is_hit(i) && of_rays.is_hit(i)) << variant.name();
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
