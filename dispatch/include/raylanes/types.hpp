// Plain data that users write and that crosses the kernel table: no vector type, no container, no invariant that a
// compiler flag could change. Every path sees the same bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

namespace raylanes {

using Float3 = std::array<float, 3>;

// What a kernel promises.
//   reproducible  multiply and add rounded apart, division and root correctly rounded, no estimates: the
//                 same bits on every path
//   fast          fused multiply-add where the path has it; bounds as stated per kernel, bits depend on the
//                 path
enum class Grade : std::uint8_t { reproducible, fast };
inline constexpr std::array<std::string_view, 2> grade_names{"reproducible", "fast"};

// A ray segment: the points origin + t·direction with tmin <= t <= tmax, closed at both ends.
// The direction need not be normalised; t counts in units of its length. A ray with a NaN or infinite
// origin or direction, a zero direction, a NaN bound or tmin > tmax hits nothing, and so does a default one.
struct Ray {
  Float3 origin{};
  float tmin = 0;
  Float3 direction{};
  float tmax = std::numeric_limits<float>::infinity();
};
static_assert(sizeof(Ray) == 32);

inline constexpr std::uint32_t no_primitive = 0xffffffffu;

// The nearest intersection along a ray. The point is (1-u-v)·v0 + u·v1 + v·v2 of the triangle `primitive`,
// and origin + t·direction up to rounding. A miss, which is what a default one is, has t = +infinity, u = v = 0,
// primitive = no_primitive; true says that it is a hit, also where the compiler takes infinities for impossible.
struct Hit {
  float t = std::numeric_limits<float>::infinity();
  float u = 0;
  float v = 0;
  std::uint32_t primitive = no_primitive;

  explicit operator bool() const { return primitive != no_primitive; }
};
static_assert(sizeof(Hit) == 16);

/// How often a ray passes through a surface, as TriangleTree::count_crossings() returns it.
struct CrossingCount {
  std::uint32_t crossings = 0;
  std::int32_t winding = 0;  ///< The sum of the crossings' sides: 1 along the normal, -1 against it.

  bool operator==(const CrossingCount&) const = default;
};

struct Triangle {
  Float3 corner[3];
};

// Axis-aligned, closed. lo > hi on an axis makes it empty: no ray hits it. Infinite bounds are allowed.
struct Box {
  Float3 lo;
  Float3 hi;
};

// A ball, closed. A negative radius makes it empty; a radius whose square overflows makes it all of space.
struct Sphere {
  Float3 centre;
  float radius;
};

// Views of rays and primitives as one array per number, `size` elements each; pointers need the alignment of a float
// only.
struct RayArrays {
  const float* origin[3];
  const float* direction[3];
  const float* tmin;
  const float* tmax;
  std::size_t size;
};
struct TriangleArrays {
  const float* corner[3][3];  // [corner][axis]
  std::size_t size;
};
struct BoxArrays {
  const float* lo[3];
  const float* hi[3];
  std::size_t size;
};
struct SphereArrays {
  const float* centre[3];
  const float* squared_radius;  // as signed_square of the radius gives it
  std::size_t size;
};

// What spheres are tested with: a negative radius stays one that nothing hits.
constexpr float signed_square(float radius) {
  return radius < 0.0f ? -(radius * radius) : radius * radius;
}

// Which elements take part: bit i % 8 of byte i / 8 is that of element i; null for all. What takes no part is neither
// read nor written, nor is the bit of an answer that belongs to it.
using LaneBits = const std::uint8_t*;

struct Path;  // <raylanes/paths.hpp>

// How a call on arrays tests. The path must be supported here; null is the one in use. `active` belongs to the
// primitives of one ray, or to the rays of one primitive.
template <class Test, Test usual>
struct CallOptions {
  Test test = usual;
  Grade grade = Grade::reproducible;
  const Path* path = nullptr;
  LaneBits active = nullptr;
};

}  // namespace raylanes
