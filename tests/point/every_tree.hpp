// Closest points of floats and doubles by every tree: by all builders, on every path, in batches and alone.
#pragma once

#include <raylanes/numbers.hpp>
#include <raylanes/raylanes.hpp>

#include "../doubles/double_point_cases.hpp"
#include "../support/soa.hpp"
#include "../support/supported_paths.hpp"
#include "point_tree_cases.hpp"

namespace raylanes::testing {

// By brute force on the first path.
inline std::vector<ClosestPoint> one_by_one(const Mesh& mesh, std::span<const Float3> points,
                                            double most = infinite) {
  const std::vector<Triangle> triangles = triangles_of(mesh);
  const TriangleColumns columns(triangles);
  std::vector<ClosestPoint> closest;
  for (const Float3& point : points)
    closest.push_back(closest_point(point, columns.arrays(),
                                    {.max_distance = static_cast<float>(most), .path = &paths().front()}));
  return closest;
}

template <class T, class Tree>
void expect_of_tree(const Tree& tree, std::span<const PointOf<T>> points,
                    const std::vector<ClosestPointOf<T>>& expected, const std::string& name, T most) {
  std::vector<ClosestPointOf<T>> found(points.size());
  const auto expect_alone = [&](const std::string& on, const auto& closest) {
    for (std::size_t i = 0; i < points.size(); ++i) found[i] = closest(points[i]);
    expect_same(found, expected, name + on + ", alone");
  };
  for (const Path* path : paths_with_own_queries()) {
    const std::string on = std::string(" on ") + path->name;
    for (const int threads : {1, 2}) {
      tree.closest_points(points, found, {.max_distance = most, .path = path, .threads = threads});
      expect_same(found, expected, name + on);
    }
    expect_alone(on, [&](const auto& point) {
      return tree.closest_point(point, {.max_distance = most, .path = path});
    });
    force_path(path->name);
    expect_alone(on, [&](const auto& point) { return tree.closest_point(point, {.max_distance = most}); });
    if (most == std::numeric_limits<T>::infinity())
      expect_alone(on, [&](const auto& point) { return tree.closest_point(point); });
    unforce_path();
  }
}

template <class AnyMesh, class Point, class T = typename Point::value_type>
void expect_everywhere(const AnyMesh& mesh, const std::vector<Point>& points,
                       const std::vector<ClosestPointOf<T>>& expected, const std::string& name,
                       double max_distance = infinite) {
  using Tree = std::conditional_t<std::is_same_v<T, float>, Bvh, BvhD>;
  const auto most = static_cast<T>(max_distance);
  for (std::size_t i = 0; i < tree_builder_names.size(); ++i) {
    const BuildOptions options{.builder = static_cast<TreeBuilder>(i), .optimize = i % 2 == 0};
    if (std::is_same_v<T, double> && options.builder == TreeBuilder::spatial_splits) continue;
    expect_of_tree<T>(Tree(mesh.vertices, mesh.triangles, options), points, expected,
                      name + ", " + std::string(tree_builder_names[i]), most);
    if (::testing::Test::HasFatalFailure()) return;
  }
  if constexpr (std::is_same_v<T, float>)
    for (std::size_t i = 0; i < kd_builder_names.size(); ++i)
      expect_of_tree<T>(KdTree(mesh, {.builder = static_cast<KdBuilder>(i)}), points, expected,
                        name + ", k-d " + std::string(kd_builder_names[i]), most);
}

}  // namespace raylanes::testing
