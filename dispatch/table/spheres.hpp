// Kernels for spheres in arrays, any number of them, the active ones or all. Contracts: <raylanes/spheres.hpp>;
// kernel_table.hpp has what all kernels have in common.
#pragma once

#include <iterator>

#include <raylanes/prepared_ray.hpp>
#include <raylanes/spheres.hpp>

#include "rows.hpp"

namespace raylanes {

// sphere: centre and signed_square of the radius.
struct SphereRow {
  void (*any_of_spheres)(const Ray& ray, Soa spheres, std::size_t n, LaneBits active, std::uint8_t* bits);
  void (*any_of_rays)(const RayArrays& rays, const float* sphere, LaneBits active, std::uint8_t* bits);
  void (*closest_of_spheres)(const Ray& ray, Soa spheres, std::size_t n, LaneBits active, Hit& nearest);
  void (*distances_of_spheres)(const Ray& ray, Soa spheres, std::size_t n, LaneBits active,
                               std::uint8_t* bits, float* near, float* far);
  void (*distances_of_rays)(const RayArrays& rays, const float* sphere, LaneBits active, std::uint8_t* bits,
                            float* near, float* far);
};
struct SphereKernels : Rows<SphereRow, std::size(sphere_tests)> {
  // For whole lines, [Grade].
  void (*line_of_spheres[grade_names.size()])(const Ray& ray, Soa spheres, std::size_t n, LaneBits active,
                                              std::uint8_t* bits);
  // For PreparedRay: what kernels of all primitives take of a ray; and the test perpendicular, grade reproducible.
  void (*prepare)(const Ray& ray, detail::RayAmong& prepared);
  detail::ClosestAmong closest_among;
};

}  // namespace raylanes
