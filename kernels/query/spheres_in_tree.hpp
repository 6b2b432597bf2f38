// One ray through a tree whose leaves are spheres, which are side by side in lanes; by the test perpendicular, so that
// hits are as those among all spheres in one array.
#pragma once

#include "../../dispatch/table/queries.hpp"
#include "../sphere/perpendicular.hpp"
#include "../traverse/walk_boxes.hpp"

namespace raylanes {
namespace {

// The nearest hit so far; the first one if any will do.
struct SphereSearch : NearestFirst {
  float tmax;
  Hit best = {};
  float box_tmax() const { return tmax; }
  void end_at(const Hit& hit) {
    best = hit;
    const float end = end_after(hit.t);
    tmax = end < tmax ? end : tmax;
  }
};

// Whether the nearer side of a sphere, seen from the begin of a segment, is that at which the line enters it. A skipped
// sphere lacks the nearer side.
template <class V>
inline auto enters_nearer(const SphereDistancesOf<V>& d, V tmin) {
  return abs(d.near - tmin) <= abs(d.far - tmin);
}

class SpheresOfRay {
  using V = Floats<node_lanes>;
  using Test = PerpendicularInLanes<Grade::reproducible, node_lanes>;

 public:
  SpheresOfRay(const SphereLeaves& spheres, const Ray& ray, const SphereQuery& asked)
      : spheres_(spheres), ray_(scaled(ray)), asked_(asked), tmin_(ray.tmin), tmax_(finite_tmax(ray.tmax)) {}

  bool visit(TreeReference leaf, SphereSearch& search) const { return visit(leaf_of(leaf), search); }
  bool visit(const LeafReference& range, SphereSearch& search) const {
    for (std::uint32_t k = 0; k < range.size; k += node_lanes)
      if (visit(range, k, search)) return true;
    return false;
  }
  [[gnu::noinline]] bool visit_unusual(TreeReference leaf, SphereSearch& search) const {
    return visit(leaf, search);
  }

 private:
  // A ray that is not valid hits nothing.
  static ScaledRayOf<V> scaled(const Ray& ray) {
    V o[3], d[3];
    Floats<1> direction[3];
    for (std::size_t axis = 0; axis < 3; ++axis)
      o[axis] = V(ray.origin[axis]), d[axis] = V(ray.direction[axis]), direction[axis] = ray.direction[axis];
    const DirectionScale<Floats<1>> s = scale_of(direction);
    const bool valid = is_valid(ray);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    return {o,
            d,
            V(valid ? ray.tmin : nan),
            V(valid ? ray.tmax : nan),
            {V(s.scale.raw), V(s.unit.raw), V(s.square.raw), V(s.inverse_square.raw)}};
  }

  // The spheres of a leaf from number k on.
  bool visit(LeafReference leaf, std::uint32_t k, SphereSearch& search) const {
    const float* const first = spheres_.numbers + std::size_t{4} * leaf.block + k;
    const V sphere[4] = {V::load(first), V::load(first + leaf.size), V::load(first + 2 * leaf.size),
                         V::load(first + 3 * leaf.size)};
    const std::uint32_t size = leaf.size - k, occupied = (2u << (size - 1)) - 1u;
    if ((bits(Test::hits(ray_, sphere)) & occupied) == 0) return false;
    const SphereDistancesOf<V> d = Test::distances(ray_, sphere);
    auto near = d.near >= V(tmin_), far = d.far >= V(tmin_);
    if (asked_.skipped != no_primitive || asked_.after != nullptr) [[unlikely]]
      admit(leaf.block + k, size, d, near, far);
    const std::uint32_t* const primitives = spheres_.primitives + leaf.block + k;
    if (asked_.rejects != nullptr) [[unlikely]]
      return ask(d, bits(d.hit & near & (d.near <= V(tmax_))) & occupied,
                 bits(d.hit & far & (d.far <= V(tmax_))) & occupied, primitives, search);
    const V t = select(near, d.near, d.far);
    const std::uint32_t hits =
        bits(d.hit & (near | far) & (t <= V(tmax_)) & (t <= V(search.best.t))) & occupied;
    if (hits == 0) return false;
    keep(t, hits, primitives, search);
    return asked_.any;
  }
  static void keep(V t, std::uint32_t hits, const std::uint32_t* primitives, SphereSearch& search) {
    float of_lane[node_lanes];
    t.store(of_lane);
    for (; hits != 0; hits &= hits - 1) {
      const int lane = std::countr_zero(hits);
      if (is_better(of_lane[lane], primitives[lane], search.best))
        search.end_at({of_lane[lane], 0, 0, primitives[lane]});
    }
  }
  // Asks about the hits of some lanes that would be the best so far. A ray that touches a sphere has one hit.
  [[gnu::noinline]] bool ask(const SphereDistancesOf<V>& d, std::uint32_t nears, std::uint32_t fars,
                             const std::uint32_t* primitives, SphereSearch& search) const {
    float t[2][node_lanes];
    d.near.store(t[0]), d.far.store(t[1]);
    fars &= ~(nears & bits(d.near == d.far));
    for (int lane = 0; lane < node_lanes; ++lane)
      for (int side = 0; side < 2; ++side) {
        if (((side == 0 ? nears : fars) >> lane & 1u) == 0) continue;
        const Hit hit{t[side][lane], 0, 0, primitives[lane]};
        if (!is_better(hit.t, hit.primitive, search.best) || asked_.rejects(asked_.function, hit)) continue;
        search.end_at(hit);
        if (asked_.any) return true;
        break;
      }
    return false;
  }
  // Leaves the sides that count.
  [[gnu::noinline]] void admit(std::uint32_t first, std::uint32_t size, const SphereDistancesOf<V>& d,
                               FloatMask<node_lanes>& near, FloatMask<node_lanes>& far) const {
    std::uint32_t skipped = 0, behind = 0;
    for (std::uint32_t i = 0; i < size && i < node_lanes; ++i) {
      const std::uint32_t primitive = spheres_.primitives[first + i];
      skipped |= std::uint32_t{primitive == asked_.skipped} << i;
      behind |= std::uint32_t{asked_.after != nullptr && primitive > asked_.after->primitive} << i;
    }
    const std::uint32_t skips_near = bits(enters_nearer(d, V(tmin_)));
    std::uint32_t nears = bits(near) & ~(skipped & skips_near), fars = bits(far) & ~(skipped & ~skips_near);
    if (asked_.after != nullptr) {
      const V last(asked_.after->t);
      nears &= bits(d.near > last) | (bits(d.near == last) & behind);
      fars &= bits(d.far > last) | (bits(d.far == last) & behind);
    }
    near = FloatMask<node_lanes>::from_bits(nears), far = FloatMask<node_lanes>::from_bits(fars);
  }

  const SphereLeaves& spheres_;
  const ScaledRayOf<V> ray_;
  const SphereQuery& asked_;
  const float tmin_, tmax_;
};

template <class Counters>
[[gnu::flatten]] Hit closest_sphere(const TreeView& tree, const SphereLeaves& spheres, const Ray& ray,
                                    const SphereQuery& asked) {
  SphereSearch search{{}, finite_tmax(asked.end)};
  Counters counters(asked);
  walk_boxes(tree, ray, tree.origin_share * largest_of(ray.origin), SpheresOfRay(spheres, ray, asked), search,
             counters);
  return search.best;
}

}  // namespace
}  // namespace raylanes
