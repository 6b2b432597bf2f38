// The closest crossings of any rays through trees over meshes of any bits.
#pragma once

#include <raylanes/stretches.hpp>

#include "../oracles/closest_crossing_oracle.hpp"
#include "../support/same_bytes.hpp"
#include "fence.hpp"
#include "support.hpp"

namespace raylanes::testing {

// Stretches follow one another within their rays, and the winding number of each is the sum of sides behind its entry.
template <class Tree, class AnyRay>
void expect_stretches(const Tree& tree, const std::vector<AnyRay>& rays, const Path* path) {
  std::vector<AnyRay> whole = rays;
  for (AnyRay& ray : whole)
    if (ray.tmin <= ray.tmax) ray.tmax = std::numeric_limits<decltype(ray.tmax)>::infinity();
  const auto lists = stretches(tree, rays, {.path = path});
  const auto crossings = tree.crossings(whole, {.path = path});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    auto end = rays[i].tmin;
    std::int64_t count = 0;
    for (const auto& stretch : lists[i]) {
      std::int64_t winding = 0;
      for (const auto& crossing : crossings[i]) winding += crossing.t > stretch.entry ? crossing.side : 0;
      if (stretch.entry < end || stretch.exit <= stretch.entry || stretch.exit > rays[i].tmax ||
          stretch.winding != winding || winding == 0)
        fail(std::string(path->name) + ": ray " + std::to_string(i) + ": a wrong stretch");
      end = stretch.exit, ++count;
    }
    // Between crossings the number changes, or does not.
    std::int64_t wanted = 0, before = 0, sum = 0;
    for (const auto& crossing : crossings[i]) sum += crossing.side;
    auto from = rays[i].tmin;
    for (std::size_t k = 0; k <= crossings[i].size(); ++k) {
      const bool is_last = k == crossings[i].size() || crossings[i][k].t > rays[i].tmax;
      const auto to = is_last ? rays[i].tmax : crossings[i][k].t;
      if (to > from) wanted += sum != 0 && sum != before ? 1 : 0, before = sum, from = to;
      if (is_last) break;
      sum -= crossings[i][k].side;
    }
    if (count != wanted) fail(std::string(path->name) + ": ray " + std::to_string(i) + ": other stretches");
  }
}

// The closest crossings, and the ones after them, in place.
template <class Tree, class AnyMesh, class AnyRay, class Options>
void expect_closest_crossings(const Tree& tree, const AnyMesh& mesh, const std::vector<AnyRay>& rays,
                              Options options) {
  using AnyHit = typename decltype(oracle_hits(mesh, rays[0]))::value_type;
  constexpr std::size_t max_rays = 64;
  static Fence fence(max_rays * sizeof(AnyHit));
  const std::span<AnyHit> hits(fence.last<AnyHit>(rays.size()), rays.size());
  std::vector<std::vector<AnyHit>> expected;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    expected.push_back(
        oracle_closest_crossings(mesh, rays[i], options.skip.count > 0 ? options.skip[i] : no_primitive));
    const auto sided = oracle_hits(mesh, rays[i], options.facing);
    std::erase_if(expected[i], [&](const AnyHit& hit) {
      return std::ranges::find(sided, hit.primitive, &AnyHit::primitive) == sided.end();
    });
  }
  for (std::size_t layer = 0; layer < 2; ++layer) {
    tree.closest_crossing(rays, hits, options);
    fence.expect_intact("closest crossing");
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!same_bytes(hits[i], layer < expected[i].size() ? expected[i][layer] : AnyHit()))
        fail(std::string(options.path->name) + ": ray " + std::to_string(i) + ": closest crossing " +
             std::to_string(layer));
    options.after = hits;
  }
  expect_stretches(tree, rays, options.path);
}

}  // namespace raylanes::testing
