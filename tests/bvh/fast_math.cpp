// A user's program that is compiled with -O3 -ffast-math, where the compiler takes infinities for impossible: a hit is
// still a hit, and a miss none.
#include <raylanes/raylanes.hpp>

#include "../support/testing.hpp"

namespace raylanes {
namespace {

#ifndef __FAST_MATH__
#error "this test is about -ffast-math"
#endif

TEST(FastMath, a_hit_is_true_and_a_miss_is_not) {
  const std::vector<Float3> vertices{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const std::vector<Index3> triangles{{0, 1, 2}};
  const Bvh bvh(vertices, triangles);
  Ray at, beside;
  at.origin = {0, 0, 3}, at.direction = {0, 0, -1};
  beside.origin = {5, 0, 3}, beside.direction = {0, 0, -1};
  EXPECT_FALSE(Hit());
  const Hit hit = bvh.closest(at), miss = bvh.closest(beside);
  EXPECT_TRUE(hit);
  EXPECT_FALSE(miss);
  EXPECT_EQ(hit.t, 3.0f);
  EXPECT_TRUE(bvh.occluded(at));
  EXPECT_FALSE(bvh.occluded(beside));
  EXPECT_FALSE(Bvh().closest(at));
}

}  // namespace
}  // namespace raylanes
