// All sphere tests over arrays: any length, alignment and mask.
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "answers.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t most = 40;

class SphereArraysOf : public ::testing::TestWithParam<SphereTest> {
 protected:
  SphereArraysOf() {
    Random random(306);
    for (SphereScene more; scene_.rays.size() < most || scene_.spheres.size() < most;) {
      more = sphere_scene(3, random);
      scene_.rays.insert(scene_.rays.end(), more.rays.begin(), more.rays.end());
      scene_.spheres.insert(scene_.spheres.end(), more.spheres.begin(), more.spheres.end());
    }
  }

  // The nearest of what takes part, from what each sphere alone answers.
  Hit nearest_of(std::size_t n, LaneBits active) const {
    Hit nearest;
    for (std::size_t i = 0; i < n; ++i)
      if ((active == nullptr || is_set({active, (n + 7) / 8}, i)) && alone_[i] && alone_[i].t < nearest.t)
        nearest = {alone_[i].t, 0, 0, static_cast<std::uint32_t>(i)};
    return nearest;
  }

  struct Inputs {
    RayColumns rays;
    SphereColumns spheres;
  };

  // n elements between guard pages, with a mask of their own; each answer as if asked alone, and what takes no part, or
  // lies behind, left as it was.
  void check(const SphereVariant& variant, Inputs& inputs, Place place, LaneBits active) {
    const std::size_t n = inputs.rays.size();
    const std::string name =
        variant.name() + ", n = " + std::to_string(n) + (active != nullptr ? ", masked" : "");
    auto& [rays, spheres] = inputs;
    const SphereRow& row = variant.kernels();
    IntervalColumns of_rays(n, place), of_spheres(n, place), any_ray(n, place), any_sphere(n, place),
        line(n, place), before(n);
    row.distances_of_rays(rays.arrays(), scene_.spheres[0].value, active, of_rays.bits(), of_rays.from(),
                          of_rays.to());
    row.distances_of_spheres(scene_.rays[0], spheres.columns(), n, active, of_spheres.bits(),
                             of_spheres.from(), of_spheres.to());
    row.any_of_rays(rays.arrays(), scene_.spheres[0].value, active, any_ray.bits());
    row.any_of_spheres(scene_.rays[0], spheres.columns(), n, active, any_sphere.bits());
    const auto grade = static_cast<std::size_t>(variant.grade);
    variant.path->kernels.spheres.line_of_spheres[grade](scene_.rays[0], spheres.columns(), n, active,
                                                         line.bits());
    for (std::size_t i = 0; i < n; ++i) {
      const bool takes_part = active == nullptr || is_set({active, (n + 7) / 8}, i);
      ASSERT_EQ(result_of(of_rays, i), takes_part ? by_ray_[i] : result_of(before, i))
          << name << " ray " << i;
      ASSERT_EQ(result_of(of_spheres, i), takes_part ? by_sphere_[i] : result_of(before, i))
          << name << " sphere " << i;
      ASSERT_EQ(any_ray.is_hit(i), of_rays.is_hit(i)) << name << " ray " << i;
      ASSERT_EQ(any_sphere.is_hit(i), of_spheres.is_hit(i)) << name << " sphere " << i;
      ASSERT_EQ(line.is_hit(i), takes_part ? by_line_[i] : before.is_hit(i)) << name << " sphere " << i;
    }
    for (IntervalColumns* out : {&of_rays, &of_spheres, &any_ray, &any_sphere, &line})
      ASSERT_TRUE(out->are_intact()) << name;
    Hit nearest;
    row.closest_of_spheres(scene_.rays[0], spheres.columns(), n, active, nearest);
    const Hit expected = nearest_of(n, active);
    ASSERT_EQ(std::memcmp(&nearest, &expected, sizeof nearest), 0) << name;
  }

  SphereScene scene_;
  std::vector<SphereResult> by_ray_, by_sphere_;
  std::vector<Hit> alone_;
  std::vector<bool> by_line_;
};

TEST_P(SphereArraysOf, any_length_alignment_and_mask_are_as_if_one_by_one) {
  for (const SphereVariant& variant : all_variants<SphereTest>()) {
    if (variant.test != GetParam()) continue;
    by_ray_.clear(), by_sphere_.clear(), alone_.clear(), by_line_.clear();
    for (std::size_t i = 0; i < most; ++i) {
      const std::span<const Sphere> sphere(&scene_.spheres[i], 1);
      by_ray_.push_back(answers(variant, {&scene_.rays[i], 1}, {&scene_.spheres[0], 1})[0]);
      by_sphere_.push_back(answers(variant, {&scene_.rays[0], 1}, sphere)[0]);
      by_line_.push_back(line_answers(*variant.path, variant.grade, {&scene_.rays[0], 1}, sphere)[0]);
      alone_.push_back(closest_answer(variant, scene_.rays[0], sphere));
    }
    Random random(312);
    for (const Place place : {Place::before_guard, Place::after_guard})
      for (std::size_t n = 0; n <= most; ++n) {
        Inputs inputs{RayColumns(std::span(scene_.rays).first(n), place),
                      SphereColumns(std::span(scene_.spheres).first(n), place)};
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
INSTANTIATE_TEST_SUITE_P(Each, SphereArraysOf,
                         ::testing::Values(SphereTest::perpendicular, SphereTest::textbook));

// A ray that hits nothing has its bits written too, and no others.
TEST(SphereArrays, of_an_invalid_ray_are_missed_where_they_take_part) {
  const Ray invalid = make_ray({0, 0, 0}, {0, 0, 0});
  const std::vector<Sphere> spheres(most, ball({0, 0, 0}, 1));
  Random random(315);
  for (const SphereVariant& variant : all_variants<SphereTest>())
    for (std::size_t n = 0; n <= most; ++n)
      for (const std::vector<std::uint8_t>& mask : masks_for(n, random)) {
        const SphereColumns columns(std::span<const Sphere>(spheres).first(n), Place::before_guard);
        IntervalColumns any(n, Place::before_guard), line(n, Place::before_guard), before(n);
        const auto line_of_spheres =
            variant.path->kernels.spheres.line_of_spheres[static_cast<std::size_t>(variant.grade)];
        variant.kernels().any_of_spheres(invalid, columns.columns(), n, mask.data(), any.bits());
        line_of_spheres(invalid, columns.columns(), n, mask.data(), line.bits());
        for (std::size_t i = 0; i < n; ++i) {
          const bool expected = is_set(mask, i) ? false : before.is_hit(i);
          ASSERT_EQ(any.is_hit(i), expected) << variant.name() << ' ' << i;
          ASSERT_EQ(line.is_hit(i), expected) << variant.name() << ' ' << i;
        }
        ASSERT_TRUE(any.are_intact() && line.are_intact()) << variant.name();
      }
}

// Blocks of eight registers and what is left of one.
TEST(SphereArrays, of_many_rays_are_as_if_one_by_one) {
  Random random(313);
  std::vector<Ray> rays;
  Sphere sphere;
  while (rays.size() < 300) {
    const SphereScene scene = sphere_scene(3, random);
    sphere = scene.spheres[0];
    rays.insert(rays.end(), scene.rays.begin(), scene.rays.end());
  }
  // Directions of all lengths: each ray has a scale of its own.
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (float& x : rays[i].direction)
      x *= std::bit_cast<float>(static_cast<std::uint32_t>(100 + i % 50) << 23);
  for (const SphereVariant& variant : all_variants<SphereTest>())
    for (const std::size_t n : {127u, 128u, 129u, 255u, 300u}) {
      const auto all = answers(variant, std::span(rays).first(n), {&sphere, 1});
      for (std::size_t i = 0; i < n; ++i)
        ASSERT_EQ(all[i], answers(variant, {&rays[i], 1}, {&sphere, 1})[0]) << variant.name() << " ray " << i;
    }
}

}  // namespace
}  // namespace raylanes::testing
