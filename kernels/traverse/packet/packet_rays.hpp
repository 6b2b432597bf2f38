// The rays of a packet: hundreds with a common point and a common major axis (Overbeck, Ramamoorthi, Mark 2008; Wald,
// Boulos, Shirley 2007), or neighbours. And their nearest hits so far. All in scratch memory.
#pragma once

#include <cstddef>

#include "../../ray/ranges.hpp"
#include "../single.hpp"
#include "tiles.hpp"

namespace raylanes {
namespace {

// A lower bound of how far along z rays still go.
inline Floats<W> depth_of(Floats<W> t, Floats<W> size_z) {
  return t * size_z * Floats<W>(1.0f + 8 * 0x1p-24f);
}

// A row for each vector of rays, a lane a ray; t from the apex.
struct alignas(64) PacketRays {
  using V = Floats<W>;
  static constexpr float infinity = std::numeric_limits<float>::infinity();

  float direction[3][max_vectors][W];  // not of rays that are seen backwards
  float slope_x[max_vectors][W], slope_y[max_vectors][W];
  float size_z[max_vectors][W];                      // of the direction along z
  float tmin[max_vectors][W], tmax[max_vectors][W];  // tmax: to the best hit so far
  float t_error[max_vectors][W];                     // of these two
  const std::uint32_t* first_run[max_vectors];
  std::uint32_t skipped[max_vectors][W];                   // the primitives that rays skip, if some skip any
  std::uint32_t occupied[max_vectors];                     // the lanes that hold rays of the packet
  std::uint32_t active[max_vectors];                       // the lanes whose rays still look for hits
  float range_x[2][max_vectors], range_y[2][max_vectors];  // the least and the largest slopes
  float far[max_vectors];
  int vectors;
  RayRuns runs;

  std::size_t index(int row, int lane) const { return runs.index(first_run[row], lane); }
  V origin_along(int k, int, const PacketFrame& frame) const { return V(frame.apex[k]); }
  // skip: of the rays of the batch. Lanes without a ray get what a ray of the batch has, too.
  void set_skipped(int row, const std::uint32_t* skip) {
    for (int lane = 0; lane < W; ++lane) skipped[row][lane] = skip[index(row, lane)];
  }
  std::uint32_t rays_that_skip(int row, std::uint32_t primitive) const {
    return bits(equal_words(FloatBits<W>::load(skipped[row]), FloatBits<W>(primitive)));
  }
  // Adds a vector with a ray in one of `lanes` at least.
  template <SharedApex apex>
  int add(const std::uint32_t* first, std::uint32_t lanes, const RayColumns& rays,
          const RaysFromApex<apex>& from_apex) {
    const int row = vectors++;
    first_run[row] = first;
    occupied[row] = active[row] = lanes;
    if constexpr (apex != SharedApex::end)
      for (int axis = 0; axis < 3; ++axis) rays.direction[axis].store(direction[axis][row]);
    else
      from_apex.t_error.store(t_error[row]);
    from_apex.slope_x.store(slope_x[row]), from_apex.slope_y.store(slope_y[row]);
    from_apex.size_z.store(size_z[row]);
    from_apex.tmin.store(tmin[row]), from_apex.tmax.store(tmax[row]);
    if (lanes != first_lanes<W>(W)) [[unlikely]]
      drop(row, lanes);
    return row;
  }
  // Ranges and depths of all vectors: lane by lane, vectors side by side.
  [[gnu::noinline]] void bound_vectors() {
    for (int row = 0; row < vectors; row += W) {
      const int count = vectors - row;
      bound(slope_x + row, count, range_x[0] + row, range_x[1] + row);
      bound(slope_y + row, count, range_y[0] + row, range_y[1] + row);
      float depth[W][W], nearest[W];
      for (int i = 0; i < W && i < count; ++i)
        depth_of(V::load(tmax[row + i]), V::load(size_z[row + i])).store(depth[i]);
      bound(depth, count, nearest, far + row);
    }
    fill_up();
  }
  // After a hit.
  void refresh(int row) { set_far(row, depth_of(V::load(tmax[row]), V::load(size_z[row]))); }

  // The frusta of W vectors of rays, and the frusta that the rays of one vector are.
  Frustum<V> frusta(int row) const {
    return {V::load(range_x[0] + row), V::load(range_x[1] + row), V::load(range_y[0] + row),
            V::load(range_y[1] + row), V::load(far + row)};
  }
  Frustum<V> ray_frusta(int row) const {
    V x = V::load(slope_x[row]), y = V::load(slope_y[row]);
    return {x, x, y, y, depth_of(V::load(tmax[row]), V::load(size_z[row]))};
  }
  Frustum<float> frustum(int row) const {
    return {range_x[0][row], range_x[1][row], range_y[0][row], range_y[1][row], far[row]};
  }
  // Around all rays.
  Frustum<float> frustum() const {
    Frustum<V> all{V(infinity), V(-infinity), V(infinity), V(-infinity), V(-infinity)};
    for (int row = 0; row < vectors; row += W) {
      Frustum<V> some = frusta(row);
      auto is_vector = FloatMask<W>::from_bits(first_lanes<W>(static_cast<std::size_t>(vectors - row)));
      all.lo_x = select(is_vector, min(some.lo_x, all.lo_x), all.lo_x);
      all.hi_x = select(is_vector, max(some.hi_x, all.hi_x), all.hi_x);
      all.lo_y = select(is_vector, min(some.lo_y, all.lo_y), all.lo_y);
      all.hi_y = select(is_vector, max(some.hi_y, all.hi_y), all.hi_y);
      all.far = max(some.far, all.far);
    }
    return {min_lane(all.lo_x), largest_lane(all.hi_x), min_lane(all.lo_y), largest_lane(all.hi_y),
            largest_lane(all.far)};
  }
  float farthest() const {
    V all = V::load(far);
    for (int row = W; row < vectors; row += W) all = max(all, V::load(far + row));
    return largest_lane(all);
  }

 protected:
  // The rows behind, as ranges are loaded by whole vectors.
  void fill_up() {
    for (int row = vectors; row < max_vectors; ++row) {
      occupied[row] = active[row] = 0;
      for (int end = 0; end < 2; ++end) range_x[end][row] = range_y[end][row] = 0.0f;
      far[row] = -infinity;
    }
  }
  void set_far(int row, V depth) {
    far[row] = largest_lane(select(FloatMask<W>::from_bits(active[row]), depth, V(-infinity)));
  }

 private:
  // The other lanes are like a ray that ends before it begins.
  [[gnu::noinline]] void drop(int row, std::uint32_t lanes) {
    const int like = std::countr_zero(lanes);
    for (int lane = 0; lane < W; ++lane)
      if ((lanes >> lane & 1u) == 0) {
        slope_x[row][lane] = slope_x[row][like], slope_y[row][lane] = slope_y[row][like];
        size_z[row][lane] = size_z[row][like], tmax[row][lane] = -infinity;
      }
  }
  // The least and the largest lane of each of up to W rows.
  static void bound(const float (*values)[W], int count, float* lo, float* hi) {
    constexpr int columns = W < row_floats ? W : row_floats;
    V least, most;
    for (int at = 0; at < W; at += columns) {
      const void* places[W];
      for (int i = 0; i < W; ++i) places[i] = values[i < count ? i : 0] + at;
      V c[columns];
      load_rows(places, c);
      for (int k = 0; k < columns; ++k) {
        least = at + k == 0 ? c[k] : min(c[k], least);
        most = at + k == 0 ? c[k] : max(c[k], most);
      }
    }
    least.store(lo), most.store(hi);
  }
};

// The rays of a coherent packet share no point but pass by together. Two planes on either side bound them, from where
// the first ray begins to behind the tree. Intervals of origins and slopes are wider where rays come together.
struct alignas(64) CoherentRays : PacketRays {
  float origin[3][max_vectors][W];                   // in the order of the frame
  float at_x[max_vectors][W], at_y[max_vectors][W];  // where z is 0
  float start[max_vectors][W];                       // z where t is 0
  float at_range_x[2][max_vectors], at_range_y[2][max_vectors];
  float length;

  V origin_along(int k, int row, const PacketFrame&) const { return V::load(origin[k][row]); }
  int add(const std::uint32_t* first, std::uint32_t lanes, const RayColumns& rays,
          const RaysFromApex<SharedApex::none>& from_apex, const PacketFrame& frame) {
    const int row = PacketRays::add(first, lanes, rays, from_apex);
    length = frame.length;
    const auto from_point = [&](int k) {
      rays.origin[frame.axes.order[k]].store(origin[k][row]);
      return rays.origin[frame.axes.order[k]] - V(frame.apex[k]);
    };
    V z = from_point(2) * V(frame.sign);
    V x = from_point(0) - from_apex.slope_x * z, y = from_point(1) - from_apex.slope_y * z;
    x.store(at_x[row]), y.store(at_y[row]), z.store(start[row]);
    bound(row, x, from_apex.slope_x, at_range_x, range_x);
    bound(row, y, from_apex.slope_y, at_range_y, range_y);
    refresh(row);
    return row;
  }
  // Vectors are bounded as they come.
  void bound_vectors() {
    fill_up();
    for (int row = vectors; row < max_vectors; ++row)
      for (int end = 0; end < 2; ++end) at_range_x[end][row] = at_range_y[end][row] = 0.0f;
  }
  void refresh(int row) { set_far(row, depth(row)); }

  CoherentFrustum<V> frusta(int row) const {
    return {PacketRays::frusta(row), V::load(at_range_x[0] + row), V::load(at_range_x[1] + row),
            V::load(at_range_y[0] + row), V::load(at_range_y[1] + row)};
  }
  CoherentFrustum<V> ray_frusta(int row) const {
    V slopes_x = V::load(slope_x[row]), slopes_y = V::load(slope_y[row]);
    V x = V::load(at_x[row]), y = V::load(at_y[row]);
    return {{slopes_x, slopes_x, slopes_y, slopes_y, depth(row)}, x, x, y, y};
  }
  CoherentFrustum<float> frustum() const {
    CoherentFrustum<float> all{{0.0f, 0.0f, 0.0f, 0.0f, farthest()}, 0.0f, 0.0f, 0.0f, 0.0f};
    bound_all(at_range_x, range_x, all.at_lo_x, all.at_hi_x, all.lo_x, all.hi_x);
    bound_all(at_range_y, range_y, all.at_lo_y, all.at_hi_y, all.lo_y, all.hi_y);
    return all;
  }

 private:
  V depth(int row) const { return depth_of(V::load(tmax[row]), V::load(size_z[row])) + V::load(start[row]); }
  // From z = 0 to the length.
  void bound(int row, V x, V slope, float (&at)[2][max_vectors], float (&range)[2][max_vectors]) const {
    const auto is_ray = FloatMask<W>::from_bits(occupied[row]);
    const auto min_of = [&](V a) { return min_lane(select(is_ray, a, V(infinity))); };
    const auto max_of = [&](V a) { return largest_lane(select(is_ray, a, V(-infinity))); };
    const V end = x + slope * V(length);
    at[0][row] = min_of(x), at[1][row] = max_of(x);
    range[0][row] = (min_of(end) - at[0][row]) / length, range[1][row] = (max_of(end) - at[1][row]) / length;
  }
  void bound_all(const float (&at)[2][max_vectors], const float (&range)[2][max_vectors], float& at_lo,
                 float& at_hi, float& lo, float& hi) const {
    float end_lo = at_lo = infinity, end_hi = at_hi = -infinity;
    const auto include = [](float& least, float& most, float a, float b) {
      least = a < least ? a : least, most = b > most ? b : most;
    };
    for (int row = 0; row < vectors; ++row) {
      include(at_lo, at_hi, at[0][row], at[1][row]);
      include(end_lo, end_hi, at[0][row] + range[0][row] * length, at[1][row] + range[1][row] * length);
    }
    lo = (end_lo - at_lo) / length, hi = (end_hi - at_hi) / length;
  }
};
template <SharedApex apex>
using RaysOf = std::conditional_t<apex == SharedApex::none, CoherentRays, PacketRays>;

template <class Rays>
struct PacketScratch {
  TileOrder::Memory order;
  Rays rays;
};

// For a test that screens two bounds of t and a leaf triangle, as in Candidate; for other tests the numbers of the hit.
template <class Test, SharedApex apex, bool deferred = screens<Test>>
struct RaysAndHits : RaysOf<apex> {
  using V = Floats<W>;
  using RaysOf<apex>::tmax;
  float t_lo[max_vectors][W];
  std::uint32_t leaf_triangle[max_vectors][W];
  void clear_hits(int row) {
    V::load(tmax[row]).store(t_lo[row]);
    FloatBits<W>(no_leaf_triangle).store(leaf_triangle[row]);
  }
  RayState<V, false> state(int row) const {
    return {{{V::load(this->tmin[row]), V::load(tmax[row])}, V::load(t_lo[row])},
            as<float>(FloatBits<W>::load(leaf_triangle[row]))};
  }
  void keep_certain(int row, const Verdict<V>& verdict, std::uint32_t of) {
    auto kept = state(row);
    kept.keep(FloatMask<W>::from_bits(verdict.certain), verdict.t_lo, verdict.t_hi,
              as<float>(FloatBits<W>(of)));
    kept.t_lo.store(t_lo[row]), kept.tmax.store(tmax[row]);
    as<std::uint32_t>(kept.leaf_triangle).store(leaf_triangle[row]);
  }
  ClosestCandidate query(int row, int lane) const {
    return ClosestCandidate(Candidate(t_lo[row][lane], tmax[row][lane], leaf_triangle[row][lane]));
  }
  void keep(int row, int lane, const Candidate& best) {
    t_lo[row][lane] = best.t_lo, tmax[row][lane] = best.tmax, leaf_triangle[row][lane] = best.leaf_triangle;
  }
};

template <class Test, SharedApex apex>
struct RaysAndHits<Test, apex, false> : RaysOf<apex> {
  using V = Floats<W>;
  using RaysOf<apex>::tmax;
  float u[max_vectors][W], v[max_vectors][W];
  std::uint32_t primitive[max_vectors][W];
  std::uint32_t found[max_vectors];  // lanes with a hit

  void clear_hits(int row) {
    found[row] = 0;
    FloatBits<W>(no_primitive).store(primitive[row]);
  }
  template <class TestHit>
  void keep_nearer(int row, const TestHit& h, std::uint32_t lanes, std::uint32_t of) {
    found[row] |= lanes;
    const V t = h.t(), end = V::load(tmax[row]);
    FloatMask<W> wins = h.hit & (t < end);
    if (const std::uint32_t tied = bits(h.hit & (t == end)); tied != 0) [[unlikely]]
      wins = wins | FloatMask<W>::from_bits(of_larger_primitives(row, tied, of));
    select(wins, t, end).store(tmax[row]);
    select(wins, h.u(), V::load(u[row])).store(u[row]), select(wins, h.v(), V::load(v[row])).store(v[row]);
    V now = as<float>(FloatBits<W>(of)), old = as<float>(FloatBits<W>::load(primitive[row]));
    as<std::uint32_t>(select(wins, now, old)).store(primitive[row]);
  }
  Closest query(int row, int lane) const {
    if ((found[row] >> lane & 1u) == 0) return Closest(tmax[row][lane], Hit());
    return Closest(tmax[row][lane], {tmax[row][lane], u[row][lane], v[row][lane], primitive[row][lane]});
  }
  void keep(int row, int lane, const Closest& query) {
    if (!query.best) return;
    found[row] |= 1u << lane;
    tmax[row][lane] = query.best.t, u[row][lane] = query.best.u, v[row][lane] = query.best.v;
    primitive[row][lane] = query.best.primitive;
  }

 private:
  // For lanes that hit at one t. Rare, hence lane by lane.
  std::uint32_t of_larger_primitives(int row, std::uint32_t lanes, std::uint32_t of) const {
    std::uint32_t larger = 0;
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      const Hit kept{tmax[row][lane], 0.0f, 0.0f, primitive[row][lane]};
      if (is_better(kept.t, of, kept)) larger |= 1u << lane;
    }
    return larger;
  }
};

// Rays as a test takes them: from what a packet keeps of them,
template <class Test, SharedApex apex>
inline PreparedRays<Test, Floats<W>> prepared_rays(const RaysAndHits<Test, apex>& rays, int row,
                                                   const PacketFrame& frame, float reach) {
  using V = Floats<W>;
  V x = V::load(rays.slope_x[row]), y = V::load(rays.slope_y[row]), z = V::load(rays.size_z[row]);
  const auto origin = [&](int k) { return rays.origin_along(k, row, frame); };
  const auto direction = [&](int axis) { return V::load(rays.direction[axis][row]); };
  if constexpr (screens<Test>) {
    return {frame.axes, Test::of_slopes(Vec3<V>(origin(0), origin(1), origin(2)), x, y, z, V(frame.sign),
                                        frame.axes, V(reach))};
  } else if constexpr (Test::by_major_axis) {
    return {frame.axes,
            Test::of_slopes(Vec3<V>(origin(0), origin(1), origin(2)), x, y, z, V(frame.sign), frame.axes)};
  } else {
    int at[3];  // of an axis in the frame
    for (int k = 0; k < 3; ++k) at[frame.axes.order[k]] = k;
    return {StoredAxes(), Test::prepare(Vec3<V>(origin(at[0]), origin(at[1]), origin(at[2])),
                                        Vec3<V>(direction(0), direction(1), direction(2)), StoredAxes())};
  }
}
// and from the user's, if a packet sees them backwards: then z of the frame is mirrored.
template <class Test>
inline PreparedRays<Test, Floats<W>> prepared_rays(const RayColumns& rays, const PacketFrame& frame,
                                                   const Box& bounds) {
  Float3 major{0.0f, 0.0f, 0.0f};
  major[frame.axes.order[2]] = -frame.sign;
  const AxesOfRay<Test> axes(major);
  const auto in_order = [&](const Floats<W>(&xyz)[3]) {
    return Vec3<Floats<W>>(xyz[axes.order[0]], xyz[axes.order[1]], xyz[axes.order[2]]);
  };
  return {axes,
          prepare_in_tree<Test>(in_order(rays.origin), in_order(rays.direction), axes, rays.reach(bounds))};
}

}  // namespace
}  // namespace raylanes
