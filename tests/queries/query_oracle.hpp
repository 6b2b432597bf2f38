// Hits of a mesh by exact arithmetic, of some triangles.
#pragma once

#include "../../bench/support/oracles/exact_rays.hpp"
#include "../support/random_input.hpp"

namespace raylanes::testing {

// The hits of one side, of all triangles but one.
template <class AnyMesh, class AnyRay>
auto oracle_hits(const AnyMesh& mesh, const AnyRay& ray, Facing facing = Facing::any,
                 std::uint32_t skipped = no_primitive) {
  auto hits = oracle::exact_hits(mesh, ray, facing);
  std::erase_if(hits, [&](const auto& hit) { return hit.primitive == skipped; });
  return hits;
}
inline Hit nearest_of_chosen(const Mesh& mesh, const Ray& ray, Facing facing, std::uint32_t skipped) {
  const std::vector<Hit> hits = oracle_hits(mesh, ray, facing, skipped);
  return hits.empty() ? Hit() : hits[0];
}

}  // namespace raylanes::testing
