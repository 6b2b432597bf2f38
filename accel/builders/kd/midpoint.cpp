#include "../in_place.hpp"
#include "growth.hpp"

namespace raylanes {
namespace {

struct Midpoint {
  bool choose(std::span<const Reference> references, const KdCell& cell, int, KdPlane& plane) const {
    if (references.size() <= tree_width) return false;
    plane.axis = longest_axis(cell.cell);
    plane.at = centre(cell.cell)[plane.axis];
    plane.flat_below = true;
    return plane.at > cell.cell.lo[plane.axis] && plane.at < cell.cell.hi[plane.axis] && differ(references);
  }

  template <class To>
  void place(const Reference& reference, const KdPlane& plane, To& to) const {
    if (reference.box.hi[plane.axis] <= plane.at)
      to.below(reference);
    else if (reference.box.lo[plane.axis] >= plane.at)
      to.above(reference);
    else
      to.keep(reference);
  }

 private:
  // Equal boxes are separated by no plane.
  static bool differ(std::span<const Reference> references) {
    const Box4& first = references[0].box;
    for (const Reference& reference : references.subspan(1))
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (reference.box.lo[axis] != first.lo[axis] || reference.box.hi[axis] != first.hi[axis]) return true;
    return false;
  }
};

}  // namespace

KdCells build_kd_midpoint(BuildInput input) {
  return KdGrowth(Midpoint(), input.run).build(std::move(input.references));
}

}  // namespace raylanes
