// The passages of any rays through trees over meshes of any bits.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "../oracles/passage_oracle.hpp"
#include "../support/same_bytes.hpp"
#include "fence.hpp"
#include "support.hpp"

namespace raylanes::testing {

// The first passages, and those behind them, in place.
template <class Tree, class AnyMesh, class AnyRay, class Options>
void expect_passages(const Tree& tree, const AnyMesh& mesh, const std::vector<AnyRay>& rays,
                     Options options) {
  using AnyHit = typename decltype(oracle_hits(mesh, rays[0]))::value_type;
  constexpr std::size_t max_rays = 64;
  static Fence fence(max_rays * sizeof(AnyHit));
  const std::span<AnyHit> hits(fence.last<AnyHit>(rays.size()), rays.size());
  std::vector<std::vector<AnyHit>> expected;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    expected.push_back(
        oracle_passages(mesh, rays[i], options.skip.count > 0 ? options.skip[i] : no_primitive));
    const auto sided = oracle_hits(mesh, rays[i], options.facing);
    std::erase_if(expected[i], [&](const AnyHit& hit) {
      return std::ranges::find(sided, hit.primitive, &AnyHit::primitive) == sided.end();
    });
  }
  for (std::size_t layer = 0; layer < 2; ++layer) {
    tree.closest_crossing(rays, hits, options);
    fence.expect_intact("passages");
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!same_bytes(hits[i], layer < expected[i].size() ? expected[i][layer] : AnyHit()))
        fail(std::string(options.path->name) + ": ray " + std::to_string(i) + ": passage " +
             std::to_string(layer));
    options.after = hits;
  }
}

}  // namespace raylanes::testing
