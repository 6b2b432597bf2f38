// Hits, crossings and places by exact rational arithmetic over all triangles. Directions are really moved by a number
// below all others, so that the definition itself is what judges. Doubles decide what rays certainly miss.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <raylanes/queries.hpp>

namespace raylanes::oracle {

// The same lists as TriangleTree::all_hits() and crossings().
std::vector<Hit> all_exact_hits(std::span<const Float3> vertices, std::span<const Index3> triangles,
                                const Ray& ray);
std::vector<Crossing> exact_crossings(std::span<const Float3> vertices, std::span<const Index3> triangles,
                                      const Ray& ray);

// Whether the point lies on the triangle, which has an area; at_edge: on an edge or corner of it.
enum class Held { no, at_edge, inside };
Held held_by(const Triangle& triangle, const Float3& point);
inline bool holds(const Triangle& triangle, const Float3& point) {
  return held_by(triangle, point) != Held::no;
}

// The place of a point relative to a triangle.
enum class Touch : std::uint8_t { none, face, edge };  // edge: also a corner
struct Placed {
  int side;  // the sign of det(a, b, c), the corners seen from the point; 0 in the triangle's plane
  Touch touch;
};
// Triangles without an area are edges, unless two corners are equal: then nothing touches them.
Placed placed(const Triangle& triangle, const Float3& point);

// The place of a finite point, by a ray of this direction, or by a vote, which has its own directions.
Location exact_location(std::span<const Float3> vertices, std::span<const Index3> triangles,
                        const Float3& point, const Float3& direction, InsideRule rule = InsideRule::parity);

}  // namespace raylanes::oracle
