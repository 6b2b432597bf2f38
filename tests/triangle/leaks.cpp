// All triangle tests on closed meshes, aimed at where triangles meet: the watertight ones leak nothing, the others what
// they are known to.
#include "../../bench/support/rays/leak_targets.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../support/float_modes.hpp"
#include "judge/triangle_answers.hpp"

namespace raylanes::testing {
namespace {

using bench::shared_points;
using bench::SharedApex;

// Rays from around the middle, at most `reach` away on each axis, to the point.
std::vector<Ray> rays_to(const SharedApex& target, const Float3& centre, const Float3& reach, int count,
                         Random& random) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    Float3 origin;
    for (std::size_t axis = 0; axis < 3; ++axis)
      origin[axis] = random.number(centre[axis] - reach[axis], centre[axis] + reach[axis]);
    rays.push_back(ray_to(origin, target.triangle, target.is_corner ? 0 : random.real(0, 1), 0));
  }
  return rays;
}

bool is_stopped(const Ray& ray, const PreparedTriangles& around) {
  std::vector<std::uint8_t> bits((around.size() + 7) / 8);
  hit_mask(ray, around, bits);
  for (std::size_t i = 0; i < around.size(); ++i)
    if (is_set(bits, i)) return true;
  return false;
}

std::size_t count_leaks(const TriangleVariant& variant, const SharedApex& target,
                        const std::vector<Ray>& rays) {
  std::size_t leaks = 0;
  TriangleColumns corners(target.around);
  PreparedTriangles around(corners.arrays(), options_of(variant));
  for (const Ray& ray : rays) {
    around.prepare(ray.direction);
    leaks += !is_stopped(ray, around);
  }
  return leaks;
}

struct LeakCase {
  const char* name;
  Float3 centre, semi_axes;
};

// The rays that pass through the mesh, by test and grade on one path.
using Leaks = std::map<std::pair<TriangleTest, Grade>, std::size_t>;

class ClosedMeshes : public ::testing::TestWithParam<LeakCase> {
 protected:
  Leaks leaks_on(const Path& path, FloatMode mode) {
    const auto& [name, centre, semi_axes] = GetParam();
    const std::vector<SharedApex> targets = shared_points(ellipsoid(quick() ? 0 : 2, centre, semi_axes));
    Float3 reach;
    for (std::size_t axis = 0; axis < 3; ++axis) reach[axis] = 0.2f * semi_axes[axis];
    Random random(111);
    rays_ = 6 * targets.size();
    Leaks leaks;
    for (const SharedApex& target : targets) {
      const std::vector<Ray> rays = rays_to(target, centre, reach, 6, random);
      const FloatModeScope scope(mode);
      for (const TriangleVariant& variant : all_variants<TriangleTest>())
        if (variant.path == &path) leaks[{variant.test, variant.grade}] += count_leaks(variant, target, rays);
    }
    return leaks;
  }

  std::size_t rays_ = 0;
};

TEST_P(ClosedMeshes, leak_nothing_through_watertight_and_alike_through_tests_of_equal_bits) {
  for (const Path* path : supported_paths())
    for (const FloatMode mode : float_modes) {
      SCOPED_TRACE(std::string(path->name) + ' ' + name_of(mode));
      Leaks leaks = leaks_on(*path, mode);
      for (const Grade grade : grades) {
        EXPECT_EQ((leaks[{TriangleTest::exact, grade}]), 0u);
        EXPECT_EQ((leaks[{TriangleTest::watertight, grade}]), 0u);
        const std::size_t moller_trumbore = leaks[{TriangleTest::moller_trumbore, grade}];
        EXPECT_EQ((leaks[{TriangleTest::directional, grade}]), moller_trumbore);
        EXPECT_EQ((leaks[{TriangleTest::moller_trumbore_edges, grade}]), moller_trumbore);
        // The others are there to show that the rays are aimed at edges, and leak no more than is known.
        if (quick()) continue;
        for (const TriangleTest test : {TriangleTest::plane_edges_plain, TriangleTest::plane_edges,
                                        TriangleTest::moller_trumbore, TriangleTest::precomputed}) {
          const std::size_t leaked = leaks[{test, grade}];
          EXPECT_GT(leaked, rays_ / 100) << name_of(test);
          EXPECT_LT(leaked, rays_ * 3 / 10) << name_of(test);
        }
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Meshes, ClosedMeshes,
                         ::testing::Values(LeakCase{"at_the_origin", {0, 0, 0}, {3, 2, 1}},
                                           LeakCase{"far_away", {148376, 1234, -223423}, {3, 2, 1}},
                                           LeakCase{"slivers_1e4", {0, 0, 0}, {1, 1e-4f, 1e-4f}},
                                           LeakCase{"slivers_1e5", {0, 0, 0}, {1, 1, 1e-5f}},
                                           LeakCase{"slivers_1e7", {0, 0, 0}, {1e-7f, 1, 1e-7f}}),
                         [](const auto& c) { return std::string(c.param.name); });

}  // namespace
}  // namespace raylanes::testing
