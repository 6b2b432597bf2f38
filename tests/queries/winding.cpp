// Winding numbers of floats: where boundaries are long or in many parts, near the rule's half, of threads and masks.
#include "../../bench/support/oracles/winding_sum.hpp"
#include "../doubles/both_numbers.hpp"
#include "chord_meshes.hpp"
#include "open_meshes.hpp"

namespace raylanes::testing {
namespace {

// One loop of many edges, flat or not, which is cut by chords.
TEST(Winding, a_large_hole) {
  for (const float slope : {0.0f, 0.4f}) {
    Mesh mesh = ellipsoid(2, {0, 0, 0});
    std::erase_if(mesh.triangles, [&](const Index3& t) {
      float height = 0;
      for (const std::uint32_t corner : t)
        height += mesh.vertices[corner][2] - slope * mesh.vertices[corner][0] * mesh.vertices[corner][1];
      return height > 0.6f;
    });
    EXPECT_GT(boundary_edges(mesh), 16u);
    EXPECT_GT(expect_windings(mesh, points_around(mesh, by_level(150), 2.5f, 110)), 30u);
  }
}

// Rays of rows go through the end of a tube, or past it, where its caps have been expanded.
TEST(Winding, rows_of_points_along_tubes) {
  Random random(111);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const float length : {12.0f, 60.0f}) {
      std::vector<Float3> points;
      for (std::size_t row = 0; row < by_level(40); ++row) {
        Float3 point = random.point(1.2f);
        for (int k = 0; k < 6; ++k) point[axis] = random.number(-1, length + 1), points.push_back(point);
      }
      const Mesh mesh = tube(axis, length);
      EXPECT_EQ(boundary_edges(mesh), 16u);
      EXPECT_GT(expect_windings(mesh, points), points.size() / 10);
      expect_windings(row_of_tubes(axis, length), points);
    }
}

TEST(Winding, faces_turned_over_copies_and_edges_of_many_triangles) {
  const Mesh whole = double_fan(30, 0.25f);
  expect_windings(turned_over(whole, 0.2, 83), points_around(whole, by_level(150), 1.5f, 84));
  Mesh copies = without(whole, 0.3, 85);
  append(copies, copies);
  append(copies, without(whole, 0.5, 86));
  append(copies, turned_over(without(cube(-1, 1), 0.2, 87), 0.3, 88));
  EXPECT_GT(expect_windings(copies, points_around(copies, by_level(150), 1.5f, 89)), 10u);
}

// Rows of a grid share rays, which go through corners and along edges of the boundary.
TEST(Winding, points_in_lines_and_rays_through_the_boundary) {
  Mesh open = cube(-1, 1);
  std::erase_if(open.triangles, [&](const Index3& t) {
    return std::ranges::all_of(t, [&](std::uint32_t corner) { return open.vertices[corner][2] > 0; });
  });
  std::vector<Float3> grid;
  for (int z = -6; z <= 6; ++z)
    for (int y = -6; y <= 6; ++y)
      for (int x = -6; x <= 6; ++x)
        grid.push_back({static_cast<float>(x) / 4, static_cast<float>(y) / 4, static_cast<float>(z) / 4});
  // On the plane of the rim some points are on its edges, others on diagonals of caps.
  EXPECT_GT(expect_windings(open, grid), 200u);
  std::ranges::reverse(grid);
  EXPECT_GT(expect_windings(open, grid), 200u);
  EXPECT_GT(expect_windings(without(open, 0.4, 92), grid), 200u);
  const Mesh holed = without(ellipsoid(1, {0, 0, 0}), 0.1, 93);
  expect_windings(holed, points_in_lines(holed, by_level(300), 1.5f, 94));
}

TEST(Winding, far_from_zero) {
  Mesh mesh = without(ellipsoid(1, {0, 0, 0}), 0.2, 97);
  std::vector<Float3> points = points_around(mesh, by_level(40), 1.5f, 98);
  for (std::vector<Float3>* all : {&mesh.vertices, &points})
    for (Float3& p : *all)
      for (float& x : p) x += 4096;
  expect_windings(mesh, points);
}

// In the mouths of tubes numbers come near ½, to which the far ends of all tubes add a little.
TEST(Winding, the_rule_of_inside_near_half) {
  const Mesh tubes = row_of_tubes(0, 12);
  Random random(112);
  std::vector<Float3> points;
  for (std::size_t i = 0; i < by_level(1000); ++i) {
    Float3 point = random.point(0.7f);
    point[0] *= 0.02f;
    point[1] += 2.5f * static_cast<float>(random.integer(0, 5));
    points.push_back(point);
  }
  each_tree(tubes, [&](const auto& tree, const Path* path) {
    EXPECT_GT(expect_rule_of_inside(tubes, tree, path, points), points.size() / 20);
  });
}

template <class T>
class WindingCalls : public ::testing::Test {};
TYPED_TEST_SUITE(WindingCalls, Numbers, NumberNames);

TYPED_TEST(WindingCalls, on_threads_and_of_active_points) {
  using T = TypeParam;
  const Mesh mesh = without(ellipsoid(1, {0, 0, 0}), 0.1, 103);
  std::vector<Float3> of_floats = points_around(mesh, 3000, 1.5f, 104);
  for (const Float3& point : points_in_lines(mesh, 1200, 1.5f, 105)) of_floats.push_back(point);
  const std::vector<PointOf<T>> points = mesh_of<T>({of_floats, {}}).vertices;
  Random random(106);
  std::vector<std::uint8_t> mask(points.size() / 8 + 1);
  for (std::uint8_t& bits : mask) bits = static_cast<std::uint8_t>(random.integer(0, 255));
  for (const Path* path : paths_with_own_queries()) {
    const auto tree = tree_of<T>(mesh_of<T>(mesh));
    std::vector<T> one(points.size()), together(points.size()), some(points.size(), -7);
    tree.winding_numbers(points, one, {.path = path});
    tree.winding_numbers(points, together, {.path = path, .threads = 3});
    EXPECT_TRUE(same_bytes(one, together));
    // Rows are of active points, so a mask gives the bytes that these have without the others.
    std::vector<PointOf<T>> chosen;
    for (std::size_t i = 0; i < points.size(); ++i)
      if ((mask[i / 8] >> i % 8 & 1) != 0) chosen.push_back(points[i]);
    std::vector<T> expected(chosen.size());
    tree.winding_numbers(chosen, expected, {.path = path});
    tree.winding_numbers(points, some, {.path = path, .threads = 2, .active = mask.data()});
    for (std::size_t i = 0, k = 0; i < points.size(); ++i)
      ASSERT_EQ(some[i], (mask[i / 8] >> i % 8 & 1) != 0 ? expected[k++] : -7) << "point " << i;
  }
}

// One by one they have the rays to the nearest side; as a grid those along x.
TEST(Winding, the_plane_of_a_flat_hole_has_one_half) {
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
