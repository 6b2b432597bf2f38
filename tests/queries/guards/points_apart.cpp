// Points, corners, counts and a caller's own tests: inputs among the results.
#include "kinds.hpp"

namespace raylanes::testing {
namespace {

template <class T, class Tree, class Closest = ClosestPointOf<T>>
void expect_points_apart(const Tree& tree) {
  using Point = std::array<T, 3>;
  Random random(705);
  std::vector<Point> points(2000);
  for (Point& point : points) {
    const Float3 at = random.point(1);
    std::ranges::copy(at, point.begin());
  }
  const std::vector<Point> given = points;
  const VertexRecords<T> view(points);
  const auto over = [&]<class Result>(Result*) {
    return std::span(reinterpret_cast<Result*>(&points[0][2]), points.size());
  };
  EXPECT_THROW(tree.closest_points(VertexRecords<T>(points.data(), 500), over((Closest*)nullptr).first(500)),
               std::invalid_argument);
  EXPECT_THROW(tree.locate(view, over((Location*)nullptr)), std::invalid_argument);
  EXPECT_THROW(tree.winding_numbers(view, over((T*)nullptr)), std::invalid_argument);
  EXPECT_THROW(tree.signed_distances(view, over((T*)nullptr)), std::invalid_argument);
  EXPECT_TRUE(same_bytes(points, given));
  std::vector<T> distances(points.size()), expected;
  std::vector<std::uint8_t> mask(points.size() / 8, 0xa5);
  std::memcpy(distances.data(), mask.data(), mask.size());
  expected = distances;
  tree.signed_distances(points, expected, {.active = mask.data()});
  tree.signed_distances(points, distances,
                        {.active = reinterpret_cast<const std::uint8_t*>(distances.data())});
  EXPECT_TRUE(same_bytes(distances, expected));
}

template <class T, class Tree, class Triangle>
void expect_corners_apart(const Tree& tree, std::vector<Triangle> triangles) {
  std::vector<std::uint32_t> primitives(triangles.size());
  for (std::size_t i = 0; i < primitives.size(); ++i) primitives[i] = static_cast<std::uint32_t>(i * 7 % 300);
  std::vector<Triangle> expected(triangles.size());
  tree.corners(primitives, expected);
  std::memcpy(triangles.data(), primitives.data(), primitives.size() * sizeof(std::uint32_t));
  tree.corners(PrimitiveView(triangles.data(), triangles.size()), triangles);
  EXPECT_TRUE(same_bytes(triangles, expected));
}

// Counts over skips of the same rays, and over others'.
template <class T, class Tree>
void expect_counts_apart(const Tree& tree) {
  const auto rays = make_rays<T>();
  std::vector<HitOf<T>> hits(n);
  tree.closest(rays, hits);
  std::vector<CrossingCount> expected(n), counts(n + 1);
  std::vector<std::uint32_t> skip;
  for (const auto& hit : hits) skip.push_back(hit.primitive);
  tree.count_crossings(rays, expected, {.skip = skip});
  for (const int threads : {1, 3})
    for (const std::size_t at : {0, 1, 2}) {
      auto* const over = reinterpret_cast<std::byte*>(counts.data()) + 4 * at;
      std::memcpy(over, skip.data(), n * sizeof(std::uint32_t));
      tree.count_crossings(rays, std::span(counts).first(n),
                           {.threads = threads, .skip = PrimitiveView(over, n)});
      EXPECT_TRUE(std::equal(expected.begin(), expected.end(), counts.begin())) << at;
    }
}

TEST(PointsApart, points_corners_and_counts) {
  const BvhKind floats;
  const KdTreeKind cells;
  const BvhDKind doubles;
  expect_points_apart<float>(floats.tree), expect_points_apart<float>(cells.tree);
  expect_points_apart<double>(doubles.tree);
  expect_points_apart<float, Scene, SceneClosestPoint>(SceneKind().tree);
  expect_corners_apart<float>(floats.tree, std::vector<Triangle>(900));
  expect_corners_apart<float>(cells.tree, std::vector<Triangle>(900));
  expect_corners_apart<double>(doubles.tree, std::vector<TriangleD>(900));
  expect_counts_apart<float>(floats.tree), expect_counts_apart<float>(cells.tree);
  expect_counts_apart<double>(doubles.tree);
  std::vector<std::size_t> offsets(n + 1);
  const auto hits = std::span(reinterpret_cast<Hit*>(&offsets[1]), 100);
  EXPECT_THROW(floats.tree.all_hits(make_rays<float>(), offsets, hits), std::invalid_argument);
}

// A caller's own test.
TEST(PointsApart, bounded_trees) {
  std::vector<Box> boxes;
  for (const Sphere& sphere : SpheresKind::spheres()) {
    Box& box = boxes.emplace_back(Box{sphere.centre, sphere.centre});
    for (std::size_t k = 0; k < 3; ++k) box.lo[k] -= 0.125f, box.hi[k] += 0.125f;
  }
  const BoundedTree tree(boxes);
  const auto front = [&](std::uint32_t primitive, const Ray& ray, Hit& hit) {
    hit.t = (boxes[primitive].lo[0] - ray.origin[0]) / ray.direction[0];
    for (std::size_t k = 1; k < 3; ++k) {
      const float at = ray.origin[k] + hit.t * ray.direction[k];
      if (!(at >= boxes[primitive].lo[k] && at <= boxes[primitive].hi[k])) return false;
    }
    return hit.t >= ray.tmin && hit.t <= ray.tmax;
  };
  std::vector<Ray> rays = make_rays<float>();
  std::vector<Hit> first(n), expected(n);
  tree.closest(rays, first, front);
  tree.closest(rays, expected, front, {.skip = first});
  for (const int threads : {1, 3})
    for (std::size_t at = 0; at <= 2 * room; ++at) {
      std::vector<Hit> hits = within(first, at);
      tree.closest(rays, HitView(hits.data() + room, n), front,
                   {.threads = threads, .skip = HitView(hits.data() + at, n)});
      hits.erase(hits.begin(), hits.begin() + room), hits.resize(n);
      EXPECT_TRUE(same_bytes(hits, expected)) << at;
    }
  EXPECT_THROW(tree.closest(rays, HitView(rays.data(), n), front), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::testing
