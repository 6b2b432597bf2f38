// Rays and leaves of doubles: what is_valid() and TreeTriangles are of floats.
#pragma once

#include "../../dispatch/table/double_rays.hpp"
#include "../exact/tree_triangles.hpp"

namespace raylanes {
namespace {

// The lanes of a leaf's triangles, at most eight.
inline constexpr int double_lanes = native_lanes == 1               ? 1
                                    : native_lanes / 2 < tree_width ? native_lanes / 2
                                                                    : tree_width;

// Whether t, u and v of one hit have a form of their own, which more lanes do not make shorter.
#if defined(__AVX2__) && defined(__FMA__)
inline constexpr bool has_hit_in_pairs = true;
#else
inline constexpr bool has_hit_in_pairs = false;
#endif

// 2^power, which is a normal number.
inline double power_of_two(int power) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(power + 1023) << 52);
}

// By the bits, whatever the processor does with subnormal numbers.
inline bool is_finite(const Double3& a) {
  return size_bits(a[0]) < 0x7ff0000000000000ull && size_bits(a[1]) < 0x7ff0000000000000ull &&
         size_bits(a[2]) < 0x7ff0000000000000ull;
}
inline bool is_valid(const RayD& ray) {
  return is_finite(ray.origin) && is_finite(ray.direction) && ray.tmin <= ray.tmax &&
         (size_bits(ray.direction[0]) | size_bits(ray.direction[1]) | size_bits(ray.direction[2])) != 0;
}

inline constexpr ShearAxes shear_axes_by_sign[3][2] = {{shear_axes(0, false), shear_axes(0, true)},
                                                       {shear_axes(1, false), shear_axes(1, true)},
                                                       {shear_axes(2, false), shear_axes(2, true)}};
inline const ShearAxes& shear_axes(const Double3& direction) {
  const std::uint64_t x = size_bits(direction[0]), y = size_bits(direction[1]), z = size_bits(direction[2]);
  const std::size_t axis = z > (y > x ? y : x) ? 2 : y > x ? 1 : 0;
  return shear_axes_by_sign[axis][direction[axis] < 0.0 ? 1 : 0];
}

struct DoubleTriangles : TrianglesOfHalves {
  const DoubleTreeView* tree = nullptr;  // null: nobody asks for masks

  explicit DoubleTriangles(const LeafHalf* of) : TrianglesOfHalves{of} {}
  explicit DoubleTriangles(const DoubleTreeView& of) : TrianglesOfHalves{of.halves}, tree(&of) {}
  const TriangleMasks& masks() const { return tree->tree.masks; }

  // Asks for a triangle ahead of time.
  void prefetch(std::uint32_t leaf_triangle) const {
    const double* const first = numbers(leaf_triangle) + leaf_triangle % tree_width;
    for (std::uint32_t k = 0; k < 9; ++k) __builtin_prefetch(first + k * lanes(leaf_triangle));
  }
  void prefetch_leaf(LeafReference leaf) const {
    const auto* const lines = reinterpret_cast<const std::byte*>(halves + leaf.block);
    for (std::size_t at = 0; at < halves_of_leaf(leaf.size) * sizeof(LeafHalf); at += 64)
      __builtin_prefetch(lines + at);
  }
};

template <>
struct TrianglesOf<double> {
  using type = DoubleTriangles;
  static constexpr int lanes = has_hit_in_pairs ? 1 : double_lanes;
};
using DoubleCandidate = CandidateOf<double>;

}  // namespace
}  // namespace raylanes
