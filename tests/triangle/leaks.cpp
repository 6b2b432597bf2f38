// The table's ray-triangle kernels on closed meshes, aimed at where triangles meet.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "../support/closed_meshes.hpp"
#include "scenes.hpp"

namespace raylanes::testing {
namespace {

std::size_t count_leaks(const KernelVariant& variant, const SharedPoint& target, RayColumns& rays,
                        TriangleHitColumns& out) {
  std::vector<bool> hit(rays.size());
  for (const Triangle& triangle : target.around) {
    variant.kernels().rays_triangle(rays.arrays(), rays.size(), triangle, out.arrays());
    for (std::size_t i = 0; i < rays.size(); ++i) hit[i] = hit[i] || out[i].hit != 0;
  }
  return static_cast<std::size_t>(std::count(hit.begin(), hit.end(), false));
}

class ClosedMesh : public ::testing::TestWithParam<Float3> {};

TEST_P(ClosedMesh, does_not_leak_where_triangles_meet) {
  const Float3 centre = GetParam();
  const std::vector<SharedPoint> targets = shared_points(ellipsoid(quick() ? 1 : 3, centre));
  const std::vector<KernelVariant> variants = all_variants<TriangleTest>();
  std::vector<std::size_t> leaks(variants.size());
  const int rays_each = quick() ? 9 : 60;  // of 3·1280 targets: 230,400 rays
  Random random(51);
  TriangleHitColumns out(static_cast<std::size_t>(rays_each));
  for (const SharedPoint& target : targets) {
    RayColumns rays(rays_to(target, centre, {0.4f, 0.4f, 0.4f}, rays_each, random));
    for (std::size_t i = 0; i < variants.size(); ++i)
      if (variants[i].test == TriangleTest::watertight || variants[i].path == &paths().front())
        leaks[i] += count_leaks(variants[i], target, rays, out);
  }
  for (std::size_t i = 0; i < variants.size(); ++i) {
    if (variants[i].test == TriangleTest::watertight) {
      EXPECT_EQ(leaks[i], 0u) << variants[i].name();
    } else if (variants[i].path == &paths().front() && centre[0] == 0) {
      EXPECT_GT(leaks[i], 0u) << variants[i].name() << ": rays that a leaky test stops are aimed at no edge";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Offsets, ClosedMesh,
                         ::testing::Values(Float3{0, 0, 0}, Float3{148376, 1234, -223423}));

}  // namespace
}  // namespace raylanes::testing
