// The edge functions of a sheared triangle with a bound of their error, in floats or in doubles: what decides all but
// few lanes. docs/exact.md derives the bound; the tests prove its steps with Gappa.
#pragma once

#include <limits>

#include "../simd/vec3.hpp"

namespace raylanes {
namespace {

// The cost of the arithmetic of a type of number.
//   unit_roundoff    half the distance from 1 to the next number
//   min_error      more than flushed inputs, products and sums can add to an edge function
//   min_direction  a major component of at least this size is sheared by quotients right within their rounding
//   scale, max_t   of t alone: a divisor from 1/scale to scale, and quotients up to max_t, neither overflow nor vanish
// That of floats, of floats widened to doubles, and of any doubles.
template <class T>
struct Precision;
template <>
struct Precision<float> {
  static constexpr float unit_roundoff = 0x1p-24f, min_error = 0x1p-120f, min_direction = 0x1p-100f,
                         scale = 0x1p100f, max_t = 0x1p110f;
};
template <>
struct Precision<double> {
  static constexpr double unit_roundoff = 0x1p-53, min_error = 0x1p-180, min_direction = 0x1p-71;
};
struct PrecisionOfDoubles {
  static constexpr double unit_roundoff = 0x1p-53, min_error = 0x1p-500, min_direction = 0x1p-100,
                          scale = 0x1p900, max_t = 0x1p1000, max_reach = 0x1p200;
};
template <class V>
struct NumberOf;
template <class T, int N>
struct NumberOf<Lanes<T, N>> {
  using type = T;
};
template <class V>
using PrecisionOf = Precision<typename NumberOf<V>::type>;

// The largest of |a|, |b|, |c|.
template <class V>
inline V largest_magnitude(V a, V b, V c) {
  return max(max(abs(a), abs(b)), abs(c));
}

// −x/z and −y/z of a direction whose components are in the order of its axes. NaN, which leaves every lane undecided,
// where a flushed component would matter.
template <class V>
struct Shear {
  V x, y;
};
template <class P, class V>
inline Shear<V> shear_within(const Vec3<V>& direction) {
  auto is_large = abs(direction.z) >= V(P::min_direction);
  V z = select(is_large, -direction.z, V(std::numeric_limits<typename NumberOf<V>::type>::quiet_NaN()));
  return {direction.x / z, direction.y / z};
}
template <class V>
inline Shear<V> shear_of(const Vec3<V>& direction) {
  return shear_within<PrecisionOf<V>>(direction);
}

template <class V, class P = PrecisionOf<V>>
struct EdgeBounds {
  using T = typename NumberOf<V>::type;
  V u, v, w;         // scaled barycentrics of corners 0, 1, 2
  V least, largest;  // of these
  V bound;           // of their errors; infinite or NaN where they may have overflowed
  V size_z;          // at least the distance of each corner along the major axis

  // Corners relative to the origin, or mirrored in it. One fused operation for two rounds less where there is one.
  EdgeBounds(const Vec3<V>& a, const Vec3<V>& b, const Vec3<V>& c, const Shear<V>& shear) {
    V ax = sheared(a.x, shear.x, a.z), ay = sheared(a.y, shear.y, a.z);
    V bx = sheared(b.x, shear.x, b.z), by = sheared(b.y, shear.y, b.z);
    V cx = sheared(c.x, shear.x, c.z), cy = sheared(c.y, shear.y, c.z);
    u = edge(cx, by, cy, bx), v = edge(ax, cy, ay, cx), w = edge(bx, ay, by, ax);
    least = min(min(u, v), w), largest = max(max(u, v), w);
    size_z = largest_magnitude(a.z, b.z, c.z);
    V size_xy = max(largest_magnitude(ax, bx, cx), largest_magnitude(ay, by, cy));
    bound = bound_for(size_xy, size_z);
  }

  // A bound for all corners within `reach` of the origin along each axis, whose sheared coordinates are at most twice
  // that; see bound_for. Products that may overflow make it infinite.
  static V bound_within(V reach) {
    constexpr T unit = P::unit_roundoff;
    return multiply_add<Grade::fast>((reach + reach) * (reach + reach + reach), V(T{18.125} * unit),
                                     V(P::min_error));
  }

  // Weights that are zero, bit i that of corner i: exactly, and of no side. If all are, the lane is neither inside nor
  // outside.
  void drop(std::uint32_t zeros) {
    if (zeros == 0) return;
    V infinity(std::numeric_limits<T>::infinity());
    V* const weights[3] = {&u, &v, &w};
    least = infinity, largest = -infinity;
    for (int i = 0; i < 3; ++i)
      if ((zeros >> i & 1u) != 0)
        *weights[i] = V(T{0});
      else
        least = min(*weights[i], least), largest = max(*weights[i], largest);
    if (zeros == 7u) least = largest = V(T{0});
  }

  // NaN is neither. outside_by(): how far weights lie on both sides of zero.
  V outside_by() const { return min(largest, -least); }
  auto certainly_outside() const { return outside_by() > bound; }
  auto certainly_inside() const { return max(least, -largest) > bound; }

  // The determinant, and the volume, which is depth times the determinant. The plane is met at t = depth() / (det() ·
  // z), with z the major component of the direction. The error of det() is at most det_bound(). With a distance along z
  // as a factor, this bounds depth(), too, if the lane is inside.
  V det() const { return (u + v) + w; }
  V depth(V az, V bz, V cz) const {
    return multiply_add<Grade::fast>(w, cz, multiply_add<Grade::fast>(v, bz, u * az));
  }
  V det_bound() const {
    return multiply_add<Grade::fast>(abs(det()), V(16 * P::unit_roundoff), V(4) * bound);
  }

 private:
  static V sheared(V x, V shear, V z) { return multiply_add<Grade::fast>(shear, z, x); }
  static V edge(V px, V qy, V py, V qx) { return multiply_add<Grade::fast>(px, qy, -(py * qx)); }

  // 18u·(r + 16u·z)·(r + z): 12 r² + 17 r·z of it for coordinates that err by u·(2r + 4z), and three roundings of the
  // function itself.
  static V bound_for(V r, V z) {
    constexpr T unit = P::unit_roundoff;
    V reach = multiply_add<Grade::fast>(z, V(T{16} * unit), r);
    return multiply_add<Grade::fast>(reach * (r + z), V(T{18} * unit), V(P::min_error));
  }
};

// Two bounds of the t at which a lane's triangle is met, if it is: the depth there is a mean of the corners', so that
// errors of the weights move it by a share of the spread of these alone. NaN, of which nothing follows, where numbers
// are too large or too small for that.
template <class V, class P = PrecisionOf<V>>
struct DepthBounds {
  V t_lo, t_hi;

  // Corners mirrored in the origin: their depths are −a.z, −b.z, −c.z.
  template <class Edges>
  DepthBounds(const Edges& e, V az, V bz, V cz, V direction_z) {
    using T = typename NumberOf<V>::type;
    constexpr T unit = P::unit_roundoff, min_error = P::min_error;
    V det = e.det(), depth = -e.depth(az, bz, cz), scale = det * direction_z;
    V spread = max(max(az, bz), cz) - min(min(az, bz), cz);
    V of_weights = V(6.0f) * e.bound * multiply_add<Grade::fast>(e.size_z, V(64 * unit), spread);
    V of_roundings = multiply_add<Grade::fast>(e.size_z * V(24 * unit), abs(det), V(min_error));
    auto is_safe =
        (abs(scale) > V(1 / P::scale)) & (abs(scale) < V(P::scale)) & (abs(depth) < abs(scale) * V(P::max_t));
    V inverse = V(1.0f) / select(is_safe, scale, V(std::numeric_limits<T>::quiet_NaN()));
    V t = depth * inverse;
    V error = multiply_add<Grade::fast>(of_weights + of_roundings, abs(inverse), V(min_error));
    t_lo = t - error, t_hi = t + error;
  }
};

}  // namespace
}  // namespace raylanes
