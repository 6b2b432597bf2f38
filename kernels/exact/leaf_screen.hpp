// The float screen of the exact test where many rays meet the triangles of a leaf: Möller, Trumbore 1997 with bounds of
// its errors. Edges, normal and what the bounds take from them are computed once for all rays. docs/exact.md, part 6,
// derives the bounds.
//   s = v0 − o, c = s × d:  weights U = e2 · c, V = −e1 · c, W = det − U − V,  det = n · d,  t = n · s / det
#pragma once

#include <limits>

#include "../../dispatch/table/tree_view.hpp"
#include "../ray/ranges.hpp"
#include "../ray/triangle_test.hpp"
#include "../simd/vec3.hpp"
#include "sides.hpp"

namespace raylanes {
namespace {

// The lanes of a register of a leaf's numbers.
template <class T>
inline constexpr int leaf_lanes = native_lanes == 1 ? 1
                                  : native_lanes * 4 / static_cast<int>(sizeof(T)) < tree_width
                                      ? native_lanes * 4 / static_cast<int>(sizeof(T))
                                      : tree_width;

// At least the length of a direction.
template <class V>
inline V length_above(const Vec3<V>& d) {
  return multiply_add<Grade::fast>(sqrt(Arithmetic<Grade::fast>::dot(d, d)), V(1.0f + 0x1p-20f), V(0x1p-45f));
}

// T: float or double.
template <class T>
class LeafScreenOf : Arithmetic<Grade::fast> {
 public:
  // row(i): number i of the triangles. farthest: at least the distance along an axis from any origin to a corner.
  // Corners times `scale`, a power of two, and so are the rays that the screen is asked about: numbers that are not
  // small are not flushed.
  template <class Rows>
  LeafScreenOf(const Rows& row, int triangles, T farthest, T scale) {
    for (int first = 0; first < triangles; first += leaf_lanes<T>)
      prepare<leaf_lanes<T>>(row, first, farthest * scale, scale);
  }

  // length: length_above() of the directions. Without a branch: one in three registers has a ray that is hit, and
  // nothing foretells which.
  template <class V, class Range, class Sides = NoRule>
  Verdict<V, MaskOf<V>> classify(const RayLanes<V>& rays, V length, int triangle, const Range& range,
                                 Sides sides = {}) const {
    const auto number = [&](int k) { return V(number_[k][triangle]); };
    const auto vector = [&](int k) { return Vec3<V>(number(k), number(k + 1), number(k + 2)); };
    Vec3<V> s = vector(corner) - rays.origin, c = cross(s, rays.direction), n = vector(normal);
    V signed_det = dot(n, rays.direction), det = abs(signed_det);
    auto sign = sign_of(signed_det), of_weights = sides.of_weights(sign);
    V u = flip(dot(vector(edge), c), of_weights), v = flip(dot(vector(minus_edge), c), of_weights), sum = det;
    if constexpr (Sides::chooses) sum = flip(signed_det, of_weights);
    V w = (sum - u) - v;
    V least = min(min(u, v), w);  // in this order: NaN is in w
    V x = abs(s.x), y = abs(s.y), z = abs(s.z);
    V share = multiply_add<Grade::fast>((x + y) + z, number(weights_far), number(weights_near));
    V minus_bound = multiply_add<Grade::fast>(-length, share, V(-0x1p-120f));
    auto outside = least < minus_bound, inside = -least < minus_bound;
    V volume = flip(dot(n, s), sign),
      error = multiply_add<Grade::fast>(
          z, number(volume_far + 2),
          multiply_add<Grade::fast>(y, number(volume_far + 1),
                                    multiply_add<Grade::fast>(x, number(volume_far), number(volume_near))));
    if constexpr (Range::only_decides) {
      // Against the ends times det: the error has room for the roundings of sums and products.
      V low = volume - error, high = volume + error, begin = range.tmin * det, end = range.tmax * det;
      auto out = outside | (low > end) | (high < begin);
      auto certain = ~out & inside & (low > begin) & (high < end);
      return {certain, ~(out | certain), low, high, -signed_det};
    } else {
      V inverse = V(1.0f) / det, t = volume * inverse;
      V off = multiply_add<Grade::fast>(error, inverse, V(0x1p-120f));
      V t_lo = t - off, t_hi = t + off;
      auto out = outside | (t_lo > range.tmax) | (t_hi < range.tmin);
      auto certain = ~out & inside & (t_lo > range.tmin) & (t_hi < range.accept_below());
      return {certain, ~(out | certain), t_lo, t_hi, -signed_det};
    }
  }

 private:
  // Rows of number_. Errors of weights: length · (weights_far · |s| + weights_near); of the volume n · s less t · det:
  // volume_far · |s|, axis by axis, + volume_near.
  static constexpr int corner = 0, minus_edge = 3, edge = 6, normal = 9, weights_far = 12, weights_near = 13,
                       volume_far = 14, volume_near = 17, count = 18;
  // Half the distance from 1 to the next float; what the first products of a cross product lose without fused ones.
  static constexpr T unit = std::numeric_limits<T>::epsilon() / 2, far_factor = has_fma ? 2.05f : 3.05f;

  template <int N, class Rows>
  void prepare(const Rows& row, int first, T farthest, T scale) {
    using V = Lanes<T, N>;
    const auto vertex = [&](int k) {
      const auto load = [&](int i) { return V::load(row(i) + first) * V(scale); };
      return Vec3<V>(load(k), load(k + 1), load(k + 2));
    };
    const auto put = [&](int k, V x) { x.store(&number_[k][first]); };
    const auto put_vector = [&](int k, const Vec3<V>& v) { put(k, v.x), put(k + 1, v.y), put(k + 2, v.z); };
    Vec3<V> v0 = vertex(0), v1 = vertex(3), v2 = vertex(6);
    Vec3<V> e = v0 - v1, f = v2 - v0, third = v2 - v1, n = cross(f, e);
    V square = max(max(dot(e, e), dot(f, f)), dot(third, third)) * V(1.0f + 0x1p-20f);
    // If products could overflow, nothing is certain.
    auto is_safe = (square < V(0x1p80f)) & (square * V(farthest) < V(0x1p118f));
    V longest = select(is_safe, sqrt(square) + V(0x1p-60f), V(std::numeric_limits<T>::infinity()));
    put_vector(corner, v0), put_vector(minus_edge, e), put_vector(edge, f), put_vector(normal, n);
    put(weights_far, longest * V(far_factor * unit));
    put(weights_near, multiply_add<Grade::fast>(longest * longest, V(31.0f * unit), V(0x1p-110f)));
    const auto far = [](V size) { return multiply_add<Grade::fast>(size, V(10.3f * unit), V(0x1p-90f)); };
    put_vector(volume_far, {far(abs(n.x)), far(abs(n.y)), far(abs(n.z))});
    // The size of a point of the triangle, seen from v0, times the error of the normal, axis by axis.
    const auto near = [](V ex, V fx, V first_product, V second_product, V nx) {
      V of_normal = multiply_add<Grade::fast>(abs(first_product) + abs(second_product), V(4.3f * unit),
                                              abs(nx) * V(4.4f * unit));
      return max(abs(ex), abs(fx)) * of_normal;
    };
    V of_normal = (near(e.x, f.x, e.y * f.z, e.z * f.y, n.x) + near(e.y, f.y, e.z * f.x, e.x * f.z, n.y)) +
                  near(e.z, f.z, e.x * f.y, e.y * f.x, n.z);
    put(volume_near, multiply_add<Grade::fast>(longest, V(0x1p-80f), V(0x1p-120f)) + of_normal);
  }

  alignas(64) T number_[count][tree_width];
};

struct LeafScreen : LeafScreenOf<float> {
  // Out of line: much code for the few calls that there are.
  [[gnu::noinline]] LeafScreen(const LeafBlock<9>& block, int triangles, float farthest, float scale)
      : LeafScreenOf([&](int i) { return block.number[i]; }, triangles, farthest, scale) {}
};

}  // namespace
}  // namespace raylanes
