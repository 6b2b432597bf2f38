#include "table/points.hpp"

#include <raylanes/points.hpp>

#include "quiet_floats.hpp"
#include "selected_row.hpp"
#include "table/kernel_table.hpp"

namespace raylanes {
namespace {

float* where(const char* what, std::span<float> out, std::size_t n) {
  if (out.empty()) return nullptr;
  require_size("distances", what, out.size(), "the triangles", n);
  return out.data();
}

}  // namespace

ClosestPoint closest_point(const Float3& point, const TriangleArrays& triangles,
                           const PointOptions& options) {
  const PointKernels& kernels = kernels_of(checked_path(options.path)).points;
  require_nameable("closest_point", triangles.size, "triangles");
  ClosestPoint closest;
  const QuietFloats quiet;
  kernels.closest_of_triangles(point, CornerArrays(triangles).array, triangles.size, options.active,
                               max_squared(options.max_distance), closest);
  return closest;
}

void distances(const Float3& point, const TriangleArrays& triangles, const PointDistances& out,
               const PointOptions& options) {
  const PointKernels& kernels = kernels_of(checked_path(options.path)).points;
  require_size("distances", "distance_squared", out.distance_squared.size(), "the triangles", triangles.size);
  float* const to[6] = {out.distance_squared.data(),
                        where("x", out.point[0], triangles.size),
                        where("y", out.point[1], triangles.size),
                        where("z", out.point[2], triangles.size),
                        where("u", out.u, triangles.size),
                        where("v", out.v, triangles.size)};
  const QuietFloats quiet;
  kernels.distances(point, CornerArrays(triangles).array, triangles.size, options.active, to);
}

}  // namespace raylanes
