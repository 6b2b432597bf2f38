// All triangle forms on closed meshes, aimed at where triangles meet: the watertight ones leak nothing, the
// others what they are known to.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "../support/closed_meshes.hpp"
#include "../support/float_modes.hpp"
#include "answers.hpp"

namespace raylanes::testing {
namespace {

bool is_stopped(const FormVariant& variant, const Ray& ray, const PreparedTriangles& around) {
  std::vector<std::uint8_t> bits(around.size() / 8 + 1);
  any_hits(variant.kernels().any_of_triangles, ray, around.columns(), columns_of(variant.test), around.size(),
           bits.data());
  for (std::size_t i = 0; i < around.size(); ++i)
    if (is_set(bits, i)) return true;
  return false;
}

std::size_t count_leaks(const FormVariant& variant, const SharedPoint& target, const std::vector<Ray>& rays) {
  std::size_t leaks = 0;
  if (variant.test == TriangleForm::directional) {
    for (const Ray& ray : rays)
      leaks += !is_stopped(variant, ray, PreparedTriangles(variant, target.around, ray.direction.data()));
  } else {
    const PreparedTriangles around(variant, target.around, nullptr);
    for (const Ray& ray : rays) leaks += !is_stopped(variant, ray, around);
  }
  return leaks;
}

struct LeakCase {
  const char* name;
  Float3 centre, semi_axes;
};

// The rays that pass through the mesh, by form and grade on one path.
using Leaks = std::map<std::pair<TriangleForm, Grade>, std::size_t>;

class ClosedMeshes : public ::testing::TestWithParam<LeakCase> {
 protected:
  Leaks leaks_on(const Path& path, FloatMode mode) {
    const auto& [name, centre, semi_axes] = GetParam();
    const std::vector<SharedPoint> targets = shared_points(ellipsoid(quick() ? 0 : 2, centre, semi_axes));
    Float3 reach;
    for (std::size_t axis = 0; axis < 3; ++axis) reach[axis] = 0.2f * semi_axes[axis];
    Random random(111);
    rays_ = 6 * targets.size();
    Leaks leaks;
    for (const SharedPoint& target : targets) {
      const std::vector<Ray> rays = rays_to(target, centre, reach, 6, random);
      const FloatModeScope scope(mode);
      for (const FormVariant& variant : all_variants<TriangleForm>())
        if (variant.path == &path) leaks[{variant.test, variant.grade}] += count_leaks(variant, target, rays);
    }
    return leaks;
  }

  std::size_t rays_ = 0;
};

TEST_P(ClosedMeshes, leak_nothing_through_watertight_and_alike_through_forms_of_equal_bits) {
  for (const Path* path : supported_paths())
    for (const FloatMode mode : float_modes) {
      SCOPED_TRACE(std::string(path->name) + ' ' + name_of(mode));
      Leaks leaks = leaks_on(*path, mode);
      for (const Grade grade : grades) {
        EXPECT_EQ((leaks[{TriangleForm::watertight, grade}]), 0u);
        const std::size_t moller_trumbore = leaks[{TriangleForm::moller_trumbore, grade}];
        EXPECT_EQ((leaks[{TriangleForm::directional, grade}]), moller_trumbore);
        EXPECT_EQ((leaks[{TriangleForm::moller_trumbore_edges, grade}]), moller_trumbore);
        // The others are there to show that the rays are aimed at edges, and leak no more than is known.
        if (quick()) continue;
        for (const TriangleForm form : {TriangleForm::plane_edges_plain, TriangleForm::plane_edges,
                                        TriangleForm::moller_trumbore, TriangleForm::precomputed}) {
          const std::size_t leaked = leaks[{form, grade}];
          EXPECT_GT(leaked, rays_ / 100) << name_of(form);
          EXPECT_LT(leaked, rays_ * 3 / 10) << name_of(form);
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
