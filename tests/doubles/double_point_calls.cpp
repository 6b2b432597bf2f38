// Calls of closest points and signed distances of doubles: the most distance, signs, refusals.
#include <gmpxx.h>

#include <stdexcept>

#include "../point/every_tree.hpp"

namespace raylanes::testing {
namespace {

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
      for (const InsideRule rule : {InsideRule::parity, InsideRule::vote}) {
        std::vector<double> distances(points.size());
        tree.signed_distances(points, distances, {.rule = rule, .path = path, .threads = 2});
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

// In a closed mesh each rule finds the same points inside.
TEST(DoubleClosestPoints, have_the_sign_of_each_rule) {
  const DoubleMesh mesh = moved(cube(-1, 1), 1e-3, {5e6, -4e6, 1e5});
  const BvhD tree(mesh.vertices, mesh.triangles);
  const std::vector<Double3> points = points_for(mesh, 200, 35);
  std::vector<double> first(points.size()), others(points.size());
  tree.signed_distances(points, first);
  EXPECT_TRUE(std::ranges::any_of(first, [](double distance) { return distance < 0; }));
  for (const InsideRule rule : {InsideRule::nonzero, InsideRule::vote, InsideRule::winding}) {
    tree.signed_distances(points, others, {.rule = rule});
    EXPECT_EQ(first, others);
  }
}

}  // namespace
}  // namespace raylanes::testing
