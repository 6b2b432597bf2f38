// Trees of floats and of doubles for tests of refits, and all that queries say of them.
#pragma once

#include <raylanes/numbers.hpp>

#include "../../bench/support/oracles/exact_rays.hpp"
#include "../doubles/both_numbers.hpp"
#include "both_trees.hpp"

namespace raylanes::testing {

template <class T>
class Refitted : public ::testing::Test {
 public:
  static constexpr bool has_floats = std::is_same_v<T, float>;
  using Tree = std::conditional_t<has_floats, Bvh, BvhD>;
  using AnyMesh = std::conditional_t<has_floats, Mesh, oracle::DoubleMesh>;
  using Rays = std::vector<RayOf<T>>;

  // Rational numbers take their time: fewer rays and triangles of doubles.
  static std::size_t by_level(std::size_t of_floats, std::size_t of_doubles) {
    return has_floats ? testing::by_level(of_floats) : of_doubles;
  }
  static AnyMesh mesh_of(const Mesh& mesh) {
    if constexpr (has_floats)
      return mesh;
    else
      return moved(mesh, 1, {0, 0, 0});
  }
  static AnyMesh soup(std::size_t triangles, float size, std::uint64_t seed) {
    return mesh_of(triangle_soup(triangles, size, seed));
  }
  static Tree tree_of(const AnyMesh& mesh, const BuildOptions& options = {}) {
    return Tree(mesh.vertices, mesh.triangles, options);
  }
  // Each vertex somewhere else, by up to `by` along each axis.
  static AnyMesh shaken(AnyMesh mesh, float by, std::uint64_t seed) {
    Random random(seed);
    for (auto& vertex : mesh.vertices)
      for (T& x : vertex) x += static_cast<T>(random.real(-by, by));
    return mesh;
  }
  static Rays rays_to(const AnyMesh& mesh, std::size_t count, std::uint64_t seed) {
    if constexpr (has_floats)
      return mixed_rays(mesh, count, 2, {0, 0, 0}, seed);
    else
      return aimed_rays(mesh, count, seed);
  }

  // Rational numbers have the hits, on every path, however rays are traced. Returns how many rays hit.
  static std::size_t expect_exact(const Tree& tree, const AnyMesh& mesh, const Rays& rays) {
    const std::vector<HitOf<T>> expected = oracle::nearest_hits(mesh, rays);
    if constexpr (has_floats) {
      expect_hits(tree, rays, expected);
    } else {
      for (const Path* path : paths_with_own_queries()) {
        std::vector<HitD> hits(rays.size());
        tree.closest(rays, hits, {.path = path});
        EXPECT_TRUE(same_bytes(hits, expected)) << path->name;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          EXPECT_TRUE(same_bytes(tree.closest(rays[i], {.path = path}), expected[i])) << path->name;
          EXPECT_EQ(tree.occluded(rays[i], {.path = path}), static_cast<bool>(expected[i])) << path->name;
        }
      }
    }
    return static_cast<std::size_t>(
        std::ranges::count_if(expected, [](const auto& hit) { return static_cast<bool>(hit); }));
  }
};

// The bytes that queries give, by their names.
struct Answer {
  std::string query, bytes;
};
inline void expect_same(const std::vector<Answer>& found, const std::vector<Answer>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_TRUE(found[i].bytes == expected[i].bytes) << found[i].query;
}

// By all queries of a tree of floats or doubles, on a path, or on the active one.
template <class Tree, class AnyRay, class Point>
std::vector<Answer> answers_of(const Tree& tree, const std::vector<AnyRay>& rays,
                               const std::vector<Point>& points, const Path* path) {
  using T = typename Point::value_type;
  std::vector<Answer> answers;
  const auto add = [&](const std::string& query, const auto& array) {
    std::string bytes(array.size() * sizeof array[0], 0);
    if (!bytes.empty()) std::memcpy(bytes.data(), array.data(), bytes.size());
    answers.push_back({query, bytes});
  };
  add("bounds", std::vector{tree.bounds()});
  std::vector<HitOf<T>> hits(rays.size()), single;
  std::vector<std::uint8_t> occluded(rays.size());
  tree.closest(rays, hits, {.path = path}), add("closest", hits);
  for (const AnyRay& ray : rays) single.push_back(tree.closest(ray, {.path = path}));
  add("closest of a ray", single);
  tree.closest_crossing(rays, hits, {.path = path}), add("closest crossing", hits);
  tree.occluded(rays, occluded, {.path = path}), add("occluded", occluded);
  add("all hits", tree.all_hits(rays, {.path = path}).items);
  add("crossings", tree.crossings(rays, {.path = path}).items);

  std::vector<ClosestPointOf<T>> closest(points.size()), alone;
  std::vector<T> numbers(points.size());
  std::vector<Location> locations(points.size());
  tree.closest_points(points, closest, {.path = path}), add("closest points", closest);
  for (const Point& point : points) alone.push_back(tree.closest_point(point, {.path = path}));
  add("closest point", alone);
  for (std::size_t i = 0; i < inside_rule_names.size(); ++i) {
    const auto rule = static_cast<InsideRule>(i);
    const std::string by_rule = " by " + std::string(inside_rule_names[i]);
    tree.locate(points, locations, {.rule = rule, .path = path}), add("locate" + by_rule, locations);
    tree.signed_distances(points, numbers, {.rule = rule, .path = path});
    add("signed distances" + by_rule, numbers);
  }
  tree.winding_numbers(points, numbers, {.path = path}), add("winding numbers", numbers);

  std::vector<std::uint32_t> primitives(1000);
  for (std::uint32_t i = 0; i < primitives.size(); ++i) primitives[i] = i;
  std::vector<std::conditional_t<std::is_same_v<T, float>, Triangle, TriangleD>> triangles(primitives.size());
  tree.corners(primitives, triangles), add("corners", triangles);
  return answers;
}

}  // namespace raylanes::testing
