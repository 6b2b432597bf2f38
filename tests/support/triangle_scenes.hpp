// Rays and the triangles they are aimed at.
#pragma once

#include "random_input.hpp"

namespace raylanes::testing {

// Rays that are tested against each of some triangles. Pairs are numbered as results are: all rays of
// triangle 0, all rays of triangle 1 ….
struct TriangleScene {
  std::vector<Ray> rays;
  std::vector<Triangle> triangles;

  std::size_t size() const { return rays.size() * triangles.size(); }
  const Ray& ray(std::size_t pair) const { return rays[pair % rays.size()]; }
  const Triangle& triangle(std::size_t pair) const { return triangles[pair / rays.size()]; }
  void scale(float factor);
};

// At what rays are aimed. off_edge is a fixed step off an edge, in or out; beside_a_tiny_one passes a
// triangle by many times its size; of tied_axes two or three components of the direction are equally large.
enum class Aim { anywhere, edge, corner, off_edge, far, small_and_distant, beside_a_tiny_one, tied_axes };

// Ray i is aimed at triangle i % triangles. Some segments end near the triangle, some rays look backwards.
TriangleScene aimed_scene(Aim aim, std::size_t rays, std::size_t triangles, Random& random);

// 19 rays and 19 triangles, so that every width has a rest; the last triangle is the first again, so that the
// nearest hit has an equal.
TriangleScene scene_for_all_widths(Aim aim, Random& random);

}  // namespace raylanes::testing
