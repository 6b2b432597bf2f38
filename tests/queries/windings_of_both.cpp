// Winding numbers of meshes of floats and of doubles: against solid angles of all triangles, and by what must hold
// exactly.
#include <raylanes/numbers.hpp>

#include "../doubles/both_numbers.hpp"
#include "chord_meshes.hpp"
#include "open_meshes.hpp"

namespace raylanes::testing {
namespace {

// The place of a mesh of doubles; floats lie as they are.
struct Placement {
  double size;
  Double3 offset;
};
constexpr Placement as_it_is{1, {0, 0, 0}};

template <class T>
class WindingsOf : public ::testing::Test {
 protected:
  static constexpr bool has_floats = std::is_same_v<T, float>;
  using Points = std::vector<PointOf<T>>;

  static std::vector<Placement> places(const std::vector<Placement>& of_doubles) {
    return has_floats ? std::vector{as_it_is} : of_doubles;
  }
  static auto mesh_at(const Placement& place, const Mesh& mesh) {
    if constexpr (has_floats)
      return mesh;
    else
      return moved(mesh, place.size, place.offset);
  }
  static auto points_at(const Placement& place, const std::vector<Float3>& points) {
    return mesh_at(place, Mesh{points, {}}).vertices;
  }
  // As many as the oracle has time for.
  static Points some_points(const auto& mesh, std::size_t of_floats, std::size_t of_doubles,
                            std::uint64_t seed) {
    if constexpr (has_floats)
      return points_around(mesh, of_floats, 1.5f, seed);
    else
      return points_around(mesh, of_doubles, seed);
  }
  // The tree that most calls use.
  static auto tree_of(const auto& mesh) {
    return std::conditional_t<has_floats, Bvh, BvhD>(mesh.vertices, mesh.triangles);
  }
  static std::vector<T> numbers_of(const auto& tree, const Points& points,
                                   const WindingOptions& options = {}) {
    std::vector<T> numbers(points.size(), -99);
    tree.winding_numbers(points, numbers, options);
    return numbers;
  }
  // In any order, so that most have rays of their own, and sorted, so that many share the rays of rows.
  template <class... Ordinary>
  static void expect_in_both_orders(const auto& mesh, Points points, std::size_t count, Random& random,
                                    Ordinary... is_ordinary) {
    for (std::size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random.index(i)]);
    points.resize(std::min(points.size(), count));
    EXPECT_GT(expect_windings(mesh, points, is_ordinary...), points.size() / 4);
    std::ranges::sort(points);
    EXPECT_GT(expect_windings(mesh, points, is_ordinary...), points.size() / 4);
  }
};
TYPED_TEST_SUITE(WindingsOf, Numbers, NumberNames);

TYPED_TEST(WindingsOf, meshes_with_holes_near_and_far) {
  const Mesh sphere = ellipsoid(1, {0, 0, 0});
  for (const double share : {0.02, 0.3, 0.9})
    for (const Placement& place :
         this->places({{0.7, {0.1, 0, -3}}, {1e-3, {5e6, -4e6, 3e5}}, {1, {1e12, 1, 1}}})) {
      SCOPED_TRACE(place.size);
      const auto mesh = this->mesh_at(place, without(sphere, share, 81));
      const auto points = this->some_points(mesh, by_level(200), by_level<std::size_t>(40, 150, 1000), 82);
      EXPECT_GT(expect_windings(mesh, points), this->has_floats ? 10u : 5u);
    }
}

// Squares of distances, and areas of triangles, leave the range of numbers.
TYPED_TEST(WindingsOf, meshes_of_all_sizes) {
  using T = TypeParam;
  const Mesh open = without(double_fan(12, 0.25f), 0.3, 95);
  const Mesh around{points_around(open, by_level<std::size_t>(20, 40, 400), 1.25f, 96), {}};
  const std::vector<double> sizes = this->has_floats
                                        ? std::vector{1e-38, 1e-30, 1e-12, 1e12, 1e30, 1.5e38}
                                        : std::vector{0x1p-1070, 0x1p-1000, 0x1p-300, 0x1p-100, 0x1p100,
                                                      0x1p300,   0x1p600,   0x1p1000, 0x1p1022};
  for (const double size : sizes) {
    SCOPED_TRACE(std::log2(size));
    const auto sized = [&](const Mesh& of) {
      auto mesh = mesh_of<T>(of);
      for (auto& vertex : mesh.vertices)
        for (T& x : vertex) x = static_cast<T>(size * double{x});
      return mesh;
    };
    expect_windings(sized(open), sized(around).vertices, this->has_floats || size > 0x1p-200);
  }
}

TYPED_TEST(WindingsOf, points_far_from_the_mesh) {
  for (const Placement& place : this->places({as_it_is, {0x1p-900, {0, 0, 0}}, {0x1p900, {0, 0, 0}}})) {
    const auto mesh = this->mesh_at(place, without(ellipsoid(1, {0, 0, 0}), 0.2, 97));
    auto points = this->some_points(mesh, by_level(40), 10, 98);
    for (const double size : {1.0, place.size})
      for (const double far : {1e3, 1e10, 1e20, 3e38, 1e100, 1e200, 1e300, 1.7e308}) {
        if (far * size > double{std::numeric_limits<TypeParam>::max()}) break;
        const auto at = static_cast<TypeParam>(far * size);
        points.push_back({at, -at, at / 2}), points.push_back({0, 0, at});
      }
    expect_windings(mesh, points);
  }
}

TYPED_TEST(WindingsOf, triangles_that_have_nothing_in_common) {
  for (const Placement& place : this->places({{1e-3, {5e6, 0, 1e6}}})) {
    const auto soup = this->mesh_at(place, triangle_soup(this->has_floats ? 200 : 100, 1.0f, 90));
    EXPECT_GT(expect_windings(soup, this->some_points(soup, by_level(150), by_level(60), 91)), 10u);
  }
}

TYPED_TEST(WindingsOf, chords_of_flat_and_rough_holes) {
  Random random(401);
  const std::size_t count = this->has_floats ? by_level(600) : by_level<std::size_t>(60, 60, 300);
  for (const auto& [axis, roughness] : {std::pair<std::size_t, int>{2, 0}, {0, 0}, {1, 1}, {2, 3}})
    for (const Placement& place : this->places({as_it_is,
                                                {0x1p-10, {0x1p22, -0x1p21, 0x1p20}},
                                                {0x1p-1000, {0, 0, 0}},
                                                {0x1p1019, {0, 0, 0}}})) {
      SCOPED_TRACE(::testing::Message()
                   << "axis " << axis << ", roughness " << roughness << ", size " << place.size);
      const HoledCube cube(axis, roughness, 402 + axis);
      EXPECT_EQ(cube.rim.size(), 24u);
      const auto points = this->points_at(place, points_of_chords(cube.rim, 400, random));
      this->expect_in_both_orders(this->mesh_at(place, cube.mesh), points, count, random);
    }
}

// Chords that pass the origin, and points so near to it that differences to corners lose them.
TYPED_TEST(WindingsOf, points_beside_chords_at_all_distances) {
  Random random(403);
  const std::vector<double> steps =
      this->has_floats ? std::vector{0.0, 0x1p-149, 0x1p-100, 0x1p-60, 0x1p-40, 0x1p-26, 0x1p-13, 0x1p-3}
                       : std::vector{0.0,      0x1p-1074, 0x1p-1000, 0x1p-600, 0x1p-300,
                                     0x1p-100, 0x1p-52,   0x1p-26,   0x1p-13,  0x1p-3};
  std::vector<PointOf<TypeParam>> points;
  for (std::size_t i = 0; i < (this->has_floats ? by_level(600) : by_level<std::size_t>(30, 50, 300)); ++i) {
    PointOf<TypeParam> point;
    for (TypeParam& x : point) {
      const double step = steps[random.index(steps.size())];
      x = static_cast<TypeParam>(step * random.real(-2, 2));
    }
    points.push_back(point);
  }
  for (const Placement& place : this->places({as_it_is, {0x1p60, {0, 0, 0}}})) {
    const auto cone = this->mesh_at(place, cone_around(0, 2, 404));
    if constexpr (std::is_same_v<TypeParam, float>)
      this->expect_in_both_orders(cone, points, points.size(), random);
    else
      this->expect_in_both_orders(cone, points, points.size(), random, false);
  }
}

// Rows on chords along an axis, whose rays go along the chord.
TYPED_TEST(WindingsOf, rows_along_chords) {
  for (const Placement& place : this->places({as_it_is, {0x1p-1000, {0, 0, 0}}, {0x1p1010, {0, 0, 0}}}))
    for (std::uint64_t seed = 0; seed < (quick() || !this->has_floats ? 3u : 8u); ++seed)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        SCOPED_TRACE(axis);
        std::vector<Float3> points(31);
        for (int k = 0; k < 31; ++k)
          points[static_cast<std::size_t>(k)][axis] = static_cast<float>(k - 15) / 2;
        const auto cone = this->mesh_at(place, cone_around(axis, 9, seed));
        EXPECT_GE(expect_windings(cone, this->points_at(place, points)), 20u);
      }
}

// The edge passes so near to the point that the triangle is a lune: from below the point, along −z, to the third
// corner. Products of the large coordinate hide the small ones.
TYPED_TEST(WindingsOf, a_point_beside_an_edge_of_large_and_small_coordinates) {
  using T = TypeParam;
  const double slope = std::atan(0.25 / 4), pi = std::numbers::pi;
  for (const double large : this->has_floats ? std::vector{0x1p40, 0x1p56, 0x1p60, 0x1p100}
                                             : std::vector{0x1p60, 0x1p100, 0x1p500, 0x1p1000, 0x1p1023})
    for (const double drop : {0.5, 0x1p-54, -0x1p-53})  // below the point, or above it
      for (const bool is_turned : {false, true}) {
        if (this->has_floats && drop != 0.5) continue;
        SCOPED_TRACE(::testing::Message() << large << ' ' << drop);
        decltype(this->mesh_at(as_it_is, Mesh())) mesh;
        mesh.vertices = {
            {0, 1, T{0.5}}, {0, static_cast<T>(-large), static_cast<T>(0.5 - drop)}, {4, 0, T{0.75}}};
        mesh.triangles = {is_turned ? Index3{1, 0, 2} : Index3{0, 1, 2}};
        const double lune = (drop > 0 ? -pi / 2 - slope : pi / 2 - slope) / (2 * pi);
        each_tree(mesh, [&](const auto& tree, const Path* path) {
          const auto numbers = this->numbers_of(tree, {{0, 0, T{0.5}}}, {.path = path});
          EXPECT_NEAR(numbers[0], is_turned ? -lune : lune, 1.5e-6);
        });
      }
}

// As count_crossings() counts them for a ray anywhere: nested, turned over and overlapping shells.
TYPED_TEST(WindingsOf, closed_meshes_have_whole_numbers) {
  Mesh shells = cube(-1, 1);
  append(shells, cube(-0.5f, 0.5f));
  append(shells, this->has_floats ? cube(0, 2) : ellipsoid(1, {0.5f, 0.5f, 0}));
  append(shells, turned_over(cube(-0.25f, 0.25f), 1.0, 1));
  for (const Placement& place :
       this->places({{1e-3, {5e6, 5e6, -5e6}}, {0x1p-900, {0, 0, 0}}, {0x1p900, {0, 0, 0}}})) {
    const auto mesh = this->mesh_at(place, shells);
    auto points = this->some_points(mesh, by_level(500), by_level(300), 99);
    std::erase_if(points, [&](const auto& point) { return is_on(mesh, point); });
    std::vector<RayOf<TypeParam>> rays;
    for (const auto& point : points)
      rays.push_back({point, 0, {TypeParam(0.31), TypeParam(-0.73), TypeParam(0.59)}});
    std::vector<CrossingCount> counts(points.size());
    this->tree_of(mesh).count_crossings(rays, counts);
    each_tree(mesh, [&](const auto& tree, const Path* path) {
      std::vector<Location> locations(points.size());
      tree.locate(points, locations, {.rule = InsideRule::winding, .path = path});
      const auto numbers = this->numbers_of(tree, points, {.path = path});
      for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ(numbers[i], static_cast<TypeParam>(counts[i].winding)) << "point " << i;
        ASSERT_EQ(locations[i], counts[i].winding > 0 ? Location::inside : Location::outside)
            << "point " << i;
      }
    });
  }
}

// The mean of both sides on a triangle; whatever a point on an edge has lies between those around it.
TYPED_TEST(WindingsOf, points_on_the_surface) {
  for (const Placement& place : this->places({as_it_is, {1, {0x1p40, -0x1p41, 0x1p42}}})) {
    const auto points = this->points_at(place, {{0.25f, 0.5f, 1},
                                                {0.25f, 0.5f, -1},
                                                {-1, 0.5f, 0.25f},
                                                {0, 1, 0.5f},
                                                {1, 1, 1},
                                                {0, 0, 1},
                                                {0, 1, 1}});
    const auto numbers = this->numbers_of(this->tree_of(this->mesh_at(place, cube(-1, 1))), points);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(numbers[i], TypeParam{0.5});
    for (std::size_t i = 4; i < points.size(); ++i) EXPECT_TRUE(numbers[i] >= 0 && numbers[i] <= 1) << i;
  }
}

// Sheets so near to each other that t of a crossing rounds to zero, or is flushed: the point is on the first alone.
TYPED_TEST(WindingsOf, sheets_behind_a_point_at_the_least_distances) {
  constexpr TypeParam least = std::numeric_limits<TypeParam>::denorm_min();
  decltype(this->mesh_at(as_it_is, Mesh())) mesh;
  for (const TypeParam height : {TypeParam{0}, least, -1024 * least})
    append(mesh, {-8, -8, height}, {8, -8, height}, {0, 8, height});
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    for (const FloatMode mode : float_modes) {
      if (mode == FloatMode::flush && !this->has_floats) continue;
      const FloatModeScope scope(mode);
      const auto numbers = this->numbers_of(
          tree, {{0, 0, 0}, {TypeParam{0.5}, -1, 0}, {0, 0, least}, {0, 0, -1024 * least}}, {.path = path});
      EXPECT_EQ(numbers, (std::vector<TypeParam>{0, 0, -1, 1})) << name_of(mode);
    }
  });
}

TYPED_TEST(WindingsOf, the_rule_of_inside_by_half) {
  for (const Placement& place : this->places({{1e-3, {5e6, 0, 1e6}}})) {
    const auto mesh = this->mesh_at(place, without(ellipsoid(1, {0, 0, 0}), 0.15, 101));
    const auto points = this->some_points(mesh, by_level(600), by_level(600), 102);
    each_tree(mesh, [&](const auto& tree, const Path* path) {
      const std::size_t inside = expect_rule_of_inside(mesh, tree, path, points);
      EXPECT_GT(inside, points.size() / 20);
    });
  }
}

TYPED_TEST(WindingsOf, a_mesh_that_is_refitted_and_a_tree_that_is_moved) {
  const Mesh hole = without(ellipsoid(1, {0, 0, 0}), 0.1, 107);
  Mesh other = hole;
  for (Float3& vertex : other.vertices) vertex = {1.5f * vertex[0], vertex[1] - 0.25f, 0.75f * vertex[2]};
  for (const Placement& place : this->places({{2, {1, 2, 3}}})) {
    const auto mesh = this->mesh_at(as_it_is, hole), then = this->mesh_at(place, other);
    const auto points = this->some_points(then, 300, 2000, 108);
    auto tree = this->tree_of(mesh);
    this->numbers_of(tree, points);
    tree.refit(then.vertices, then.triangles);
    const auto built = this->numbers_of(this->tree_of(then), points);
    EXPECT_TRUE(same_bytes(this->numbers_of(tree, points), built));
    const auto taken = std::move(tree);
    EXPECT_TRUE(same_bytes(this->numbers_of(taken, points), built));
  }
}

TYPED_TEST(WindingsOf, no_triangles_points_that_are_not_finite_and_what_is_refused) {
  using T = TypeParam;
  constexpr T none = std::numeric_limits<T>::quiet_NaN(), far = std::numeric_limits<T>::infinity();
  const std::vector<PointOf<T>> points = {{none, 0, 0}, {0, far, 0}, {0, 0, -far}, {0, 0, 0}};
  const auto numbers_at = [&](const Mesh& mesh) {
    return this->numbers_of(this->tree_of(this->mesh_at(as_it_is, mesh)), points);
  };
  EXPECT_EQ(numbers_at({}), std::vector<T>(4));
  EXPECT_EQ(numbers_at(cube(-1, 1)), (std::vector<T>{0, 0, 0, 1}));
  const std::vector<T> open = numbers_at(without(cube(-1, 1), 0.3, 109));
  EXPECT_EQ(open[0] + open[1] + open[2], 0);
  const auto tree = this->tree_of(this->mesh_at(as_it_is, cube(-1, 1)));
  tree.winding_numbers(std::vector<PointOf<T>>(), {});
  std::vector<T> numbers(4), few(2);
  EXPECT_THROW(tree.winding_numbers(points, few), std::invalid_argument);
  for (const double accuracy : {-1e-9, -1.0, static_cast<double>(none)})
    EXPECT_THROW(tree.winding_numbers(points, numbers, {.accuracy = accuracy}), std::invalid_argument);
  EXPECT_THROW(tree.winding_numbers(points, numbers, {.threads = -1}), std::invalid_argument);
  EXPECT_THROW(tree.winding_numbers({nullptr, 4}, numbers), std::invalid_argument);
  tree.winding_numbers(points, numbers, {.accuracy = static_cast<double>(far)});
  EXPECT_EQ(numbers[3], 1);
}

}  // namespace
}  // namespace raylanes::testing
