// What exact arithmetic says of lists and crossings, of a mesh.
#pragma once

#include "../../bench/support/oracles/exact_crossings.hpp"
#include "../support/random_input.hpp"

namespace raylanes::testing {

inline std::vector<Hit> oracle_hits(const Mesh& mesh, const Ray& ray) {
  return oracle::all_exact_hits(mesh.vertices, mesh.triangles, ray);
}
inline std::vector<Crossing> oracle_crossings(const Mesh& mesh, const Ray& ray) {
  return oracle::exact_crossings(mesh.vertices, mesh.triangles, ray);
}

}  // namespace raylanes::testing
