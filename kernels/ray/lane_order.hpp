// Lanes of one register: what differs from lane to lane where each lane is a ray of its own, and flags.
#pragma once

#include "../simd/slices.hpp"
#include "../triangle/ray_triangle.hpp"

namespace raylanes {
namespace {

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
  template <bool with_swap>
  void permute(const Floats<W> (&xyz)[3], Floats<W> (&out)[3]) const {
    const Floats<W> next = select(z_is_x, xyz[1], select(z_is_y, xyz[2], xyz[0]));
    const Floats<W> last = select(z_is_x, xyz[2], select(z_is_y, xyz[0], xyz[1]));
    out[0] = with_swap ? select(swapped, last, next) : next;
    out[1] = with_swap ? select(swapped, next, last) : last;
    out[2] = select(z_is_x, xyz[0], select(z_is_y, xyz[1], xyz[2]));
  }
};

// The watertight test of rays against one triangle each, whose shear axes differ. The ways from corner to
// origin are permuted, not the ends. corners: x, y, z of the first, the second, the third. Without its axes x and y swapped a triangle has all its edge functions
// negated, which changes nothing else; but Kahan's determinant does not negate exactly.
template <Grade grade>
inline ScaledTriangleHit<W> scaled_watertight_of_rays(const Floats<W> (&origin)[3],
                                                      const Floats<W> (&direction)[3],
                                                      const Floats<W>* corners) {
  constexpr bool with_swap = grade == Grade::fast && has_fma;
  const LaneAxes axes(direction);
  Floats<W> d[3], way[3][3];
  axes.permute<with_swap>(direction, d);
  for (int k = 0; k < 3; ++k) {
    Floats<W> unpermuted[3];
    for (int axis = 0; axis < 3; ++axis) unpermuted[axis] = origin[axis] - corners[3 * k + axis];
    axes.permute<with_swap>(unpermuted, way[k]);
  }
  return scaled_watertight_of_ways<grade, W>(shear_ray<W>(origin, d), way);
}

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
