// Points against triangles of one path, in arrays and in trees: compiled once per path with its flags and back end; the
// table is the only symbol that leaves the object.
#include "../simd/slices.hpp"
#include "closest_in_tree.hpp"

namespace raylanes {
namespace {

using F = Floats<W>;

// In floats: each triangle for itself.
[[gnu::flatten]] void distances(const Float3& point, Soa corners, std::size_t n, LaneBits active,
                                float* const (&out)[6]) {
  Vec3<F> p{F(point[0]), F(point[1]), F(point[2])};
  F infinity(std::numeric_limits<float>::infinity()), nan(std::numeric_limits<float>::quiet_NaN());
  for_each_slice(0, n, active, [&](const auto& slice) {
    F number[9];
    for (int k = 0; k < 9; ++k) number[k] = slice.load(corners[k]);
    Vec3<F> v0 = vec3(number), v1 = vec3(number + 3), v2 = vec3(number + 6);
    TriangleEdges<F> edges = PointTriangle<F, Grade::reproducible>::set_up(v0, v1, v2);
    PointOnTriangle<F> h = PointTriangle<F, Grade::reproducible>::closest(p, edges);
    Vec3<F> at = PointTriangle<F, Grade::reproducible>::at(h, v0, v1, v2);
    auto is_number = (edges.edges_squared < infinity) & (h.distance_squared < infinity);
    F result[6] = {h.distance_squared, at.x, at.y, at.z, h.u, h.v},
      otherwise[6] = {infinity, nan, nan, nan, F(0.0f), F(0.0f)};
    for (int k = 0; k < 6; ++k)
      if (out[k] != nullptr) slice.store(select(is_number, result[k], otherwise[k]), out[k]);
  });
}

struct ArrayCorners {
  Soa corners;
  float number(int k, std::uint32_t triangle) const { return corners[k][triangle]; }
  static std::uint32_t primitive(std::uint32_t triangle) { return triangle; }
};

// In doubles, as in trees.
[[gnu::flatten]] void closest_of_triangles(const Float3& point, Soa corners, std::size_t n, LaneBits active,
                                           double max_squared, ClosestPoint& closest) {
  closest = ClosestPoint();
  if (!is_finite(point)) return;
  auto p = doubles_of<half_of<W>>(point);
  const ArrayCorners triangles{corners};
  NearestTriangle<float> nearest(max_squared);
  for_each_slice(0, n, active, [&](const auto& slice) {
    F number[9];
    for (int k = 0; k < 9; ++k) number[k] = slice.load(corners[k]);
    std::uint32_t index[W];
    for (std::uint32_t lane = 0; lane < W; ++lane) index[lane] = static_cast<std::uint32_t>(slice.i) + lane;
    keep_nearest(nearest, p, number, slice.taken() & all_lanes, index, triangles);
  });
  closest = nearest.answer(triangles);
}

constexpr PointKernels all_kernels() {
  PointKernels kernels{distances, closest_of_triangles, closest_of_point<FloatPoints>,
                       closest_of_points<FloatPoints, NoCounters>, nullptr};
  if constexpr (RAYLANES_COUNTERS) kernels.counted = closest_of_points<FloatPoints, CountTests>;
  return kernels;
}

}  // namespace

RAYLANES_UNIT_TABLE(PointKernels, points, all_kernels())
}  // namespace raylanes
