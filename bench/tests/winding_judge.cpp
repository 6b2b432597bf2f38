// The judge of winding numbers finds numbers that are wrong, and none that are right.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include <raylanes/bvh.hpp>

#include "../../tests/queries/open_meshes.hpp"
#include "../../tests/queries/query_trees.hpp"
#include "../rows/point_rows.hpp"
#include "../support/oracles/winding_sum.hpp"
#include "../support/scenes/damage.hpp"
#include "../support/scenes/procedural.hpp"

namespace raylanes::bench {
namespace {

const Mesh flat{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
const Mesh tilted{{{0, 0, 0}, {4, 0, 4}, {0, 4, 4}}, {{0, 1, 2}}};  // z = x + y

oracle::WindingSum sum_of(const Mesh& mesh, const Float3& point) {
  return oracle::winding_sum(mesh.vertices, mesh.triangles, point);
}

// The row that all points of a mesh have, with one number moved by `broken`.
PointRow judged(const Mesh& mesh, const std::vector<Float3>& points, float broken) {
  std::vector<float> numbers(points.size());
  Bvh(mesh).winding_numbers(points, numbers);
  numbers[points.size() / 2] += broken;
  PointRow row{};
  row.contender = "bvh";
  for (std::size_t i = 0; i < points.size(); ++i)
    row.judge_winding(numbers[i], sum_of(mesh, points[i]), 1.1e-6);
  return row;
}

TEST(WindingJudge, finds_one_number_that_is_wrong) {
  const Mesh mesh = with_holes(make_procedural_scene("spheres").mesh, 4);
  std::vector<Float3> points = testing::points_around(mesh, 40, 1.5f, 9);
  for (const Mesh* each : {&mesh, &flat}) {
    if (each == &flat) points = {{1, 1, 0}, {2, 0, 0}, {3, 3, 0}, {0.5f, 1, 0.25f}, {1e-12f, 1, 0}};
    const PointRow right = judged(*each, points, 0);
    EXPECT_EQ(right.wrong, 0u);
    EXPECT_TRUE(right.is_sound());
    EXPECT_GE(right.judged, points.size() / 2);
    for (const float broken : {4e-6f, -0.5f, 1.0f, std::numeric_limits<float>::quiet_NaN()}) {
      const PointRow wrong = judged(*each, points, broken);
      EXPECT_EQ(wrong.wrong, 1u) << broken;
      EXPECT_FALSE(wrong.is_sound()) << broken;
      EXPECT_GT(wrong.winding_error, 2e-6) << broken;
    }
  }
}

TEST(WindingJudge, leaves_out_points_without_a_limit) {
  PointRow row{};
  row.contender = "kdtree";
  row.judge_winding(7, sum_of(flat, {2, 0, 0}), 0);
  EXPECT_EQ(row.judged, 0u);
  EXPECT_TRUE(row.is_sound());
}

// All points of the box are in the plane of the triangle, half of them on it.
TEST(WindingJudge, finds_ours_right_on_one_triangle) {
  for (const Mesh& mesh : {flat, tilted}) {
    const Scene scene{"triangle", mesh, {}};
    PointRowsOptions options;
    options.paths = {&active_path()}, options.queries = {PointQuery::winding};
    options.kinds = {PointKind::box, PointKind::surface, PointKind::grid};
    options.count = 500, options.grid = {16, 16, 4}, options.seconds = 0;
    for (const PointRow& row : measure_points(scene, options)) {
      EXPECT_TRUE(row.is_sound()) << row.contender << ' ' << static_cast<int>(row.kind);
      EXPECT_GT(row.judged, 100u);
    }
  }
}

}  // namespace
}  // namespace raylanes::bench
