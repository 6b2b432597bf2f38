// Ray–triangle tests, one text each for 1 ray × N triangles and N rays × 1 triangle: whatever is single is
// broadcast. Every acceptance is a comparison that NaN fails; division comes after the decision.
#pragma once

#include "../simd/vocabulary.hpp"

namespace raylanes {
namespace {

template <int N>
struct TriangleHit {
  FloatMask<N> hit;
  Floats<N> t, u, v;  // defined where hit
};

template <int N>
using Corner = Floats<N>[3];  // x, y, z of one corner

// The axes of the canonical shear: z is the axis of the largest |direction| (the lowest of equals), x and y
// follow, swapped for a negative direction so that the winding is kept.
struct ShearAxes {
  int x, y, z;
};

inline ShearAxes shear_axes(const Float3& direction) {
  const auto magnitude = [&](int axis) {
    return direction[axis] < 0.0f ? -direction[axis] : direction[axis];
  };
  int z = magnitude(1) > magnitude(0) ? 1 : 0;
  if (magnitude(2) > magnitude(z)) z = 2;
  const int next = (z + 1) % 3, last = (z + 2) % 3;
  return direction[z] < 0.0f ? ShearAxes{last, next, z} : ShearAxes{next, last, z};
}

// The tests look from a corner back to the origin, that is at everything mirrored in a point: no sign that is
// compared changes and no rounding does, and "origin − corner" takes a corner straight from memory, where
// "corner − origin" would first need it in a register.

// A ray in the order of its shear axes, with the shear that maps it to the z axis; scale_z mirrors back.
template <int N>
struct ShearedRay {
  Floats<N> origin[3];
  Floats<N> shear_x, shear_y, scale_z;
};

// direction is in shear order.
template <int N>
inline ShearedRay<N> shear_ray(const Floats<N> (&origin)[3], const Floats<N> (&direction)[3]) {
  return {{origin[0], origin[1], origin[2]},
          direction[0] / direction[2],
          direction[1] / direction[2],
          Floats<N>(-1.0f) / direction[2]};
}

// A corner against the ray, x and y mirrored: a function of corner and ray alone, so that all triangles that
// share it agree.
template <int N>
struct ShearedCorner {
  Floats<N> x, y, z;
};

// `way` leads from the corner to the origin, in shear order.
template <Grade grade, int N>
inline ShearedCorner<N> shear_corner(const ShearedRay<N>& ray, const Floats<N> (&way)[3]) {
  return {multiply_add<grade>(-ray.shear_x, way[2], way[0]),
          multiply_add<grade>(-ray.shear_y, way[2], way[1]), ray.scale_z * way[2]};
}

template <int N>
inline void way_to_origin(const Floats<N> (&origin)[3], const Corner<N>& corner, Floats<N> (&way)[3]) {
  for (int axis = 0; axis < 3; ++axis) way[axis] = origin[axis] - corner[axis];
}

template <int N>
struct EdgeFunctions {
  Floats<N> u, v, w;  // scaled barycentric weights of corners 0, 1, 2
};

template <Grade grade, int N>
inline EdgeFunctions<N> edge_functions(const ShearedCorner<N>& a, const ShearedCorner<N>& b,
                                       const ShearedCorner<N>& c) {
  return {difference_of_products<grade>(c.x, b.y, c.y, b.x),
          difference_of_products<grade>(a.x, c.y, a.y, c.x),
          difference_of_products<grade>(b.x, a.y, b.y, a.x)};
}

// The least and the largest edge function. A NaN among three may get lost here; it makes their sum NaN.
template <int N>
struct EdgeRange {
  Floats<N> least, largest;
  explicit EdgeRange(const EdgeFunctions<N>& e)
      : least(min(min(e.u, e.v), e.w)), largest(max(max(e.u, e.v), e.w)) {}
  FloatMask<N> same_sign() const { return (least >= Floats<N>(0.0f)) | (largest <= Floats<N>(0.0f)); }
  FloatMask<N> same_strict_sign() const { return (least > Floats<N>(0.0f)) | (largest < Floats<N>(0.0f)); }
};

// The edge functions of the lanes in `undecided` again, in double, where the products are exact and so is
// the sign of the difference. Rare, hence out of line and lane by lane.
template <int N>
[[gnu::noinline]] void decide_in_double(EdgeFunctions<N>& e, const ShearedCorner<N>& a,
                                        const ShearedCorner<N>& b, const ShearedCorner<N>& c,
                                        std::uint32_t undecided) {
  float ax[N], ay[N], bx[N], by[N], cx[N], cy[N], u[N], v[N], w[N];
  a.x.store(ax), a.y.store(ay), b.x.store(bx), b.y.store(by), c.x.store(cx), c.y.store(cy);
  e.u.store(u), e.v.store(v), e.w.store(w);
  const auto cross = [](float px, float qy, float py, float qx) {
    return static_cast<float>(static_cast<double>(px) * qy - static_cast<double>(py) * qx);
  };
  for (int i = 0; i < N; ++i) {
    if ((undecided >> i & 1u) == 0) continue;
    u[i] = cross(cx[i], by[i], cy[i], bx[i]);
    v[i] = cross(ax[i], cy[i], ay[i], cx[i]);
    w[i] = cross(bx[i], ay[i], by[i], ax[i]);
  }
  e = {Floats<N>::load(u), Floats<N>::load(v), Floats<N>::load(w)};
}

// Whether a zero edge function says that the ray meets the edge exactly. Kahan's determinant says so; the
// plain one may have cancelled to zero, and must be decided again.
template <Grade grade>
inline constexpr bool zero_is_exact = grade == Grade::fast&& has_fma;

// What a test knows before it divides: t, u, v times det.
template <int N>
struct ScaledTriangleHit {
  FloatMask<N> inside;  // of the triangle; the segment is not looked at yet
  Floats<N> det, scaled_t, scaled_u, scaled_v;

  // To compare; may be −0. NaN where det is zero and so is scaled_t.
  Floats<N> compared_t() const { return scaled_t / det; }
  // Adding +0 turns −0 into +0: the sign of a zero must not depend on the winding.
  Floats<N> t() const { return compared_t() + Floats<N>(0.0f); }
  Floats<N> u() const { return scaled_u / det + Floats<N>(0.0f); }
  Floats<N> v() const { return scaled_v / det + Floats<N>(0.0f); }
};

template <int N>
inline TriangleHit<N> divide(const ScaledTriangleHit<N>& h, Floats<N> tmin, Floats<N> tmax) {
  const Floats<N> t = h.t();
  return {h.inside & (t >= tmin) & (t <= tmax), t, h.u(), h.v()};
}

// Watertight (Woop, Benthin, Wald 2013), corners in shear order. Where det is 0 with all edge functions of
// one sign they are all 0, and so is scaled_t: t is NaN, which no segment holds.
template <Grade grade, int N>
inline ScaledTriangleHit<N> scaled_watertight_of_ways(const ShearedRay<N>& ray,
                                                      const Floats<N> (&way)[3][3]) {
  const ShearedCorner<N> a = shear_corner<grade, N>(ray, way[0]);
  const ShearedCorner<N> b = shear_corner<grade, N>(ray, way[1]);
  const ShearedCorner<N> c = shear_corner<grade, N>(ray, way[2]);
  EdgeFunctions<N> e = edge_functions<grade, N>(a, b, c);
  const EdgeRange<N> range(e);
  FloatMask<N> inside = range.same_sign();
  if constexpr (!zero_is_exact<grade>) {
    const FloatMask<N> undecided = inside & ~range.same_strict_sign();
    if (any(undecided)) [[unlikely]] {
      decide_in_double<N>(e, a, b, c, bits(undecided));
      inside = EdgeRange<N>(e).same_sign();
    }
  }
  const Floats<N> scaled_t = multiply_add<grade>(e.w, c.z, multiply_add<grade>(e.u, a.z, e.v * b.z));
  return {inside, (e.u + e.v) + e.w, scaled_t, e.v, e.w};
}

template <Grade grade, int N>
inline ScaledTriangleHit<N> scaled_watertight(const ShearedRay<N>& ray, const Corner<N> (&corner)[3]) {
  Floats<N> way[3][3];
  for (int k = 0; k < 3; ++k) way_to_origin<N>(ray.origin, corner[k], way[k]);
  return scaled_watertight_of_ways<grade, N>(ray, way);
}

template <Grade grade, int N>
inline TriangleHit<N> watertight(const ShearedRay<N>& ray, const Corner<N> (&corner)[3], Floats<N> tmin,
                                 Floats<N> tmax) {
  return divide<N>(scaled_watertight<grade, N>(ray, corner), tmin, tmax);
}

template <int N>
inline void negate(const Floats<N> (&a)[3], Floats<N> (&out)[3]) {
  for (int axis = 0; axis < 3; ++axis) out[axis] = -a[axis];
}

template <Grade grade, int N>
inline Floats<N> dot(const Floats<N> (&a)[3], const Floats<N> (&b)[3]) {
  return multiply_add<grade>(a[2], b[2], multiply_add<grade>(a[1], b[1], a[0] * b[0]));
}

template <Grade grade, int N>
inline void cross(const Floats<N> (&a)[3], const Floats<N> (&b)[3], Floats<N> (&out)[3]) {
  out[0] = multiply_add<grade>(a[1], b[2], -(a[2] * b[1]));
  out[1] = multiply_add<grade>(a[2], b[0], -(a[0] * b[2]));
  out[2] = multiply_add<grade>(a[0], b[1], -(a[1] * b[0]));
}

// The sign bit of x, to be moved to other numbers with `flip`.
template <int N>
inline FloatBits<N> sign_of(Floats<N> x) {
  return as<std::uint32_t>(x) & FloatBits<N>(0x80000000u);
}
template <int N>
inline Floats<N> flip(Floats<N> x, FloatBits<N> sign) {
  return as<float>(as<std::uint32_t>(x) ^ sign);
}

// Möller, Trumbore 1997, from the way from a corner to the origin and the two edges at that corner; the same
// bits if all four vectors are negated. Signs are moved to the numerators so that one text serves both
// windings; u + v <= 1 is decided on scaled values, where a rounded quotient would lose exact edge hits.
template <Grade grade, int N>
inline ScaledTriangleHit<N> scaled_moller_trumbore(const Floats<N> (&from_corner)[3],
                                                   const Floats<N> (&direction)[3],
                                                   const Floats<N> (&edge1)[3], const Floats<N> (&edge2)[3]) {
  const Floats<N> zero(0.0f);
  Floats<N> p[3], q[3];
  cross<grade, N>(direction, edge2, p);
  cross<grade, N>(from_corner, edge1, q);
  const Floats<N> signed_det = dot<grade, N>(edge1, p);
  const FloatBits<N> sign = sign_of<N>(signed_det);
  const Floats<N> det = abs(signed_det);
  const Floats<N> u = flip<N>(dot<grade, N>(from_corner, p), sign);
  const Floats<N> v = flip<N>(dot<grade, N>(direction, q), sign);
  const Floats<N> t = flip<N>(dot<grade, N>(edge2, q), sign);
  // A NaN that min drops is in u + v.
  return {(det > zero) & (min(u, v) >= zero) & (u + v <= det), det, t, u, v};
}

// From three corners; `backward` is minus the direction.
template <Grade grade, int N>
inline ScaledTriangleHit<N> scaled_moller_trumbore(const Floats<N> (&origin)[3],
                                                   const Floats<N> (&backward)[3],
                                                   const Corner<N> (&corner)[3]) {
  Floats<N> to_corner[3], edge1[3], edge2[3];
  for (int axis = 0; axis < 3; ++axis) {
    to_corner[axis] = corner[0][axis] - origin[axis];
    edge1[axis] = corner[0][axis] - corner[1][axis];
    edge2[axis] = corner[0][axis] - corner[2][axis];
  }
  return scaled_moller_trumbore<grade, N>(to_corner, backward, edge1, edge2);
}

template <Grade grade, int N>
inline TriangleHit<N> moller_trumbore(const Floats<N> (&origin)[3], const Floats<N> (&backward)[3],
                                      const Corner<N> (&corner)[3], Floats<N> tmin, Floats<N> tmax) {
  return divide<N>(scaled_moller_trumbore<grade, N>(origin, backward, corner), tmin, tmax);
}

}  // namespace
}  // namespace raylanes
