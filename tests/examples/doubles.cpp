// The tree of doubles: exact where floats could not tell two points apart.
#include "example.hpp"

namespace raylanes::testing {
namespace {

// The unit cube at x = 10^9, where neighbouring floats are 64 apart.
constexpr double far = 1e9;
BvhD far_cube() {
  std::vector<Double3> vertices;
  for (const Float3& v : cube.vertices) vertices.push_back({far + v[0], v[1], v[2]});
  return {vertices, cube.triangles};
}
RayD along_z(double x) {
  return {.origin = {far + x, 0.5, 3}, .direction = {0, 0, -1}};
}

TEST(DoublesByExample, hits_far_from_zero) {
  const BvhD bvh = far_cube();
  for (const Path* path : supported_paths()) {
    const HitD hit = bvh.closest(along_z(0.25), {.path = path});
    EXPECT_TRUE(hit.t == 2 && hit.primitive == 3) << path->name;
    EXPECT_TRUE(bvh.occluded(along_z(1), {.path = path})) << path->name << ": an edge";
    EXPECT_FALSE(bvh.occluded(along_z(1 + 0x1p-20), {.path = path})) << path->name << ": just beside it";
    EXPECT_FALSE(bvh.closest(RayD{}, {.path = path})) << path->name << ": no ray";
  }
}

TEST(DoublesByExample, places_far_from_zero) {
  const BvhD bvh = far_cube();
  const std::vector<Double3> points{
      {far + 0.5, 0.5, 0.5}, {far + 1, 0.5, 0.5}, {far + 1 + 0x1p-20, 0.5, 0.5}};
  for (const Path* path : supported_paths()) {
    std::vector<Location> found(points.size());
    bvh.locate(points, found, {.path = path});
    EXPECT_EQ(found, (std::vector{Location::inside, Location::on, Location::outside})) << path->name;
    const ClosestPointD closest = bvh.closest_point({far + 0.25, 0.5, 3}, {.path = path});
    EXPECT_EQ(closest.point, (Double3{far + 0.25, 0.5, 1})) << path->name;
    EXPECT_EQ(closest.distance, 2) << path->name;
  }
}

}  // namespace
}  // namespace raylanes::testing
