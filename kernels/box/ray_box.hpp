// The slab test (Kay, Kajiya 1986; sign-ordered as Williams et al. 2005), one text for 1 ray × N boxes, N
// rays × 1 box, and the nodes of a tree: whatever is single is broadcast.
#pragma once

#include <limits>

#include "../simd/vocabulary.hpp"

namespace raylanes {
namespace {

// A ray as slabs want it. Near and far constants differ so that a caller can widen the box for free: move
// the near plane's origin forward and the far plane's back (a pad in space), or scale the far reciprocal
// (a factor on t).
template <int N>
struct SlabRay {
  Floats<N> near_origin[3];
  Floats<N> far_origin[3];
  Floats<N> near_inverse[3];
  Floats<N> far_inverse[3];
};

template <int N>
struct SlabInterval {
  Floats<N> entry;
  Floats<N> exit;
};

// near_plane and far_plane: per axis the box plane that the ray meets first and last, by the sign bit of the
// reciprocal, so that −0 counts as negative. Clips [tmin, tmax]; the box is hit where entry <= exit.
// The running bound is the second operand of min and max, so a NaN (0·inf: the origin lies in a plane that
// the ray is parallel to) leaves it as it is: that slab contains the ray.
template <int N>
inline SlabInterval<N> clip_to_slabs(const SlabRay<N>& ray, const Floats<N> (&near_plane)[3],
                                     const Floats<N> (&far_plane)[3], Floats<N> tmin, Floats<N> tmax) {
  SlabInterval<N> inside{tmin, tmax};
  for (int axis = 0; axis < 3; ++axis) {
    const Floats<N> t_near = (near_plane[axis] - ray.near_origin[axis]) * ray.near_inverse[axis];
    const Floats<N> t_far = (far_plane[axis] - ray.far_origin[axis]) * ray.far_inverse[axis];
    inside.entry = max(t_near, inside.entry);
    inside.exit = min(t_far, inside.exit);
  }
  return inside;
}

// 1 + 2γ3 rounded up: three roundings in each of the two distances (subtract, reciprocal, multiply).
inline constexpr float conservative_far_factor = 1.0f + 3.0f * std::numeric_limits<float>::epsilon();

template <int N>
inline SlabRay<N> conservative_slab_ray(const Floats<N> (&origin)[3], const Floats<N> (&direction)[3]) {
  SlabRay<N> ray;
  for (int axis = 0; axis < 3; ++axis) {
    const Floats<N> inverse = Floats<N>(1.0f) / direction[axis];
    ray.near_origin[axis] = ray.far_origin[axis] = origin[axis];
    ray.near_inverse[axis] = inverse;
    ray.far_inverse[axis] = inverse * Floats<N>(conservative_far_factor);
  }
  return ray;
}

}  // namespace
}  // namespace raylanes
