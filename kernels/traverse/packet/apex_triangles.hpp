// Triangles as they look from the apex of a packet. By the planes through the apex and their edges frusta drop them and
// rays decide most hits: in floats, or in doubles for rays of doubles. And the numbers of hits, which neighbours share
// much of. docs/exact.md, parts 4 and 5, derives the bounds.
#pragma once

#include <array>
#include <type_traits>

#include "../../exact/exact_numbers.hpp"
#include "../../exact/leaf_screen.hpp"
#include "../../exact/triangle_from_origin.hpp"
#include "packet_rays.hpp"

namespace raylanes {
namespace {

// Three planes through the apex and an edge each, turned so that rays that hit are on the positive side of all, or less
// than the bound off. Twice the edge functions of slopes, by normals that are small where triangles are:
// (b + c) × (c − b).
template <class T>
struct PlaneNumbers {
  T normal[12][tree_width];  // of the planes, and the area as a vector
  T minus_bound[tree_width];
  T near[tree_width];  // no corner is before this

  template <class V>
  V at(int edge, int triangle, V x, V y) const {
    V z = multiply_add<Grade::fast>(V(normal[edge + 1][triangle]), y, V(normal[edge + 2][triangle]));
    return multiply_add<Grade::fast>(V(normal[edge][triangle]), x, z);
  }
};

// The triangles of a leaf. T: of the corners, and of the rays that are tested; frusta always test in floats.
template <class Test, class T = float>
class alignas(64) EdgePlanes : PlaneNumbers<float> {
  static constexpr bool narrows = !std::is_same_v<T, float>;
  static constexpr int lanes = leaf_lanes<T>;
  using V = Lanes<T, lanes>;

 public:
  // Triangles whose t follows from their planes, with no numbers of unusual size where they are hit.
  std::uint32_t plain = 0;
  // Triangles whose normals point away from the apex, if they are plain.
  std::uint32_t away = 0;

  // number(k, i): lanes of number k of the triangles' corners, from i on. apex: in the order of the frame.
  template <class Number>
  EdgePlanes(const PacketFrame& frame, const std::array<T, 3>& apex, int triangles, Number number) {
    for (int i = 0; i < triangles; i += lanes) set(frame, apex, number, i);
    if constexpr (narrows)
      for (int i = 0; i < triangles; i += node_lanes)
        narrow(i, triangles - i > node_lanes / 2 ? node_lanes / 2 : 0);
  }
  EdgePlanes(const LeafBlock<Test::floats>& block, const PacketFrame& frame) requires(!narrows)
      : EdgePlanes(frame, frame.apex, tree_width,
                   [&](int k, int i) { return V::load(block.number[k] + i); }) {}

  // The triangles that may meet the rays.
  std::uint32_t met_by(const Frustum<float>& rays) const {
    using F = Floats<node_lanes>;
    std::uint32_t met = 0;
    for (int i = 0; i < tree_width; i += node_lanes) {
      F bound = F::load(minus_bound + i);
      auto inside = F::load(near + i) <= F(rays.far);
      for (int edge = 0; edge < 9; edge += 3) {
        F x = F::load(normal[edge] + i), y = F::load(normal[edge + 1] + i);
        F most = max(x * F(rays.lo_x), x * F(rays.hi_x)) +
                 (max(y * F(rays.lo_y), y * F(rays.hi_y)) + F::load(normal[edge + 2] + i));
        inside = inside & (most >= bound);
      }
      met |= bits(inside) << i;
    }
    return met & in_front_;
  }
  // The vectors of rays that may meet one. The end of their slopes that is farthest out is looked up: a branch for each
  // plane would be predicted wrongly half the time.
  std::uint32_t vectors_met(int triangle, const PacketRays& rays) const {
    using F = Floats<W>;
    const float *x[3], *y[3];
    for (int edge = 0; edge < 3; ++edge) {
      x[edge] = rays.range_x[normal[3 * edge][triangle] >= 0.0f];
      y[edge] = rays.range_y[normal[3 * edge + 1][triangle] >= 0.0f];
    }
    F bound(minus_bound[triangle]), first(near[triangle]);
    std::uint32_t met = 0;
    for (int row = 0; row < rays.vectors; row += W) {
      auto inside = first <= F::load(rays.far + row);
      for (int edge = 0; edge < 3; ++edge)
        inside = inside & (at(3 * edge, triangle, F::load(x[edge] + row), F::load(y[edge] + row)) >= bound);
      met |= bits(inside) << row;
    }
    return met;
  }

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
  Verdict<R, MaskOf<R>> decide(int triangle, R side, R slope_x, R slope_y, R size_z, const Range& range,
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
  static constexpr bool adds_roundings = !screens<Test> && !may_take_planes<Test>;
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
    // The volume that apex and triangle span has the sign of what weights of hits add up to. If a triangle's plane is
    // too near to the apex for that, nothing is known.
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
    away |= bits(spanned > V(0.0f)) << i;
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
    in_front_ |= bits(max(max(a.z, b.z), c.z) + pad >= V(0.0f)) << i;
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
  std::uint32_t in_front_ = 0;  // triangles with a corner that is not behind the apex
  [[no_unique_address]] std::conditional_t<narrows, PlaneNumbers<T>, Nothing> wide_;
  T volume_[tree_width];
  T min_volume_[tree_width], largest_volume_[tree_width];  // with room for what t may be off
};

// The hits of a vector of rays, misses at first, with the bits of primitives.
struct ColumnsOfHits {
  Floats<W> t{std::numeric_limits<float>::infinity()}, u{0.0f}, v{0.0f};
  Floats<W> primitive = as<float>(FloatBits<W>(no_primitive));

  void set(std::uint32_t lanes, Floats<W> new_t, Floats<W> new_u, Floats<W> new_v, Floats<W> new_primitive) {
    const auto taken = FloatMask<W>::from_bits(lanes);
    t = select(taken, new_t, t), u = select(taken, new_u, u), v = select(taken, new_v, v);
    primitive = select(taken, new_primitive, primitive);
  }
};

// For a test that screens: the numbers of the hits of a vector of rays. Returns the lanes whose numbers are not clear;
// zeros and their neighbours never are.
template <class Test>
inline std::uint32_t round_hits(const RaysAndHits<Test, SharedApex::origin>& rays, int row,
                                TrianglesFromOrigin& triangles, ColumnsOfHits& hits) {
  using V = Floats<W>;
  const Vec3<V> direction(V::load(rays.direction[0][row]), V::load(rays.direction[1][row]),
                          V::load(rays.direction[2][row]));
  const V size = V::load(rays.size_z[row]);
  const auto leaf_triangles = FloatBits<W>::load(rays.leaf_triangle[row]);
  const auto lanes_of = [&](std::uint32_t leaf_triangle) {
    return bits(equal_words(leaf_triangles, FloatBits<W>(leaf_triangle)));
  };
  std::uint32_t pending = rays.occupied[row] & ~lanes_of(no_leaf_triangle), undecided = 0;
  while (pending != 0) {
    const std::uint32_t leaf_triangle = rays.leaf_triangle[row][std::countr_zero(pending)];
    const std::uint32_t lanes = pending & lanes_of(leaf_triangle);
    pending &= ~lanes;
    const TriangleFromOrigin& triangle = triangles[leaf_triangle];
    const RoundedNumbers<W> numbers(numbers_from_origin<0>(triangle, direction, size),
                                    numbers_from_origin<1>(triangle, direction, size));
    const V least = min(min(numbers.t.low, numbers.u.low), numbers.v.low);
    hits.set(lanes, numbers.t.value, numbers.u.value, numbers.v.value,
             as<float>(FloatBits<W>(triangle.primitive)));
    undecided |= lanes & ~bits(numbers.are_clear() & (least >= V(0x1p-100f)));
  }
  return undecided;
}

// Stores the hits of a vector of rays, each as a row, into the batch.
template <int N = W>
inline void store_hits(Hit* all, const PacketRays& rays, int row, const ColumnsOfHits& hits) {
  const Floats<N> columns[] = {hits.t, hits.u, hits.v, hits.primitive};
  if constexpr (N >= 4)
    if (rays.runs.of_four && rays.occupied[row] == first_lanes<N>(N)) [[likely]] {
      void* places[N / 4];
      for (int k = 0; k < N / 4; ++k) places[k] = all + rays.first_run[row][k];
      return store_strips(places, columns);
    }
  Hit of_no_ray;
  void* places[N];
  for (int lane = 0; lane < N; ++lane)
    places[lane] = (rays.occupied[row] >> lane & 1u) != 0 ? all + rays.index(row, lane) : &of_no_ray;
  store_rows(places, columns);
}
// Stores which rays are occluded: those that no longer are active.
inline void store_decisions(std::uint8_t* all, const PacketRays& rays, int row) {
  const std::uint32_t hit = ~rays.active[row];
  if (W >= 4 && rays.runs.of_four && rays.occupied[row] == first_lanes<W>(W)) {
    for (int k = 0; k < W / 4; ++k) {
      // A byte each of four bits.
      std::uint32_t bytes = 0;
      for (int lane = 0; lane < W; ++lane)
        if (strip_of_lane<W>(lane) == k) bytes |= (hit >> lane & 1u) << 8 * row_in_strip<W>(lane);
      __builtin_memcpy(all + rays.first_run[row][k], &bytes, sizeof bytes);
    }
    return;
  }
  for (std::uint32_t lanes = rays.occupied[row]; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    all[rays.index(row, lane)] = static_cast<std::uint8_t>(hit >> lane & 1u);
  }
}
static_assert(sizeof(Hit) == 4 * sizeof(float) && offsetof(Hit, t) == 0 &&
              offsetof(Hit, primitive) == 3 * sizeof(float));

}  // namespace
}  // namespace raylanes
