// A k-d tree has the results of a BVH, byte for byte, whichever builder made it.
#include <cstring>

#include "example.hpp"

namespace raylanes::testing {
namespace {

TEST(KdTreeByExample, has_the_hits_of_a_bvh) {
  const Bvh bvh(cube);
  std::vector<Ray> rays;
  for (int i = 0; i < 200; ++i)
    rays.push_back({.origin = {-1, 0.005f * static_cast<float>(i), 2}, .direction = {1.5f, 0.1f, -1.5f}});
  for (const KdBuilder builder : {KdBuilder::midpoint, KdBuilder::sah}) {
    const KdTree kdtree(cube, {.builder = builder});
    for (const Path* path : supported_paths()) {
      std::vector<Hit> of_bvh(rays.size()), of_kdtree(rays.size());
      bvh.closest(rays, of_bvh, {.path = path});
      kdtree.closest(rays, of_kdtree, {.path = path});
      EXPECT_EQ(std::memcmp(of_bvh.data(), of_kdtree.data(), rays.size() * sizeof(Hit)), 0) << path->name;
      EXPECT_TRUE(of_kdtree.front() && !of_kdtree.back()) << path->name;
    }
  }
}

TEST(KdTreeByExample, sees_one_side_on_request) {
  const KdTree kdtree(cube);
  const Ray through{.origin = {0.25f, 0.5f, 3}, .direction = {0, 0, -1}};
  for (const Path* path : supported_paths()) {
    EXPECT_EQ(kdtree.closest(through, {.path = path, .facing = Facing::front}).t, 2) << path->name;
    EXPECT_EQ(kdtree.closest(through, {.path = path, .facing = Facing::back}).t, 3) << path->name;
    EXPECT_FALSE(KdTree().closest(through, {.path = path})) << path->name << ": an empty tree";
  }
}

TEST(KdTreeByExample, tells_outside_inside_and_on_as_a_bvh_does) {
  using enum Location;
  const std::vector<Float3> points{{0, 0, 0.5f},       {0, 0, -0.5f}, {1, 1, 1},       {0, 0, 0x1.000002p0f},
                                   {0.5f, 0.5f, 0.5f}, {2, 1, 1},     {0.5f, 0.5f, 1}, {0.5f, 1, 0.25f}};
  const std::vector<Location> expected{on, outside, on, outside, inside, outside, on, on};
  for (const Path* path : supported_paths()) {
    std::vector<Location> of_bvh(points.size()), of_kdtree(points.size());
    Bvh(cube).locate(points, of_bvh, {.path = path});
    KdTree(cube).locate(points, of_kdtree, {.path = path});
    EXPECT_EQ(of_bvh, expected) << path->name;
    EXPECT_EQ(of_kdtree, expected) << path->name;
  }
}

}  // namespace
}  // namespace raylanes::testing
