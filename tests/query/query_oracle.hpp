// What exact arithmetic says of lists, crossings and places: rational numbers over all triangles. Directions are really
// moved by a number below all others, so that the definition itself is what judges.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <raylanes/queries.hpp>

#include "../../bench/oracles/exact_hit.hpp"
#include "../../bench/oracles/rational_vectors.hpp"
#include "../support/random_input.hpp"

namespace raylanes::testing {

using oracle::operator-, oracle::operator+;

inline std::vector<Hit> oracle_hits(const Mesh& mesh, const Ray& ray) {
  std::vector<Hit> hits;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    Hit hit = oracle::exact_hit(ray, triangle_of(mesh.vertices, mesh.triangles[i]));
    if (!hit) continue;
    hit.primitive = i;
    hits.push_back(hit);
  }
  std::stable_sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.t < b.t; });
  return hits;
}

inline bool hits_nothing(const Ray& ray) {
  bool finite = true, moves = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    finite = finite && std::isfinite(ray.origin[axis]) && std::isfinite(ray.direction[axis]);
    moves = moves || ray.direction[axis] != 0;
  }
  return !finite || !moves || !(ray.tmin <= ray.tmax);
}

// A triangle seen from a point.
struct SeenTriangle {
  oracle::Vector a, b, c, of_bc, of_ca, of_ab;
  mpq_class volume;

  SeenTriangle(const Float3& from, const Triangle& triangle)
      : a(oracle::to_vector(triangle.corner[0]) - oracle::to_vector(from)),
        b(oracle::to_vector(triangle.corner[1]) - oracle::to_vector(from)),
        c(oracle::to_vector(triangle.corner[2]) - oracle::to_vector(from)),
        of_bc(oracle::cross(b, c)),
        of_ca(oracle::cross(c, a)),
        of_ab(oracle::cross(a, b)),
        volume(oracle::dot(a, of_bc)) {}

  // The signs of the three weights; 0 if they differ.
  int common_sign(const oracle::Vector& d) const {
    const int u = sgn(oracle::dot(d, of_bc)), v = sgn(oracle::dot(d, of_ca)), w = sgn(oracle::dot(d, of_ab));
    return u == v && v == w ? u : 0;
  }
  bool surely_missed(const oracle::Vector& d) const {
    const int u = sgn(oracle::dot(d, of_bc)), v = sgn(oracle::dot(d, of_ca)), w = sgn(oracle::dot(d, of_ab));
    return std::min({u, v, w}) < 0 && std::max({u, v, w}) > 0;
  }
  // Whether it holds the point: in its plane, and in the three half planes along it.
  bool holds_origin() const {
    const oracle::Vector n = of_bc + of_ca + of_ab;
    if (volume != 0 || oracle::dot(n, n) == 0) return false;
    return sgn(oracle::dot(n, of_bc)) >= 0 && sgn(oracle::dot(n, of_ca)) >= 0 &&
           sgn(oracle::dot(n, of_ab)) >= 0;
  }
};

inline oracle::Vector moved_direction(const Ray& ray) {
  oracle::Vector d = oracle::to_vector(ray.direction);
  mpq_class tiny = 1, step(mpz_class(1), mpz_class(1) << 1500);
  for (mpq_class& x : d) tiny *= step, x += tiny;
  return d;
}

inline std::vector<Crossing> oracle_crossings(const Mesh& mesh, const Ray& ray) {
  std::vector<Crossing> crossings;
  if (hits_nothing(ray)) return crossings;
  constexpr float largest = std::numeric_limits<float>::max();
  if (ray.tmin > largest || ray.tmax < -largest) return crossings;
  const mpq_class tmin = std::max(ray.tmin, -largest), tmax = std::min(ray.tmax, largest);
  const oracle::Vector d = oracle::to_vector(ray.direction), moved = moved_direction(ray);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const SeenTriangle seen(ray.origin, triangle_of(mesh.vertices, mesh.triangles[i]));
    if (seen.surely_missed(d)) continue;
    const int side = seen.common_sign(moved);
    if (side == 0) continue;
    const mpq_class det =
        oracle::dot(d, seen.of_bc) + oracle::dot(d, seen.of_ca) + oracle::dot(d, seen.of_ab);
    const mpq_class t = det == 0 ? mpq_class(0) : mpq_class(seen.volume / det);
    if (t >= tmin && t <= tmax) crossings.push_back({oracle::nearest_float(t), i, side});
  }
  std::stable_sort(crossings.begin(), crossings.end(),
                   [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
  return crossings;
}

// By a ray of this direction, which the answer does not depend on.
inline Location oracle_location(const Mesh& mesh, const Float3& point, const Float3& direction,
                                InsideRule rule = InsideRule::parity) {
  for (const Index3& triangle : mesh.triangles)
    if (SeenTriangle(point, triangle_of(mesh.vertices, triangle)).holds_origin()) return Location::on;
  int winding = 0, parity = 0;
  for (const Crossing& crossing : oracle_crossings(mesh, make_ray(point, direction)))
    winding += crossing.side, parity ^= 1;
  return (rule == InsideRule::parity ? parity : winding) != 0 ? Location::inside : Location::outside;
}

}  // namespace raylanes::testing
