// Sums of solid angles: on triangles, in their planes, and near their edges.
#include "../../bench/support/oracles/winding_sum.hpp"

#include "../../bench/support/oracles/exact_rays.hpp"
#include "../queries/open_meshes.hpp"
#include "../queries/query_trees.hpp"

namespace raylanes::testing {
namespace {

const Mesh flat{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
const Mesh tilted{{{0, 0, 0}, {4, 0, 4}, {0, 4, 4}}, {{0, 1, 2}}};  // z = x + y
const Mesh line{{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {3, 3, 3}}, {{0, 1, 2}}};

oracle::WindingSum sum_of(const Mesh& mesh, const Float3& point) {
  return oracle::winding_sum(mesh.vertices, mesh.triangles, point);
}

TEST(Placed, tells_faces_from_edges_and_planes) {
  const auto triangle = oracle::corners_of(tilted, 0);
  const auto touch = [&](const Float3& point) { return oracle::placed(triangle, point).touch; };
  EXPECT_EQ(touch({1, 1, 2}), oracle::Touch::face);
  EXPECT_EQ(touch({2, 2, 4}), oracle::Touch::edge);
  EXPECT_EQ(touch({4, 0, 4}), oracle::Touch::edge);
  EXPECT_EQ(touch({3, 3, 6}), oracle::Touch::none);
  EXPECT_EQ(oracle::placed(oracle::corners_of(flat, 0), Float3{3, 3, 0}).touch, oracle::Touch::none)
      << "in the box";
  EXPECT_EQ(touch({1, 1, 2.5f}), oracle::Touch::none);
  EXPECT_EQ(oracle::placed(triangle, Float3{3, 3, 6}).side, 0);
  EXPECT_EQ(oracle::placed(triangle, Float3{1, 1, 3}).side, -oracle::placed(triangle, Float3{1, 1, 1}).side);
}

TEST(WindingSum, is_0_in_the_plane_of_one_triangle) {
  for (const Float3& point : {Float3{1, 1, 0}, Float3{0.1f, 0.3f, 0}, Float3{3, 3, 0}, Float3{-1, 0, 0},
                              Float3{5, 0, 0}, Float3{1e9f, 1e-9f, 0}})
    for (const bool is_flat : {true, false}) {
      const Float3 at{point[0], point[1], is_flat ? 0 : point[0] + point[1]};
      if (static_cast<double>(at[2]) != (is_flat ? 0 : double(at[0]) + double(at[1]))) continue;
      const oracle::WindingSum sum = sum_of(is_flat ? flat : tilted, at);
      EXPECT_TRUE(sum.is_judge()) << at[0] << ' ' << at[1] << ' ' << is_flat;
      EXPECT_EQ(sum.number, 0) << at[0] << ' ' << at[1] << ' ' << is_flat;
    }
}

TEST(WindingSum, has_both_sides_beside_a_triangle) {
  constexpr float tiny = 0x1p-60f;
  const oracle::WindingSum above = sum_of(flat, {1, 1, tiny}), below = sum_of(flat, {1, 1, -tiny});
  EXPECT_NEAR(above.number, -0.5, above.error);
  EXPECT_NEAR(below.number, 0.5, below.error);
  EXPECT_LT(above.error, 1e-12);
}

TEST(WindingSum, is_no_judge_on_edges_and_corners) {
  for (const Float3& point : {Float3{2, 0, 0}, Float3{2, 2, 0}, Float3{4, 0, 0}, Float3{0, 0, 0}})
    EXPECT_TRUE(sum_of(flat, point).is_on_edge) << point[0] << ' ' << point[1];
  EXPECT_TRUE(sum_of(tilted, {2, 2, 4}).is_on_edge);
  const Mesh solid = cube(-1, 1);
  EXPECT_TRUE(sum_of(solid, {0, 0, 1}).is_on_edge) << "the diagonal of a face";
  EXPECT_FALSE(sum_of(flat, {2, 1e-30f, 0}).is_on_edge);
  EXPECT_FALSE(sum_of(flat, {2, 1e-30f, 1e-30f}).is_judge()) << "no digits are left so near";
}

TEST(WindingSum, is_one_half_on_the_faces_of_a_solid) {
  const Mesh solid = cube(-1, 1);
  for (const Float3& point : {Float3{0.25f, 0.5f, 1}, Float3{-1, 0.5f, 0.25f}}) {
    const oracle::WindingSum sum = sum_of(solid, point);
    EXPECT_NEAR(sum.number, 0.5, sum.error);
    EXPECT_TRUE(sum.is_judge());
  }
}

TEST(WindingSum, takes_triangles_without_an_area_for_edges) {
  EXPECT_TRUE(sum_of(line, {2, 2, 2}).is_on_edge);
  EXPECT_FALSE(sum_of(line, {2, 2, 2.5f}).is_on_edge);
  EXPECT_FALSE(sum_of(line, {4, 4, 4}).is_on_edge);
  EXPECT_EQ(sum_of(line, {2, 2, 2.5f}).number, 0);
  EXPECT_FALSE(sum_of({line.vertices, {{0, 2, 3}}}, {2, 2, 2}).is_on_edge) << "two equal corners";
}

// Sums in 64-bit significands have other errors. Some points are so near to edges that few digits are left.
TEST(WindingSum, is_within_its_error) {
  const Mesh mesh = without(ellipsoid(1, {0, 0, 0}), 0.3, 7);
  std::vector<Float3> points = points_around(mesh, 300, 1.5f, 8);
  for (const Index3& t : mesh.triangles) {
    const Float3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]];
    points.push_back({0.5f * (a[0] + b[0]), 0.5f * (a[1] + b[1]), 0.5f * (a[2] + b[2])});
  }
  double largest_error = 0;
  for (const Float3& point : points) {
    const oracle::WindingSum sum = sum_of(mesh, point);
    if (!sum.is_judge() || is_on(mesh, point)) continue;
    const SummedWinding expected(mesh, point);
    EXPECT_LE(std::abs(static_cast<long double>(sum.number) - expected.number), sum.error + expected.error);
    largest_error = std::max(largest_error, sum.error);
  }
  EXPECT_GT(largest_error, 1e-10);
}

// Seen from 0, the corners have a determinant of 1 or -1, of which doubles keep no digit: the sums have its sign.
TEST(WindingSum, has_the_exact_side_where_doubles_have_none) {
  constexpr float f[] = {3524578, 5702887, 9227465, 14930352};  // of Fibonacci: f[0]·f[2] - f[1]² is ±1
  Random random(12);
  int sides[2] = {0, 0};
  for (int i = 0; i < 200; ++i) {
    const auto x = static_cast<float>(random.integer(-4000000, 4000000)),
               y = static_cast<float>(random.integer(-4000000, 4000000));
    const float step = i % 2 == 0 ? 1.0f : -1.0f;
    const Mesh mesh{{{f[0], f[1], x}, {f[1], f[2], y}, {-f[2], -f[3], step - x - y}}, {{0, 1, 2}}};
    const oracle::Placed exact = oracle::placed(oracle::corners_of(mesh, 0), Float3{0, 0, 0});
    ASSERT_NE(exact.side, 0);
    const oracle::WindingSum sum = sum_of(mesh, {0, 0, 0});
    EXPECT_NEAR(sum.number, 0.5 * exact.side, sum.error);
    EXPECT_TRUE(sum.is_judge());
    ++sides[exact.side > 0 ? 1 : 0];
  }
  EXPECT_EQ(sides[0], 100);
}

}  // namespace
}  // namespace raylanes::testing
