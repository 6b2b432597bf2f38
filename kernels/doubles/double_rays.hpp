// Rays and leaves of doubles: what Ray, TreeTriangles and Candidate are of floats.
#pragma once

#include "../../dispatch/table/double_rays.hpp"
#include "../exact/deferred_hits.hpp"

namespace raylanes {
namespace {

// The lanes of a leaf's triangles, at most eight.
inline constexpr int double_lanes = native_lanes == 1               ? 1
                                    : native_lanes / 2 < tree_width ? native_lanes / 2
                                                                    : tree_width;

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

// leaf_triangle: eight times the number of the leaf's first half, plus the lane; and half_leaf if there is one half.
inline constexpr std::uint32_t half_leaf = 0x80000000u;

struct DoubleTriangles {
  const LeafHalf* halves;

  explicit DoubleTriangles(const DoubleTreeView& tree) : halves(tree.halves) {}

  static std::uint32_t first_of(LeafReference leaf) {
    return leaf.block * tree_width | (leaf.size > tree_width / 2 ? 0u : half_leaf);
  }
  const double* numbers(std::uint32_t leaf_triangle) const {
    return reinterpret_cast<const double*>(halves[(leaf_triangle & ~half_leaf) / tree_width].bytes);
  }
  static std::uint32_t lanes(std::uint32_t leaf_triangle) {
    return (leaf_triangle & half_leaf) != 0 ? tree_width / 2 : tree_width;
  }
  double number(int k, std::uint32_t leaf_triangle) const {
    return numbers(
        leaf_triangle)[static_cast<std::uint32_t>(k) * lanes(leaf_triangle) + leaf_triangle % tree_width];
  }
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
  std::uint32_t primitive(std::uint32_t leaf_triangle) const {
    const auto* const primitives =
        reinterpret_cast<const std::uint32_t*>(numbers(leaf_triangle) + 9 * lanes(leaf_triangle));
    return primitives[leaf_triangle % tree_width];
  }
};

struct DoubleCandidate {
  double t_lo, tmax;  // as in Candidate
  std::uint32_t leaf_triangle = no_leaf_triangle;

  explicit DoubleCandidate(const RayD& ray) : t_lo(finite_tmax(ray.tmax)), tmax(t_lo) {}
  void keep(double new_t_lo, double t_hi, std::uint32_t new_leaf_triangle) {
    t_lo = new_t_lo, tmax = t_hi, leaf_triangle = new_leaf_triangle;
  }
};
template <>
struct CandidateOf<RayD> {
  using type = DoubleCandidate;
};

}  // namespace
}  // namespace raylanes
