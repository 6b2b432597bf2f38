// Sphere tests on any number of rays and spheres, with lanes left out by a mask.
#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "answers.hpp"

namespace raylanes::testing {
namespace {

TEST(Spheres, of_any_count_and_with_inactive_lanes) {
  Random random(306);
  const SphereScene scene = sphere_scene(3, random);
  for (const SphereVariant& variant : all_variants<SphereTest>()) {
    const std::vector<SphereResult> whole = answers(variant, scene.rays, scene.spheres);
    const std::size_t all = scene.rays.size();
    for (const Place place : {Place::before_guard, Place::after_guard})
      for (const std::size_t n : {1u, 3u, 5u, 8u, 9u}) {
        const std::vector<SphereResult> part =
            answers(variant, std::span(scene.rays).first(2 * n), std::span(scene.spheres).first(n), place);
        for (std::size_t i = 0; i < part.size(); ++i)
          ASSERT_EQ(part[i], whole[i / (2 * n) * all + i % (2 * n)]) << variant.name();
      }
    const std::uint8_t active[4] = {0x35, 0xff, 0xff, 0x02};
    RayColumns rays(scene.rays);
    BoxHitColumns out(all);
    const BoxResult before = out[0];
    const BoxHitArrays to = out.arrays();
    distances(variant.kernels(), rays.arrays(), all, scene.spheres[0].value, {to.entry, to.exit, to.hit},
              active);
    for (std::size_t i = 0; i < all; ++i) {
      const bool is_active = is_set(active, i);
      const BoxResult expected = is_active ? BoxResult{whole[i].near, whole[i].far, whole[i].hit} : before;
      ASSERT_EQ(out[i], expected) << variant.name();
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
