// Points and normals of a mesh where a ray hit it.
#pragma once

#include <raylanes/types.hpp>

#include "../scenes/vector3.hpp"

namespace raylanes::bench {

// The geometric normal of triangle `primitive`, of length twice its area. In double the edges are exact
// unless the exponents of the coordinates lie far apart.
inline Double3 scaled_normal(const Mesh& mesh, std::uint32_t primitive) {
  const auto& [a, b, c] = mesh.triangles[primitive];
  const Double3 origin = to_double(mesh.vertices[a]);
  return cross(subtract(to_double(mesh.vertices[b]), origin), subtract(to_double(mesh.vertices[c]), origin));
}

// Whether the triangle has a normal.
inline bool has_area(const Mesh& mesh, std::uint32_t primitive) {
  return length(scaled_normal(mesh, primitive)) > 0;
}

// The normal of length 1 (counter-clockwise corners turn about it); NaN for a triangle without area.
inline Double3 surface_normal(const Mesh& mesh, std::uint32_t primitive) {
  return normalized(scaled_normal(mesh, primitive));
}

// `normal` or its opposite, whichever points against `direction`; at a right angle, `normal`.
inline Double3 normal_against(const Double3& direction, const Double3& normal) {
  return dot(direction, normal) > 0 ? scale(normal, -1) : normal;
}

// (1-u-v)·v0 + u·v1 + v·v2, which is closer to the triangle than origin + t·direction.
inline Double3 hit_point(const Mesh& mesh, const Hit& hit) {
  const auto& [a, b, c] = mesh.triangles[hit.primitive];
  const double u = hit.u, v = hit.v;
  return add(scale(to_double(mesh.vertices[a]), 1 - u - v),
             add(scale(to_double(mesh.vertices[b]), u), scale(to_double(mesh.vertices[c]), v)));
}

// Two vectors that form a right-handed orthonormal frame with a normal of length 1 (Duff et al., "Building an
// Orthonormal Basis, Revisited", 2017).
inline std::pair<Double3, Double3> tangents_of(const Double3& n) {
  const double sign = std::copysign(1.0, n[2]);
  const double a = -1 / (sign + n[2]);
  const double b = n[0] * n[1] * a;
  return {{1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]}, {b, sign + n[1] * n[1] * a, -n[1]}};
}

}  // namespace raylanes::bench
