// The triangles of a leaf by the planes through their edges and the point that the rays of a packet share: in floats,
// or in doubles for rays of doubles, where frusta still ask in floats. Never wrong where they say that nothing is met:
// see docs/exact.md, part 5.
#pragma once

#include <array>
#include <type_traits>

#include "../../exact/exact_numbers.hpp"
#include "../../exact/leaf_filter.hpp"
#include "culls.hpp"

namespace raylanes {
namespace {

// T: of the corners, and of the rays that are tested.
template <class Test, class T = float>
class alignas(64) EdgePlanes : public Cones {
  static constexpr bool narrows = !std::is_same_v<T, float>;
  static constexpr int lanes = leaf_lanes<T>;
  using V = Lanes<T, lanes>;

 public:
  // Triangles whose t follows from their planes, with no numbers of unusual size where they are hit.
  std::uint32_t plain = 0;

  // number(k, i): lanes of number k of the triangles' corners, from i on. apex: in the order of the frame.
  template <class Number>
  EdgePlanes(const PacketFrame& frame, const std::array<T, 3>& apex, int triangles, Number number) {
    in_front = 0;
    for (int i = 0; i < triangles; i += lanes) set(frame, apex, number, i);
    if constexpr (narrows)
      for (int i = 0; i < triangles; i += node_lanes)
        narrow(i, triangles - i > node_lanes / 2 ? node_lanes / 2 : 0);
  }
  EdgePlanes(const LeafBlock<Test::floats>& block, const PacketFrame& frame) requires(!narrows)
      : EdgePlanes(frame, frame.apex, tree_width,
                   [&](int k, int i) { return V::load(block.number[k] + i); }) {}

  // The least of the planes' sides that rays are on, and what it is not below where a triangle may be hit.
  template <class R>
  R side(int triangle, R slope_x, R slope_y) const {
    const auto& planes = numbers_of(*this);
    return min(min(planes.at(0, triangle, slope_x, slope_y), planes.at(3, triangle, slope_x, slope_y)),
               planes.at(6, triangle, slope_x, slope_y));
  }
  T bound(int triangle) const { return numbers_of(*this).minus_bound[triangle]; }
  // Rays on that side of a plain triangle: which hit it certainly, and which are neither that nor hit it beside their
  // segments. Hits count certainly within `surely`, which is what a segment is at least.
  template <class R, class Range>
  FilterResult<R, MaskOf<R>> decide(int triangle, R side, R slope_x, R slope_y, R size_z, const Range& range,
                                    const Range& surely) const {
    R along = scale(triangle, slope_x, slope_y, size_z);
    R least(min_volume_[triangle]), largest(largest_volume_[triangle]);
    auto inside = side > -R(bound(triangle));
    MaskOf<R> beside, certain;
    if constexpr (Range::only_decides) {
      // For ends times the scale: without a division.
      beside = (least > range.tmax * along) | (largest < range.tmin * along);
      certain = (least > surely.tmin * along) & (largest < surely.tmax * along);
    } else {
      R inverse = fast_reciprocal(along);
      least = least * inverse, largest = largest * inverse;
      beside = (least > range.tmax) | (largest < range.tmin);
      certain = (least > surely.tmin) & (largest < surely.accept_below());
    }
    return {inside & certain, ~(inside & (certain | beside)), least, largest};
  }
  // A hit of a plain triangle by the planes alone, within a segment.
  template <class R, class Range>
  DividedHit<R> hit(int triangle, R slope_x, R slope_y, R size_z, const Range& range) const {
    const auto& planes = numbers_of(*this);
    R a = planes.at(0, triangle, slope_x, slope_y), b = planes.at(3, triangle, slope_x, slope_y),
      c = planes.at(6, triangle, slope_x, slope_y);
    R inverse = fast_reciprocal(scale(triangle, slope_x, slope_y, size_z));
    R share = inverse * (R(0.5f) * size_z), t = R(volume_[triangle]) * inverse;
    return {(min(min(a, b), c) >= R(0.0f)) & (t >= range.tmin) & (t <= range.tmax), t, b * share, c * share};
  }

 private:
  // Bounds in units of roundings; a test whose numbers are rounded adds its own.
  static constexpr bool adds_roundings = !is_filtered<Test> && !may_take_planes<Test>;
  static constexpr T unit = std::numeric_limits<T>::epsilon() / 2;
  static constexpr T spanned_units = 12, edge_units = adds_roundings ? 164 : 100, area_units = 160,
                     own_spanned_units = 64;

  // The planes of those who are tested.
  template <class Self>
  static auto& numbers_of(Self& self) {
    if constexpr (narrows)
      return self.wide_;
    else
      return self;
  }
  // The volume divided by t; for a plain triangle, where it is hit, of usual size.
  template <class R>
  R scale(int triangle, R slope_x, R slope_y, R size_z) const {
    return numbers_of(*this).at(9, triangle, slope_x, slope_y) * size_z;
  }
  // NaN for zero, if it is estimated.
  template <class R>
  static R fast_reciprocal(R a) {
    if constexpr (narrows) {
      return R(1.0) / a;
    } else {
      R inverse = reciprocal_estimate(a);
      return inverse * (R(2.0f) - a * inverse);
    }
  }

  template <class Number>
  void set(const PacketFrame& frame, const std::array<T, 3>& apex, Number number_of, int i) {
    using A = Arithmetic<Grade::fast>;
    const auto corner = [&](int k) {
      const auto number = [&](int axis) { return number_of(frame.axes.index(k + axis), i); };
      return Vec3<V>(number(0), number(1), number(2));
    };
    const auto mirrored = [&](const Vec3<V>& p) { return Vec3<V>(p.x, p.y, p.z * V(frame.sign)); };
    Vec3<V> va = corner(0), vb = corner(3), vc = corner(6);
    const Vec3<V> origin{V(apex[0]), V(apex[1]), V(apex[2])};
    Vec3<V> a = mirrored(va - origin), b = mirrored(vb - origin), c = mirrored(vc - origin);
    Vec3<V> ab = mirrored(vb - va), bc = mirrored(vc - vb), ca = mirrored(va - vc);
    Vec3<V> farthest(largest_magnitude(a.x, b.x, c.x), largest_magnitude(a.y, b.y, c.y),
                     largest_magnitude(a.z, b.z, c.z));
    V reach = size(farthest);
    V extent = max(max(size(ab), size(bc)), size(ca)) + V(0x1p-100f);
    // The volume that origin and triangle span has the sign of what weights of hits add up to. If a triangle's plane is
    // too near to the origin for that, nothing is known.
    Vec3<V> area = A::cross(ca, ab), products = products_of(ca, ab);
    V spanned = A::dot(a, area);
    V area_size = extent * extent, edge_size = reach * extent;
    V spanned_bound = A::dot(farthest, products) * V(spanned_units * unit) +
                      (edge_size * (extent * V(0x1p-8f) + V(1.0f)) + reach + V(1.0f)) * V(0x1p-117f) +
                      (products.x + products.y) * V(1.25f * frame.apex_offset);
    V bound = edge_size * V(edge_units * unit) + V(0x1p-120f) + extent * V(9 * frame.apex_offset);
    if constexpr (adds_roundings) {
      spanned_bound = spanned_bound + reach * area_size * V(own_spanned_units * unit);
      bound = bound + area_size * V(area_units * unit);
    }
    // Segments that go beyond the end meet what is there from the other side.
    V size_of_volume = abs(spanned), infinite(std::numeric_limits<T>::infinity());
    const auto is_ahead =
        size_of_volume > spanned_bound + (products.x + products.y + products.z) * V(1.25f * frame.past);
    auto& planes = numbers_of(*this);
    select(is_ahead, -bound, -infinite).store(planes.minus_bound + i);
    const auto sign = sign_of(spanned);
    V share = (spanned_bound + spanned_bound) / size_of_volume + V(16 * unit);
    size_of_volume.store(volume_ + i);
    (size_of_volume * (V(1.0f) - share)).store(min_volume_ + i);
    (size_of_volume * (V(1.0f) + share)).store(largest_volume_ + i);
    plain |= bits(is_ahead & (share < V(0x1p-6f)) & (size_of_volume >= V(frame.padding * 0x1p-49f)) &
                  (size(area) <= V(0x1p60f)))
             << i;
    const auto store_vector = [&](int edge, const Vec3<V>& n) {
      flip(n.x, sign).store(planes.normal[edge] + i), flip(n.y, sign).store(planes.normal[edge + 1] + i);
      flip(n.z, sign).store(planes.normal[edge + 2] + i);
    };
    store_vector(0, A::cross(b + c, bc)), store_vector(3, A::cross(c + a, ca));
    store_vector(6, A::cross(a + b, ab)), store_vector(9, area);
    V pad(frame.padding);
    (min(min(a.z, b.z), c.z) - pad).store(planes.near + i);
    in_front |= bits(max(max(a.z, b.z), c.z) + pad >= V(0.0f)) << i;
  }
  // For frusta, with room for slopes that are rounded to floats: three roundings, and four of the sums. second: where
  // the second half of lanes is, if they have triangles.
  void narrow(int i, int second) {
    const auto narrowed = [&](const T* numbers) {
      return floats_of<node_lanes>(
          [&](int half) { return HalfInDoubles<0, node_lanes>::load(numbers + i + half); }, second);
    };
    using F = Floats<node_lanes>;
    F largest(0.0f);
    for (int edge = 0; edge < 9; edge += 3) {
      F sum(0.0f);
      for (int k = edge; k < edge + 3; ++k) {
        F number = narrowed(wide_.normal[k]);
        number.store(normal[k] + i);
        sum = sum + abs(number);
      }
      largest = max(sum, largest);
    }
    (narrowed(wide_.minus_bound) * F(1.001f) - largest * F(16 * 0x1p-24f) - F(0x1p-110f))
        .store(minus_bound + i);
    narrowed(wide_.near).store(near + i);
  }
  // For each component of the cross product: the sum of the sizes of its two terms.
  template <class V>
  static Vec3<V> products_of(const Vec3<V>& p, const Vec3<V>& q) {
    V px = abs(p.x), py = abs(p.y), pz = abs(p.z), qx = abs(q.x), qy = abs(q.y), qz = abs(q.z);
    return {py * qz + pz * qy, pz * qx + px * qz, px * qy + py * qx};
  }
  template <class V>
  static V size(const Vec3<V>& p) {
    return largest_magnitude(p.x, p.y, p.z);
  }

  struct Nothing {};
  struct Wide : PlaneNumbers<T> {
    T near[tree_width];
  };
  [[no_unique_address]] std::conditional_t<narrows, Wide, Nothing> wide_;
  T volume_[tree_width];
  T min_volume_[tree_width], largest_volume_[tree_width];  // with room for what t may be off
};

}  // namespace
}  // namespace raylanes
