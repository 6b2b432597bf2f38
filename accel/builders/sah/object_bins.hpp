// Bins along each axis, and the border between them where the surface-area heuristic says to split (Wald 2007).
#pragma once

#include "../in_place.hpp"

namespace raylanes {

inline constexpr std::size_t max_bins = 16;
// Axes along which centres extend less than this share of the longest extent are not binned: over several scenes that
// costs no quality, and spares a tenth of the time.
inline constexpr float min_extent = 0.5f;

// A place to split: references whose bin along the axis is below `bin` go left.
struct BinBorder {
  float cost = infinite_float;  // of both sides
  std::size_t axis = 0;
  std::int32_t bin = 0;
  Box4 left = empty_four_box, right = empty_four_box;  // around both sides
};

// Maps centres to bins, for all axes at a time; monotone, so a border between bins is a border in space.
class Binning {
 public:
  // Few references need few bins.
  Binning(const Box4& centres, std::uint32_t count)
      : bins_(std::min<std::size_t>(max_bins, 4 + count / 16)), origin_(centres.lo) {
    const Vec4 extent = centres.hi - centres.lo;
    const float longest = extent[longest_axis(centres)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // Just below bins/extent, so that the last centre falls into the last bin. If this is not a number, all centres
      // fall into the first.
      const float scale = static_cast<float>(bins_) * (1.0f - 1e-6f) / extent[axis];
      const bool serves = extent[axis] > 0.0f && extent[axis] < infinite_float && scale < infinite_float &&
                          extent[axis] >= min_extent * longest;
      if (serves) axes_[axes_count_++] = axis;
      scale_[axis] = serves ? scale : 0.0f;
    }
  }

  std::size_t bins() const { return bins_; }
  std::span<const std::size_t> axes() const { return std::span(axes_).first(axes_count_); }
  Vec4i operator()(const Reference& reference) const {
    const Vec4 at = position(centre(reference.box));
    // The centre of an empty box is NaN, and falls into the first bin.
    const Vec4 last = Vec4{} + (static_cast<float>(bins_) - 1.0f);
    return __builtin_convertvector(least(greatest(at, Vec4{}), last), Vec4i);
  }
  // Whether the bin of a centre is below a border's: that of a NaN is.
  bool is_below(Vec4 centre, const BinBorder& border) const {
    return !(position(centre)[border.axis] >= static_cast<float>(border.bin));
  }

 private:
  Vec4 position(Vec4 centre) const { return (centre - origin_) * scale_; }

  std::size_t bins_;
  std::array<std::size_t, 3> axes_{};
  std::size_t axes_count_ = 0;
  Vec4 origin_;
  Vec4 scale_{};
};

class ObjectBins {
 public:
  explicit ObjectBins(const Binning& binning) : binning_(binning) {
    for (const std::size_t axis : binning.axes())
      for (std::size_t i = 0; i < binning.bins(); ++i) boxes_[axis][i] = empty_four_box, counts_[axis][i] = 0;
  }

  void add(std::span<const Reference> references) {
    const std::span<const std::size_t> axes = binning_.axes();
    if (axes.size() == 3)
      add<3>(references, axes.data());
    else if (axes.size() == 2)
      add<2>(references, axes.data());
    else if (axes.size() == 1)
      add<1>(references, axes.data());
  }
  void add(const ObjectBins& other) {
    for (const std::size_t axis : binning_.axes())
      for (std::size_t i = 0; i < binning_.bins(); ++i) {
        extend(boxes_[axis][i], other.boxes_[axis][i]);
        counts_[axis][i] += other.counts_[axis][i];
      }
  }

  // Infinite cost where there is no axis to split along, or areas overflow.
  BinBorder best() const {
    BinBorder best;
    for (const std::size_t axis : binning_.axes()) sweep(axis, best);
    if (best.cost == infinite_float) return best;
    const auto bin = static_cast<std::size_t>(best.bin);
    for (std::size_t i = 0; i < binning_.bins(); ++i)
      extend(i < bin ? best.left : best.right, boxes_[best.axis][i]);
    return best;
  }

 private:
  template <std::size_t axis_count>
  void add(std::span<const Reference> references, const std::size_t* axes) {
    for (const Reference& reference : references) {
      const Vec4i bin = binning_(reference);
      for (std::size_t k = 0; k < axis_count; ++k) {
        const std::size_t axis = axis_count == 3 ? k : axes[k];
        const auto i = static_cast<std::uint32_t>(bin[axis]);
        extend(boxes_[axis][i], reference.box);
        ++counts_[axis][i];
      }
    }
  }

  void sweep(std::size_t axis, BinBorder& best) const {
    const auto& boxes = boxes_[axis];
    const auto& counts = counts_[axis];
    std::array<float, max_bins> right_cost;
    Box4 box = empty_four_box;
    std::uint32_t count = 0;
    for (std::size_t i = binning_.bins() - 1; i > 0; --i) {
      extend(box, boxes[i]);
      count += counts[i];
      right_cost[i] = cost_of_side(box, count);
    }
    box = empty_four_box, count = 0;
    for (std::size_t i = 1; i < binning_.bins(); ++i) {
      extend(box, boxes[i - 1]);
      count += counts[i - 1];
      const float cost = cost_of_side(box, count) + right_cost[i];
      if (cost < best.cost) best.cost = cost, best.axis = axis, best.bin = static_cast<std::int32_t>(i);
    }
  }

  const Binning& binning_;
  std::array<std::array<Box4, max_bins>, 3> boxes_;
  std::array<std::array<std::uint32_t, max_bins>, 3> counts_;
};

// The best border of many references, on threads.
inline BinBorder best_border(std::span<const Reference> references, const Binning& binning, int threads) {
  constexpr std::size_t grain = 1 << 14;
  ObjectBins all(binning);
  if (threads == 1 || references.size() <= grain) {
    all.add(references);
    return all.best();
  }
  std::mutex mutex;
  in_parallel(references.size(), grain, threads, [&](std::size_t begin, std::size_t end) {
    ObjectBins mine(binning);
    mine.add(references.subspan(begin, end - begin));
    const std::lock_guard lock(mutex);
    all.add(mine);
  });
  return all.best();
}

}  // namespace raylanes
