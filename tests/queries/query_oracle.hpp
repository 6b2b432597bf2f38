// Lists and crossings of a mesh by exact arithmetic.
#pragma once

#include "../../bench/support/oracles/exact_crossings.hpp"
#include "../../bench/support/oracles/rational_vectors.hpp"
#include "../support/random_input.hpp"

namespace raylanes::testing {

inline std::vector<Hit> oracle_hits(const Mesh& mesh, const Ray& ray) {
  return oracle::all_exact_hits(mesh.vertices, mesh.triangles, ray);
}
inline std::vector<Crossing> oracle_crossings(const Mesh& mesh, const Ray& ray) {
  return oracle::exact_crossings(mesh.vertices, mesh.triangles, ray);
}

// The side of a triangle that a ray comes to: -1 is the front, 1 the back.
inline int exact_side(const Mesh& mesh, const Ray& ray, std::uint32_t primitive) {
  const Triangle triangle = triangle_of(mesh.vertices, mesh.triangles[primitive]);
  const oracle::Vector v0 = oracle::to_vector(triangle.corner[0]);
  const auto edge_to = [&](int k) { return oracle::operator-(oracle::to_vector(triangle.corner[k]), v0); };
  return sgn(oracle::dot(oracle::to_vector(ray.direction), oracle::cross(edge_to(1), edge_to(2))));
}
// The hits of one side, of all triangles but one.
inline std::vector<Hit> oracle_hits(const Mesh& mesh, const Ray& ray, Facing facing,
                                    std::uint32_t skipped = no_primitive) {
  std::vector<Hit> hits = oracle_hits(mesh, ray);
  const int kept = facing == Facing::front ? -1 : 1;
  std::erase_if(hits, [&](const Hit& hit) {
    return hit.primitive == skipped ||
           (facing != Facing::any && exact_side(mesh, ray, hit.primitive) != kept);
  });
  return hits;
}
inline Hit nearest_of_chosen(const Mesh& mesh, const Ray& ray, Facing facing, std::uint32_t skipped) {
  const std::vector<Hit> hits = oracle_hits(mesh, ray, facing, skipped);
  return hits.empty() ? Hit() : hits[0];
}

}  // namespace raylanes::testing
