// Closest points and signed distances of trees of doubles: against rational numbers, and against trees of one triangle.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "../support/float_modes.hpp"
#include "../support/guarded_array.hpp"
#include "../support/message_of.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity(),
                 not_a_number = std::numeric_limits<double>::quiet_NaN(),
                 largest = std::numeric_limits<double>::max();

// At corners, on edges and faces, a step of a double beside them, anywhere, and far away.
std::vector<Double3> points_for(const DoubleMesh& mesh, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Double3> points;
  for (const RayD& ray : aimed_rays(mesh, count / 3, seed)) {
    Double3 target = ray.origin;
    for (std::size_t k = 0; k < 3; ++k) target[k] += ray.direction[k];
    points.push_back(ray.origin), points.push_back(target);
    for (double& x : target) x = std::nextafter(x, random.chance(0.5) ? infinite : -infinite);
    points.push_back(target);
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 5 + mesh.vertices.size() / 20)
    points.push_back(mesh.vertices[i]);
  for (Double3& point : points)
    for (double& x : point) x = std::isnan(x) ? 0 : std::clamp(x, -largest, largest);
  return points;
}
// Points so near to each other that they go together.
std::vector<Double3> clusters(const std::vector<Double3>& points, double size, std::uint64_t seed) {
  Random random(seed);
  std::vector<Double3> result;
  for (const Double3& point : points) {
    const double off = random.chance(0.2) ? 0.0 : size * std::ldexp(1.0, random.integer(-20, -4));
    for (int i = 0; i < 40; ++i) {
      result.push_back(point);
      for (double& x : result.back()) x += off * random.real(-1, 1);
    }
  }
  return result;
}
double size_of(const DoubleMesh& mesh) {
  double size = 0;
  for (const Double3& v : mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k)
      size = std::max(size, std::abs(0.5 * v[k] - 0.5 * mesh.vertices[0][k]));
  return size;
}

std::vector<ClosestPointD> closest_of(const BvhD& tree, std::span<const Double3> points,
                                      const ClosestPointOptionsD& options = {}) {
  std::vector<ClosestPointD> closest(points.size());
  tree.closest_points(points, closest, options);
  return closest;
}
void expect_same(const std::vector<ClosestPointD>& found, const std::vector<ClosestPointD>& expected,
                 const std::string& name) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_TRUE(same_bytes(found[i], expected[i]))
        << name << ", point " << i << ": " << found[i].primitive << " at " << found[i].distance << ", not "
        << expected[i].primitive << " at " << expected[i].distance;
}

// The least of all triangles, each in a tree of its own; compared where no square leaves the range of doubles.
std::vector<ClosestPointD> one_by_one(const DoubleMesh& mesh, std::span<const Double3> points,
                                      double most = infinite) {
  const double size = size_of(mesh);
  const int exponent = size > 0x1p400 ? -900 : size < 0x1p-400 && size > 0 ? 900 : 0;
  const auto scaled = [&](std::span<const Double3> some) {
    std::vector<Double3> result(some.begin(), some.end());
    for (Double3& p : result)
      for (double& x : p) x = std::ldexp(x, exponent);
    return result;
  };
  const std::vector<Double3> vertices = scaled(mesh.vertices), to = scaled(points);
  std::vector<ClosestPointD> closest(points.size());
  std::vector<double> least(points.size(), infinite);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::vector<Index3> triangle{mesh.triangles[t]};
    const BvhD tree(mesh.vertices, triangle), of_scaled(vertices, triangle);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ClosestPointD here = tree.closest_point(points[i], {.max_distance = most, .path = &paths().front()});
      if (!here) continue;
      const double square = exponent == 0
                                ? here.distance_squared
                                : of_scaled.closest_point(to[i], {.path = &paths().front()}).distance_squared;
      if (!(square < least[i])) continue;
      here.primitive = static_cast<std::uint32_t>(t);
      closest[i] = here, least[i] = square;
    }
  }
  return closest;
}

// By every builder, on every path, in batches and alone.
void expect_everywhere(const DoubleMesh& mesh, std::span<const Double3> points,
                       const std::vector<ClosestPointD>& expected, const std::string& name,
                       double most = infinite) {
  for (const TreeBuilder builder : {TreeBuilder::binned_sah, TreeBuilder::morton, TreeBuilder::median}) {
    const BvhD tree(mesh.vertices, mesh.triangles, {.builder = builder});
    for (const Path* path : supported_paths()) {
      const std::string of_path = name + " on " + path->name;
      for (const int threads : {1, 2})
        expect_same(closest_of(tree, points, {.max_distance = most, .path = path, .threads = threads}),
                    expected, of_path);
      std::vector<ClosestPointD> single;
      for (const Double3& point : points)
        single.push_back(tree.closest_point(point, {.max_distance = most, .path = path}));
      expect_same(single, expected, of_path + ", alone");
    }
    if (::testing::Test::HasFatalFailure()) return;
  }
}

mpq_class square(double x) {
  return mpq_class(x) * mpq_class(x);
}

void expect_near(const DoubleMesh& mesh, std::span<const Double3> points,
                 const std::vector<ClosestPointD>& found, const std::string& name) {
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_EQ(fault_of_closest_point(mesh, points[i], found[i]), "") << name << ", point " << i;
}

TEST(DoubleClosestPoints, are_near_by_rationals_and_the_least_of_all_triangles) {
  for (const DoubleCase& c : double_cases(0)) {
    const std::vector<Double3> points = points_for(c.mesh, by_level<std::size_t>(30, 90, 900), 21);
    const std::vector<ClosestPointD> found = closest_of(BvhD(c.mesh.vertices, c.mesh.triangles), points);
    expect_near(c.mesh, points, found, c.name);
    expect_same(found, one_by_one(c.mesh, points), c.name);
    expect_everywhere(c.mesh, points, found, c.name);
    if (HasFatalFailure()) return;
  }
}

TEST(DoubleClosestPoints, go_together_as_they_go_alone) {
  for (const DoubleCase& c : double_cases(0)) {
    const std::vector<Double3> points =
        clusters(points_for(c.mesh, by_level<std::size_t>(12, 30, 300), 22), size_of(c.mesh), 23);
    const BvhD tree(c.mesh.vertices, c.mesh.triangles);
    std::vector<ClosestPointD> alone;
    for (const Double3& point : points)
      alone.push_back(tree.closest_point(point, {.path = &paths().front()}));
    expect_same(alone, one_by_one(c.mesh, points), c.name);
    expect_everywhere(c.mesh, points, alone, c.name);
    if (HasFatalFailure()) return;
  }
}

// Many triangles: leaves of all sizes, and lists of those that wait.
TEST(DoubleClosestPoints, of_many_triangles) {
  const struct {
    Mesh mesh;
    double factor;
    Double3 offset;
  } cases[] = {{ellipsoid(3, {0, 0, 0}), 1.0 / 3, {0.1, 0.2, 0.3}},
               {ellipsoid(3, {0, 0, 0}), 1e-3, {5e6, -4e6, 1e5}},
               {doubled(integer_grid(8)), 0.1, {1e5, 0, 0}},
               {needles_and_slivers(120, 2712).across, 0.3, {7, 7, 7}}};
  for (const auto& [of_floats, factor, offset] : cases) {
    const DoubleMesh mesh = moved(of_floats, factor, offset);
    std::vector<Double3> points = points_for(mesh, by_level<std::size_t>(30, 90, 900), 24);
    for (const Double3& point :
         clusters(points_for(mesh, by_level<std::size_t>(3, 6, 30), 25), size_of(mesh), 26))
      points.push_back(point);
    expect_everywhere(mesh, points, one_by_one(mesh, points), "many");
    if (HasFatalFailure()) return;
  }
}

TEST(DoubleClosestPoints, are_zero_at_corners) {
  for (const DoubleCase& c : double_cases(0)) {
    const BvhD tree(c.mesh.vertices, c.mesh.triangles);
    for (const Index3& t : c.mesh.triangles)
      for (const std::uint32_t corner : t) {
        const ClosestPointD found = tree.closest_point(c.mesh.vertices[corner]);
        if (!found) continue;
        ASSERT_TRUE(found.distance == 0 && found.distance_squared == 0) << c.name;
      }
  }
}

TEST(DoubleClosestPoints, of_equal_distances_the_lowest_primitive) {
  const DoubleMesh once = moved(ellipsoid(1, {0, 0, 0}), 0.7, {1e6, 0, 0});
  DoubleMesh twice = once;
  twice.triangles.insert(twice.triangles.end(), once.triangles.begin(), once.triangles.end());
  const std::vector<Double3> points = points_for(once, 120, 27);
  expect_everywhere(twice, points, one_by_one(once, points), "twice");
  std::ranges::reverse(twice.triangles);
  for (const ClosestPointD& found : closest_of(BvhD(twice.vertices, twice.triangles), points))
    ASSERT_LT(found.primitive, once.triangles.size());
}

// The square of most is compared exactly: of neighbours of the root, those count whose square is not below.
TEST(DoubleClosestPoints, keep_to_the_most_distance) {
  for (const double factor : {1.0, 0x1p300, 0x1p-300, 0x1p1000, 0x1p-1000}) {
    const DoubleMesh mesh = moved(triangle_soup(60, 0.3f, 2717), factor, {0, 0, 0});
    const std::vector<Double3> points = points_for(mesh, 60, 28);
    const BvhD tree(mesh.vertices, mesh.triangles);
    for (const Path* path : supported_paths())
      for (const Double3& point : points) {
        const ClosestPointD found = tree.closest_point(point, {.path = path});
        if (!std::isfinite(found.distance)) continue;
        // In units in which the square is a double.
        const double unit = factor, in_units = tree.closest_point(point).distance / unit;
        if (!(in_units > 0x1p-400 && in_units < 0x1p400)) continue;
        for (double most = std::nextafter(found.distance, 0.0);
             most <= std::nextafter(found.distance, infinite); most = std::nextafter(most, infinite)) {
          const ClosestPointD near = tree.closest_point(point, {.max_distance = most, .path = path});
          if (most < found.distance) {
            ASSERT_TRUE(!near || found.distance_squared <= most * most) << most;
          }
          if (most > found.distance) {
            ASSERT_TRUE(same_bytes(near, found)) << most;
          }
          if (factor == 1.0 && found.distance_squared > 0x1p-800) {
            ASSERT_EQ(static_cast<bool>(near), mpq_class(found.distance_squared) <= square(most)) << most;
          }
        }
      }
    for (const double most : {-1.0, not_a_number, -infinite})
      for (const ClosestPointD& found : closest_of(tree, points, {.max_distance = most}))
        ASSERT_TRUE(same_bytes(found, ClosestPointD()));
    for (const double most : {0.0, 0.25 * factor, largest})
      expect_everywhere(mesh, points, one_by_one(mesh, points, most), "most", most);
    if (HasFatalFailure()) return;
  }
}

// Numbers of all sizes in one mesh, and planes that are far thinner than their coordinates.
TEST(DoubleClosestPoints, have_all_scales_at_once) {
  DoubleMesh mesh;
  const auto append = [&](const Mesh& of_floats, double factor, const Double3& offset) {
    const DoubleMesh part = moved(of_floats, factor, offset);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Index3& t : part.triangles)
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  };
  for (const int exponent : {-1070, -900, -500, -100, 0, 100, 400, 900})
    append(triangle_soup(12, 0.5f, 2721), std::ldexp(1.0, exponent), {0, 0, 0});
  DoubleMesh flat;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const double y = i * 1e-300;
    const Double3 corners[] = {{1e300, y, 0}, {1e300, y + 1e-300, 0}, {1e300, y, 1e-300}};
    flat.vertices.insert(flat.vertices.end(), std::begin(corners), std::end(corners));
    flat.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  DoubleMesh far;  // seen from 2^62 sizes away, 2^80 from zero
  for (std::uint32_t i = 0; i < 40; ++i) {
    const double y = i % 7, z = i;
    const Double3 corners[] = {{0x1p80, y, z}, {0x1p80, y + 1, z}, {0x1p80, y, z + 1}};
    far.vertices.insert(far.vertices.end(), std::begin(corners), std::end(corners));
    far.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  for (DoubleMesh* each : {&mesh, &flat, &far}) {
    std::vector<Double3> points = points_for(*each, by_level<std::size_t>(30, 90, 600), 29);
    for (const double off : {0x1p40, 0x1p55, 0x1p62, 0x1p66, 0x1p70})
      points.insert(points.end(), {{0x1p80, off, 0}, {0x1p80, -off, off}, {0x1p80 + off, 3, 5}});
    const std::vector<ClosestPointD> found = closest_of(BvhD(each->vertices, each->triangles), points);
    expect_near(*each, points, found, "all scales");
    expect_everywhere(*each, points, found, "all scales");
    if (each == &far) expect_same(found, one_by_one(far, points), "far");
    const FloatModeScope scope(FloatMode::flush);
    closest_of(BvhD(each->vertices, each->triangles), points);
  }
}

TEST(DoubleClosestPoints, of_any_bits) {
  const DoubleMesh mesh = moved(double_fan(24, 0.3f), 1e-3, {5e6, 4e5, -5e6});
  const BvhD tree(mesh.vertices, mesh.triangles), empty;
  const double numbers[] = {0.0, -0.0, 5e6, 0x1p-1074, -1e300, largest, -largest, infinite, not_a_number};
  std::vector<Double3> points;
  for (const double x : numbers)
    for (const double y : numbers)
      for (const double z : numbers) points.push_back({x, y, z});
  for (const Path* path : supported_paths()) {
    const std::vector<ClosestPointD> found = closest_of(tree, points, {.path = path});
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool is_finite = std::ranges::all_of(points[i], [](double x) { return std::isfinite(x); });
      ASSERT_EQ(static_cast<bool>(found[i]), is_finite) << i;
      ASSERT_TRUE(same_bytes(empty.closest_point(points[i], {.path = path}), ClosestPointD()));
    }
    std::erase_if(points, [](const Double3& p) {
      return !std::ranges::all_of(p, [](double x) { return std::isfinite(x); });
    });
    expect_near(mesh, points, closest_of(tree, points, {.path = path}), path->name);
  }
}

TEST(DoubleClosestPoints, follow_a_refit) {
  DoubleMesh mesh = moved(ellipsoid(2, {0, 0, 0}), 1.0, {0, 0, 0});
  BvhD tree(mesh.vertices, mesh.triangles);
  Random random(30);
  for (Double3& v : mesh.vertices)
    for (double& x : v) x = 1e-3 * x + 1e-4 * random.real(-1, 1) + 5e6;
  tree.refit(mesh.vertices, mesh.triangles);
  const std::vector<Double3> points = clusters(points_for(mesh, 60, 31), 1e-3, 32);
  expect_same(closest_of(tree, points), closest_of(BvhD(mesh.vertices, mesh.triangles), points), "refitted");
}

TEST(DoubleClosestPoints, take_batches_as_they_lie) {
  struct [[gnu::packed]] Record {
    char name[3];
    Double3 at;
  };
  const DoubleMesh mesh = moved(ellipsoid(2, {0, 0, 0}), 1e-3, {5e6, -4e6, 1e5});
  const BvhD tree(mesh.vertices, mesh.triangles);
  Random random(33);
  for (const std::size_t n : {0, 1, 7, 33, 300}) {
    GuardedArray<Record> records(n, Place::before_guard);
    GuardedArray<ClosestPointD> found(n, Place::before_guard);
    const std::vector<Double3> all = points_for(mesh, 900, 34),
                               points(all.begin(), all.begin() + std::ptrdiff_t(n));
    for (std::size_t i = 0; i < n; ++i) std::memcpy(&records[i].at, &points[i], sizeof(Double3));
    const std::vector<ClosestPointD> expected = closest_of(tree, points);
    const VertexViewD view(n == 0 ? nullptr : reinterpret_cast<const std::byte*>(&records[0]) + 3, n,
                           sizeof(Record));
    for (const auto& mask : masks_for(n, random)) {
      ClosestPointD untouched;
      untouched.unused = 7;
      for (std::size_t i = 0; i < n; ++i) found[i] = untouched;
      tree.closest_points(view, {found.data(), n}, {.threads = 2, .active = mask.data()});
      std::vector<double> distances(n, 7.0);
      tree.signed_distances(view, distances, {.active = mask.data()});
      for (std::size_t i = 0; i < n; ++i) {
        const bool active = (mask[i / 8] >> i % 8 & 1) != 0;
        ASSERT_TRUE(same_bytes(found[i], active ? expected[i] : untouched));
        if (active) {
          ASSERT_TRUE(distances[i] == 0 || std::abs(distances[i]) == expected[i].distance);
        } else {
          ASSERT_EQ(distances[i], 7.0);
        }
      }
      ASSERT_TRUE(found.is_intact());
    }
  }
}

TEST(DoubleSignedDistances, are_zero_on_the_surface_and_nowhere_else) {
  const struct {
    double factor;
    Double3 offset;
  } cases[] = {{1, {0, 0, 0}},        {1e-3, {5e6, -4e6, 1e5}}, {0x1p-1060, {0, 0, 0}},
               {0x1p-300, {0, 0, 0}}, {0x1p300, {0, 0, 0}},     {0x1p1000, {0, 0, 0}}};
  for (const auto& [factor, offset] : cases) {
    const DoubleMesh mesh = moved(double_fan(24, 0.3f), factor, offset);
    const std::vector<Double3> points = points_for(mesh, by_level<std::size_t>(30, 90, 900), 35);
    const BvhD tree(mesh.vertices, mesh.triangles);
    const std::vector<ClosestPointD> closest = closest_of(tree, points);
    for (const Path* path : supported_paths())
      for (const InsideRule rule : {InsideRule::parity, InsideRule::vote}) {
        std::vector<double> distances(points.size());
        tree.signed_distances(points, distances, {.rule = rule, .path = path, .threads = 2});
        for (std::size_t i = 0; i < points.size(); ++i) {
          const Location location = exact_location(mesh, points[i]);
          const int sign = location == Location::on ? 0 : location == Location::inside ? -1 : 1;
          ASSERT_EQ((distances[i] > 0) - (distances[i] < 0), sign) << factor << ", point " << i;
          ASSERT_EQ(std::abs(distances[i]),
                    sign == 0 ? 0.0 : std::clamp(closest[i].distance, 0x1p-1022, largest));
        }
      }
    std::vector<double> near(points.size());
    tree.signed_distances(points, near, {.max_distance = 0.1 * factor});
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double distance = closest[i].distance;
      ASSERT_TRUE(near[i] == 0 || std::isinf(near[i]) == (distance > 0.1 * factor)) << near[i];
    }
  }
}

TEST(DoubleClosestPoints, refuse_what_does_not_fit) {
  const DoubleMesh mesh = moved(cube(-1, 1), 1, {0, 0, 0});
  const BvhD tree(mesh.vertices, mesh.triangles);
  const std::vector<Double3> points(3);
  std::vector<ClosestPointD> found(2);
  std::vector<double> distances(3);
  EXPECT_NE(message_of([&] { tree.closest_points(points, found); }).find("closest has 2"), std::string::npos);
  EXPECT_NE(message_of([&] { tree.closest_points(VertexViewD(nullptr, 2), found); }).find("nothing"),
            std::string::npos);
  EXPECT_NE(message_of([&] { tree.closest_point({}, {.threads = -1}); }).find("-1 threads"),
            std::string::npos);
  EXPECT_THROW(tree.signed_distances(points, std::span(distances).first(2)), std::invalid_argument);
  EXPECT_THROW(tree.signed_distances(points, distances, {.threads = -1}), std::invalid_argument);
  EXPECT_THROW(tree.signed_distances(points, distances, {.rule = InsideRule::winding}),
               std::invalid_argument);
  BvhD().signed_distances(points, distances);
  EXPECT_EQ(distances, std::vector<double>(3, infinite));
}

}  // namespace
}  // namespace raylanes::testing
