// The box tests as forms that the loops of intersections.cpp are instantiated with: a ray prepared so that
// the distances of a plane cost two operations, or one fused.
#pragma once

#include <raylanes/intersections.hpp>

#include "../ray/lane_order.hpp"
#include "ray_box.hpp"

namespace raylanes {
namespace {

// lo·(1/d) − o·(1/d), see BoxTest::directional. The near constant moves the plane towards the ray's origin
// and the far one away from it.
struct ProductRay {
  Floats<W> near_inverse[3], near_product[3], far_inverse[3], far_product[3];
};

inline ProductRay product_ray(const Floats<W> (&origin)[3], const Floats<W> (&direction)[3]) {
  const Floats<W> least(0x1p-96f), slack(0x1p40f), zero(0.0f);
  ProductRay ray;
  for (int axis = 0; axis < 3; ++axis) {
    const FloatMask<W> tiny = abs(direction[axis]) < least;
    const FloatBits<W> sign = as<std::uint32_t>(direction[axis]) & FloatBits<W>(0x80000000u);
    const Floats<W> repaired = as<float>(as<std::uint32_t>(least) | sign);
    const Floats<W> inverse = Floats<W>(1.0f) / select(tiny, repaired, direction[axis]);
    const Floats<W> product = origin[axis] * inverse;
    const Floats<W> pad = Floats<W>(8 * 0x1p-24f) * abs(product) + select(tiny, slack, zero);
    const Floats<W> widen(conservative_far_factor);
    ray.near_inverse[axis] = inverse;
    ray.near_product[axis] = product + pad;
    ray.far_inverse[axis] = inverse * widen;
    ray.far_product[axis] = (product - pad) * widen;
  }
  return ray;
}

template <BoxTest test, Grade grade>
struct BoxForm {
  SlabRay<W> ray;
  explicit BoxForm(const Floats<W> (&origin)[3], const Floats<W> (&direction)[3])
      : ray(conservative_slab_ray<W>(origin, direction)) {
    if constexpr (test == BoxTest::plain)
      for (int axis = 0; axis < 3; ++axis) ray.far_inverse[axis] = ray.near_inverse[axis];
  }
  const Floats<W> (&inverse() const)[3] { return ray.near_inverse; }
  Floats<W> near(int axis, Floats<W> plane) const {
    return (plane - ray.near_origin[axis]) * ray.near_inverse[axis];
  }
  Floats<W> far(int axis, Floats<W> plane) const {
    return (plane - ray.near_origin[axis]) * ray.far_inverse[axis];
  }
};

template <Grade grade>
struct BoxForm<BoxTest::directional, grade> {
  ProductRay ray;
  explicit BoxForm(const Floats<W> (&origin)[3], const Floats<W> (&direction)[3])
      : ray(product_ray(origin, direction)) {}
  const Floats<W> (&inverse() const)[3] { return ray.near_inverse; }
  Floats<W> near(int axis, Floats<W> plane) const {
    return multiply_add<grade>(plane, ray.near_inverse[axis], -ray.near_product[axis]);
  }
  Floats<W> far(int axis, Floats<W> plane) const {
    return multiply_add<grade>(plane, ray.far_inverse[axis], -ray.far_product[axis]);
  }
};

// The same distances with the subtractions on the pipes that multiply: yes or no for many boxes waits for
// those that add. Flat, because g++ 12 keeps a struct within a struct in memory.
template <BoxTest test, Grade grade>
struct ManyBoxesForm {
  Floats<W> origin[3], near_inverse[3], far_inverse[3], one = opaque_one<W>();
  explicit ManyBoxesForm(const Floats<W> (&o)[3], const Floats<W> (&direction)[3]) {
    const BoxForm<test, grade> form(o, direction);
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = o[axis];
      near_inverse[axis] = form.ray.near_inverse[axis];
      far_inverse[axis] = form.ray.far_inverse[axis];
    }
  }
  Floats<W> near(int axis, Floats<W> plane) const {
    return subtract_by_multipliers(plane, origin[axis], one) * near_inverse[axis];
  }
  Floats<W> far(int axis, Floats<W> plane) const {
    return subtract_by_multipliers(plane, origin[axis], one) * far_inverse[axis];
  }
};
template <Grade grade>
struct ManyBoxesForm<BoxTest::directional, grade> : BoxForm<BoxTest::directional, grade> {
  using BoxForm<BoxTest::directional, grade>::BoxForm;
};

// Clips [tmin, tmax]; a NaN distance (0·inf: the origin in a plane that the ray is parallel to) leaves the
// bound as it is.
template <class Form>
inline SlabInterval<W> clip(const Form& form, const Floats<W> (&near_plane)[3],
                            const Floats<W> (&far_plane)[3], Floats<W> tmin, Floats<W> tmax) {
  SlabInterval<W> inside{tmin, tmax};
  for (int axis = 0; axis < 3; ++axis) {
    inside.entry = max(form.near(axis, near_plane[axis]), inside.entry);
    inside.exit = min(form.far(axis, far_plane[axis]), inside.exit);
  }
  return inside;
}

// Yes or no, with the axis along which the ray moves most as the last: there a distance is NaN only if the
// plane is, and the order of the operands lets that NaN through to the comparison. So only the other two
// axes need the check for NaN and order, which is `proper`.
template <class Form>
inline FloatMask<W> meets(const Form& form, const Floats<W> (&near_plane)[3], const Floats<W> (&far_plane)[3],
                          Floats<W> tmin, Floats<W> tmax, FloatMask<W> proper) {
  Floats<W> entry = tmin, exit = tmax;
  for (int axis = 0; axis < 2; ++axis) {
    entry = max(form.near(axis, near_plane[axis]), entry);
    exit = min(form.far(axis, far_plane[axis]), exit);
  }
  entry = max(entry, form.near(2, near_plane[2]));
  exit = min(exit, form.far(2, far_plane[2]));
  return (entry <= exit) & proper;
}

}  // namespace
}  // namespace raylanes
