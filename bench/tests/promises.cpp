// The results that the tool calls a broken promise, winding numbers among them, and the expansions that those are
// compared with.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <raylanes/bvh.hpp>

#include "../../tests/queries/open_meshes.hpp"
#include "../../tests/queries/query_trees.hpp"
#include "../contenders/fast_winding.hpp"
#include "../rows/kernels/kernel_rows.hpp"
#include "../rows/point_rows.hpp"
#include "../support/oracles/winding_sum.hpp"
#include "../support/scenes/damage.hpp"
#include "../support/scenes/procedural.hpp"

namespace raylanes::bench {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Promises, of_kernels) {
  struct Case {
    const char *kernel, *test;
    double wrong, leaks;
    bool kept;
  };
  for (const Case& one : {Case{"triangle", "exact", 0, 0, true},
                          {"triangle", "exact", nan, 0, false},
                          {"triangle", "exact", 0, 1, false},
                          {"triangle", "integers", 1, 0, false},
                          {"triangle", "watertight", 1, 0, true},
                          {"triangle", "watertight", 0, 1, false},
                          {"triangle", "moller_trumbore", 1, 1, true},
                          {"box", "conservative", 1, 0, false},
                          {"box", "plain", 1, 0, true}}) {
    KernelAccuracy accuracy;
    accuracy.wrong_per_million[1] = one.wrong;
    KernelRow row{};
    row.kernel = one.kernel, row.test = one.test, row.accuracy = &accuracy, row.leaks = one.leaks;
    EXPECT_EQ(keeps_promise(row), one.kept) << one.kernel << ' ' << one.test;
  }
}

TEST(Promises, of_points) {
  const std::vector<double> near{4, 9, infinity}, far{4, 16, infinity}, lost{4, nan, infinity};
  EXPECT_EQ(largest_difference(near, near, 10), 0);
  EXPECT_EQ(largest_difference(near, far, 10), 0.1);
  EXPECT_EQ(largest_difference(near, lost, 10), infinity);
  EXPECT_EQ(largest_difference(lost, near, 10), infinity);
  struct Case {
    const char* contender;
    double difference;
    std::uint32_t wrong;
    bool is_closed, is_sound;
  };
  // A point that is not where rational numbers have it says nothing where the mesh has holes.
  for (const Case& one : {Case{"bvh", 0, 0, true, true},
                          {"kdtree", infinity, 0, true, false},
                          {"embree", infinity, 1, true, true},
                          {"bvh", 0, 1, true, false},
                          {"bvh", 0, 1, false, true}}) {
    PointRow row{};
    row.contender = one.contender, row.largest_difference = one.difference, row.is_closed = one.is_closed;
    row.wrong = one.wrong;
    EXPECT_EQ(row.is_sound(), one.is_sound) << one.contender;
  }
}

// A row is right until one of its numbers is moved by `broken`. Points without a limit do not count.
TEST(Promises, of_winding_numbers) {
  const Mesh spheres = with_holes(make_procedural_scene("spheres").mesh, 4);
  const Mesh flat{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
  const std::vector<Float3> on_flat{{1, 1, 0}, {2, 0, 0}, {3, 3, 0}, {0.5f, 1, 0.25f}, {1e-12f, 1, 0}};
  for (const Mesh* mesh : {&spheres, &flat}) {
    const auto points = mesh == &flat ? on_flat : testing::points_around(*mesh, 40, 1.5f, 9);
    std::vector<float> numbers(points.size());
    Bvh(*mesh).winding_numbers(points, numbers);
    for (const float broken : {0.0f, 4e-6f, -0.5f, 1.0f, std::numeric_limits<float>::quiet_NaN()}) {
      PointRow row{};
      row.contender = "bvh";
      for (std::size_t i = 0; i < points.size(); ++i)
        row.judge_winding(numbers[i] + (i == points.size() / 2 ? broken : 0),
                          oracle::winding_sum(mesh->vertices, mesh->triangles, points[i]), 1.1e-6);
      EXPECT_TRUE(row.wrong == (broken != 0) && row.is_sound() == (broken == 0)) << broken;
      EXPECT_GE(row.judged, points.size() / 2);
      EXPECT_TRUE(broken == 0 || row.winding_error > 2e-6) << broken;
    }
  }
  PointRow row{};
  row.contender = "kdtree";
  row.judge_winding(7, oracle::winding_sum(flat.vertices, flat.triangles, {2, 0, 0}), 0);
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
    rival.numbers(points, infinity, sums), rival.numbers(points, 2, coarse), rival.numbers(points, 8, fine);
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
