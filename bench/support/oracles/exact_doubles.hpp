// The hits and crossings of rays and triangles of doubles by rational arithmetic. Independent of the library.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <raylanes/doubles.hpp>

namespace raylanes::oracle {

struct DoubleMesh {
  std::vector<Double3> vertices;
  std::vector<Index3> triangles;
};
using DoubleCorners = std::array<Double3, 3>;
DoubleCorners corners_of(const DoubleMesh& mesh, std::size_t triangle);

// A hit, rounded once, as primitive 0; and the side: -1 is the front.
struct SidedHit {
  HitD hit;
  int side = 0;
};
SidedHit exact_double_hit(const RayD& ray, const DoubleCorners& corners);

// All of a ray, in the order of t and primitives, of some sides.
std::vector<HitD> exact_double_hits(const DoubleMesh& mesh, const RayD& ray, Facing facing = Facing::any);

// Those by simulation of simplicity, in the same order.
std::vector<CrossingD> exact_double_crossings(const DoubleMesh& mesh, const RayD& ray);

// The sign of det(a, b, c), the corners seen from a finite point.
int side_of(const DoubleCorners& corners, const Double3& point);
// Whether a point is on one of the triangles that have an area.
bool is_on(const DoubleMesh& mesh, const Double3& point);
// Whether it is on an edge of a triangle that has no two equal corners.
bool is_on_edge(const DoubleMesh& mesh, const Double3& point);
// Whether it is inside a closed mesh, by the crossings of another ray than the library's.
Location exact_location(const DoubleMesh& mesh, const Double3& point);

// Says which promise of ClosestPointD a closest point of a finite point breaks: it is within the bound of its triangle,
// and no other triangle is nearer by more than that. Empty if it keeps them.
std::string fault_of_closest_point(const DoubleMesh& mesh, const Double3& point, const ClosestPointD& found);

}  // namespace raylanes::oracle
