// The closest point of a mesh: on a side, an edge or a corner.
#include "example.hpp"

namespace raylanes::testing {
namespace {

struct Case {
  const char* what;
  Float3 from, closest;
  double distance_squared;
};
// From outside, from inside, and from the surface of the unit cube.
constexpr Case cases[]{{"above a side", {0.5f, 0.25f, 3}, {0.5f, 0.25f, 1}, 4},
                       {"beside an edge", {0.5f, -3, -4}, {0.5f, 0, 0}, 25},
                       {"off a corner", {3, 3, 2}, {1, 1, 1}, 9},
                       {"within", {0.5f, 0.5f, 0.75f}, {0.5f, 0.5f, 1}, 0.0625},
                       {"on a side", {0.5f, 0.25f, 1}, {0.5f, 0.25f, 1}, 0},
                       {"on a corner", {0, 0, 0}, {0, 0, 0}, 0}};

TEST(ClosestPointsByExample, of_a_cube) {
  const Bvh bvh(cube);
  const KdTree kdtree(cube);
  for (const Path* path : supported_paths())
    for (const Case& one : cases)
      for (const TriangleTree* tree :
           {static_cast<const TriangleTree*>(&bvh), static_cast<const TriangleTree*>(&kdtree)}) {
        const ClosestPoint found = tree->closest_point(one.from, {.path = path});
        EXPECT_EQ(found.point, one.closest) << path->name << ": " << one.what;
        EXPECT_EQ(found.distance_squared, one.distance_squared) << path->name << ": " << one.what;
      }
}

TEST(ClosestPointsByExample, may_be_too_far_or_nowhere) {
  const Bvh bvh(cube);
  for (const Path* path : supported_paths()) {
    EXPECT_TRUE(bvh.closest_point({0.5f, 0.5f, 3}, {.max_distance = 2, .path = path})) << path->name;
    EXPECT_FALSE(bvh.closest_point({0.5f, 0.5f, 3}, {.max_distance = 1.9f, .path = path})) << path->name;
    EXPECT_FALSE(bvh.closest_point({nan, 0, 0}, {.path = path})) << path->name;
    EXPECT_FALSE(Bvh().closest_point({0, 0, 0}, {.path = path})) << path->name;
  }
}

}  // namespace
}  // namespace raylanes::testing
