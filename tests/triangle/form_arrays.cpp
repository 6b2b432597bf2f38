// All triangle forms on any number of rays and triangles, with lanes left out by a mask.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "../support/random_input.hpp"
#include "answers.hpp"
#include "scenes.hpp"

namespace raylanes::testing {
namespace {

using Results = std::vector<TriangleResult>;

// Rays and triangles for all forms alike: `directional` wants one direction, so all rays get that of the
// first and start so that they reach what they were aimed at.
TriangleScene scene_for(const FormVariant& variant, std::uint64_t seed) {
  Random random(seed);
  TriangleScene scene = scene_for_all_widths(Aim::anywhere, random);
  for (Ray& ray : scene.rays) {
    ray.tmin = -infinity;
    if (variant.test != TriangleForm::directional) continue;
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] += ray.direction[axis] - scene.rays[0].direction[axis];
      ray.direction[axis] = scene.rays[0].direction[axis];
    }
  }
  return scene;
}

TEST(TriangleForms, of_any_length_and_alignment_stay_within_their_arrays) {
  for (const FormVariant& variant : all_variants<TriangleForm>()) {
    const TriangleScene scene = scene_for(variant, 106);
    const float* const direction = scene.rays[0].direction.data();
    const Results whole = answers(variant, scene.rays, scene.triangles);
    for (const Place place : {Place::before_guard, Place::after_guard})
      for (std::size_t n = 0; n <= scene.rays.size(); ++n) {
        const PreparedTriangles prepared(variant, std::span(scene.triangles).first(n), direction, place);
        GuardedArray<std::uint8_t> bits(n / 8 + 1, place);
        std::fill_n(bits.data(), bits.size(), std::uint8_t{0xff});
        any_hits(variant.kernels().any_of_triangles, scene.rays[0], prepared.columns(),
                 columns_of(variant.test), n, bits.data());
        for (std::size_t i = 0; i < bits.size() * 8; ++i) {
          const bool expected = i >= n || whole[i * scene.rays.size()].hit != 0;
          ASSERT_EQ(is_set({bits.data(), bits.size()}, i), expected) << variant.name() << " n " << n;
        }
        ASSERT_TRUE(bits.is_intact()) << variant.name() << " n " << n;
        RayColumns rays(std::span(scene.rays).first(n), place);
        TriangleHitColumns out(n, place);
        const PreparedTriangles target(variant, std::span(scene.triangles).first(1), direction);
        const TriangleHitArrays to = out.arrays();
        closest_hits(variant.kernels(), Wanted::weights, rays.arrays(), n, target.one(0).data(),
                     {to.t, to.hit, to.u, to.v, {}});
        for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(out[i], whole[i]) << variant.name() << " n " << n;
        ASSERT_TRUE(out.are_intact()) << variant.name() << " n " << n;
      }
  }
}

TEST(TriangleForms, leave_the_outputs_of_inactive_lanes_untouched) {
  Random random(107);
  for (const FormVariant& variant : all_variants<TriangleForm>()) {
    const TriangleScene scene = scene_for(variant, 107);
    const float* const direction = scene.rays[0].direction.data();
    const Results whole = answers(variant, scene.rays, scene.triangles);
    std::uint8_t active[3] = {};
    for (std::size_t i = 0; i < 19; ++i)
      if (random.chance(0.5)) active[i / 8] = static_cast<std::uint8_t>(active[i / 8] | 1u << (i % 8));
    const auto is_active = [&](std::size_t i) { return is_set(active, i); };
    std::vector<Ray> spoiled_rays = scene.rays;
    std::vector<Triangle> spoiled = scene.triangles;
    for (std::size_t i = 0; i < 19; ++i)
      if (!is_active(i)) {
        spoiled_rays[i] = make_ray({nan, nan, nan}, {nan, nan, nan}, nan, nan);
        spoiled[i] = make_triangle({nan, nan, nan}, {nan, nan, nan}, {nan, nan, nan});
      }
    const PreparedTriangles prepared(variant, spoiled, direction);
    std::uint8_t bits[3] = {0x5a, 0xa5, 0x5a};
    any_hits(variant.kernels().any_of_triangles, scene.rays[0], prepared.columns(), columns_of(variant.test),
             19, bits, active);
    RayColumns rays(spoiled_rays);
    TriangleHitColumns out(19);
    const TriangleResult before = out[0];
    const TriangleHitArrays to = out.arrays();
    const PreparedTriangles target(variant, std::span(scene.triangles).first(1), direction);
    closest_hits(variant.kernels(), Wanted::weights, rays.arrays(), 19, target.one(0).data(),
                 {to.t, to.hit, to.u, to.v, {}}, active);
    for (std::size_t i = 0; i < 19; ++i) {
      const std::uint8_t old[3] = {0x5a, 0xa5, 0x5a};
      const bool untouched = is_set(old, i);
      const bool hit = whole[i * 19].hit != 0;
      ASSERT_EQ(is_set(bits, i), is_active(i) ? hit : untouched) << variant.name();
      ASSERT_EQ(out[i], is_active(i) ? whole[i] : before) << variant.name();
    }
    Hit nearest{infinity, 0, 0, no_primitive};
    for (std::uint32_t i = 0; i < 19; ++i)
      if (is_active(i) && whole[i * 19].hit != 0 && whole[i * 19].t < nearest.t)
        nearest = {whole[i * 19].t, whole[i * 19].u, whole[i * 19].v, i};
    const Hit found = closest_hit(variant.kernels(), Wanted::weights, scene.rays[0], prepared.columns(),
                                  columns_of(variant.test), 19, active)
                          .hit;
    EXPECT_EQ(std::memcmp(&found, &nearest, sizeof found), 0) << variant.name();
  }
}

}  // namespace
}  // namespace raylanes::testing
