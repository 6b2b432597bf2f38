// The judge of winding numbers finds numbers that are wrong and none that are right, and the expansions that they are
// compared with converge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <raylanes/bvh.hpp>

#include "../../tests/queries/open_meshes.hpp"
#include "../../tests/queries/query_trees.hpp"
#include "../contenders/fast_winding.hpp"
#include "../rows/point_rows.hpp"
#include "../support/oracles/winding_sum.hpp"
#include "../support/scenes/damage.hpp"
#include "../support/scenes/procedural.hpp"

namespace raylanes::bench {
namespace {

const Mesh flat{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};

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
  const std::vector<Float3> on_flat = {{1, 1, 0}, {2, 0, 0}, {3, 3, 0}, {0.5f, 1, 0.25f}, {1e-12f, 1, 0}};
  for (const Mesh* each : {&mesh, &flat}) {
    const std::vector<Float3> points = each == &flat ? on_flat : testing::points_around(mesh, 40, 1.5f, 9);
    const PointRow right = judged(*each, points, 0);
    EXPECT_TRUE(right.wrong == 0 && right.is_sound());
    EXPECT_GE(right.judged, points.size() / 2);
    for (const float broken : {4e-6f, -0.5f, 1.0f, std::numeric_limits<float>::quiet_NaN()}) {
      const PointRow wrong = judged(*each, points, broken);
      EXPECT_TRUE(wrong.wrong == 1 && !wrong.is_sound()) << broken;
      EXPECT_GT(wrong.winding_error, 2e-6) << broken;
    }
  }
}

TEST(WindingJudge, leaves_out_points_without_a_limit) {
  PointRow row{};
  row.contender = "kdtree";
  row.judge_winding(7, sum_of(flat, {2, 0, 0}), 0);
  EXPECT_TRUE(row.judged == 0 && row.is_sound());
}

// The sum of all solid angles is ours within our accuracy and a rounding. Expansions have terms up to the third degree:
// what they leave out falls at least as β^-4 at each node.
TEST(FastWinding, sums_solid_angles_and_expands_them) {
  const Mesh whole = make_procedural_scene("spheres").mesh;
  for (const Mesh& mesh : {whole, with_holes(whole, 8)}) {
    testing::Random random(7);
    std::vector<Float3> points(40);
    for (Float3& point : points) point = random.point(1);
    const FastWinding rival(mesh);
    std::vector<double> sums(points.size()), coarse(points.size()), fine(points.size());
    rival.numbers(points, std::numeric_limits<double>::infinity(), sums);
    rival.numbers(points, 2, coarse), rival.numbers(points, 8, fine);
    std::vector<float> ours(points.size());
    Bvh(mesh).winding_numbers(points, ours);
    double coarse_error = 0, fine_error = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(sums[i], static_cast<double>(ours[i]), 1e-6 + 0x1p-24 * std::abs(sums[i]) + 1e-9) << i;
      coarse_error = std::max(coarse_error, std::abs(coarse[i] - sums[i]));
      fine_error = std::max(fine_error, std::abs(fine[i] - sums[i]));
    }
    EXPECT_GT(coarse_error, 0);
    EXPECT_LT(fine_error, coarse_error / 64);
  }
}

}  // namespace
}  // namespace raylanes::bench
