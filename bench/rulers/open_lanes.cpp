// The kernels' own text with one lane, and counters.
#define RAYLANES_BACKEND_SCALAR
#include "open_lanes.hpp"

#include "../../dispatch/table.hpp"
#include "../../kernels/traverse/single.hpp"
#include "../../kernels/triangle/exact.hpp"
#include "kernel_view.hpp"

namespace raylanes::bench {
namespace {

OpenLanes counted;

struct CountedExact : Exact<Grade::reproducible> {
  template <bool in_tree, class Ray, class Load, class Segment>
  static auto settle(const Ray& ray, Load load, std::uint32_t occupied, Segment segment) {
    const auto to_origin = [&](int k) {
      return ray.origin - Vec3<Floats<1>>(load(k), load(k + 1), load(k + 2));
    };
    const EdgeBounds<Floats<1>> edges(to_origin(0), to_origin(3), to_origin(6), {ray.shear_x, ray.shear_y});
    ++counted.tests;
    if (!any(edges.surely_outside() | edges.surely_inside())) {
      ++counted.after_floats;
      LanesApart<1> lane;
      store(ray.origin, lane.origin), store(ray.ordered_direction, lane.direction);
      for (int k = 0; k < floats; ++k) load(k).store(lane.corner[k]);
      const InDoubles<0, 1> wide(lane);
      if (!any(wide.outside | wide.inside)) ++counted.after_doubles;
    }
    return Exact<Grade::reproducible>::settle<in_tree>(ray, load, occupied, segment);
  }

 private:
  static void store(const Vec3<Floats<1>>& xyz, float (*to)[1]) {
    xyz.x.store(to[0]), xyz.y.store(to[1]), xyz.z.store(to[2]);
  }
};

}  // namespace

OpenLanes OpenLaneCounter::count(std::span<const Ray> rays) const {
  counted = {};
  NoCounters none{TraceBatch{}};
  const TreeView tree = kernel_view(tree_);
  for (const Ray& ray : rays) trace_ray<WalksNodes, CountedExact, ClosestSlot>(tree, ray, none);
  return counted;
}

void add_open_lane(const Ray& ray, const Triangle& triangle, OpenLanes& lanes) {
  const SharedAxes axes(ray.direction);
  const auto number = [&](int k) {
    const int at = axes.index(k);
    return Floats<1>(triangle.corner[at / 3][at % 3]);
  };
  counted = lanes;
  CountedExact::settle<false>(CountedExact::prepare(broadcast<Floats<1>>(ray.origin, axes),
                                                    broadcast<Floats<1>>(ray.direction, axes), axes),
                              number, 1u, [&] {
                                return Segment<Floats<1>>{Floats<1>(ray.tmin), Floats<1>(ray.tmax)};
                              });
  lanes = counted;
}

}  // namespace raylanes::bench
