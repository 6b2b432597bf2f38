// Plain data that users write and that crosses the kernel table: no vector type, no container, no invariant that a
// compiler flag could change. Every path sees the same bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

// Marks a parameter: clang warns (-Wdangling) if what is made of it outlives the temporary that it is bound to.
#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::lifetimebound)
#define RAYLANES_LIFETIMEBOUND [[clang::lifetimebound]]
#endif
#endif
#ifndef RAYLANES_LIFETIMEBOUND
#define RAYLANES_LIFETIMEBOUND
#endif

/// All public names of the library.
namespace raylanes {

/// Three coordinates: x, y, z.
using Float3 = std::array<float, 3>;

/// The promise of a kernel about its bits.
enum class Grade : std::uint8_t {
  reproducible,  ///< The same bits on every ISA path: no fused multiply-add, no estimates, correctly rounded roots.
  fast  ///< Fused multiply-add if the ISA path has it. Bounds hold as each kernel states; bits may differ.
};
/// The names of the grades, by enumerator.
inline constexpr std::array<std::string_view, 2> grade_names{"reproducible", "fast"};

/// A ray segment: the points origin + t·direction with tmin <= t <= tmax, both ends included.
/// The direction need not be normalised: t is measured in units of its length.
/// The ray hits nothing if its origin or direction is not finite, its direction is zero, tmin or tmax is NaN, or
/// tmin > tmax. A default-constructed ray has no direction, and hits nothing.
struct Ray {
  Float3 origin{};
  float tmin = 0;
  Float3 direction{};
  float tmax = std::numeric_limits<float>::infinity();
};
static_assert(sizeof(Ray) == 32);

/// The primitive index of a miss.
inline constexpr std::uint32_t no_primitive = 0xffffffffu;

/// The nearest intersection along a ray.
/// The point is (1-u-v)·v0 + u·v1 + v·v2 of the triangle `primitive`, and origin + t·direction up to rounding.
/// A miss has t = +infinity, u = v = 0 and primitive = no_primitive; a default-constructed Hit is a miss.
struct Hit {
  float t = std::numeric_limits<float>::infinity();
  float u = 0;
  float v = 0;
  std::uint32_t primitive = no_primitive;

  /// Returns whether this is a hit. It compares `primitive`, so -ffinite-math-only does not change it.
  explicit operator bool() const { return primitive != no_primitive; }
};
static_assert(sizeof(Hit) == 16);

/// How often a ray passes through a surface, as TriangleTree::count_crossings() returns it.
struct CrossingCount {
  std::uint32_t crossings = 0;
  std::int32_t winding = 0;  ///< The sum of the crossings' sides: 1 along the normal, -1 against it.

  bool operator==(const CrossingCount&) const = default;
};

/// A triangle by its corners v0, v1, v2.
struct Triangle {
  Float3 corner[3];
};

/// An axis-aligned box, boundary included. Bounds may be infinite. If lo > hi on an axis, the box is empty.
struct Box {
  Float3 lo;
  Float3 hi;
};

/// A ball, boundary included. A negative radius makes it empty; a radius whose square overflows makes it all of space.
struct Sphere {
  Float3 centre;
  float radius;
};

/// A view of `size` rays as one array per number. Pointers need the alignment of a float.
struct RayArrays {
  const float* origin[3];
  const float* direction[3];
  const float* tmin;
  const float* tmax;
  std::size_t size;
};
/// A view of `size` triangles as one array per number. Pointers need the alignment of a float.
struct TriangleArrays {
  const float* corner[3][3];  ///< [corner][axis]
  std::size_t size;
};
/// A view of `size` boxes as one array per number. Pointers need the alignment of a float.
struct BoxArrays {
  const float* lo[3];
  const float* hi[3];
  std::size_t size;
};
/// A view of `size` spheres as one array per number. Pointers need the alignment of a float.
struct SphereArrays {
  const float* centre[3];
  const float* squared_radius;  ///< signed_square() of each radius
  std::size_t size;
};

/// Returns radius², negative if the radius is: a sphere of negative radius stays empty.
constexpr float signed_square(float radius) {
  return radius < 0.0f ? -(radius * radius) : radius * radius;
}

/// A mask of active elements: bit i % 8 of byte i / 8 is set if element i is active; null: all are.
/// Calls neither read nor write inactive elements, and leave their bits in results unchanged.
using LaneBits = const std::uint8_t*;

/// Three coordinates in double precision: x, y, z.
using Double3 = std::array<double, 3>;

/// A ray segment in double precision; otherwise as Ray.
struct RayD {
  Double3 origin{};
  double tmin = 0;
  Double3 direction{};
  double tmax = std::numeric_limits<double>::infinity();
};
static_assert(sizeof(RayD) == 64);

/// The nearest intersection along a ray in double precision; otherwise as Hit.
struct HitD {
  double t = std::numeric_limits<double>::infinity();
  double u = 0;
  double v = 0;
  std::uint32_t primitive = no_primitive;
  std::uint32_t unused = 0;  ///< always 0

  /// Returns whether this is a hit. It compares `primitive`, so -ffinite-math-only does not change it.
  explicit operator bool() const { return primitive != no_primitive; }
};
static_assert(sizeof(HitD) == 32);

/// A view of `size` rays in double precision as one array per number. Pointers need the alignment of a double.
struct RayArraysD {
  const double* origin[3];
  const double* direction[3];
  const double* tmin;
  const double* tmax;
  std::size_t size;
};

/// A triangle in double precision by its corners v0, v1, v2.
struct TriangleD {
  Double3 corner[3];
};

/// An axis-aligned box in double precision, boundary included.
struct BoxD {
  Double3 lo;
  Double3 hi;
};

struct Path;  // <raylanes/paths.hpp>

/// Options of calls on arrays.
template <class Test, Test usual>
struct CallOptions {
  Test test = usual;                  ///< the test to use
  Grade grade = Grade::reproducible;  ///< its promise about bits
  const Path* path = nullptr;         ///< an ISA path that this machine supports; null: the active one
  LaneBits active = nullptr;  ///< of the primitives, or of the rays if there is one primitive; null: all
};

}  // namespace raylanes
