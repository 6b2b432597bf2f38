// Rays of doubles along axes and in the planes of a mesh, against rational numbers.
#include <gtest/gtest.h>

#include "../support/float_modes.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "../support/terrain.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

RayD widened(const Ray& ray) {
  RayD wide;
  for (std::size_t k = 0; k < 3; ++k) wide.origin[k] = ray.origin[k], wide.direction[k] = ray.direction[k];
  wide.tmin = ray.tmin, wide.tmax = ray.tmax;
  return wide;
}

TEST(DoublesAlongAxes, have_the_hits_and_crossings_of_rational_numbers) {
  const Mesh mesh = terrain_over_a_floor();
  const DoubleMesh wide = moved(mesh, 1.0, {0, 0, 0});
  std::vector<RayD> rays;
  for (const Ray& ray : rays_along_axes(mesh, by_level(120, 300, 1200), 65)) rays.push_back(widened(ray));
  std::vector<std::vector<HitD>> all;
  std::vector<std::vector<CrossingD>> crossed;
  for (const RayD& ray : rays) {
    all.push_back(exact_double_hits(wide, ray));
    crossed.push_back(exact_double_crossings(wide, ray));
  }
  const BvhD tree(wide.vertices, wide.triangles);
  for (const Path* path : paths_with_own_queries())
    for (const FloatMode mode : float_modes) {
      const FloatModeScope scope(mode);
      std::vector<HitD> hits(rays.size());
      tree.closest(rays, hits, {.path = path});
      const RayLists<HitD> lists = tree.all_hits(rays, {.path = path});
      const RayLists<CrossingD> crossings = tree.crossings(rays, {.path = path});
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const HitD first = all[i].empty() ? HitD() : all[i][0];
        ASSERT_TRUE(same_bytes(hits[i], first)) << path->name << " ray " << i;
        ASSERT_TRUE(same_bytes(tree.closest(rays[i], {.path = path}), first)) << path->name << " ray " << i;
        ASSERT_EQ(tree.occluded(rays[i], {.path = path}), static_cast<bool>(first)) << "ray " << i;
        ASSERT_TRUE(same_bytes(lists[i], all[i])) << path->name << " ray " << i;
        ASSERT_TRUE(std::ranges::equal(crossings[i], crossed[i])) << path->name << " ray " << i;
      }
    }
}

}  // namespace
}  // namespace raylanes::testing
