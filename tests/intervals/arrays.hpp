// Tests of boxes and of spheres over arrays: any length, alignment and mask.
#pragma once

#include "interval_answers.hpp"

namespace raylanes::testing {

// As many rays as primitives, which meet often.
template <class Kind>
IntervalScene<PrimitiveOf<Kind>> scene_of_many(std::size_t count);

template <class Kind>
class IntervalArrays : public ::testing::Test {
 protected:
  static constexpr std::size_t most = 40;
  using Primitive = PrimitiveOf<Kind>;

  struct Inputs {
    RayColumns rays;
    Columns<Primitive> primitives;
  };
  Inputs inputs(std::size_t n, Place place) const {
    return {RayColumns(std::span(scene_.rays).first(n), place),
            Columns<Primitive>(std::span(scene_.primitives).first(n), place)};
  }

  // n elements between guard pages, with a mask of their own; each answer as if asked alone, and what takes no part, or
  // lies behind, left as it was.
  void check(const Variant<Kind>& variant, Inputs& in, Place place, LaneBits active) {
    const std::size_t n = in.rays.size();
    const std::string name =
        variant.name() + ", n = " + std::to_string(n) + (active != nullptr ? ", masked" : "");
    const IntervalRow row = interval_row(variant.kernels());
    const Ray& ray = scene_.rays[0];
    const auto numbers = numbers_of(scene_.primitives[0]);
    IntervalColumns of_rays(n, place), of_primitives(n, place), any_ray(n, place), any_primitive(n, place),
        before(n);
    row.of_rays(in.rays.arrays(), numbers.data(), active, of_rays.bits(), of_rays.from(), of_rays.to());
    row.of_primitives(ray, in.primitives.soa(), n, active, of_primitives.bits(), of_primitives.from(),
                      of_primitives.to());
    row.any_of_rays(in.rays.arrays(), numbers.data(), active, any_ray.bits());
    row.any_of_primitives(ray, in.primitives.soa(), n, active, any_primitive.bits());
    for (std::size_t i = 0; i < n; ++i) {
      const bool takes_part = active == nullptr || is_set({active, (n + 7) / 8}, i);
      ASSERT_EQ(of_rays[i], takes_part ? by_ray_[i] : before[i]) << name << " ray " << i;
      ASSERT_EQ(of_primitives[i], takes_part ? by_primitive_[i] : before[i]) << name << " primitive " << i;
      ASSERT_EQ(any_ray.is_hit(i), of_rays.is_hit(i)) << name << " ray " << i;
      ASSERT_EQ(any_primitive.is_hit(i), of_primitives.is_hit(i)) << name << " primitive " << i;
    }
    for (IntervalColumns* out : {&of_rays, &of_primitives, &any_ray, &any_primitive})
      ASSERT_TRUE(out->are_intact()) << name;
  }

  void ask_one_by_one(const Variant<Kind>& variant) {
    by_ray_.clear(), by_primitive_.clear();
    for (std::size_t i = 0; i < most; ++i) {
      by_ray_.push_back(answers(variant, {&scene_.rays[i], 1}, {&scene_.primitives[0], 1})[0]);
      by_primitive_.push_back(answers(variant, {&scene_.rays[0], 1}, {&scene_.primitives[i], 1})[0]);
    }
  }

  IntervalScene<Primitive> scene_ = scene_of_many<Kind>(most);
  std::vector<IntervalResult> by_ray_, by_primitive_;
};
TYPED_TEST_SUITE_P(IntervalArrays);

TYPED_TEST_P(IntervalArrays, any_length_alignment_and_mask_are_as_if_one_by_one) {
  for (const Variant<TypeParam>& variant : all_variants<TypeParam>()) {
    this->ask_one_by_one(variant);
    for_all_masks(
        this->most, [&](std::size_t n, Place place) { return this->inputs(n, place); },
        [&](auto& inputs, Place place, LaneBits active) { this->check(variant, inputs, place, active); });
    if (this->HasFatalFailure()) return;
  }
}

// A ray that hits nothing has its bits written too, and no others.
TYPED_TEST_P(IntervalArrays, of_an_invalid_ray_are_missed_where_they_take_part) {
  const Ray invalid = make_ray({0, 0, 0}, {0, 0, 0});
  for (const Variant<TypeParam>& variant : all_variants<TypeParam>())
    for_all_masks(
        this->most, [&](std::size_t n, Place place) { return this->inputs(n, place); },
        [&](auto& inputs, Place place, LaneBits active) {
          const std::size_t n = inputs.rays.size();
          IntervalColumns out(n, place), before(n);
          interval_row(variant.kernels())
              .any_of_primitives(invalid, inputs.primitives.soa(), n, active, out.bits());
          for (std::size_t i = 0; i < n; ++i) {
            const bool takes_part = active == nullptr || is_set({active, (n + 7) / 8}, i);
            ASSERT_EQ(out.is_hit(i), takes_part ? false : before.is_hit(i)) << variant.name() << ' ' << i;
          }
          ASSERT_TRUE(out.are_intact()) << variant.name();
        });
}

// Inactive elements are not even read: here they lie on pages that must not be read.
TYPED_TEST_P(IntervalArrays, of_inactive_elements_may_be_nowhere) {
  // Elements 29, 30, 31 exist; or 0, 1, 2 of 32.
  for (const bool at_end : {false, true}) {
    auto three = this->inputs(3, at_end ? Place::after_guard : Place::before_guard);
    IntervalColumns of_primitives(32), of_rays(32);
    std::vector<const float*> columns = three.primitives.pointers();
    RayArrays arrays = three.rays.arrays();
    arrays.size = 32;
    std::vector<std::uint8_t> mask{0, 0, 0, 0};
    mask[at_end ? 3 : 0] = at_end ? 0xe0 : 0x07;
    if (at_end) {
      // There is one element before these, then a page that may not be looked at.
      for (const float*& column : columns) column -= 29;
      for (std::size_t axis = 0; axis < 3; ++axis) arrays.origin[axis] -= 29, arrays.direction[axis] -= 29;
      arrays.tmin -= 29, arrays.tmax -= 29;
    }
    const auto numbers = numbers_of(this->scene_.primitives[0]);
    for (const Variant<TypeParam>& variant : all_variants<TypeParam>()) {
      this->ask_one_by_one(variant);
      const IntervalRow row = interval_row(variant.kernels());
      row.of_primitives(this->scene_.rays[0], columns.data(), 32, mask.data(), of_primitives.bits(),
                        of_primitives.from(), of_primitives.to());
      row.of_rays(arrays, numbers.data(), mask.data(), of_rays.bits(), of_rays.from(), of_rays.to());
      row.any_of_primitives(this->scene_.rays[0], columns.data(), 32, mask.data(), of_primitives.bits());
      row.any_of_rays(arrays, numbers.data(), mask.data(), of_rays.bits());
      for (std::size_t i = 0, at = at_end ? 29 : 0; i < 3; ++i, ++at) {
        EXPECT_EQ(of_primitives[at], this->by_primitive_[i]) << variant.name();
        EXPECT_EQ(of_rays[at], this->by_ray_[i]) << variant.name();
      }
    }
  }
}

REGISTER_TYPED_TEST_SUITE_P(IntervalArrays, any_length_alignment_and_mask_are_as_if_one_by_one,
                            of_an_invalid_ray_are_missed_where_they_take_part,
                            of_inactive_elements_may_be_nowhere);

}  // namespace raylanes::testing
