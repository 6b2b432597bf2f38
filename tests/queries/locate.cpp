// Which points are inside: against rational numbers, and by what must hold whatever the direction.
#include <raylanes/closed_mesh.hpp>

#include "worlds/worlds.hpp"

namespace raylanes::testing {
namespace {

template <class AnyMesh, class Point = typename decltype(AnyMesh::vertices)::value_type>
std::size_t expect_locations(const AnyMesh& mesh, const std::vector<std::type_identity_t<Point>>& points,
                             bool may_flush = true) {
  constexpr bool has_floats = std::is_same_v<Point, Float3>;
  std::size_t on = 0;
  for (const InsideRule rule : {InsideRule::parity, InsideRule::nonzero, InsideRule::vote}) {
    if (rule != InsideRule::vote && !closed_report(mesh.vertices, mesh.triangles).has_winding_numbers())
      continue;  // they depend on a direction
    SCOPED_TRACE(inside_rule_names[static_cast<std::size_t>(rule)]);
    std::vector<Location> expected;
    for (const Point& point : points) {
      // By the crossings of another ray than the library's.
      expected.push_back(exact_location(mesh, point, {3, -7, 2}, rule));
      on += expected.back() == Location::on ? 1 : 0;
    }
    each_tree(mesh, [&](const auto& tree, const Path* path) {
      for (const FloatMode mode : float_modes) {
        if (mode == FloatMode::flush && !(may_flush && has_floats)) continue;
        const FloatModeScope scope(mode);
        std::vector<Location> locations(points.size());
        tree.locate(points, locations, {.rule = rule, .path = path, .threads = 2});
        for (std::size_t i = 0; i < points.size(); ++i)
          ASSERT_EQ(locations[i], expected[i]) << name_of(mode) << ", point " << i;
      }
    });
  }
  return on;
}

// As it is with floats; of doubles also where no coordinate is a float.
struct Placement {
  double size;
  Double3 offset;
};
template <class T>
void expect_at_places(const Mesh& mesh, const std::vector<Float3>& points, std::size_t min_on,
                      const std::vector<Placement>& of_doubles) {
  if constexpr (std::is_same_v<T, float>) {
    EXPECT_GT(expect_locations(mesh, points), min_on);
  } else {
    for (const Placement& place : of_doubles) {
      SCOPED_TRACE(place.size);
      const DoubleMesh doubles = moved(mesh, place.size, place.offset);
      std::vector<Double3> some = doubles.vertices;
      const std::vector<Double3> others = moved({points, {}}, place.size, place.offset).vertices;
      some.insert(some.end(), others.begin(), others.begin() + std::ssize(others) / 3);
      EXPECT_GE(expect_locations(doubles, some), doubles.vertices.size());
    }
  }
}

template <class T>
class Locate : public ::testing::Test {};
TYPED_TEST_SUITE(Locate, Numbers, NumberNames);

TYPED_TEST(Locate, points_in_on_and_outside_of_closed_meshes) {
  for (const Mesh& mesh : {ellipsoid(1, {0, 0, 0}), double_fan(30, 0.25f), double_fan(30, 0.0f), cube(-1, 1)})
    expect_at_places<TypeParam>(mesh, points_around(mesh, by_level(500), 1.5f, 51), 20,
                                {{1, {0, 0, 0}}, {1e-3, {5e6, -4e6, 1e5}}, {3, {1e15, 7, -2e15}}});
}

Mesh nested_cubes() {
  Mesh mesh = cube(-1, 1);
  append(mesh, cube(-0.5f, 0.5f));  // pointing out: solid in solid
  append(mesh, cube(0, 2));         // overlaps
  return mesh;
}

TEST(LocateFloats, nested_and_overlapping_shells_by_either_rule) {
  Mesh mesh = nested_cubes();
  append(mesh, turned_over(cube(-0.25f, 0.25f), 1, 1));
  EXPECT_GT(expect_locations(mesh, points_around(mesh, by_level(600), 2.5f, 52)), 20u);
}

// In a cube whose sides are longer than the largest number, which rays to its far side cross beyond that.
TYPED_TEST(Locate, at_all_scales) {
  using T = TypeParam;
  const Mesh unit = double_fan(12, 0.25f);
  std::vector<Float3> points = points_around(unit, by_level(200), 1.5f, 53);
  for (const Float3& point : points_in_lines(unit, by_level(200), 1.25f, 61)) points.push_back(point);
  if constexpr (std::is_same_v<T, double>)
    return expect_at_places<T>(
        unit, points, 0, {{0x1p-900, {}}, {0x1p-250, {}}, {0x1p-130, {}}, {0x1p130, {}}, {0x1p1000, {}}});
  for (const float scaling : {1e-30f, 1e-12f, 1e12f, 1e30f, 1.5e38f}) {
    SCOPED_TRACE(scaling);
    Mesh mesh = unit, at{points, {}};
    scale(mesh, scaling), scale(at, scaling);
    expect_locations(mesh, at.vertices, scaling > 1e-20f);
  }
}

TEST(LocateFloats, points_in_lines_in_on_and_outside_of_closed_meshes) {
  for (const Mesh& mesh : {ellipsoid(1, {0, 0, 0}), double_fan(30, 0.25f), cube(-1, 1)})
    EXPECT_GT(expect_locations(mesh, points_in_lines(mesh, by_level(1200), 1.5f, 59)), 10u);
  const Mesh nested = nested_cubes();
  EXPECT_GT(expect_locations(nested, points_in_lines(nested, by_level(1200), 2.5f, 60)), 10u);
}

// A direction that matters is the line's, upwards, for each point that has a neighbour on it: whether floats decide the
// line or not, on every path, and for any number of threads.
TEST(LocateFloats, points_in_lines_of_open_meshes_by_the_direction_of_their_line) {
  Random random(62);
  Mesh mesh = ellipsoid(1, {0, 0, 0});
  append(mesh, triangle_soup(40, 1.0f, 63));
  std::erase_if(mesh.triangles, [&](const Index3&) { return random.chance(0.15); });
  const std::vector<Float3> points = points_in_lines(mesh, by_level(1200), 3.0f, 64);
  const Box bounds = Bvh(mesh).bounds();
  const auto is_in = [](const Box& box, const Float3& point) {
    bool in = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      in = in && box.lo[axis] <= point[axis] && point[axis] <= box.hi[axis];
    return in;
  };
  const auto shared = [&](std::size_t i, std::size_t axis) {
    for (std::size_t other = 0; other < 3; ++other)
      if (other != axis && points[i][other] != points[i + 1][other]) return false;
    return true;
  };
  std::vector<Location> expected(points.size());
  std::vector<bool> is_in_line(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const std::size_t begin : {i - 1, i})  // the line with the point before goes first
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (!is_in_line[i] && begin < points.size() - 1 && shared(begin, axis)) {
          Float3 up{};
          up[axis] = 1.0f;
          if (is_in(bounds, points[i]))  // others are outside, whatever is crossed
            expected[i] = oracle::exact_location(mesh, points[i], up);
          is_in_line[i] = true;
        }
  EXPECT_GT(std::ranges::count(is_in_line, true), static_cast<std::ptrdiff_t>(points.size() / 2));
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    std::vector<Location> locations(points.size()), by_threads(points.size());
    tree.locate(points, locations, {.path = path});
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      wrong += is_in_line[i] && locations[i] != expected[i] ? 1 : 0;
    EXPECT_EQ(wrong, 0u);
    tree.locate(points, by_threads, {.path = path, .threads = 3});
    EXPECT_EQ(locations, by_threads);
  });
}

// In a box without a lid, five of six rays say inside; above the rim, one of six does.
TEST(LocateFloats, a_box_without_a_lid_by_vote) {
  Mesh box = cube(-1, 1);
  std::erase_if(box.triangles, [&](const Index3& t) {
    return std::ranges::all_of(t, [&](std::uint32_t corner) { return box.vertices[corner][2] > 0; });
  });
  ASSERT_EQ(box.triangles.size(), 10u);
  using enum Location;
  const std::vector<Float3> points = {
      {0, 0, 0},  {0.5f, -0.25f, 0.99f}, {0, 0, 1},   {0, 0, 1.5f}, {0, 0, -2}, {1, 1, 1},
      {-1, 0, 0}, {0.9f, 0.9f, -0.9f},   {3, 3, 0.5f}};
  // In the plane of the rim rays pass above the walls: moved, they point up.
  const std::vector<Location> expected = {inside, inside, outside, outside, outside, on, on, inside, outside};
  each_tree(box, [&](const auto& tree, const Path* path) {
    std::vector<Location> locations(points.size());
    tree.locate(points, locations, {.rule = InsideRule::vote, .path = path});
    EXPECT_EQ(locations, expected);
  });
  EXPECT_GT(expect_locations(box, points_around(box, by_level(300), 1.5f, 56)), 10u);
}

TEST(LocateFloats, meshes_with_holes_by_vote) {
  Random random(57);
  for (Mesh mesh : {ellipsoid(1, {0, 0, 0}), double_fan(30, 0.25f), cube(-1, 1)}) {
    std::erase_if(mesh.triangles, [&](const Index3&) { return random.chance(0.15); });
    ASSERT_FALSE(is_closed(mesh));
    EXPECT_GT(expect_locations(mesh, points_around(mesh, by_level(300), 1.5f, 58)), 10u);
  }
}

// Three walls that meet in a corner: of its rays those to the walls cross them, three of six, and that is no majority.
TEST(LocateFloats, three_votes_of_six_are_outside) {
  const Mesh corner{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}}};
  const std::vector<Float3> points = {{0.25f, 0.25f, 0.25f}};
  Location location = Location::on;
  Bvh(corner).locate(points, std::span(&location, 1), {.rule = InsideRule::vote});
  EXPECT_EQ(location, Location::outside);
  Mesh more = corner;
  more.triangles.push_back({1, 2, 3});
  Bvh(more).locate(points, std::span(&location, 1), {.rule = InsideRule::vote});
  EXPECT_EQ(location, Location::inside);
}

TYPED_TEST(Locate, in_a_cube_of_all_numbers) {
  using T = TypeParam;
  constexpr T most = std::numeric_limits<T>::max();
  const auto share = [&](Random& random) { return static_cast<T>(random.real(-1, 1)) * T(0.94) * most; };
  auto mesh = mesh_of<T>(cube(-1, 1));
  for (auto& vertex : mesh.vertices)
    for (T& x : vertex) x *= T(0.955) * most;
  Random random(65);
  std::vector<PointOf<T>> points;
  for (std::size_t i = 0; i < by_level(1000); ++i) {
    PointOf<T> point{share(random), share(random), share(random)};
    for (int k = 0; k < 6; ++k) points.push_back(point), point[i % 3] = share(random);
  }
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    std::vector<Location> locations(points.size());
    for (std::size_t rule = 0; rule < inside_rule_names.size(); ++rule) {
      tree.locate(points, locations, {.rule = static_cast<InsideRule>(rule), .path = path});
      EXPECT_EQ(std::ranges::count(locations, Location::inside), std::ssize(points))
          << inside_rule_names[rule];
    }
    std::vector<T> numbers(points.size());
    tree.winding_numbers(points, numbers, {.path = path});
    EXPECT_EQ(numbers, std::vector<T>(points.size(), 1));
  });
}

TEST(LocateFloats, takes_any_points) {
  const Mesh mesh = cube(-1, 1);
  const Bvh bvh(mesh);
  const std::vector<Float3> points = {{nan, 0, 0},       {0, infinity, 0}, {0, 0, -infinity}, {0, 0, 0},
                                      {1e38f, 1e38f, 0}, {0, -0.0f, 1},    {1e-45f, 0, 0}};
  using enum Location;
  const std::vector<Location> expected = {outside, outside, outside, inside, outside, on, inside};
  std::vector<Location> locations(points.size());
  bvh.locate(points, locations);
  EXPECT_EQ(locations, expected);
  const std::uint8_t active = 0x08;
  locations.assign(points.size(), on);
  bvh.locate(points, locations, {.active = &active});
  EXPECT_EQ(locations, (std::vector<Location>{on, on, on, inside, on, on, on}));
  const std::vector<Float3> line = {{nan, 0.25f, 0}, {0.5f, 0.25f, 0}, {infinity, 0.25f, 0}, {-2, 0.25f, 0},
                                    {-1, 0.25f, 0},  {2, 0.25f, 0},    {-0.0f, 0.25f, 0}};
  bvh.locate(line, locations);
  EXPECT_EQ(locations, (std::vector<Location>{outside, inside, outside, outside, on, outside, inside}));
  locations.assign(points.size(), on);
  bvh.locate(line, locations, {.active = &active});
  EXPECT_EQ(locations, (std::vector<Location>{on, on, on, outside, on, on, on}));
  Bvh().locate(points, locations);
  EXPECT_EQ(locations, std::vector<Location>(points.size(), outside));
  EXPECT_THROW(bvh.locate(points, std::span(locations).first(2)), std::invalid_argument);
  EXPECT_THROW(bvh.locate(points, locations, {.rule = static_cast<InsideRule>(inside_rule_names.size())}),
               std::invalid_argument);
  EXPECT_THROW(bvh.locate(VertexView(nullptr, 7), locations), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::testing
