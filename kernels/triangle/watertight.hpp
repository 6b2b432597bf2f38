// Watertight (Woop, Benthin, Wald 2013), on components in the order of the ray's axes.
#pragma once

#include "../ray/triangle_test.hpp"

namespace raylanes {
namespace {

// A corner against the ray, x and y mirrored: a function of corner and ray alone, so that all triangles that
// share it agree.
template <class V>
struct ShearedCorner {
  V x, y, z;
};

template <class V>
struct EdgeFunctions {
  V u, v, w;  // scaled barycentrics of corners 0, 1, 2
};

// The least and the largest edge function. A NaN among three may get lost here; it makes their sum NaN.
template <class V>
struct EdgeRange {
  V least, largest;
  explicit EdgeRange(const EdgeFunctions<V>& e)
      : least(min(min(e.u, e.v), e.w)), largest(max(max(e.u, e.v), e.w)) {}
  MaskOf<V> same_sign() const { return (least >= V(0.0f)) | (largest <= V(0.0f)); }
  MaskOf<V> same_strict_sign() const { return (least > V(0.0f)) | (largest < V(0.0f)); }
};

// The edge functions of the lanes in `undecided` again, in double, where the products are exact and so is
// the sign of the difference. Rare, hence out of line and lane by lane.
template <int N>
[[gnu::noinline]] void decide_in_double(EdgeFunctions<Floats<N>>& e, const ShearedCorner<Floats<N>>& a,
                                        const ShearedCorner<Floats<N>>& b, const ShearedCorner<Floats<N>>& c,
                                        std::uint32_t undecided) {
  float ax[N], ay[N], bx[N], by[N], cx[N], cy[N], u[N], v[N], w[N];
  a.x.store(ax), a.y.store(ay), b.x.store(bx), b.y.store(by), c.x.store(cx), c.y.store(cy);
  e.u.store(u), e.v.store(v), e.w.store(w);
  const auto difference = [](float px, float qy, float py, float qx) {
    return static_cast<float>(static_cast<double>(px) * qy - static_cast<double>(py) * qx);
  };
  for (int i = 0; i < N; ++i) {
    if ((undecided >> i & 1u) == 0) continue;
    u[i] = difference(cx[i], by[i], cy[i], bx[i]);
    v[i] = difference(ax[i], cy[i], ay[i], cx[i]);
    w[i] = difference(bx[i], ay[i], by[i], ax[i]);
  }
  e = {Floats<N>::load(u), Floats<N>::load(v), Floats<N>::load(w)};
}

template <Grade grade>
struct Watertight : OfCorners {
  static constexpr TriangleTest id = TriangleTest::watertight;
  static constexpr bool by_major_axis = true, rounds = true, eager = false;
  // Without its axes x and y swapped a triangle has all its edge functions negated, which changes nothing else;
  // but Kahan's determinant does not negate exactly.
  static constexpr bool keeps_winding = grade == Grade::fast && has_fma;
  // Whether a zero edge function says that the ray meets the edge exactly. Kahan's determinant says so; the
  // plain one may have cancelled to zero, and must be decided again.
  static constexpr bool zero_is_exact = grade == Grade::fast && has_fma;

  // With the shear that maps the ray to the z axis; scale_z mirrors back.
  template <class V, class Axes>
  struct Ray {
    Vec3<V> origin;
    V shear_x, shear_y, scale_z;
    Axes axes;
  };
  template <class V, class Axes>
  static Ray<V, Axes> prepare(const Vec3<V>& origin, const Vec3<V>& direction, const Axes& axes) {
    Vec3<V> d = axes.template permute<keeps_winding>(direction);
    return {origin, d.x / d.z, d.y / d.z, V(-1.0f) / d.z, axes};
  }

  // Takes slopes x/z and y/z up the major axis, which has the sign and size of the direction.
  template <class V>
  static Ray<V, SharedAxes> of_slopes(const Vec3<V>& origin, V slope_x, V slope_y, V size_z, V sign,
                                      const SharedAxes& axes) {
    return {origin, slope_x * sign, slope_y * sign, V(-1.0f) / (size_z * sign), axes};
  }

  // The tests look from a corner back to the origin, that is at everything mirrored in a point: no sign that is
  // compared changes and no rounding does, and "origin − corner" takes a corner straight from memory, where
  // "corner − origin" would first need it in a register.
  template <class V, class Axes>
  static ShearedCorner<V> shear(const Ray<V, Axes>& ray, const Vec3<V>& corner) {
    Vec3<V> to_origin = ray.axes.template permute<keeps_winding>(ray.origin - corner);
    return {multiply_add<grade>(-ray.shear_x, to_origin.z, to_origin.x),
            multiply_add<grade>(-ray.shear_y, to_origin.z, to_origin.y), ray.scale_z * to_origin.z};
  }

  // If det is 0 with all edge functions of one sign, they are all 0, and so is scaled_t: t is NaN, which no range
  // holds.
  template <class V, class Range>
  static ScaledHit<V> decide(const ShearedCorner<V>& a, const ShearedCorner<V>& b, const ShearedCorner<V>& c,
                             const Range& range) {
    EdgeFunctions<V> e{difference_of_products<grade>(c.x, b.y, c.y, b.x),
                       difference_of_products<grade>(a.x, c.y, a.y, c.x),
                       difference_of_products<grade>(b.x, a.y, b.y, a.x)};
    EdgeRange<V> edges(e);
    MaskOf<V> inside = edges.same_sign();
    if constexpr (!zero_is_exact) {
      MaskOf<V> undecided = inside & ~edges.same_strict_sign();
      if (any(undecided)) [[unlikely]] {
        decide_in_double(e, a, b, c, bits(undecided));
        inside = EdgeRange<V>(e).same_sign();
      }
    }
    V t = multiply_add<grade>(e.w, c.z, multiply_add<grade>(e.u, a.z, e.v * b.z));
    V det = (e.u + e.v) + e.w;
    return {range.accept(inside, [&] { return t / det; }), det, t, e.v, e.w};
  }

  template <class V, class Axes, class Range>
  static ScaledHit<V> test(const Ray<V, Axes>& ray, const V (&c)[floats], const Range& range) {
    return decide(shear(ray, vec3(c)), shear(ray, vec3(c + 3)), shear(ray, vec3(c + 6)), range);
  }
};

}  // namespace
}  // namespace raylanes
