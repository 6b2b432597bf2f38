// Closest points of batches by trees: the bytes of points one by one, however a batch lies, and less work.
#include <raylanes/numbers.hpp>
#include <raylanes/raylanes.hpp>

#include "../../accel/queries/closest_points.hpp"
#include "../doubles/double_cases.hpp"
#include "../support/float_modes.hpp"
#include "../support/guarded_array.hpp"
#include "../support/level.hpp"
#include "../support/message_of.hpp"
#include "../support/supported_paths.hpp"
#include "point_tree_cases.hpp"

namespace raylanes::testing {
namespace {

template <class T>
class PointsOf : public ::testing::Test {
 protected:
  static auto tree_of(const Mesh& mesh, double factor, const Double3& offset) {
    if constexpr (std::is_same_v<T, float>) {
      return Bvh(mesh);
    } else {
      const DoubleMesh far = moved(mesh, factor, offset);
      return BvhD(far.vertices, far.triangles);
    }
  }
};
using Numbers = ::testing::Types<float, double>;
TYPED_TEST_SUITE(PointsOf, Numbers);

// In pieces and orders of their own, strided, masked, beside guards: closest points, and distances with a sign.
TYPED_TEST(PointsOf, any_batch_have_the_bytes_of_one_by_one) {
  using Point = PointOf<TypeParam>;
  struct [[gnu::packed]] Record {
    char name[3];
    Point at;
  };
  const auto tree = this->tree_of(ellipsoid(2, {0, 0, 0}), 1e-3, {5e6, -4e6, 1e5});
  Random random(2725);
  for (const std::size_t n : {0u, 1u, 7u, 31u, 32u, 33u, 200u, 3000u, (1u << 17) + 33u}) {
    GuardedArray<Record> records(n, Place::before_guard);
    GuardedArray<ClosestPointOf<TypeParam>> found(n, Place::before_guard);
    GuardedArray<TypeParam> distances(n, Place::before_guard);
    std::vector<ClosestPointOf<TypeParam>> expected(found.data(), found.data() + n);
    std::vector<TypeParam> expected_distances(distances.data(), distances.data() + n);
    std::vector<std::uint8_t> mask((n + 7) / 8);
    for (std::size_t i = 0; i < n; ++i) {
      Point point;
      for (std::size_t k = 0; k < 3; ++k) {
        const double share = random.real(-0.25, 1.25);
        point[k] = static_cast<TypeParam>((1 - share) * tree.bounds().lo[k] + share * tree.bounds().hi[k]);
      }
      std::memcpy(&records[i].at, &point, sizeof point);
      if (!random.chance(0.7)) continue;
      mask[i / 8] = static_cast<std::uint8_t>(mask[i / 8] | 1u << i % 8);
      expected[i] = tree.closest_point(point);
      tree.signed_distances(std::span(&point, 1), std::span(&expected_distances[i], 1));
    }
    GuardedArray<std::uint8_t> active(mask.size(), Place::before_guard);
    active.fill(mask);
    const VertexRecords<TypeParam> points(
        n == 0 ? nullptr : reinterpret_cast<const std::byte*>(&records[0]) + 3, n, sizeof(Record));
    for (const Path* path : paths_with_own_queries())
      for (const int threads : {1, 2}) {
        tree.closest_points(points, {found.data(), n},
                            {.path = path, .threads = threads, .active = active.data()});
        tree.signed_distances(points, {distances.data(), n},
                              {.path = path, .threads = threads, .active = active.data()});
        ASSERT_TRUE(found.holds(expected) && distances.holds(expected_distances)) << n;
        ASSERT_TRUE(found.is_intact() && distances.is_intact());
      }
  }
}

TYPED_TEST(PointsOf, what_does_not_fit_is_refused) {
  using T = TypeParam;
  const auto tree = this->tree_of(cube(-1, 1), 1, {0, 0, 0});
  const std::vector<PointOf<T>> points(3);
  std::vector<ClosestPointOf<T>> found(2);
  std::vector<T> distances(3);
  const auto expect_refused = [](const char* words, const auto& call) {
    EXPECT_NE(message_of(call).find(words), std::string::npos);
  };
  const VertexRecords<T> nowhere(nullptr, 2);
  expect_refused("closest has 2", [&] { tree.closest_points(points, found); });
  expect_refused("nothing", [&] { tree.closest_points(nowhere, found); });
  expect_refused("-1 threads", [&] { tree.closest_point({}, {.threads = -1}); });
  expect_refused("2", [&] { tree.signed_distances(points, std::span(distances).first(2)); });
  expect_refused("nothing", [&] { tree.signed_distances(nowhere, std::span(distances).first(2)); });
  expect_refused("-1 threads", [&] { tree.signed_distances(points, distances, {.threads = -1}); });
  expect_refused("rule", [&] {
    tree.signed_distances(points, distances, {.rule = InsideRule(inside_rule_names.size())});
  });
  std::remove_cvref_t<decltype(tree)>().signed_distances(points, distances);
  EXPECT_EQ(distances, std::vector<T>(3, std::numeric_limits<T>::infinity()));
}

// Around a cube: so far is easily said. With reports and without.
TEST(ClosestPointsOfTrees, go_on_behind_those_that_are_ordered_together) {
  const Bvh bvh(cube(-1, 1));
  Random random(2727);
  std::vector<Float3> points(max_ordered_points + 999);
  for (Float3& point : points) point = random.point(2);
  std::vector<ClosestPoint> found(points.size());
  std::size_t reports = 0;
  const Progress count = [&](double) { ++reports; };
  for (const Progress* progress : {static_cast<const Progress*>(nullptr), &count}) {
    std::fill(found.begin(), found.end(), ClosestPoint{});
    bvh.closest_points(points, found, {.progress = progress});
    for (std::size_t i = 0; i < points.size(); ++i) {
      double outside = 0, most = 0;
      for (const float x : points[i]) {
        const double size = std::abs(double{x});
        outside += std::max(size - 1, 0.0) * std::max(size - 1, 0.0), most = std::max(most, size);
      }
      ASSERT_NEAR(found[i].distance_squared, most > 1 ? outside : (1 - most) * (1 - most), 1e-12) << i;
    }
  }
  EXPECT_GT(reports, 0u);
}

class CountedClosestPoints : public Counting {};

TEST_F(CountedClosestPoints, have_the_same_bytes_and_fewer_tests_than_triangles) {
  Random random(2728);
  const Mesh mesh = ellipsoid(3, {0, 0, 0});
  const std::vector<Float3> points = points_for(mesh, 300, random);
  std::vector<ClosestPoint> found(points.size()), expected(points.size());
  const Bvh bvh(mesh);
  for (const Path* path : paths_with_own_queries())
    for (const int threads : {1, 2}) {
      TraceCounters counters;
      bvh.closest_points(points, expected, {.path = path});
      bvh.closest_points(points, found, {.path = path, .threads = threads, .counters = &counters});
      expect_same(found, expected, path->name);
      EXPECT_GE(counters.triangle_tests, points.size() - 2);
      EXPECT_GE(counters.triangle_tests, counters.leaves);
      EXPECT_GE(counters.box_tests, counters.nodes);
      EXPECT_LT(counters.triangle_tests, points.size() * mesh.triangles.size() / 10);
    }
}

// Neighbours visit a node once, on every path but that of one lane.
TEST_F(CountedClosestPoints, share_nodes_with_neighbours) {
  const Mesh mesh = ellipsoid(4, {0, 0, 0});
  Random random(2735);
  std::vector<Float3> points;
  for (int i = 0; i < 2000; ++i) points.push_back(random.point(0.05f, {1, 0, 0}));
  std::vector<ClosestPoint> found(points.size());
  const Bvh bvh(mesh);
  for (const Path* path : paths_with_own_queries()) {
    TraceCounters together, alone;
    bvh.closest_points(points, found, {.path = path, .counters = &together});
    for (const Float3& point : points) bvh.closest_point(point, {.path = path, .counters = &alone});
    if (path->lanes == 1) continue;
    EXPECT_LT(3 * together.nodes, alone.nodes) << path->name;
    EXPECT_LT(2 * together.leaves, alone.leaves) << path->name;
  }
}

// Neighbours that were found before bound the search.
TEST_F(CountedClosestPoints, gain_by_neighbours) {
  const Mesh mesh = ellipsoid(4, {0, 0, 0});
  Random random(2729);
  std::vector<Float3> near, far;
  for (int i = 0; i < 2000; ++i) near.push_back(random.point(0.01f, {3, 0, 0}));
  std::vector<ClosestPoint> found(near.size());
  const Bvh bvh(mesh);
  TraceCounters together, alone;
  bvh.closest_points(near, found, {.counters = &together});
  for (const Float3& point : near) bvh.closest_point(point, {.counters = &alone});
  EXPECT_LT(together.triangle_tests, alone.triangle_tests);
}

}  // namespace
}  // namespace raylanes::testing
