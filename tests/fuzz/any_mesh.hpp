// Meshes of any finite numbers, and rays of any bits that may meet them.
#pragma once

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

// Anywhere, or at a corner or the inside of a triangle, now and then across an axis.
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
    const std::size_t across = bytes.below(12);
    if (across < 3) origin[across] += direction[across], direction[across] = 0;
  }
  const float tmin = bytes.chance(180) ? 0.0f : coordinates();
  const float tmax = bytes.chance(180) ? infinity : coordinates();
  return make_ray(origin, direction, tmin, tmax);
}

// Now and then a scene of another size, far from zero along an axis, and directions of another length.
struct Placement {
  float size = 1, length = 1;
  Float3 at{0, 0, 0};

  explicit Placement(Bytes& bytes) {
    if (!bytes.chance(80)) return;
    size = std::ldexp(1.0f, bytes.pick({-100, -60, -20, 20, 50, 55, 80, 100}));
    length = std::ldexp(1.0f, bytes.pick({-40, -29, -27, 0, 29, 40}));
    at[bytes.below(3)] = bytes.pick({0.0f, 0x1p12f, 0x1p18f, 0x1p21f, 0x1p24f}) * size;
  }
  void move(Float3& point) const {
    for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = size * point[axis] + at[axis];
  }
  void move(Ray& ray) const {
    move(ray.origin);
    for (float& x : ray.direction) x *= length;
    ray.tmin *= size / length, ray.tmax *= size / length;
  }
};

}  // namespace raylanes::testing
