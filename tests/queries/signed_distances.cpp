// Signed distances: signs and sizes against rational numbers, and that signs are exact where sizes are not.
#include <raylanes/closed_mesh.hpp>

#include "../../bench/support/oracles/exact_point.hpp"
#include "../point/point_cases.hpp"
#include "../support/same_bytes.hpp"
#include "query_trees.hpp"

namespace raylanes::testing {
namespace {

int sign_of(Location location) {
  return location == Location::on ? 0 : location == Location::inside ? -1 : 1;
}

struct ExactDistance {
  int sign;
  mpq_class square, reach;  // of the farthest corner
};

std::vector<ExactDistance> exact_distances(const Mesh& mesh, const std::vector<Float3>& points,
                                           InsideRule rule) {
  std::vector<ExactDistance> exact;
  for (const Float3& point : points) {
    ExactDistance& to = exact.emplace_back(
        ExactDistance{sign_of(oracle::exact_location(mesh, point, {0.3f, -0.7f, 0.2f}, rule)), -1, 0});
    for (const Index3& corners : mesh.triangles) {
      const Triangle triangle = triangle_of(mesh.vertices, corners);
      const mpq_class square = oracle::exact_square_of_distance(point, triangle);
      if (to.square < 0 || square < to.square) to.square = square;
      to.reach = std::max<mpq_class>(to.reach, square_of_reach({point, triangle}));
    }
  }
  return exact;
}

// The root of a square that is off by 2^-46 of the reach, rounded to a float.
void expect_exact(std::span<const float> distances, const std::vector<ExactDistance>& exact) {
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const float distance = distances[i];
    ASSERT_EQ((distance > 0) - (distance < 0), exact[i].sign) << i << ": " << distance;
    const mpq_class square = mpq_class(distance) * mpq_class(distance);
    EXPECT_LE(abs(square - exact[i].square),
              mpq_class(0x1.01p-46) * exact[i].reach + mpq_class(0x1p-22) * exact[i].square)
        << i << ": " << distance;
  }
}

void expect_distances(const Mesh& mesh, const std::vector<Float3>& points, InsideRule rule) {
  const std::vector<ExactDistance> exact = exact_distances(mesh, points, rule);
  std::vector<float> first;
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    for (const FloatMode mode : float_modes) {
      const FloatModeScope scope(mode);
      std::vector<float> distances(points.size());
      tree.signed_distances(points, distances, {.rule = rule, .path = path});
      if (first.empty()) {
        expect_exact(distances, exact);
        first = distances;
      }
      EXPECT_TRUE(same_bytes(distances, first)) << name_of(mode);
    }
  });
}

TEST(SignedDistances, of_closed_meshes_are_exact_in_sign_and_near_in_size) {
  for (const Mesh& mesh : {ellipsoid(1, {0, 0, 0}), double_fan(30, 0.25f), double_fan(30, 0.0f), cube(-1, 1)})
    for (const InsideRule rule : {InsideRule::parity, InsideRule::nonzero})
      expect_distances(mesh, points_around(mesh, by_level(200), 1.5f, 71), rule);
}

TEST(SignedDistances, of_meshes_with_holes_have_the_sign_of_the_vote) {
  Mesh mesh = ellipsoid(1, {0, 0, 0});
  std::erase_if(mesh.triangles, [&, k = 0](const Index3&) mutable { return ++k % 7 == 0; });
  expect_distances(mesh, points_around(mesh, by_level(150), 1.5f, 72), InsideRule::vote);
}

// So near that the square of the distance is a rounding error, or too small for a float.
TEST(SignedDistances, are_zero_on_the_surface_and_nowhere_else) {
  for (const float scaling : {1.0f, 1e-36f, 1e30f}) {
    SCOPED_TRACE(scaling);
    Mesh mesh = double_fan(30, 0.25f);
    scale(mesh, scaling);
    std::vector<Float3> points;
    for (const Float3& point : points_around(mesh, by_level(600), 1.5f * scaling, 73)) {
      points.push_back(point);
      for (const float to : {-infinity, infinity}) {
        points.push_back(point);
        points.back()[2] = std::nextafter(point[2], to);
      }
    }
    each_tree(mesh, [&](const auto& tree, const Path* path) {
      std::vector<float> distances(points.size());
      std::vector<Location> locations(points.size());
      tree.signed_distances(points, distances, {.path = path});
      tree.locate(points, locations, {.path = path});
      std::size_t on = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ((distances[i] > 0) - (distances[i] < 0), sign_of(locations[i])) << i;
        ASSERT_TRUE(distances[i] == 0 || std::isnormal(distances[i])) << i << ": " << distances[i];
        on += locations[i] == Location::on ? 1 : 0;
      }
      EXPECT_GT(on, 5u);
    });
  }
}

TEST(SignedDistances, keep_to_the_most_distance) {
  const Mesh mesh = ellipsoid(2, {0, 0, 0});
  const std::vector<Float3> points = points_around(mesh, by_level(600), 1.5f, 74);
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    std::vector<float> all(points.size()), near(points.size());
    tree.signed_distances(points, all, {.path = path});
    for (const float most : {0.25f, 0.0f, -1.0f, nan}) {
      tree.signed_distances(points, near, {.max_distance = most, .path = path, .threads = 2});
      std::size_t left = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const bool is_near = all[i] == 0 || std::abs(all[i]) <= most;
        // A point within a rounding of a triangle may have distance 0.
        if (most == 0.0f && std::abs(all[i]) < 1e-6f) continue;
        ASSERT_EQ(near[i], is_near ? all[i] : std::copysign(infinity, all[i])) << most;
        left += is_near ? 1 : 0;
      }
      if (most > 0) {
        EXPECT_GT(left, 5u);
      }
    }
  });
}

TEST(SignedDistances, take_any_points) {
  const Bvh bvh(cube(-1, 1));
  const std::vector<Float3> points = {
      {nan, 0, 0}, {0, -infinity, 0}, {0, 0, 0}, {3e38f, 3e38f, 3e38f}, {1, 1, 1}};
  std::vector<float> distances(points.size());
  for (const InsideRule rule : {InsideRule::parity, InsideRule::nonzero, InsideRule::vote}) {
    bvh.signed_distances(points, distances, {.rule = rule});
    EXPECT_EQ(distances, (std::vector<float>{infinity, infinity, -1, std::numeric_limits<float>::max(), 0}));
  }
  KdTree().signed_distances(points, distances);
  EXPECT_EQ(distances, std::vector<float>(points.size(), infinity));
}

class CountedSignedDistances : public Counting {};
TEST_F(CountedSignedDistances, are_the_same_and_count_both_searches) {
  const Mesh mesh = ellipsoid(2, {0, 0, 0});
  const std::vector<Float3> points = points_around(mesh, 200, 1.5f, 76);
  std::vector<float> distances(points.size()), counted(points.size());
  std::vector<ClosestPoint> closest(points.size());
  std::vector<Location> locations(points.size());
  const Bvh bvh(mesh);
  TraceCounters both, one, other;
  bvh.signed_distances(points, distances);
  bvh.signed_distances(points, counted, {.counters = &both});
  bvh.closest_points(points, closest, {.counters = &one});
  bvh.locate(points, locations, {.counters = &other});
  EXPECT_EQ(distances, counted);
  EXPECT_EQ(both.triangle_tests, one.triangle_tests + other.triangle_tests);
}

}  // namespace
}  // namespace raylanes::testing
