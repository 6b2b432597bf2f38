// Meshes of any finite numbers, and rays of any bits that may meet them.
#pragma once

#include <cmath>

#include <raylanes/mesh.hpp>

#include "../support/random_input.hpp"
#include "support.hpp"

namespace raylanes::testing {

inline float finite(float x) {
  return std::isfinite(x) ? x : std::signbit(x) ? -3e38f : 3e38f;
}

inline Float3 finite_point(Coordinates& coordinates) {
  Float3 p;
  for (float& x : p) x = finite(coordinates());
  return p;
}

// Small meshes with shared corners, or now and then up to a few thousand triangles that lie close to some point.
inline Mesh any_mesh(Bytes& bytes) {
  Coordinates coordinates(bytes);
  Mesh mesh;
  const bool large = bytes.chance(6);
  const std::size_t triangles = large ? 300 + bytes.below(3700) : bytes.below(40);
  const float size = std::ldexp(1.0f, -static_cast<int>(bytes.below(20)));
  const std::size_t vertices = triangles + 3;
  for (std::size_t i = 0; i < vertices; ++i) mesh.vertices.push_back(finite_point(coordinates));
  const bool soup = large || bytes.chance(64);
  for (std::uint32_t i = 0; i < triangles; ++i) {
    if (!soup) {
      const auto corner = [&] { return static_cast<std::uint32_t>(bytes.below(vertices)); };
      mesh.triangles.push_back({corner(), corner(), corner()});
      continue;
    }
    const Float3 centre = mesh.vertices[i];
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int corner = 0; corner < 3; ++corner) {
      Float3 p = finite_point(coordinates);
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = finite(centre[axis] + size * p[axis]);
      mesh.vertices.push_back(p);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

// Anywhere, or at a corner or the inside of a triangle.
inline Ray any_ray(Bytes& bytes, Coordinates& coordinates, const Mesh& mesh) {
  Float3 origin, direction;
  for (float& x : origin) x = coordinates();
  for (float& x : direction) x = coordinates();
  if (!mesh.triangles.empty() && bytes.chance(160)) {
    const Index3& triangle = mesh.triangles[bytes.below(mesh.triangles.size())];
    const float u = static_cast<float>(bytes.below(9)) / 8,
                v = static_cast<float>(bytes.below(9)) / 8 * (1 - u);
    for (std::size_t axis = 0; axis < 3; ++axis)
      direction[axis] = (1 - u - v) * mesh.vertices[triangle[0]][axis] +
                        u * mesh.vertices[triangle[1]][axis] + v * mesh.vertices[triangle[2]][axis] -
                        origin[axis];
  }
  const float tmin = bytes.chance(180) ? 0.0f : coordinates();
  const float tmax = bytes.chance(180) ? infinity : coordinates();
  return make_ray(origin, direction, tmin, tmax);
}

}  // namespace raylanes::testing
