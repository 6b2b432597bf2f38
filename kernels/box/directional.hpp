// The box test whose distances cost one multiply-add: products of origin and reciprocal are prepared with the ray.
#pragma once

#include "slabs.hpp"

namespace raylanes {
namespace {

// lo·(1/d) − o·(1/d), see BoxTest::directional. The near constant moves the plane towards the ray's origin
// and the far one away from it.
template <Grade grade>
struct DirectionalSlabs {
  static constexpr BoxTest id = BoxTest::directional;
  static constexpr int floats = 6;

  struct Ray {
    Floats<W> inverse[3], near_product[3], far_inverse[3], far_product[3];
    template <class V>
    Ray(const V (&origin)[3], const V (&direction)[3]) {
      V least(0x1p-96f), slack(0x1p40f), zero(0.0f), widen(conservative_far_factor);
      for (int axis = 0; axis < 3; ++axis) {
        auto tiny = abs(direction[axis]) < least;
        V repaired = flip(least, sign_of(direction[axis]));
        V reciprocal = V(1.0f) / select(tiny, repaired, direction[axis]);
        V product = origin[axis] * reciprocal;
        V pad = V(8 * 0x1p-24f) * abs(product) + select(tiny, slack, zero);
        inverse[axis] = in_all_lanes(reciprocal);
        near_product[axis] = in_all_lanes(product + pad);
        far_inverse[axis] = in_all_lanes(reciprocal * widen);
        far_product[axis] = in_all_lanes((product - pad) * widen);
      }
    }
    Floats<W> near(int axis, Floats<W> plane) const {
      return multiply_add<grade>(plane, inverse[axis], -near_product[axis]);
    }
    Floats<W> far(int axis, Floats<W> plane) const {
      return multiply_add<grade>(plane, far_inverse[axis], -far_product[axis]);
    }
  };
  using ManyBoxes = Ray;
};

}  // namespace
}  // namespace raylanes
