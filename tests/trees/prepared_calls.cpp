// Calls that are prepared once have the bytes of calls with one ray, by any options, in every kind of tree.
#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>

#include "both_trees.hpp"

namespace raylanes::testing {
namespace {

template <class Tree>
class PreparedCalls : public ::testing::Test {};
TYPED_TEST_SUITE(PreparedCalls, SavedKinds, TreeKindNames);

template <class Tree>
using OptionsOf = typename decltype(std::declval<Tree&>().calls())::Options;

// Those that kernels take, and those that they do not.
template <class Tree>
std::vector<OptionsOf<Tree>> options_of_calls() {
  std::vector<OptionsOf<Tree>> all(5);
  all[1].facing = Facing::front, all[2].facing = Facing::back, all[3].threads = 2;
  if constexpr (!has_doubles<Tree>)
    all[4].test = TriangleTest::watertight, all.push_back({.mode = TraversalMode::packet}),
    all.push_back({.grade = Grade::fast});
  return all;
}

template <class Tree, class AnyRay>
void expect_same_calls(const Tree& tree, const std::vector<AnyRay>& rays, const OptionsOf<Tree>& options) {
  const auto calls = tree.calls(options);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_TRUE(same_bytes(calls.closest(rays[i]), tree.closest(rays[i], options))) << "ray " << i;
    ASSERT_EQ(calls.occluded(rays[i]), tree.occluded(rays[i], options)) << "ray " << i;
  }
}

TYPED_TEST(PreparedCalls, have_the_bytes_of_calls) {
  const auto mesh = soup_for<TypeParam>(300, 91);
  const auto rays = rays_for(mesh, static_cast<std::size_t>(by_level(200, 600, 2000)), 92);
  const auto tree = built<TypeParam>(mesh);
  for (const Path* path : supported_paths())
    for (OptionsOf<TypeParam> options : options_of_calls<TypeParam>()) {
      options.path = path;
      expect_same_calls(tree, rays, options);
      expect_same_calls(TypeParam(), rays, options);
    }
  expect_same_calls(tree, rays, {});
}

// Each call reads the primitive to skip, and the hit to look behind.
TYPED_TEST(PreparedCalls, follow_what_options_refer_to) {
  const auto mesh = soup_for<TypeParam>(300, 93);
  const auto rays = rays_for(mesh, 200, 94);
  const auto tree = built<TypeParam>(mesh);
  auto here = tree.closest(rays[0]);
  OptionsOf<TypeParam> skips, looks_behind;
  skips.skip = here.primitive, looks_behind.after = {&here, 1};
  const auto without = tree.calls(skips), behind = tree.calls(looks_behind);
  std::size_t others = 0;
  for (const auto& ray : rays) {
    here = tree.closest(ray);
    EXPECT_TRUE(same_bytes(without.closest(ray), tree.closest(ray, skips)));
    EXPECT_EQ(without.occluded(ray), tree.occluded(ray, skips));
    EXPECT_TRUE(same_bytes(behind.closest(ray), tree.closest(ray, looks_behind)));
    others += without.closest(ray).primitive != here.primitive ? 1u : 0u;
  }
  EXPECT_GT(others, 50u);
}

TYPED_TEST(PreparedCalls, refuse_what_calls_refuse) {
  const auto tree = built<TypeParam>(soup_for<TypeParam>(30, 95));
  const std::uint32_t primitives[2] = {0, 1};
  OptionsOf<TypeParam> threads, facing, skip;
  threads.threads = -1, facing.facing = static_cast<Facing>(3), skip.skip = primitives;
  for (const auto& options : {threads, facing, skip})
    EXPECT_THROW(static_cast<void>(tree.calls(options)), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::testing
