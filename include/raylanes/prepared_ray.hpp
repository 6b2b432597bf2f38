// A ray that meets few boxes, spheres or triangles at a time: at the nodes and leaves of a tree of your own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <raylanes/types.hpp>

namespace raylanes {

namespace detail {

// The numbers that kernels compute from a ray once; ray.tmin is NaN for a ray that hits nothing.
struct RayAmong {
  Ray ray;
  // For boxes: reciprocals, and which of the arrays lo[3], hi[3] has the plane that the ray meets first, and last.
  float inverse[3], far_inverse[3];
  std::uint32_t first[3], last[3];
  float scale, unit, square, inverse_square;  // for spheres
  float shear[2];                             // for triangles, and their order of axes
  std::int32_t order[3];
};

using HitsAmong = std::uint32_t (*)(const RayAmong& ray, const BoxArrays& boxes, float* entry);
using ClosestAmong = void (*)(const RayAmong& ray, const float* const* arrays, std::size_t n, LaneBits active,
                              Hit& nearest);

}  // namespace detail

/// A ray that is checked and prepared once, and then asked about 1 to 32 primitives a call.
/// Results have the bytes of the calls on arrays with a Ray: intervals() by BoxTest::conservative, closest_hit() by
/// SphereTest::perpendicular and TriangleTest::exact. A call costs a few nanoseconds, where the calls
/// with a Ray check their options first.
/// Arrays need the alignment of a float. Floating-point exceptions are not masked: to prepare a ray and to ask it may
/// raise invalid, divide by zero and overflow.
class PreparedRay {
 public:
  /// The most primitives of a call.
  static constexpr std::size_t max_primitives = 32;

  /// Prepares the ray for the kernels of an ISA path that this machine supports; null: the active one.
  /// Throws std::invalid_argument if this machine lacks the path; throws as active_path() does if `path` is null.
  explicit PreparedRay(const Ray& ray, const Path* path = nullptr);

  /// Returns the ray.
  const Ray& ray() const { return ray_; }
  /// Ends the ray at another distance: that of the nearest hit so far. A NaN, or less than tmin, hits nothing.
  void set_tmax(float tmax) { ray_.tmax = among_.ray.tmax = tmax; }

  /// Returns the boxes that the ray hits: box i in bit i.
  /// Throws std::invalid_argument for more than max_primitives boxes.
  friend std::uint32_t hits(const PreparedRay& ray, const BoxArrays& boxes) {
    if (boxes.size > max_primitives) refuse(boxes.size);
    return ray.boxes_(ray.among_, boxes, nullptr);
  }
  /// Returns the boxes that the ray hits: box i in bit i.
  /// Writes the t of its entry into box i to entry[i], +infinity for a miss.
  /// Throws std::invalid_argument for more than max_primitives boxes, or if `entry` has not one float for each.
  friend std::uint32_t hits(const PreparedRay& ray, const BoxArrays& boxes, std::span<float> entry) {
    if (boxes.size > max_primitives || entry.size() != boxes.size) refuse(boxes.size, entry.size());
    return ray.boxes_(ray.among_, boxes, entry.data());
  }

  /// Returns the nearest surface of a sphere that the ray meets; ties in t go to the lowest index.
  /// Throws std::invalid_argument for more than max_primitives spheres.
  friend Hit closest_hit(const PreparedRay& ray, const SphereArrays& spheres) {
    if (spheres.size > max_primitives) refuse(spheres.size);
    static_assert(offsetof(SphereArrays, squared_radius) == sizeof spheres.centre);
    Hit nearest;
    ray.spheres_(ray.among_, spheres.centre, spheres.size, nullptr, nearest);
    return nearest;
  }
  /// Returns the nearest hit of a triangle by exact decisions; ties in t go to the lowest index.
  /// Throws std::invalid_argument for more than max_primitives triangles.
  friend Hit closest_hit(const PreparedRay& ray, const TriangleArrays& triangles) {
    if (triangles.size > max_primitives) refuse(triangles.size);
    Hit nearest;
    ray.triangles_(ray.among_, triangles.corner[0], triangles.size, nullptr, nearest);
    return nearest;
  }

 private:
  [[noreturn]] static void refuse(std::size_t primitives);
  [[noreturn]] static void refuse(std::size_t boxes, std::size_t entries);

  Ray ray_;
  detail::RayAmong among_;
  detail::HitsAmong boxes_;
  detail::ClosestAmong spheres_, triangles_;
};
// By name, too, where a variable hides it.
std::uint32_t hits(const PreparedRay& ray, const BoxArrays& boxes);
std::uint32_t hits(const PreparedRay& ray, const BoxArrays& boxes, std::span<float> entry);
Hit closest_hit(const PreparedRay& ray, const SphereArrays& spheres);
Hit closest_hit(const PreparedRay& ray, const TriangleArrays& triangles);

}  // namespace raylanes
