// Lanes of one register: what differs from lane to lane where each lane is a ray of its own, and flags.
#pragma once

#include "vocabulary.hpp"

namespace raylanes {
namespace {

inline constexpr int W = native_lanes;

inline FloatBits<W> as_flags(FloatMask<W> m) {
  return as<std::uint32_t>(select(m, as<float>(FloatBits<W>(~0u)), Floats<W>(0.0f)));
}

// Lane by lane a permutation of axes, for rays whose shear axes differ.
struct LaneAxes {
  FloatMask<W> z_is_x, z_is_y, swapped;
  explicit LaneAxes(const Floats<W> (&direction)[3]) {
    const Floats<W> x = abs(direction[0]), y = abs(direction[1]), z = abs(direction[2]);
    z_is_x = (x >= y) & (x >= z);
    z_is_y = ~z_is_x & (y >= z);
    swapped = select(z_is_x, direction[0], select(z_is_y, direction[1], direction[2])) < Floats<W>(0.0f);
  }
  template <bool with_swap = true>
  void permute(const Floats<W> (&xyz)[3], Floats<W> (&out)[3]) const {
    const Floats<W> next = select(z_is_x, xyz[1], select(z_is_y, xyz[2], xyz[0]));
    const Floats<W> last = select(z_is_x, xyz[2], select(z_is_y, xyz[0], xyz[1]));
    out[0] = with_swap ? select(swapped, last, next) : next;
    out[1] = with_swap ? select(swapped, next, last) : last;
    out[2] = select(z_is_x, xyz[0], select(z_is_y, xyz[1], xyz[2]));
  }
};

// The planes that a ray meets first and last, by the sign bit of its reciprocal direction.
inline void order_planes(const Floats<W> (&inverse)[3], const Floats<W> (&lo)[3], const Floats<W> (&hi)[3],
                         Floats<W> (&near_plane)[3], Floats<W> (&far_plane)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    near_plane[axis] = select_negative(inverse[axis], hi[axis], lo[axis]);
    far_plane[axis] = select_negative(inverse[axis], lo[axis], hi[axis]);
  }
}

// A box with a NaN bound, or without extent because lo > hi, is hit by nothing.
inline FloatMask<W> is_proper_box(const Floats<W> (&lo)[3], const Floats<W> (&hi)[3]) {
  return (lo[0] <= hi[0]) & (lo[1] <= hi[1]) & (lo[2] <= hi[2]);
}

}  // namespace
}  // namespace raylanes
