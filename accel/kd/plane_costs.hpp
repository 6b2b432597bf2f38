// What planes cost by the surface area heuristic (MacDonald, Booth 1990), and the best of many.
#pragma once

#include <array>
#include <span>

#include "growth.hpp"

namespace raylanes {

// Half the surface of a box, in doubles: areas of finite boxes neither overflow nor vanish.
inline double area_of(const FourBox& box) {
  const double x = double{box.hi[0]} - double{box.lo[0]}, y = double{box.hi[1]} - double{box.lo[1]},
               z = double{box.hi[2]} - double{box.lo[2]};
  return x * y + y * z + z * x;
}

// The expected cost of so many triangles in a cell that is not divided yet: one block, or as many as they fill; some
// divisions pay later.
inline double expected_blocks(std::uint32_t count) {
  constexpr double of_triangle = 1.0 / tree_width;
  return count == 0 ? 0.0 : std::max(1.0, of_triangle * count);
}

// How many references lie on each side of a plane, or in it.
struct SideCounts {
  std::uint32_t below, above, flat;
};

// The best plane of a cell so far: costs are those of a line that meets the cell.
class BestPlane {
 public:
  explicit BestPlane(const KdCell& cell)
      : cell_(cell.cell), blocks_(cell.blocks), inverse_area_(1.0 / area_of(cell.cell)) {}

  // A plane in the cell, not outside. What lies in it goes where that is cheaper.
  void offer(std::size_t axis, float at, const SideCounts& counts) {
    FourBox below = cell_, above = cell_;
    below.hi[axis] = above.lo[axis] = at;
    const double area_below = area_of(below) * inverse_area_, area_above = area_of(above) * inverse_area_;
    take(axis, at, true, area_below, counts.below + counts.flat, area_above, counts.above);
    if (counts.flat > 0)
      take(axis, at, false, area_below, counts.below, area_above, counts.above + counts.flat);
  }

  // Whether one is cheaper than a leaf.
  bool better_than_leaf(std::size_t count, KdPlane& plane) const {
    plane = plane_;
    return cost_ < kd_block_cost * blocks_of(count);
  }

 private:
  // Cutting off empty space is worth more than it costs now (Wald, Havran 2006).
  static constexpr double of_empty_space = 0.8;

  void take(std::size_t axis, float at, bool flat_below, double area_below, std::uint32_t below,
            double area_above, std::uint32_t above) {
    const bool is_border = at <= cell_.lo[axis] || at >= cell_.hi[axis];
    if (is_border && (below == 0 || above == 0)) return;
    double cost =
        1.0 + kd_block_cost * (area_below * expected_blocks(below) + area_above * expected_blocks(above));
    if (below == 0 || above == 0) cost *= of_empty_space;
    if (!(cost < cost_) || blocks_of(below) + blocks_of(above) > blocks_) return;
    cost_ = cost, plane_ = {axis, at, flat_below};
  }

  const FourBox& cell_;
  std::uint32_t blocks_;
  double inverse_area_, cost_ = infinite_float;
  KdPlane plane_{};
};

// Planes at the borders of equal bins along each axis of the box, and at its sides.
class PlaneBins {
 public:
  static constexpr std::size_t bins = 32;

  explicit PlaneBins(const FourBox& box) : box_(box), width_((box.hi - box.lo) * (1.0f / bins)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float scale = 1.0f / width_[axis];
      serves_[axis] = width_[axis] > 0.0f && width_[axis] < infinite_float && scale < infinite_float;
      scale_[axis] = serves_[axis] ? scale : 0.0f;
    }
  }

  void add(std::span<const Reference> references) {
    const Four last = Four{} + (bins - 1.0f);
    for (const Reference& reference : references) {
      const Four lo = (reference.box.lo - box_.lo) * scale_, hi = (reference.box.hi - box_.lo) * scale_;
      const FourInts first = __builtin_convertvector(least(greatest(lo, Four{}), last), FourInts);
      const FourInts end = __builtin_convertvector(least(greatest(hi, Four{}), last), FourInts);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ++begins_[axis][static_cast<std::size_t>(first[axis])];
        ++ends_[axis][static_cast<std::size_t>(end[axis])];
      }
    }
  }
  void add(const PlaneBins& other) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < bins; ++i)
        begins_[axis][i] += other.begins_[axis][i], ends_[axis][i] += other.ends_[axis][i];
  }

  void offer_to(BestPlane& best, const KdCell& cell, std::uint32_t count) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (cell.cell.lo[axis] < box_.lo[axis]) best.offer(axis, box_.lo[axis], {0, count, 0});
      if (cell.cell.hi[axis] > box_.hi[axis]) best.offer(axis, box_.hi[axis], {count, 0, 0});
      if (!serves_[axis]) continue;
      std::uint32_t below = 0, above = count;
      for (std::size_t i = 1; i < bins; ++i) {
        below += begins_[axis][i - 1], above -= ends_[axis][i - 1];
        const float at = box_.lo[axis] + width_[axis] * static_cast<float>(i);
        if (at > cell.cell.lo[axis] && at < cell.cell.hi[axis]) best.offer(axis, at, {below, above, 0});
      }
    }
  }

 private:
  using Counts = std::array<std::uint32_t, bins>;

  FourBox box_;
  Four width_, scale_{};
  bool serves_[3];
  std::array<Counts, 3> begins_{}, ends_{};
};

// All planes at which a reference begins or ends.
class ExactPlanes {
 public:
  static constexpr std::size_t most = 16;

  explicit ExactPlanes(std::span<const Reference> references) : count_(references.size()) {
    for (std::size_t i = 0; i < most; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        lo_[axis][i] = i < count_ ? references[i].box.lo[axis] : infinite_float;  // neither below, nor above
        hi_[axis][i] = i < count_ ? references[i].box.hi[axis] : -infinite_float;
      }
  }

  void offer_to(BestPlane& best) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < count_; ++i) {
        best.offer(axis, lo_[axis][i], counts_at(axis, lo_[axis][i]));
        if (hi_[axis][i] != lo_[axis][i]) best.offer(axis, hi_[axis][i], counts_at(axis, hi_[axis][i]));
      }
  }

 private:
  SideCounts counts_at(std::size_t axis, float at) const {
    std::uint32_t below = 0, above = 0, either = 0;
    for (std::size_t i = 0; i < most; ++i) {
      const std::uint32_t begins = lo_[axis][i]<at, ends = hi_[axis][i]> at;
      below += begins, above += ends, either += begins | ends;
    }
    return {below, above, static_cast<std::uint32_t>(count_) - either};
  }

  std::size_t count_;
  alignas(16) float lo_[3][most], hi_[3][most];
};

}  // namespace raylanes
