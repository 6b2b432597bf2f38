// Closest points by trees of floats and of doubles: the bytes that all triangles one by one give, whatever tree,
// builder, path and threads; and what rational numbers say of them.
#include "../doubles/both_numbers.hpp"
#include "../support/float_modes.hpp"
#include "../support/level.hpp"
#include "../support/message_of.hpp"
#include "every_tree.hpp"

namespace raylanes::testing {
namespace {

template <class T>
class ClosestPointsOf : public ::testing::Test {
 protected:
  static constexpr bool has_floats = std::is_same_v<T, float>;
  using AnyMesh = std::conditional_t<has_floats, Mesh, DoubleMesh>;
  using Tree = std::conditional_t<has_floats, Bvh, BvhD>;
  using Points = std::vector<PointOf<T>>;
  struct Case {
    std::string name;
    AnyMesh mesh;
  };

  // The oracle of doubles builds a tree for each triangle: fewer points.
  static std::size_t by_level(std::size_t of_floats, std::size_t of_doubles) {
    return has_floats ? testing::by_level(of_floats) : of_doubles;
  }
  // As it is with floats; of doubles moved and scaled, so that no coordinate is a float.
  static AnyMesh mesh_of(const Mesh& mesh, double factor = 1.0 / 3, const Double3& offset = {0.1, 0.2, 0.3}) {
    if constexpr (has_floats)
      return mesh;
    else
      return moved(mesh, factor, offset);
  }
  static Points some_points(const AnyMesh& mesh, std::size_t count, std::uint64_t seed) {
    if constexpr (has_floats) {
      Random random(seed);
      return points_for(mesh, count, random);
    } else {
      return points_for(mesh, count, seed);
    }
  }
  static Points some_clusters(const AnyMesh& mesh, std::size_t count) {
    if constexpr (has_floats) {
      Random random(2730);
      return clusters(mesh, static_cast<int>(count), 45, random);
    } else {
      return clusters(points_for(mesh, count, 22), size_of(mesh), 23);
    }
  }
  static std::vector<Case> cases() {
    std::vector<Case> all;
    if constexpr (has_floats) {
      for (NamedMesh& named : meshes()) all.push_back({named.name, std::move(named.mesh)});
    } else {
      for (DoubleCase& c : double_cases(0)) all.push_back({c.name, std::move(c.mesh)});
      all.push_back({"many", moved(ellipsoid(3, {0, 0, 0}), 1e-3, {5e6, -4e6, 1e5})});
      all.push_back({"doubled grid", moved(doubled(integer_grid(8)), 0.1, {1e5, 0, 0})});
      all.push_back({"slivers", moved(needles_and_slivers(120, 2712).across, 0.3, {7, 7, 7})});
    }
    return all;
  }
};
TYPED_TEST_SUITE(ClosestPointsOf, Numbers, NumberNames);

TYPED_TEST(ClosestPointsOf, trees_are_those_of_all_triangles) {
  for (const auto& [name, mesh] : this->cases()) {
    const auto points =
        this->some_points(mesh, this->by_level(900, by_level<std::size_t>(30, 90, 900)), 2715);
    const auto expected = one_by_one(mesh, points);
    expect_everywhere(mesh, points, expected, name);
    if constexpr (!TestFixture::has_floats) expect_near(mesh, points, expected, name);
    const std::vector some(points.begin(), points.begin() + std::min<std::ptrdiff_t>(4, std::ssize(points)));
    expect_everywhere(mesh, some, one_by_one(mesh, some, 0.5), name, 0.5);
    if (this->HasFatalFailure()) return;
  }
}

// Points so near to each other that they go through trees together.
TYPED_TEST(ClosestPointsOf, neighbours_have_the_bytes_of_points_alone) {
  for (const auto& [name, mesh] : this->cases()) {
    if (mesh.triangles.empty()) continue;
    const auto points = this->some_clusters(mesh, by_level<std::size_t>(10, 30, 60));
    const auto mosts = this->has_floats ? std::vector{infinite, 0.05, 0.0} : std::vector{infinite};
    for (const double most : mosts)
      expect_everywhere(mesh, points, one_by_one(mesh, points, most), name, most);
    if (this->HasFatalFailure()) return;
  }
}

TYPED_TEST(ClosestPointsOf, trees_keep_to_the_most_distance) {
  const auto mesh = this->mesh_of(triangle_soup(200, 0.2f, 2717), 1, {0, 0, 0});
  const auto points = this->some_points(mesh, this->by_level(100, 30), 2716);
  for (const double most : {0.0, -0.0, 0x1p-149, 1e-4, 0.1, 1.0, 3e38, -1.0, not_a_number, -infinite})
    expect_everywhere(mesh, points, one_by_one(mesh, points, most), std::to_string(most), most);
}

// Squares of distances round by more than triangles differ, and doubles decide between few of them.
TYPED_TEST(ClosestPointsOf, trees_are_found_from_far_away) {
  Random random(2724);
  Mesh aside = triangle_soup(150, 0.3f, 2725), small = ellipsoid(1, {0, 0, 0});
  for (Float3& vertex : aside.vertices) vertex[0] += 1000, vertex[2] -= 3;
  scale(small, 0x1p-70f);
  std::vector meshes{this->mesh_of(ellipsoid(2, {0, 0, 0}), 1, {0, 0, 0}),
                     this->mesh_of(integer_grid(8), 1, {0, 0, 0}), this->mesh_of(aside, 1, {0, 0, 0}),
                     this->mesh_of(small, 1, {0, 0, 0})};
  if (!TestFixture::has_floats) meshes.push_back(this->mesh_of(ellipsoid(2, {0, 0, 0}), 1, {5e9, -4e10, 7}));
  for (const auto& mesh : meshes) {
    const auto bounds = typename TestFixture::Tree(mesh.vertices, mesh.triangles).bounds();
    const auto extent = bounds.hi[0] - bounds.lo[0];
    typename TestFixture::Points points;
    for (const int exponent : {5, 6, 7, 10, 14, 20, 30, 39, 41})
      for (int i = 0; i < by_level(4, 8, 24); ++i) {
        Float3 way = random.point(1);
        if (i % 4 == 1) way[random.index(3)] = 0;
        if (i % 4 == 2) way = {0, 0, 0}, way[random.index(3)] = -1;
        auto& point = points.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) point[k] = bounds.lo[k] + std::ldexp(way[k] * extent, exponent);
      }
    const auto expect_exact = [&](const char* name) {
      expect_everywhere(mesh, points, one_by_one(mesh, points), name);
      const double most = std::ldexp(double{extent}, 10);
      expect_everywhere(mesh, points, one_by_one(mesh, points, most), name, most);
    };
    expect_exact("far");
    if constexpr (TestFixture::has_floats) {
      const FloatModeScope scope(FloatMode::flush);
      expect_exact("far, flushed");
    }
  }
}

TYPED_TEST(ClosestPointsOf, equal_distances_are_of_the_lowest_primitive) {
  const auto once = this->mesh_of(ellipsoid(1, {0, 0, 0}), 0.7, {1e6, 0, 0});
  auto twice = once;
  twice.triangles.insert(twice.triangles.end(), once.triangles.begin(), once.triangles.end());
  const auto points = this->some_points(once, 120, 27);
  expect_everywhere(twice, points, one_by_one(once, points), "twice");
  std::ranges::reverse(twice.triangles);
  const typename TestFixture::Tree tree(twice.vertices, twice.triangles);
  for (const auto& point : points) {
    const auto found = tree.closest_point(point);
    ASSERT_TRUE(!found || found.primitive < once.triangles.size());
  }
}

TYPED_TEST(ClosestPointsOf, corners_are_there) {
  for (const auto& [name, mesh] : this->cases()) {
    const typename TestFixture::Tree tree(mesh.vertices, mesh.triangles);
    for (const Index3& t : mesh.triangles) {
      const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      if (a == b || b == c || c == a) continue;
      for (const auto& corner : {a, b, c}) ASSERT_EQ(tree.closest_point(corner).distance_squared, 0) << name;
    }
  }
}

TYPED_TEST(ClosestPointsOf, any_bits) {
  using T = TypeParam;
  constexpr T most = std::numeric_limits<T>::max(), inf = std::numeric_limits<T>::infinity();
  const T numbers[] = {0,    T(-0.0), T(5e6), std::numeric_limits<T>::denorm_min(), T(-1e30),
                       most, -most,   inf,    std::numeric_limits<T>::quiet_NaN()};
  const auto mesh = this->mesh_of(double_fan(24, 0.3f), 1e-3, {5e6, 4e5, -5e6});
  typename TestFixture::Points points;
  std::size_t finite = 0;
  for (const T x : numbers)
    for (const T y : numbers)
      for (const T z : numbers) {
        points.push_back({x, y, z});
        finite += std::isfinite(x) && std::isfinite(y) && std::isfinite(z) ? 1 : 0;
      }
  const typename TestFixture::Tree tree(mesh.vertices, mesh.triangles), empty;
  std::vector<ClosestPointOf<T>> found(points.size());
  tree.closest_points(points, found, {.path = &paths().front()});
  EXPECT_EQ(std::ranges::count_if(found, [](const auto& closest) { return static_cast<bool>(closest); }),
            static_cast<std::ptrdiff_t>(finite));
  expect_everywhere(mesh, points, found, "any bits");
  for (const auto& point : points) ASSERT_TRUE(same_bytes(empty.closest_point(point), ClosestPointOf<T>()));
  if constexpr (!TestFixture::has_floats)
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!found[i]) continue;
      ASSERT_EQ(fault_of_closest_point(mesh, points[i], found[i]), "") << i;
    }
}

TEST(ClosestPointsOfTrees, have_every_scale) {
  Random random(2718);
  const Mesh soup = triangle_soup(150, 0.3f, 2719);
  for (const int exponent : {-140, -120, -100, -60, 60, 90, 120}) {
    const Mesh mesh = scaled(soup, exponent);
    std::vector<Float3> points = points_for(soup, 100, random);
    for (const Float3& point : clusters(soup, by_level(6, 30, 30), 45, random)) points.push_back(point);
    for (std::size_t i = 4; i < points.size(); ++i)
      for (float& x : points[i]) x = std::ldexp(x, exponent);
    expect_everywhere(mesh, points, one_by_one(mesh, points), "2^" + std::to_string(exponent));
    const FloatModeScope scope(FloatMode::flush);
    expect_everywhere(mesh, points, one_by_one(mesh, points), "flushed 2^" + std::to_string(exponent));
  }
}

// More triangles at the same distance than can wait.
TEST(ClosestPointsOfTrees, wait_in_turns) {
  Random random(2733);
  const Triangle t = random.triangle(1, {5, 0, 0});
  Mesh mesh = triangle_soup(20, 0.2f, 2734);
  for (int i = 0; i < 200; ++i) append(mesh, t);
  std::vector<Float3> points;
  for (int i = 0; i < 300; ++i) points.push_back(random.point(0.01f, {5, 0.5f, 1}));
  expect_everywhere(mesh, points, one_by_one(mesh, points), "the same triangles");
}

// Small and large numbers in one mesh.
TEST(ClosestPointsOfTrees, have_all_scales_at_once) {
  Random random(2720);
  Mesh mesh;
  for (const int exponent : {-140, -100, -50, 0, 50, 100, 126})
    append(mesh, scaled(triangle_soup(30, 0.5f, 2721), exponent));
  std::vector<Float3> points = points_for(mesh, 200, random);
  for (std::size_t i = 4; i < points.size(); ++i)
    for (float& x : points[i])
      if (!std::isfinite(x)) x = 0;
  expect_everywhere(mesh, points, one_by_one(mesh, points), "all scales");
  const FloatModeScope scope(FloatMode::flush);
  expect_everywhere(mesh, points, one_by_one(mesh, points), "all scales, flushed");
}

// Not only what the text of doubles says: rationals, over all triangles.
TEST(ClosestPointsOfTrees, are_the_nearest_by_rationals) {
  Random random(2722);
  const Mesh mesh = triangle_soup(60, 0.4f, 2723);
  const std::vector<Triangle> triangles = triangles_of(mesh);
  const std::vector<Float3> points = points_for(mesh, by_level(200), random);
  const Bvh bvh(mesh);
  for (std::size_t i = 4; i < points.size(); ++i) {
    const ClosestPoint found = bvh.closest_point(points[i]);
    mpq_class least = -1, reach = 0;
    for (const Triangle& t : triangles) {
      const mpq_class d = oracle::exact_square_of_distance(points[i], t);
      if (least < 0 || d < least) least = d;
      reach = std::max<mpq_class>(reach, square_of_reach({points[i], t}));
    }
    ASSERT_TRUE(found) << i;
    EXPECT_LE(abs(mpq_class(found.distance_squared) - least), mpq_class(0x1p-46) * reach) << i;
    const Triangle& t = triangles[found.primitive];
    const Float3 at = found.point;
    EXPECT_LE(oracle::exact_square_of_distance(at, t), mpq_class(0x1p-44)) << i;  // rounded to floats
    EXPECT_NEAR(std::hypot(at[0] - points[i][0], at[1] - points[i][1], at[2] - points[i][2]),
                std::sqrt(found.distance_squared), 1e-6 * (1 + std::sqrt(found.distance_squared)));
  }
}

TEST(ClosestPointsOfTrees, refuse_paths_of_other_machines) {
  const Bvh bvh(triangle_soup(10, 0.2f, 2737));
  expect_foreign_path_refused<ClosestPointOptions>(
      [&](const ClosestPointOptions& options, const auto& check) {
        check("closest_point", [&] { bvh.closest_point({}, options); });
      });
}

}  // namespace
}  // namespace raylanes::testing
