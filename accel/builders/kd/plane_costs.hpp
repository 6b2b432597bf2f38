// Costs of planes by the surface area heuristic (MacDonald, Booth 1990), and the best of many planes.
#pragma once

#include "growth.hpp"

namespace raylanes {

// The expected cost of so many triangles in a cell that is not divided yet: one block, or as many as they fill; some
// divisions pay later.
inline double expected_blocks(std::uint32_t count) {
  constexpr double of_triangle = 1.0 / tree_width;
  return count == 0 ? 0.0 : std::max(1.0, of_triangle * count);
}

// The best plane of a cell so far. Costs are for a line that meets the cell.
class BestPlane {
 public:
  explicit BestPlane(const KdCell& cell) : cell_(cell.cell), blocks_(cell.blocks) {
    const double inverse_area = 1.0 / area_of(cell.cell);
    const Vec4 extent = cell.cell.hi - cell.cell.lo;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double a = double{extent[(axis + 1) % 3]}, b = double{extent[(axis + 2) % 3]};
      face_[axis] = a * b * inverse_area, side_[axis] = (a + b) * inverse_area;
    }
  }

  // A plane within the cell, and how many references are on both sides; those in it are above.
  void offer(std::size_t axis, float at, std::uint32_t below, std::uint32_t above) {
    take({axis, at, false}, below, above);
  }
  // The sides of a box around all triangles, where space is empty beyond.
  void offer_sides(const Box4& box, std::uint32_t count) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (cell_.lo[axis] < box.lo[axis]) take({axis, box.lo[axis], false}, 0, count);
      if (cell_.hi[axis] > box.hi[axis]) take({axis, box.hi[axis], true}, count, 0);
    }
  }

  // Whether one is cheaper than a leaf.
  bool better_than_leaf(std::uint32_t count, KdPlane& plane) const {
    plane = plane_;
    return cost_ < leaf_cost(count);
  }
  // Whether it is with so many on both sides, and they have room: bins only estimate that.
  bool better_than_leaf(std::uint32_t count, std::uint32_t below, std::uint32_t above) const {
    return has_room(below, above) && cost_of(plane_, below, above) < leaf_cost(count);
  }

 private:
  // Cutting off empty space is worth more than it costs now (Wald, Havran 2006).
  static constexpr double of_empty_space = 0.8;

  // The area of a part of the cell with this extent along an axis, as a share of the whole.
  double area(std::size_t axis, double extent) const { return face_[axis] + side_[axis] * extent; }

  static double leaf_cost(std::uint32_t count) { return kd_block_cost * blocks_of(count); }
  bool has_room(std::uint32_t below, std::uint32_t above) const {
    return blocks_of(below) + blocks_of(above) <= blocks_;
  }
  double cost_of(const KdPlane& plane, std::uint32_t below, std::uint32_t above) const {
    const double area_below = area(plane.axis, double{plane.at} - double{cell_.lo[plane.axis]}),
                 area_above = area(plane.axis, double{cell_.hi[plane.axis]} - double{plane.at});
    const double cost =
        1.0 + kd_block_cost * (area_below * expected_blocks(below) + area_above * expected_blocks(above));
    return below == 0 || above == 0 ? of_empty_space * cost : cost;
  }
  void take(const KdPlane& plane, std::uint32_t below, std::uint32_t above) {
    const double cost = cost_of(plane, below, above);
    if (cost < cost_ && has_room(below, above)) cost_ = cost, plane_ = plane;
  }

  const Box4& cell_;
  std::uint32_t blocks_;
  double face_[3], side_[3], cost_ = infinite_float;
  KdPlane plane_{};
};

// Planes at the borders of equal bins along each axis of the box around the references.
class PlaneBins {
 public:
  PlaneBins(const Box4& box, std::size_t references)
      : box_(box),
        bins_(references > few ? most : most / 2),
        width_((box.hi - box.lo) / static_cast<float>(bins_)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float scale = 1.0f / width_[axis];
      serves_[axis] = width_[axis] > 0.0f && width_[axis] < infinite_float && scale < infinite_float;
      scale_[axis] = serves_[axis] ? scale : 0.0f;
    }
  }

  void add(std::span<const Reference> references) {
    const Vec4 last = Vec4{} + (static_cast<float>(bins_) - 1.0f);
    for (const Reference& reference : references) {
      const Vec4 lo = (reference.box.lo - box_.lo) * scale_, hi = (reference.box.hi - box_.lo) * scale_;
      const Vec4i first = __builtin_convertvector(least(greatest(lo, Vec4{}), last), Vec4i);
      const Vec4i end = __builtin_convertvector(least(greatest(hi, Vec4{}), last), Vec4i);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ++begins_[axis][static_cast<std::size_t>(first[axis])];
        ++ends_[axis][static_cast<std::size_t>(end[axis])];
      }
    }
  }
  void add(const PlaneBins& other) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < bins_; ++i)
        begins_[axis][i] += other.begins_[axis][i], ends_[axis][i] += other.ends_[axis][i];
  }

  void offer_to(BestPlane& best, std::uint32_t count) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!serves_[axis]) continue;
      std::uint32_t below = 0, above = count;
      for (std::size_t i = 1; i < bins_; ++i) {
        below += begins_[axis][i - 1], above -= ends_[axis][i - 1];
        const float at = box_.lo[axis] + width_[axis] * static_cast<float>(i);
        if (at > box_.lo[axis] && at < box_.hi[axis]) best.offer(axis, at, below, above);
      }
    }
  }

 private:
  static constexpr std::size_t most = 32, few = 64;
  using Counts = std::array<std::uint32_t, most>;

  Box4 box_;
  std::size_t bins_;
  Vec4 width_, scale_{};
  bool serves_[3];
  std::array<Counts, 3> begins_{}, ends_{};
};

}  // namespace raylanes
