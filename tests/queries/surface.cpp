// The corners of triangles that hits name, and normals and positions made of them.
#include <raylanes/doubles.hpp>
#include <raylanes/surface.hpp>

#include "../support/same_bytes.hpp"
#include "query_trees.hpp"

namespace raylanes::testing {
namespace {

// A soup with triangles that have no leaf: the first, one within, and the last.
Mesh soup_with_gaps() {
  Mesh mesh = triangle_soup(200, 0.5f, 851);
  for (const std::size_t i : {std::size_t{0}, std::size_t{77}, mesh.triangles.size() - 1})
    mesh.triangles[i][1] = mesh.triangles[i][0];
  return mesh;
}
bool is_gap(const Index3& triangle) {
  return triangle[0] == triangle[1];
}
template <class AnyTriangle>
bool is_nan(const AnyTriangle& triangle) {
  for (const auto& corner : triangle.corner)
    for (const auto x : corner)
      if (!std::isnan(x)) return false;
  return true;
}

// Each triangle by its index, in any order, and indices of none.
template <class AnyTriangle, class Tree, class Vertices>
void expect_corners(const Tree& tree, const Vertices& vertices, const std::vector<Index3>& triangles) {
  const auto n = static_cast<std::uint32_t>(triangles.size());
  std::vector<std::uint32_t> asked;
  for (std::uint32_t i = 0; i < n; ++i) asked.push_back(i * 7 % n), asked.push_back(i);
  for (const std::uint32_t none : {n, n + 9, no_primitive}) asked.push_back(none);
  std::vector<AnyTriangle> found(asked.size());
  tree.corners(asked, found);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    if (asked[k] >= n || is_gap(triangles[asked[k]])) {
      EXPECT_TRUE(is_nan(found[k])) << asked[k];
      continue;
    }
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(found[k].corner[i], vertices[triangles[asked[k]][i]]);
  }
  EXPECT_THROW(tree.corners(asked, std::span(found).first(3)), std::invalid_argument);
  EXPECT_THROW(tree.corners(PrimitiveView(nullptr, 3), std::span(found).first(3)), std::invalid_argument);
  tree.corners(std::vector<std::uint32_t>(), std::span<AnyTriangle>());
}

TEST(Surface, corners_are_those_of_the_mesh) {
  const Mesh mesh = soup_with_gaps();
  std::vector<Double3> vertices;
  for (const Float3& v : mesh.vertices)
    vertices.push_back({double{v[0]} + 1e-12, double{v[1]} - 1e-12, double{v[2]}});
  expect_corners<Triangle>(Bvh(mesh), mesh.vertices, mesh.triangles);
  expect_corners<Triangle>(Bvh(mesh, {.builder = TreeBuilder::spatial_splits}), mesh.vertices,
                           mesh.triangles);
  expect_corners<Triangle>(KdTree(mesh), mesh.vertices, mesh.triangles);
  expect_corners<TriangleD>(BvhD(vertices, mesh.triangles), vertices, mesh.triangles);
  Triangle none;
  Bvh().corners(0u, std::span(&none, 1));
  EXPECT_TRUE(is_nan(none));
  TriangleD none_of_doubles;
  BvhD().corners(0u, std::span(&none_of_doubles, 1));
  EXPECT_TRUE(is_nan(none_of_doubles));
}

TEST(Surface, corners_follow_a_refit_and_take_records) {
  Mesh mesh = cube(-1, 1);
  Bvh bvh(mesh);
  for (Float3& vertex : mesh.vertices) vertex[0] += 3;
  bvh.refit(mesh.vertices, mesh.triangles);
  const Ray ray = make_ray({3.25f, 0.5f, 5}, {0, 0, -2});
  const Hit hit = bvh.closest(ray);
  Triangle triangle;
  bvh.corners(hit, std::span(&triangle, 1));
  EXPECT_EQ(triangle.corner[2], mesh.vertices[mesh.triangles[hit.primitive][2]]);
  EXPECT_EQ(unit_normal(triangle), (Float3{0, 0, 1}));
  EXPECT_EQ(position(ray, hit.t), (Float3{3.25f, 0.5f, 1}));
}

// Against the same in long doubles: each component within two roundings.
TEST(Surface, normals_are_across_both_edges) {
  Random random(852);
  for (int i = 0; i < 300; ++i) {
    Triangle triangle;
    TriangleD doubled;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corner[k] = random.point(100);
      for (std::size_t axis = 0; axis < 3; ++axis)
        doubled.corner[k][axis] = static_cast<double>(triangle.corner[k][axis]);
    }
    const Float3 normal = unit_normal(triangle);
    const Double3 exact = unit_normal(doubled);
    for (std::size_t edge = 1; edge < 3; ++edge) {
      long double across = 0, length = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const long double way = doubled.corner[edge][k] - doubled.corner[0][k];
        across += way * exact[k], length += way * way;
      }
      EXPECT_LE(std::abs(across), 1e-11L * std::sqrt(length));
    }
    long double one = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      one += static_cast<long double>(exact[k]) * exact[k];
      EXPECT_EQ(normal[k], static_cast<float>(exact[k]));
    }
    EXPECT_NEAR(static_cast<double>(one), 1, 1e-15);
  }
  const Triangle flat{{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}};
  EXPECT_TRUE(std::isnan(unit_normal(flat)[0]));
}

// The normal of the moved corners, turned to where the solid is outside.
TEST(Surface, normals_in_scenes_point_out_of_solids) {
  Random random(853);
  for (int i = 0; i < 200; ++i) {
    Transform transform;
    for (float(&row)[4] : transform.row)
      for (float& x : row) x = random.number(-2, 2);
    Triangle triangle, moved;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corner[k] = random.point(1);
      for (std::size_t j = 0; j < 3; ++j) {
        moved.corner[k][j] = transform.row[j][3];
        for (std::size_t axis = 0; axis < 3; ++axis)
          moved.corner[k][j] += transform.row[j][axis] * triangle.corner[k][axis];
      }
    }
    const Float3 expected = unit_normal(moved), found = normal_in_scene(transform, unit_normal(triangle));
    const float(&r)[3][4] = transform.row;
    const float determinant = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) -
                              r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0]) +
                              r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
    if (std::abs(determinant) < 0.1f) continue;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(found[k], determinant < 0 ? -expected[k] : expected[k], 2e-3f) << i;
  }
  EXPECT_TRUE(std::isnan(normal_in_scene({{{1, 0, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}}}, {0, 0, 1})[0]));
}

}  // namespace
}  // namespace raylanes::testing
