// Winding numbers: against solid angles of all triangles, and by what must hold exactly.
#include "open_meshes.hpp"

namespace raylanes::testing {
namespace {

TEST(Winding, meshes_with_holes_of_any_size) {
  const Mesh whole = ellipsoid(1, {0, 0, 0});
  for (const double share : {0.02, 0.3, 0.9}) {
    const Mesh mesh = without(whole, share, 81);
    EXPECT_GT(expect_windings(mesh, points_around(mesh, by_level(200), 1.5f, 82)), 10u);
  }
}

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

TEST(Winding, triangles_that_have_nothing_in_common) {
  const Mesh soup = triangle_soup(200, 1.0f, 90);
  EXPECT_GT(expect_windings(soup, points_around(soup, by_level(150), 2.0f, 91)), 10u);
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

TEST(Winding, any_size) {
  for (const float scaling : {1e-38f, 1e-30f, 1e-12f, 1e12f, 1e30f, 1.5e38f}) {
    SCOPED_TRACE(scaling);
    Mesh mesh = without(double_fan(12, 0.25f), 0.3, 95);
    scale(mesh, scaling);
    expect_windings(mesh, points_around(mesh, by_level(40), 1.25f * scaling, 96));
  }
}

TEST(Winding, far_from_zero_and_far_from_the_mesh) {
  Mesh mesh = without(ellipsoid(1, {0, 0, 0}), 0.2, 97);
  std::vector<Float3> points = points_around(mesh, by_level(40), 1.5f, 98);
  for (const float far : {1e3f, 1e10f, 1e20f, 3e38f})
    points.push_back({far, -far, 0.5f * far}), points.push_back({0, 0, far});
  expect_windings(mesh, points);
  for (std::vector<Float3>* all : {&mesh.vertices, &points})
    for (Float3& p : *all)
      for (float& x : p) x += 4096;
  expect_windings(mesh, points);
}

// As count_crossings() counts them for a ray anywhere: nested, turned over and overlapping shells.
TEST(Winding, closed_meshes_have_whole_numbers) {
  Mesh mesh = cube(-1, 1);
  append(mesh, cube(-0.5f, 0.5f));
  append(mesh, cube(0, 2));
  append(mesh, turned_over(cube(-0.25f, 0.25f), 1.0, 1));
  std::vector<Float3> points = points_around(mesh, by_level(500), 2.5f, 99);
  std::erase_if(points, [&](const Float3& point) { return is_on(mesh, point); });
  std::vector<Ray> rays;
  for (const Float3& point : points) rays.push_back({point, 0.0f, {0.31f, -0.73f, 0.59f}});
  std::vector<CrossingCount> counts(points.size());
  Bvh(mesh).count_crossings(rays, counts);
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    std::vector<float> numbers(points.size());
    tree.winding_numbers(points, numbers, {.path = path});
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_EQ(numbers[i], static_cast<float>(counts[i].winding)) << "point " << i;
  });
}

// The mean of both sides on a triangle; whatever a point on an edge has lies between those around it.
TEST(Winding, points_on_the_surface) {
  const Mesh mesh = cube(-1, 1);
  const std::vector<Float3> points = {{0.25f, 0.5f, 1}, {0.25f, 0.5f, -1}, {-1, 0.5f, 0.25f}, {0, 1, 0.5f},
                                      {1, 1, 1},        {0, 0, 1},         {0, 1, 1}};
  std::vector<float> numbers(points.size());
  Bvh(mesh).winding_numbers(points, numbers);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(numbers[i], 0.5f);
  for (std::size_t i = 4; i < points.size(); ++i) EXPECT_TRUE(numbers[i] >= 0 && numbers[i] <= 1) << i;
}

// Sheets so near to each other that t of a crossing rounds to zero, or is flushed: the point is on the first alone.
TEST(Winding, sheets_behind_a_point_at_the_least_distances) {
  constexpr float least = std::numeric_limits<float>::denorm_min();
  Mesh mesh;
  for (const float height : {0.0f, least, -1024 * least})
    append(mesh, make_triangle({-8, -8, height}, {8, -8, height}, {0, 8, height}));
  const std::vector<Float3> points = {{0, 0, 0}, {0.5f, -1, 0}, {0, 0, least}, {0, 0, -1024 * least}};
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    for (const FloatMode mode : float_modes) {
      const FloatModeScope scope(mode);
      std::vector<float> numbers(points.size());
      tree.winding_numbers(points, numbers, {.path = path});
      const std::vector<float> expected = {0, 0, -1, 1};
      EXPECT_EQ(numbers, expected) << name_of(mode);
    }
  });
}

std::size_t expect_rule_of_inside(const Mesh& mesh, const std::vector<Float3>& points) {
  std::size_t inside = 0;
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    std::vector<Location> locations(points.size());
    std::vector<float> numbers(points.size()), distances(points.size());
    tree.locate(points, locations, {.rule = InsideRule::winding, .path = path});
    tree.winding_numbers(points, numbers, {.accuracy = 0, .path = path});
    tree.signed_distances(points, distances, {.rule = InsideRule::winding, .path = path});
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Location expected = is_on(mesh, points[i]) ? Location::on
                                : numbers[i] >= 0.5f   ? Location::inside
                                                       : Location::outside;
      // A number that is less than ½ may be ½ as a float.
      EXPECT_TRUE(numbers[i] == 0.5f || locations[i] == expected) << "point " << i;
      EXPECT_EQ(distances[i] < 0, locations[i] == Location::inside);
      inside += locations[i] == Location::inside ? 1 : 0;
    }
  });
  return inside;
}

TEST(Winding, the_rule_of_inside_by_half) {
  const Mesh mesh = without(ellipsoid(1, {0, 0, 0}), 0.15, 101);
  const std::vector<Float3> points = points_around(mesh, by_level(600), 1.5f, 102);
  EXPECT_GT(expect_rule_of_inside(mesh, points), points.size() / 4);
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
  const std::size_t inside = expect_rule_of_inside(tubes, points);
  EXPECT_GT(inside, points.size() / 4);
}

TEST(Winding, threads_masks_and_strides) {
  const Mesh mesh = without(ellipsoid(1, {0, 0, 0}), 0.1, 103);
  std::vector<Float3> points = points_around(mesh, 3000, 1.5f, 104);
  for (const Float3& point : points_in_lines(mesh, 1200, 1.5f, 105)) points.push_back(point);
  Random random(106);
  std::vector<std::uint8_t> mask(points.size() / 8 + 1);
  for (std::uint8_t& bits : mask) bits = static_cast<std::uint8_t>(random.integer(0, 255));
  for (const Path* path : paths_with_own_queries()) {
    const Bvh bvh(mesh);
    std::vector<float> one(points.size()), together(points.size()), some(points.size(), -7.0f);
    bvh.winding_numbers(points, one, {.path = path});
    bvh.winding_numbers(points, together, {.path = path, .threads = 3});
    EXPECT_TRUE(same_bytes(one, together));
    // Rows are of active points, so a mask gives the bytes that these have without the others.
    std::vector<Float3> chosen;
    for (std::size_t i = 0; i < points.size(); ++i)
      if ((mask[i / 8] >> i % 8 & 1) != 0) chosen.push_back(points[i]);
    std::vector<float> expected(chosen.size());
    bvh.winding_numbers(chosen, expected, {.path = path});
    bvh.winding_numbers(points, some, {.path = path, .threads = 2, .active = mask.data()});
    for (std::size_t i = 0, k = 0; i < points.size(); ++i)
      ASSERT_EQ(some[i], (mask[i / 8] >> i % 8 & 1) != 0 ? expected[k++] : -7.0f) << "point " << i;
  }
}

TEST(Winding, follows_a_mesh_that_is_refitted) {
  Mesh mesh = without(ellipsoid(1, {0, 0, 0}), 0.1, 107);
  const std::vector<Float3> points = points_around(mesh, 300, 1.5f, 108);
  std::vector<float> refitted(points.size()), built(points.size());
  Bvh bvh(mesh);
  bvh.winding_numbers(points, refitted);
  for (Float3& vertex : mesh.vertices) vertex = {1.5f * vertex[0], vertex[1] - 0.25f, 0.75f * vertex[2]};
  bvh.refit(mesh.vertices, mesh.triangles);
  bvh.winding_numbers(points, refitted);
  Bvh moved = std::move(bvh);
  moved.winding_numbers(points, refitted);
  Bvh(mesh).winding_numbers(points, built);
  EXPECT_TRUE(same_bytes(refitted, built));
}

TEST(Winding, no_triangles_no_points_and_points_that_are_not_finite) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                  infinity = std::numeric_limits<float>::infinity();
  const std::vector<Float3> points = {{nan, 0, 0}, {0, infinity, 0}, {0, 0, -infinity}, {0, 0, 0}};
  std::vector<float> numbers(4, 9.0f);
  Bvh().winding_numbers(points, numbers);
  EXPECT_EQ(numbers, std::vector<float>(4, 0.0f));
  Bvh(cube(-1, 1)).winding_numbers(points, numbers);
  EXPECT_EQ(numbers, (std::vector<float>{0, 0, 0, 1}));
  Bvh(without(cube(-1, 1), 0.3, 109)).winding_numbers(points, numbers);
  EXPECT_EQ(numbers[0] + numbers[1] + numbers[2], 0.0f);
  Bvh(cube(-1, 1)).winding_numbers(std::vector<Float3>(), {});
}

TEST(Winding, options_that_are_refused) {
  const Bvh bvh(cube(-1, 1));
  const std::vector<Float3> points(3);
  std::vector<float> numbers(3), few(2);
  EXPECT_THROW(bvh.winding_numbers(points, few), std::invalid_argument);
  for (const double accuracy : {-1e-9, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(bvh.winding_numbers(points, numbers, {.accuracy = accuracy}), std::invalid_argument);
  EXPECT_THROW(bvh.winding_numbers(points, numbers, {.threads = -1}), std::invalid_argument);
  EXPECT_THROW(bvh.winding_numbers({nullptr, 3}, numbers), std::invalid_argument);
  bvh.winding_numbers(points, numbers, {.accuracy = std::numeric_limits<double>::infinity()});
  EXPECT_EQ(numbers, std::vector<float>(3, 1.0f));
}

}  // namespace
}  // namespace raylanes::testing
