// Plain data that crosses the kernel table: no vector type, no container, no invariant that a compiler
// flag could change. Every path sees the same bytes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace raylanes {

// A ray segment: the points origin + t·direction with tmin <= t <= tmax, closed at both ends.
// The direction need not be normalised; t counts in units of its length. A ray with a NaN or infinite
// origin or direction, a zero direction, a NaN bound or tmin > tmax hits nothing.
struct Ray {
  float origin[3];
  float tmin;
  float direction[3];
  float tmax;
};
static_assert(sizeof(Ray) == 32);

inline constexpr std::uint32_t no_primitive = 0xffffffffu;

// The nearest intersection along a ray. The point is (1-u-v)·v0 + u·v1 + v·v2 of the triangle `primitive`,
// and origin + t·direction up to rounding. A miss has t = +infinity, u = v = 0, primitive = no_primitive.
struct Hit {
  float t;
  float u;
  float v;
  std::uint32_t primitive;
};
static_assert(sizeof(Hit) == 16);

// Three corners, each x, y, z.
struct TriangleVertices {
  float vertex[3][3];
};

// An axis-aligned box, closed. lo > hi on an axis makes it empty: no ray hits it. Infinite bounds are
// allowed.
struct Box {
  float lo[3];
  float hi[3];
};

}  // namespace raylanes
