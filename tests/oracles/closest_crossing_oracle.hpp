// Closest crossings by their definition in rational numbers: the hits that are crossings, but for glances. The point at
// which a ray meets a plane says on which edge it is; weights are not asked.
#pragma once

#include "../../bench/support/oracles/rational_vectors.hpp"
#include "../queries/query_oracle.hpp"

namespace raylanes::testing {

// The corners of the edge that holds the point at which a ray meets the plane of a triangle: two, one of them where the
// point is this corner, none between the edges.
template <class AnyRay, class Point>
std::set<Point> met_corners(const AnyRay& ray, const Point (&corners)[3]) {
  using namespace oracle;
  const Vector a = to_vector(corners[0]), o = to_vector(ray.origin), d = to_vector(ray.direction);
  const Vector n = cross(to_vector(corners[1]) - a, to_vector(corners[2]) - a);
  const mpq_class t = dot(n, a - o) / dot(n, d);
  const Vector at{o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]};
  std::set<Point> met;
  bool some = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point &p = corners[k], &q = corners[(k + 1) % 3];
    const Vector out = cross(at - to_vector(p), to_vector(q) - to_vector(p));
    if (out[0] != 0 || out[1] != 0 || out[2] != 0) continue;
    const std::set<Point> edge{p, q};
    std::set<Point> both;
    std::set_intersection(met.begin(), met.end(), edge.begin(), edge.end(), std::inserter(both, both.end()));
    met = some ? both : edge, some = true;
  }
  return met;
}

// Hits and crossings are those that are there for the ray.
template <class AnyMesh, class AnyRay, class AnyHit, class AnyCrossing>
std::vector<AnyHit> oracle_closest_crossings(const AnyMesh& mesh, const AnyRay& ray,
                                             const std::vector<AnyHit>& hits,
                                             const std::vector<AnyCrossing>& crossings) {
  using Point = typename decltype(mesh.vertices)::value_type;
  struct Passing {
    AnyHit hit;
    int side;
    std::set<Point> corners, met;
  };
  std::vector<Passing> passing;
  for (const AnyHit& hit : hits) {
    const auto own = std::ranges::find(crossings, hit.primitive, &AnyCrossing::primitive);
    if (own == crossings.end()) continue;
    Point corners[3];
    for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.vertices[mesh.triangles[hit.primitive][k]];
    passing.push_back({hit, own->side, {corners, corners + 3}, met_corners(ray, corners)});
  }
  std::vector<AnyHit> closest_crossings;
  for (const Passing& own : passing) {
    int sum = 0, before = 0;
    bool is_alone = true;
    for (const Passing& other : passing) {
      if (other.met != own.met) continue;
      sum += other.side, is_alone = is_alone && other.corners == own.corners;
      before += other.side == own.side && other.hit.primitive < own.hit.primitive ? 1 : 0;
    }
    if (own.met.empty() || is_alone || before < sum * own.side) closest_crossings.push_back(own.hit);
  }
  return closest_crossings;
}

// The crossings of all triangles but one.
template <class AnyMesh, class AnyRay>
auto oracle_closest_crossings(const AnyMesh& mesh, const AnyRay& ray, std::uint32_t skipped = no_primitive) {
  return oracle_closest_crossings(mesh, ray, oracle_hits(mesh, ray, Facing::any, skipped),
                                  oracle::exact_crossings(mesh, ray));
}

// From points that are multiples of a half to corners and middles of edges, which floats hold.
inline std::vector<Ray> touching_rays(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Triangle triangle = random.triangle_of(mesh);
    const Float3 &a = triangle.corner[random.integer(0, 2)], &b = triangle.corner[random.integer(0, 2)];
    Float3 origin, direction;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      origin[axis] = 0.5f * static_cast<float>(random.integer(-6, 6));
      direction[axis] = 0.5f * (a[axis] + b[axis]) - origin[axis];
    }
    if (direction != Float3{}) rays.push_back(make_ray(origin, direction));
  }
  return rays;
}

}  // namespace raylanes::testing
