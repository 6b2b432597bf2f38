// Kernels for triangles in arrays, any number of them, the active ones or all. Contracts: <raylanes/triangles.hpp>;
// kernel_table.hpp has what all kernels have in common.
#pragma once

#include <iterator>

#include <raylanes/prepared_ray.hpp>
#include <raylanes/triangles.hpp>

#include "rows.hpp"

namespace raylanes {

// triangles: what the test reads; triangle: the numbers of one, one after the other.
struct TriangleRow {
  // Writes the numbers that the test reads of the active ones of n triangles, from their corners v0 v1 v2, into arrays
  // that overlap nothing. The test directional needs the direction of all rays, three numbers; for other tests it may
  // be null.
  void (*prepare)(Soa corners, std::size_t n, LaneBits active, const float* direction, float* const* out);
  void (*any_of_triangles)(const Ray& ray, Soa triangles, std::size_t n, LaneBits active, std::uint8_t* bits);
  void (*any_of_rays)(const RayArrays& rays, const float* triangle, LaneBits active, std::uint8_t* bits);
  void (*closest_of_triangles)(const Ray& ray, Soa triangles, std::size_t n, LaneBits active, Hit& nearest);
  // u and v may be null.
  void (*closest_of_rays)(const RayArrays& rays, const float* triangle, LaneBits active, std::uint8_t* bits,
                          float* t, float* u, float* v);
};
struct TriangleKernels : Rows<TriangleRow, std::size(triangle_tests)> {
  // For PreparedRay, by the test exact.
  detail::ClosestAmong closest_among;
};

}  // namespace raylanes
