// Closest points and signed distances of doubles: all scales at once, the most distance, signs.
#include <gmpxx.h>

#include "../point/every_tree.hpp"
#include "../support/float_modes.hpp"

namespace raylanes::testing {
namespace {

// Numbers of all sizes in one mesh, and planes that are far thinner than their coordinates.
TEST(DoubleClosestPoints, have_all_scales_at_once) {
  DoubleMesh mesh;
  for (const int exponent : {-1070, -900, -500, -100, 0, 100, 400, 900})
    append(mesh, moved(triangle_soup(12, 0.5f, 2721), std::ldexp(1.0, exponent), {0, 0, 0}));
  DoubleMesh flat;
  for (int i = 0; i < 40; ++i) {
    const double y = i * 1e-300;
    append(flat, {1e300, y, 0}, {1e300, y + 1e-300, 0}, {1e300, y, 1e-300});
  }
  DoubleMesh far;  // seen from 2^62 sizes away, 2^70 from zero
  for (int i = 0; i < 40; ++i) {
    const double y = i % 7, z = i;
    append(far, {0x1p70, y, z}, {0x1p70, y + 1, z}, {0x1p70, y, z + 1});
  }
  for (DoubleMesh* each : {&mesh, &flat, &far}) {
    std::vector<Double3> points = points_for(*each, by_level<std::size_t>(30, 90, 250), 29);
    for (const double off : {0x1p40, 0x1p55, 0x1p62, 0x1p66, 0x1p70})
      points.insert(points.end(), {{0x1p70, off, 0}, {0x1p70, -off, off}, {0x1p70 + off, 3, 5}});
    const std::vector<ClosestPointD> found = closest_of(BvhD(each->vertices, each->triangles), points);
    expect_near(*each, points, found, "all scales");
    expect_everywhere(*each, points, found, "all scales");
    if (each == &far) expect_same(found, one_by_one(far, points), "far");
    const FloatModeScope scope(FloatMode::flush);
    closest_of(BvhD(each->vertices, each->triangles), points);
  }
}

mpq_class square(double x) {
  return mpq_class(x) * mpq_class(x);
}

// The square of most is compared exactly: of neighbours of the root, those count whose square is not below.
TEST(DoubleClosestPoints, keep_to_the_most_distance) {
  for (const double factor : {1.0, 0x1p300, 0x1p-300, 0x1p1000, 0x1p-1000}) {
    const DoubleMesh mesh = moved(triangle_soup(60, 0.3f, 2717), factor, {0, 0, 0});
    const std::vector<Double3> points = points_for(mesh, 60, 28);
    const BvhD tree(mesh.vertices, mesh.triangles);
    for (const Path* path : paths_with_own_queries())
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
    std::vector<Location> locations;
    for (const Double3& point : points) locations.push_back(exact_location(mesh, point));
    for (const Path* path : paths_with_own_queries())
      for (std::size_t rule = 0; rule < inside_rule_names.size(); ++rule) {
        std::vector<double> distances(points.size());
        tree.signed_distances(points, distances, {.rule = InsideRule(rule), .path = path, .threads = 2});
        for (std::size_t i = 0; i < points.size(); ++i) {
          const int sign = locations[i] == Location::on ? 0 : locations[i] == Location::inside ? -1 : 1;
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

}  // namespace
}  // namespace raylanes::testing
