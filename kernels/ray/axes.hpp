// The order of components that a ray asks for: its major axis last. One order for all lanes, or one per lane.
#pragma once

#include <bit>

#include "../simd/vec3.hpp"

namespace raylanes {
namespace {

// The axes of the canonical shear: z is the axis of the largest |direction| (the lowest of equals), x and y
// follow, swapped for a negative direction so that the winding is kept.
struct ShearAxes {
  int x, y, z;
};

inline constexpr ShearAxes axes_of_positive[3] = {{1, 2, 0}, {2, 0, 1}, {0, 1, 2}};
constexpr ShearAxes shear_axes(int z, bool is_negative) {
  const ShearAxes axes = axes_of_positive[z];
  return is_negative ? ShearAxes{axes.y, axes.x, z} : axes;
}
inline ShearAxes shear_axes(const Float3& direction) {
  // As integers magnitudes compare alike, and cost no branch.
  const auto magnitude = [&](int axis) {
    return std::bit_cast<std::uint32_t>(direction[axis]) & 0x7fffffffu;
  };
  int z = magnitude(1) > magnitude(0) ? 1 : 0;
  z = magnitude(2) > magnitude(z) ? 2 : z;
  return shear_axes(z, direction[z] < 0.0f);
}

// The order in which numbers are stored, for tests that take any.
struct StoredAxes {
  static constexpr int order[3] = {0, 1, 2};

  StoredAxes() = default;
  template <class Direction>
  explicit StoredAxes(const Direction&) {}

  static int index(int k) { return k; }
};

// All lanes share one order: numbers are loaded in it, and nothing is left to be permuted.
struct SharedAxes {
  int order[3];

  explicit SharedAxes(const ShearAxes& axes) : order{axes.x, axes.y, axes.z} {}
  explicit SharedAxes(const Float3& direction) : SharedAxes(shear_axes(direction)) {}
  // The index of number k of a triangle: its vectors keep their places, their components do not.
  int index(int k) const { return k / 3 * 3 + order[k % 3]; }
  template <bool keeps_winding, class V>
  static Vec3<V> permute(const Vec3<V>& v) {
    return v;
  }
};

// Each lane has its own: numbers are loaded as they are, and vectors permuted lane by lane.
template <class V>
struct LaneAxes {
  using M = decltype(V() < V());
  M z_is_x, z_is_y, swapped;

  explicit LaneAxes(const Vec3<V>& direction) {
    V x = abs(direction.x), y = abs(direction.y), z = abs(direction.z);
    z_is_x = (x >= y) & (x >= z);
    z_is_y = ~z_is_x & (y >= z);
    swapped = select(z_is_x, direction.x, select(z_is_y, direction.y, direction.z)) < V(0.0f);
  }
  // The major axis as a number, and axes again from it, for permutations that do not keep the winding.
  V number() const { return select(z_is_x, V(0.0f), select(z_is_y, V(1.0f), V(2.0f))); }
  static LaneAxes of_number(V major) { return LaneAxes(major == V(0.0f), major == V(1.0f)); }
  static int index(int k) { return k; }
  // Without keeps_winding x and y are never swapped: cheaper, for arithmetic that negates exactly.
  template <bool keeps_winding>
  Vec3<V> permute(const Vec3<V>& v) const {
    V next = select(z_is_x, v.y, select(z_is_y, v.z, v.x));
    V last = select(z_is_x, v.z, select(z_is_y, v.x, v.y));
    V major = select(z_is_x, v.x, select(z_is_y, v.y, v.z));
    if constexpr (keeps_winding)
      return {select(swapped, last, next), select(swapped, next, last), major};
    else
      return {next, last, major};
  }

 private:
  LaneAxes(M x, M y) : z_is_x(x), z_is_y(y), swapped(x & y) {}  // none: x and y exclude each other
};

}  // namespace
}  // namespace raylanes
