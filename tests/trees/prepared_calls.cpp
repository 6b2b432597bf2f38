// Calls that are prepared once, and batches of few rays, have the bytes of calls with one ray, by any options, in every
// kind of tree.
#include <raylanes/scene.hpp>

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
  OptionsOf<TypeParam> skips, has_after;
  skips.skip = here.primitive, has_after.after = {&here, 1};
  const auto without = tree.calls(skips), behind = tree.calls(has_after);
  std::size_t others = 0;
  for (const auto& ray : rays) {
    here = tree.closest(ray);
    EXPECT_TRUE(same_bytes(without.closest(ray), tree.closest(ray, skips)));
    EXPECT_EQ(without.occluded(ray), tree.occluded(ray, skips));
    EXPECT_TRUE(same_bytes(behind.closest(ray), tree.closest(ray, has_after)));
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

// One mesh, which is in the common tree; and another one that moves.
struct CommonScene : Scene {
  CommonScene() = default;
  CommonScene(const std::vector<Float3>& vertices, const std::vector<Index3>& triangles) {
    place(add(Bvh(vertices, triangles)));
    update();
  }
};
struct MovedScene : Scene {
  MovedScene() = default;
  MovedScene(const std::vector<Float3>& vertices, const std::vector<Index3>& triangles) {
    const std::uint32_t mesh = add(Bvh(vertices, triangles));
    place(mesh), place(mesh, {{{0.6f, 0.8f, 0, 0.2f}, {-0.8f, 0.6f, 0, 0.1f}, {0, 0, 1, 0.3f}}});
    update();
  }
};

template <class Tree>
class BatchesOfFew : public ::testing::Test {};
struct FewKindNames {
  template <class Tree>
  static std::string GetName(int i) {
    if constexpr (std::is_base_of_v<Scene, Tree>)
      return std::is_same_v<Tree, CommonScene> ? "CommonScene" : "MovedScene";
    else
      return TreeKindNames::GetName<Tree>(i);
  }
};
using FewKinds = ::testing::Types<Bvh, KdTree, BvhD, CommonScene, MovedScene>;
TYPED_TEST_SUITE(BatchesOfFew, FewKinds, FewKindNames);

template <class Tree>
using BatchOptions = std::conditional_t<has_doubles<Tree>, TraceOptionsD, TraceOptions>;

// Rays that share nothing; that begin at a point, in a narrow view; and that end about there.
template <class AnyRay>
std::vector<std::vector<AnyRay>> rays_by_points(const std::vector<AnyRay>& rays) {
  std::vector<std::vector<AnyRay>> all(3, rays);
  const AnyRay middle = rays[1];
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      AnyRay &begins = all[1][i], &ends = all[2][i];
      begins.origin[k] = middle.origin[k];
      begins.direction[k] = middle.direction[k] + rays[i].direction[k] / 64;
      ends.direction[k] = middle.origin[k] - ends.origin[k];
      begins.tmin = ends.tmin = 0, begins.tmax = middle.tmax, ends.tmax = 0.999f;
    }
  return all;
}

// With `skips` each ray leaves out what it hits first, and the batch reads this where it writes hits.
template <class Tree, class AnyRay, class Options>
void expect_batches_as_calls(const Tree& tree, const std::vector<AnyRay>& rays, const Options& options,
                             bool skips) {
  using AnyHit = decltype(tree.closest(rays[0], options));
  std::vector<AnyHit> first, expected;
  std::vector<std::uint8_t> dark;
  for (const AnyRay& ray : rays) {
    first.push_back(tree.closest(ray, options));
    Options one = options;
    if (skips) one.skip = first.back();
    expected.push_back(tree.closest(ray, one)), dark.push_back(tree.occluded(ray, one) ? 1 : 0);
  }
  for (std::size_t n = 0; n <= rays.size(); n += n < 70 ? 1 : 61) {
    const std::span<const AnyRay> some(rays.data(), n);
    std::vector<AnyHit> hits = first;
    std::vector<std::uint8_t> occluded(n + 1, 9);
    Options batch = options;
    if (skips) batch.skip = std::span<const AnyHit>(hits.data(), n);
    tree.occluded(some, std::span(occluded).first(n), batch);
    tree.closest(some, std::span(hits).first(n), batch);
    ASSERT_TRUE(same_bytes(std::span(hits).first(n), std::span(expected).first(n))) << n << " rays";
    ASSERT_TRUE(same_bytes(std::span(hits).subspan(n), std::span(first).subspan(n))) << n << " rays";
    ASSERT_TRUE(std::ranges::equal(std::span(occluded).first(n), std::span(dark).first(n))) << n << " rays";
    ASSERT_EQ(occluded[n], 9) << n << " rays";
  }
}

TYPED_TEST(BatchesOfFew, have_the_bytes_of_calls) {
  const auto mesh = soup_for<TypeParam>(300, 96);
  const auto tree = built<TypeParam>(mesh);
  std::vector<BatchOptions<TypeParam>> all(4);
  all[1].facing = Facing::front, all[2].facing = Facing::back, all[3].threads = 2;
  if constexpr (!has_doubles<TypeParam>)
    for (std::size_t hint = 1; hint < batch_hint_names.size(); ++hint)
      all.push_back({.hint = static_cast<BatchHint>(hint)});
  for (const auto& rays :
       rays_by_points(rays_for(mesh, static_cast<std::size_t>(by_level(140, 300, 700)), 97)))
    for (const Path* path : supported_paths())
      for (auto options : all)
        for (const bool skips : {false, true}) {
          options.path = path;
          expect_batches_as_calls(tree, rays, options, skips);
          if (this->HasFatalFailure()) return;
        }
}

// A batch of few rays checks what a large one does, and may write results where later rays read.
TYPED_TEST(BatchesOfFew, check_what_batches_check) {
  const auto mesh = soup_for<TypeParam>(300, 98);
  const auto tree = built<TypeParam>(mesh);
  const auto rays = rays_for(mesh, 20, 99);
  const BatchOptions<TypeParam> plain;
  using AnyHit = decltype(tree.closest(rays[0], plain));
  std::vector<AnyHit> hits(rays.size() + 1), expected;
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = tree.closest(rays[i], plain);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    BatchOptions<TypeParam> one;
    one.skip = hits[i];
    expected.push_back(tree.closest(rays[i], one));
  }
  BatchOptions<TypeParam> shifted, wrong, reported;
  shifted.skip = std::span<const AnyHit>(hits.data(), rays.size());
  tree.closest(rays, std::span(hits).subspan(1), shifted);
  EXPECT_TRUE(same_bytes(std::span(hits).subspan(1), std::span(expected)));

  auto overlapping = rays;
  const auto written = [&](std::size_t bytes, std::size_t count) {
    return HitRecords<AnyHit>(reinterpret_cast<std::byte*>(overlapping.data()) + bytes, count);
  };
  EXPECT_THROW(tree.closest(rays, std::span(hits).first(3), plain), std::invalid_argument);
  EXPECT_THROW(tree.closest(std::span(overlapping).first(4), written(0, 4), plain), std::invalid_argument);
  EXPECT_THROW(tree.closest(std::span(overlapping).subspan(1, 4), written(8, 4), plain),
               std::invalid_argument);
  EXPECT_TRUE(same_bytes(overlapping, rays));
  wrong.threads = -1;
  EXPECT_THROW(tree.closest(rays, std::span(hits).first(rays.size()), wrong), std::invalid_argument);
  wrong.threads = 1, wrong.skip = std::span<const AnyHit>(hits.data(), 2);
  EXPECT_THROW(tree.closest(rays, std::span(hits).first(rays.size()), wrong), std::invalid_argument);
  std::size_t reports = 0;
  const Progress progress = [&](double) { ++reports; };
  reported.progress = &progress;
  tree.closest(rays, std::span(hits).first(rays.size()), reported);
  EXPECT_GT(reports, 0u);
}

}  // namespace
}  // namespace raylanes::testing
