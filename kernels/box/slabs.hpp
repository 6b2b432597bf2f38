// The slab test (Kay, Kajiya 1986; sign-ordered as Williams et al. 2005), one text for 1 ray × N boxes, N
// rays × 1 box, and the nodes of a tree: whatever is single is broadcast.
#pragma once

#include <limits>

#include <raylanes/boxes.hpp>

#include "../ray/ray_columns.hpp"

namespace raylanes {
namespace {

// A ray as the nodes of a tree want it, in lanes or not. Near and far constants differ so that a caller can widen the
// box for free: move the near plane's origin forward and the far plane's back (a pad in space), or scale the far
// reciprocal (a factor on t).
template <class V>
struct SlabRay {
  V near_origin[3], far_origin[3], near_inverse[3], far_inverse[3];

  // The distance at which it meets a plane: as the first plane of a box, as the last one.
  V near(int axis, V plane) const { return (plane - near_origin[axis]) * near_inverse[axis]; }
  V far(int axis, V plane) const { return (plane - far_origin[axis]) * far_inverse[axis]; }
};

// Clips a segment to the part in the box; the box is hit where that is not empty, tmin <= tmax. near_plane and
// far_plane: per axis the box plane that the ray meets first and last, by the sign bit of the reciprocal, so that −0
// counts as negative. `ray` knows the distances of planes. The running bound is the second operand of min and max, so a
// NaN (0·inf: the origin lies in a plane that the ray is parallel to) leaves it as it is: that slab contains the ray.
template <int N, class Ray>
inline Segment<Floats<N>> clip_to_slabs(const Ray& ray, const Floats<N> (&near_plane)[3],
                                        const Floats<N> (&far_plane)[3], const Segment<Floats<N>>& segment) {
  Segment<Floats<N>> inside = segment;
  for (int axis = 0; axis < 3; ++axis) {
    inside.tmin = max(ray.near(axis, near_plane[axis]), inside.tmin);
    inside.tmax = min(ray.far(axis, far_plane[axis]), inside.tmax);
  }
  return inside;
}

// 1 + 2γ3 rounded up: three roundings in each of the two distances (subtract, reciprocal, multiply).
inline constexpr float conservative_far_factor = 1.0f + 3.0f * std::numeric_limits<float>::epsilon();

// The tests that subtract the origin. A test has
//   id, floats   its enumerator; how many numbers a box has
//   Ray          a ray of one lane or of W as the test wants it, with near and far, and `inverse` for the order
//                of planes
//   ManyBoxes    one that answers yes or no for many boxes
template <BoxTest test>
struct Slabs {
  static constexpr BoxTest id = test;
  static constexpr int floats = 6;
  static constexpr bool is_widened = test == BoxTest::conservative;

  struct Ray {
    Floats<W> origin[3], inverse[3], far_inverse[3];
    template <class V>
    Ray(const V (&o)[3], const V (&direction)[3]) {
      for (int axis = 0; axis < 3; ++axis) {
        V reciprocal = V(1.0f) / direction[axis];
        origin[axis] = in_all_lanes(o[axis]);
        inverse[axis] = in_all_lanes(reciprocal);
        far_inverse[axis] =
            is_widened ? in_all_lanes(reciprocal * V(conservative_far_factor)) : inverse[axis];
      }
    }
    Floats<W> near(int axis, Floats<W> plane) const { return (plane - origin[axis]) * inverse[axis]; }
    Floats<W> far(int axis, Floats<W> plane) const { return (plane - origin[axis]) * far_inverse[axis]; }
  };

  // The same distances with the subtractions on the pipes that multiply: yes or no for many boxes waits for
  // those that add.
  struct ManyBoxes : Ray {
    Floats<W> one = opaque_one<W>();
    using Ray::Ray;
    Floats<W> near(int axis, Floats<W> plane) const {
      return subtract_by_multipliers(plane, this->origin[axis], one) * this->inverse[axis];
    }
    Floats<W> far(int axis, Floats<W> plane) const {
      return subtract_by_multipliers(plane, this->origin[axis], one) * this->far_inverse[axis];
    }
  };
};
template <Grade>
struct ConservativeSlabs : Slabs<BoxTest::conservative> {
  static constexpr bool has_one_arithmetic = true;
};
template <Grade>
struct PlainSlabs : Slabs<BoxTest::plain> {
  static constexpr bool has_one_arithmetic = true;
};

}  // namespace
}  // namespace raylanes
