
#include "plane_costs.hpp"

namespace raylanes {
namespace {

bool is_empty(const Box4& box) {
  return !(box.lo[0] <= box.hi[0] && box.lo[1] <= box.hi[1] && box.lo[2] <= box.hi[2]);
}

class Sah {
 public:
  Sah(const Clipper& clipper, std::size_t triangles)
      : clipper_(clipper),
        max_depth_(std::min(max_kd_depth - 1,
                            12 + static_cast<int>(1.5 * std::log2(static_cast<double>(triangles) + 1.0)))) {}

  bool choose(std::span<const Reference> references, const KdCell& cell, int threads, KdPlane& plane) const {
    if (cell.depth >= max_depth_) return false;
    const auto count = static_cast<std::uint32_t>(references.size());
    BestPlane best(cell);
    best.offer_sides(cell.box, count);
    // A cell that fills no more than a block is not worth dividing: only empty space is cut off.
    if (count > tree_width) binned(references, cell.box, threads).offer_to(best, count);
    if (!best.better_than_leaf(count, plane)) return false;
    std::uint32_t below = 0, above = 0;
    for (const Reference& reference : references) {
      const Sides sides = sides_of(reference, plane);
      below += sides.below, above += sides.above;
    }
    return best.better_than_leaf(count, below, above);
  }

  template <class To>
  void place(const Reference& reference, const KdPlane& plane, To& to) const {
    const Sides sides = sides_of(reference, plane);
    if (sides.below && sides.above) {
      const std::uint32_t primitive = reference.primitive();
      const Clipper::Halves halves = clipper_.cut(primitive, reference.box, plane.axis, plane.at);
      if (!is_empty(halves.below)) to.below(Reference::make(halves.below, primitive));
      if (!is_empty(halves.above)) to.above(Reference::make(halves.above, primitive));
    } else if (sides.below) {
      to.below(reference);
    } else {
      to.above(reference);
    }
  }

 private:
  // A reference goes where it has more than the plane; what lies across, to both sides.
  struct Sides {
    bool below, above;
  };
  static Sides sides_of(const Reference& reference, const KdPlane& plane) {
    const bool begins_below =
        reference.box.lo[plane.axis]<plane.at, ends_above = reference.box.hi[plane.axis]> plane.at;
    return {begins_below || (!ends_above && plane.flat_below),
            ends_above || (!begins_below && !plane.flat_below)};
  }

  static PlaneBins binned(std::span<const Reference> references, const Box4& box, int threads) {
    constexpr std::size_t grain = 1 << 13;
    PlaneBins all(box, references.size());
    std::mutex mutex;
    in_parallel(references.size(), grain, threads, [&](std::size_t begin, std::size_t end) {
      PlaneBins mine(box, references.size());
      mine.add(references.subspan(begin, end - begin));
      const std::lock_guard lock(mutex);
      all.add(mine);
    });
    return all;
  }

  const Clipper& clipper_;
  int max_depth_;
};

}  // namespace

KdCells build_kd_sah(BuildInput input) {
  const Sah splitter(*input.clipper, input.references.size());
  return KdGrowth(splitter, input.run).build(std::move(input.references));
}

}  // namespace raylanes
