// The box around what lies in the lanes of rows, as nodes and blocks have them.
#pragma once

#include "../mesh/bounding_boxes.hpp"
#include "four_floats.hpp"

namespace raylanes {

// Grows a box in each of four lanes by what they hold; what is NaN, as in lanes without a triangle, is in no box.
class BoxOfLanes {
 public:
  BoxOfLanes() {
    for (int axis = 0; axis < 3; ++axis) {
      lo_[axis] = FourFloats(empty_box.lo[0]);
      hi_[axis] = FourFloats(empty_box.hi[0]);
    }
  }
  void extend(std::size_t axis, FourFloats lo, FourFloats hi) {
    lo_[axis] = min(lo, lo_[axis]);
    hi_[axis] = max(hi, hi_[axis]);
  }
  // Around all lanes.
  Box box() const {
    float corner[2][4];
    of_lanes(lo_, [](FourFloats a, FourFloats b) { return min(a, b); }).store(corner[0]);
    of_lanes(hi_, [](FourFloats a, FourFloats b) { return max(a, b); }).store(corner[1]);
    return {{corner[0][0], corner[0][1], corner[0][2]}, {corner[1][0], corner[1][1], corner[1][2]}};
  }

 private:
  // The minimum or the maximum of the lanes of each axis, axis by axis; the fourth result is unused.
  template <class Choose>
  static FourFloats of_lanes(const FourFloats (&axes)[3], Choose choose) {
    const FourFloats xy_low = interleave_low(axes[0], axes[1]), z_low = interleave_low(axes[2], axes[2]);
    const FourFloats xy_high = interleave_high(axes[0], axes[1]), z_high = interleave_high(axes[2], axes[2]);
    return choose(choose(low_halves(xy_low, z_low), high_halves(xy_low, z_low)),
                  choose(low_halves(xy_high, z_high), high_halves(xy_high, z_high)));
  }

  FourFloats lo_[3], hi_[3];
};

}  // namespace raylanes
