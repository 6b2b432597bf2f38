// The kernels' own text with one lane, and counters.
#define RAYLANES_BACKEND_SCALAR
#include "undecided_lanes.hpp"

#include <raylanes/bvh.hpp>

#include "../../../dispatch/table/traversal.hpp"
#include "../../../dispatch/table/tree_view.hpp"
#include "../../../kernels/exact/exact_test.hpp"
#include "../../../kernels/traverse/single.hpp"

namespace raylanes::bench {
namespace {

// A tree as kernels see it, for tests that read corners. Valid as long as bvh.view() is.
TreeView kernel_view(const Bvh& bvh) {
  const BvhView view = bvh.view();
  return {view.nodes.data(), view.leaves.data(), view.root, view.bounds};
}

UndecidedLanes counted;

struct CountedExact : Exact<Grade::reproducible> {
  template <bool in_tree, class Ray, class Load, class Segment>
  static auto classify(const Ray& ray, Load load, std::uint32_t occupied, Segment segment,
                       NoRule sides = {}) {
    const auto filtered = Exact<Grade::reproducible>::classify<in_tree>(ray, load, occupied, segment, sides);
    ++counted.tests;
    if (filtered.undecided != 0) {
      ++counted.after_floats;
      RayTrianglePairs<1> lane;
      store(ray.origin, lane.origin), store(ray.ordered_direction, lane.direction);
      for (int k = 0; k < floats; ++k) load(k).store(lane.corner[k]);
      const auto range = segment();
      range.tmin.store(lane.tmin), range.tmax.store(lane.tmax);
      RoundedHits<1> hits;
      if (decide_exactly(lane, 1u, hits) != 0) ++counted.after_doubles;
    }
    return filtered;
  }

 private:
  static void store(const Vec3<Floats<1>>& xyz, float (*to)[1]) {
    xyz.x.store(to[0]), xyz.y.store(to[1]), xyz.z.store(to[2]);
  }
};

}  // namespace

UndecidedLanes UndecidedLaneCounter::count(std::span<const Ray> rays) const {
  counted = {};
  NoCounters none{TraceBatch{}};
  const TreeView tree = kernel_view(tree_);
  for (const Ray& ray : rays) trace_ray<WalksNodes, CountedExact, ClosestCandidate>(tree, ray, none);
  return counted;
}

void add_undecided_lane(const Ray& ray, const Triangle& triangle, UndecidedLanes& lanes) {
  const SharedAxes axes(ray.direction);
  const auto number = [&](int k) {
    const int at = axes.index(k);
    return Floats<1>(triangle.corner[at / 3][at % 3]);
  };
  counted = lanes;
  CountedExact::classify<false>(CountedExact::prepare(broadcast<Floats<1>>(ray.origin, axes),
                                                      broadcast<Floats<1>>(ray.direction, axes), axes),
                                number, 1u, [&] {
                                  return Segment<Floats<1>>{Floats<1>(ray.tmin), Floats<1>(ray.tmax)};
                                });
  lanes = counted;
}

}  // namespace raylanes::bench
