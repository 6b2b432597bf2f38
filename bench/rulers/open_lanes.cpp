// The kernels' own text with one lane, and counters.
#define RAYLANES_BACKEND_SCALAR
#include "open_lanes.hpp"

#include <vector>

#include "../../accel/build/builders.hpp"
#include "../../accel/layout/wide_tree.hpp"
#include "../../dispatch/table.hpp"
#include "../../kernels/traverse/single.hpp"
#include "../../kernels/triangle/exact.hpp"

namespace raylanes::bench {
namespace {

OpenLanes counted;

struct CountedExact : Exact<Grade::reproducible> {
  template <class Ray, class Load, class Segment>
  static Settled<1> settle(const Ray& ray, Load load, std::uint32_t occupied, Segment segment) {
    using V = Floats<1>;
    V c[floats];
    for (int k = 0; k < floats; ++k) c[k] = load(k);
    const auto to_origin = [&](const V* corner) { return ray.origin - vec3(corner); };
    const EdgeBounds<V> edges(to_origin(c), to_origin(c + 3), to_origin(c + 6), {ray.shear_x, ray.shear_y});
    ++counted.tests;
    if (!any(edges.surely_outside() | edges.surely_inside())) {
      ++counted.after_floats;
      const InDoubles<0, 1> wide({ray.origin, ray.ordered_direction}, c);
      if (!any(wide.outside | wide.inside)) ++counted.after_doubles;
    }
    return Exact<Grade::reproducible>::settle(ray, load, occupied, segment);
  }
};

}  // namespace

OpenLanes count_open_lanes(const Mesh& mesh, std::span<const Ray> rays) {
  std::vector<Box> boxes;
  for (const Index3& triangle : mesh.triangles) boxes.push_back(triangle_box(mesh.vertices, triangle));
  const WideTree tree = collapse_to_wide(build_binned_sah(boxes), {mesh.vertices, mesh.triangles});
  counted = {};
  NoCounters none;
  for (const Ray& ray : rays) trace_ray<CountedExact, Closest>(tree.view(TriangleTest::exact), ray, none);
  return counted;
}

}  // namespace raylanes::bench
