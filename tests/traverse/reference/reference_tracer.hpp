// The canonical watertight test and a brute force over a mesh as plain scalar code, written apart from the
// kernels: what the reproducible grade must equal byte for byte.
#pragma once

#include <raylanes/mesh.hpp>
#include <raylanes/types.hpp>

#include "../../support/testing.hpp"

namespace raylanes::testing {

// The corners of a triangle as the sheared test sees them (Woop, Benthin, Wald 2013): the ray is the z axis.
// `fused` uses one rounding for multiply and subtract, as paths with FMA do in the fast grade.
struct ShearedTriangle {
  std::array<float, 3> x, y, z;
};
ShearedTriangle shear_triangle(const Ray& ray, const Triangle& triangle, bool fused);

// Whether the z axis passes the triangle's projection, decided without rounding: closed edges, and no
// triangle that is degenerate in projection. Barring underflow and overflow of double.
bool axis_passes(const ShearedTriangle& sheared);

// The canonical test with its recomputation in double; primitive 0 for a hit. Rays and triangles with NaN or
// infinite coordinates, rays without direction or extent are a miss.
Hit canonical_hit(const Ray& ray, const Triangle& triangle);

// The nearest canonical hit, of equal t the smallest primitive; one for each ray.
std::vector<Hit> brute_force(std::span<const Float3> vertices, std::span<const Index3> triangles,
                             std::span<const Ray> rays);

}  // namespace raylanes::testing
