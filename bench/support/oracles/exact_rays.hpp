// Hits, crossings and places of floats and of doubles by rational arithmetic over all triangles; rounded arithmetic
// decides what rays certainly miss. Independent of the library.
#pragma once

#include <raylanes/doubles.hpp>
#include <raylanes/numbers.hpp>

#include "../std.hpp"

namespace raylanes::oracle {

struct DoubleMesh {
  std::vector<Double3> vertices;
  std::vector<Index3> triangles;
};
template <class T>
using MeshOf = std::conditional_t<std::is_same_v<T, float>, Mesh, DoubleMesh>;
template <class AnyRay>
using NumberOf = std::remove_const_t<decltype(AnyRay::tmin)>;

template <class T>
using TriangleCorners = std::array<PointOf<T>, 3>;
template <class AnyMesh>
auto corners_of(const AnyMesh& mesh, std::size_t triangle) {
  const Index3& t = mesh.triangles[triangle];
  return std::array{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

// A hit, rounded once, as primitive 0; and the side: -1 is the front. A t beyond the largest number is a miss.
template <class T>
struct SidedHit {
  HitOf<T> hit;
  int side = 0;
};
template <class AnyRay, class T = NumberOf<AnyRay>>
SidedHit<T> exact_hit(const AnyRay& ray, const TriangleCorners<T>& corners);

// All hits of a ray, in the order of t and primitives, of some sides.
template <class AnyRay, class T = NumberOf<AnyRay>>
std::vector<HitOf<T>> exact_hits(const MeshOf<T>& mesh, const AnyRay& ray, Facing facing = Facing::any);
// The nearest hit of each ray.
std::vector<Hit> nearest_hits(const Mesh& mesh, std::span<const Ray> rays);
std::vector<HitD> nearest_hits(const DoubleMesh& mesh, std::span<const RayD> rays);

// The crossings by simulation of simplicity, in the same order.
template <class AnyRay, class T = NumberOf<AnyRay>>
std::vector<CrossingOf<T>> exact_crossings(const MeshOf<T>& mesh, const AnyRay& ray);

// The place of a finite point relative to a triangle. Triangles without an area are edges, unless two corners are
// equal: then nothing touches them.
enum class Touch : std::uint8_t { none, face, edge };  // edge: also a corner
struct Placed {
  int side;  // the sign of det(a, b, c), the corners seen from the point; 0 in the triangle's plane
  Touch touch;
};
template <class T>
Placed placed(const TriangleCorners<T>& corners, const PointOf<T>& point);

// Whether a point is on one of the triangles that have an area.
template <class T>
bool is_on(const MeshOf<T>& mesh, const PointOf<T>& point);
// Whether it is on an edge of a triangle that has no two equal corners.
template <class T>
bool is_on_edge(const MeshOf<T>& mesh, const PointOf<T>& point);
// The place of a finite point, by a ray of this direction, or by a vote, which has its own directions.
template <class T>
Location exact_location(const MeshOf<T>& mesh, const PointOf<T>& point,
                        const std::type_identity_t<PointOf<T>>& direction = {T(0.3), T(-0.7), T(0.61)},
                        InsideRule rule = InsideRule::parity);

}  // namespace raylanes::oracle
