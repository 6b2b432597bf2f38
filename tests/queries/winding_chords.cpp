// Winding numbers at points where the library's own division of a boundary has edges and caps: on chords between
// corners of a hole, which cut long loops and bound fans, and in planes through three corners. The mesh has nothing
// there.
#include <numbers>
#include <utility>

#include "../../bench/support/oracles/winding_sum.hpp"
#include "chord_meshes.hpp"
#include "open_meshes.hpp"

namespace raylanes::testing {
namespace {

// In any order, so that most have rays of their own, and sorted, so that many share the rays of rows.
void expect_windings_in_both_orders(const Mesh& mesh, std::vector<Float3> points, std::size_t count,
                                    Random& random) {
  for (std::size_t i = points.size(); i > 1; --i)
    std::swap(points[i - 1], points[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
  points.resize(std::min(points.size(), count));
  EXPECT_GT(expect_windings(mesh, points), points.size() / 4);
  std::ranges::sort(points);
  EXPECT_GT(expect_windings(mesh, points), points.size() / 4);
}

TEST(WindingChords, between_corners_of_flat_and_rough_holes) {
  Random random(401);
  for (const auto& [axis, roughness] : {std::pair<std::size_t, int>{2, 0}, {0, 0}, {1, 1}, {2, 3}}) {
    SCOPED_TRACE(::testing::Message() << "axis " << axis << ", roughness " << roughness);
    const HoledCube cube(axis, roughness, 402 + axis);
    EXPECT_EQ(cube.rim.size(), 24u);
    expect_windings_in_both_orders(cube.mesh, points_of_chords(cube.rim, 400, random), by_level(600), random);
  }
}

// One by one they have the rays to the nearest side; as a grid those along x.
TEST(WindingChords, the_plane_of_a_flat_hole_has_one_half) {
  const HoledCube cube(2, 0, 1);
  std::vector<Float3> grid;
  for (int y = -10; y <= 10; ++y)
    for (int x = -10; x <= 10; ++x) grid.push_back({static_cast<float>(x), static_cast<float>(y), 24});
  each_tree(cube.mesh, [&](const auto& tree, const Path* path) {
    std::vector<float> numbers(grid.size());
    tree.winding_numbers(grid, numbers, {.path = path});
    float alone = 0;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      tree.winding_numbers(std::span(grid).subspan(i, 1), std::span(&alone, 1), {.path = path});
      wrong += std::abs(numbers[i] - 0.5f) > 1e-6f || std::abs(alone - 0.5f) > 1e-6f ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0u);
  });
}

// Chords that pass the origin, and points so near to it that differences to corners lose them.
TEST(WindingChords, points_beside_chords_at_all_distances) {
  Random random(403);
  const Mesh cone = cone_around(0, 2, 404);
  const float steps[] = {0.0f, 0x1p-149f, 0x1p-100f, 0x1p-60f, 0x1p-40f, 0x1p-26f, 0x1p-13f, 0x1p-3f};
  std::vector<Float3> points;
  for (std::size_t i = 0; i < by_level(600); ++i) {
    Float3 point;
    for (float& x : point) x = steps[random.integer(0, 7)] * random.number(-2, 2);
    points.push_back(point);
  }
  expect_windings_in_both_orders(cone, points, points.size(), random);
}

// Rows on chords along an axis, whose rays go along the chord.
TEST(WindingChords, rows_along_chords) {
  for (std::uint64_t seed = 0; seed < (quick() ? 3u : 8u); ++seed)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      SCOPED_TRACE(axis);
      std::vector<Float3> points;
      for (int k = -15; k <= 15; ++k) {
        Float3 point{};
        point[axis] = static_cast<float>(k) / 2;
        points.push_back(point);
      }
      EXPECT_GE(expect_windings(cone_around(axis, 9, seed), points), 20u);
    }
}

// The edge passes so near to the point that the triangle is a lune: from below the point, along −z, to the third
// corner. Products of the large coordinate hide the small ones.
TEST(WindingChords, a_point_beside_an_edge_of_large_and_small_coordinates) {
  const double lune = (std::numbers::pi / 2 + std::atan(0.25 / 4)) / (2 * std::numbers::pi);
  for (const float large : {0x1p40f, 0x1p56f, 0x1p60f, 0x1p100f})
    for (const bool is_turned : {false, true}) {
      SCOPED_TRACE(large);
      const Float3 near{0, 1, 0.5f}, far{0, -large, 0}, third{4, 0, 0.75f};
      Mesh mesh;
      append(mesh, is_turned ? make_triangle(far, near, third) : make_triangle(near, far, third));
      const std::vector<Float3> points = {{0, 0, 0.5f}};
      each_tree(mesh, [&](const auto& tree, const Path* path) {
        std::vector<float> numbers(1);
        tree.winding_numbers(points, numbers, {.path = path});
        EXPECT_NEAR(numbers[0], is_turned ? lune : -lune, 1.5e-6);
      });
    }
}

// The first call of a tree makes its boundary on the threads of the call: in parts that are joined in their order.
TEST(Winding, a_boundary_made_by_threads) {
  const Mesh mesh = triangle_soup(by_level(6000), 0.1f, 117);
  Random random(118);
  std::vector<Float3> points;
  for (int i = 0; i < 60; ++i) points.push_back(random.point(1.5f));
  std::vector<float> one(points.size()), many(points.size());
  Bvh(mesh).winding_numbers(points, one, {.threads = 1});
  for (const int threads : {0, 3}) {
    Bvh(mesh).winding_numbers(points, many, {.threads = threads});
    EXPECT_EQ(one, many) << threads;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const oracle::WindingSum sum = oracle::winding_sum(mesh.vertices, mesh.triangles, points[i]);
    EXPECT_NEAR(static_cast<double>(one[i]), sum.number, 2e-5 + sum.error) << i;
  }
}

}  // namespace
}  // namespace raylanes::testing
