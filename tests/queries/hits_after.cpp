// Filters: which hits they see, in which order, and what they may do.
#include "../support/filtered.hpp"
#include "../support/same_bytes.hpp"
#include "query_trees.hpp"
#include "worlds/worlds.hpp"

namespace raylanes::testing {
namespace {

template <class T>
class Predicates : public ::testing::Test {};

// Triangles that a rule leaves out: as if the mesh did not have them.
TEST(Filters, leave_out_triangles) {
  const Mesh mesh = triangle_soup(by_level(400), 0.5f, 68);
  const std::vector<Ray> rays = aimed_rays(mesh, by_level(400), 2, 69);
  std::vector<std::uint32_t> ray_masks, triangle_masks;
  for (std::uint32_t i = 0; i < rays.size(); ++i) ray_masks.push_back(1u << i % 3 | (i % 7 == 0 ? 8u : 0u));
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) triangle_masks.push_back(i % 16);
  const std::vector<std::uint8_t> active(rays.size() / 8 + 1, 0xb7);
  const auto check = [&](const auto& tree, const Path* path, const auto& filter) {
    std::vector<Hit> hits(rays.size()), some(rays.size(), Hit{7, 0, 0, 1});
    std::vector<std::uint8_t> occluded(rays.size());
    tree.closest(rays, hits, filter, {.path = path});
    tree.occluded(rays, occluded, filter, {.path = path});
    tree.closest(rays, some, filter, {.path = path, .threads = 2, .active = active.data()});
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      Hit expected;
      for (const Hit& hit : oracle_hits(mesh, rays[i]))
        if (!expected && (ray_masks[i] & triangle_masks[hit.primitive]) != 0) expected = hit;
      ASSERT_TRUE(same_bytes(expected, hits[i])) << i;
      ASSERT_EQ(occluded[i], expected ? 1 : 0) << i;
      if ((active[i / 8] >> i % 8 & 1) == 0) expected = {7, 0, 0, 1};
      ASSERT_TRUE(same_bytes(expected, some[i])) << i;
      found += hits[i] ? 1 : 0;
    }
    EXPECT_GT(found, 5u);
  };
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    check(tree, path, mask_filter(ray_masks, triangle_masks));
    check(tree, path, HitFilter(mask_filter(ray_masks, triangle_masks)));
  });
}

TEST(Filters, of_one_ray_take_the_options_of_a_call) {
  const Mesh mesh = triangle_soup(300, 0.5f, 77);
  const std::vector<Ray> rays = aimed_rays(mesh, 60, 2, 78);
  const Bvh bvh(mesh);
  const auto none = [](const Hit&) { return false; };
  EXPECT_THROW(bvh.closest(rays[0], none, {.test = TriangleTest::watertight}), std::invalid_argument);
  EXPECT_THROW(bvh.occluded(rays[0], none, {.test = TriangleTest::watertight}), std::invalid_argument);
  const Hit first = bvh.closest(rays[0]);
  EXPECT_TRUE(
      same_bytes(bvh.closest(rays[0], none, {.after = first}), bvh.closest(rays[0], {.after = first})));
  EXPECT_EQ(bvh.occluded(rays[0], none, {.after = Hit()}), static_cast<bool>(first));
}

// Only closest() reads TraceOptions::after.
TEST(Filters, of_occluded_ignore_hits_to_look_behind) {
  const Mesh mesh = triangle_soup(200, 0.5f, 75);
  const std::vector<Ray> rays = aimed_rays(mesh, 100, 2, 76);
  const Bvh bvh(mesh);
  const HitFilter filter = reject_even<Hit>;
  std::vector<std::uint8_t> expected(rays.size()), occluded(rays.size());
  bvh.occluded(rays, expected, filter);
  EXPECT_TRUE(std::ranges::count(expected, 1) > 5);
  std::vector<Hit> misses(rays.size());
  bvh.occluded(rays, occluded, filter, {.after = HitView(misses.data(), misses.size())});
  EXPECT_EQ(occluded, expected);
  bvh.occluded(rays, occluded, filter, {.after = HitView(misses.data(), 1)});
  EXPECT_EQ(occluded, expected);
}

// More hits than a filter is asked about at a time: the nearest hits of all rays, in order, come before next hits.
TEST(Filters, see_nearest_hits_of_large_batches_first) {
  const Mesh mesh = triangle_soup(40, 1.0f, 70);
  const Bvh bvh(mesh);
  const std::vector<Ray> few = aimed_rays(mesh, 500, 2, 71), rays = repeated(few, 20000);
  std::vector<Hit> nearest(rays.size()), hits(rays.size()), expected(few.size());
  bvh.closest(rays, nearest);
  bvh.closest(few, expected, HitFilter(reject_even<Hit>));
  std::size_t last = 0, nearest_seen = 0, others = 0, calls = 0;
  const HitFilter filter = [&](std::span<const std::size_t> of, std::span<const Hit> some,
                               std::span<std::uint8_t> rejected) {
    ++calls;
    for (std::size_t k = 0; k < of.size(); ++k) {
      const bool is_nearest = same_bytes(some[k], nearest[of[k]]);
      EXPECT_TRUE(!is_nearest || (others == 0 && (nearest_seen == 0 || of[k] > last)));
      (is_nearest ? nearest_seen : others) += 1, last = of[k];
    }
    reject_even<Hit>(of, some, rejected);
  };
  bvh.closest(rays, hits, filter);
  EXPECT_EQ(nearest_seen, static_cast<std::size_t>(
                              std::ranges::count_if(nearest, [](const Hit& hit) { return bool(hit); })));
  EXPECT_GT(nearest_seen, 10000u);
  EXPECT_GT(others, 1000u);
  EXPECT_GT(calls, 2u);
  for (std::size_t i = 0; i < rays.size(); ++i)
    ASSERT_TRUE(same_bytes(hits[i], expected[i % few.size()])) << i;
}

TEST(Filters, see_each_hit_once_in_order_and_may_throw) {
  const Mesh mesh = triangle_soup(200, 0.5f, 70);
  const std::vector<Ray> rays = aimed_rays(mesh, 100, 2, 71);
  const Bvh bvh(mesh);
  std::vector<std::vector<Hit>> seen(rays.size());
  std::vector<Hit> hits(rays.size());
  bvh.closest(
      rays, hits,
      [&](std::span<const std::size_t> of, std::span<const Hit> found, std::span<std::uint8_t> rejected) {
        for (std::size_t k = 0; k < of.size(); ++k) seen[of[k]].push_back(found[k]), rejected[k] = 1;
      });
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_TRUE(same_bytes(seen[i], oracle_hits(mesh, rays[i]))) << i;
    EXPECT_FALSE(hits[i]);
  }
  const HitFilter throwing = [](auto...) { throw std::runtime_error("enough"); };
  EXPECT_THROW(bvh.closest(rays, hits, throwing), std::runtime_error);
  std::vector<std::uint8_t> unwritten(rays.size(), 7);
  EXPECT_THROW(bvh.occluded(rays, unwritten, throwing), std::runtime_error);
  EXPECT_EQ(std::ranges::count(unwritten, 7), std::ssize(unwritten));
  bvh.closest(rays, hits, HitFilter());
  EXPECT_TRUE(std::ranges::any_of(hits, [](const Hit& hit) { return bool(hit); }));
  EXPECT_THROW(bvh.closest(rays, hits, throwing, {.test = TriangleTest::watertight}), std::invalid_argument);
}

// Predicates that query the tree that asks them, on one thread and on two, in batches that go together and one by one.
TYPED_TEST_SUITE(Predicates, Numbers, NumberNames);

TYPED_TEST(Predicates, may_query_their_tree) {
  using T = TypeParam;
  const Mesh mesh = triangle_soup(300, 0.5f, 81);
  const auto rays = rays_of<T>(aimed_rays(mesh, 5000, 2, 82));
  const auto some = std::vector(rays.begin(), rays.begin() + 100);
  each_tree(mesh_of<T>(mesh), [&](const auto& tree, const Path* path) {
    // Whether the ray of a hit has another triangle behind it.
    const auto rejects = [&](std::size_t ray, const HitOf<T>& hit) {
      std::vector<std::uint8_t> any(some.size());
      if (ray % 64 == 0) tree.occluded(some, any, [](std::size_t, const HitOf<T>&) { return true; });
      EXPECT_EQ(std::ranges::count(any, 1), 0);
      return static_cast<bool>(tree.closest(rays[ray], {.path = path, .after = hit}));
    };
    for (const int threads : {1, 2}) {
      std::vector<HitOf<T>> last(rays.size());
      tree.closest(rays, last, rejects, {.path = path, .threads = threads});
      for (std::size_t i = 0; i < rays.size(); i += 7) {
        const auto all = tree.all_hits(std::span(&rays[i], 1), {.path = path});
        ASSERT_TRUE(same_bytes(last[i], all[0].empty() ? HitOf<T>() : all[0].back())) << i;
      }
    }
  });
}

TYPED_TEST(Predicates, may_throw) {
  using T = TypeParam;
  const Mesh mesh = triangle_soup(300, 0.5f, 83);
  const auto rays = rays_of<T>(aimed_rays(mesh, 20000, 2, 84));
  each_tree(mesh_of<T>(mesh), [&](const auto& tree, const Path* path) {
    std::vector<HitOf<T>> hits(rays.size()), again(rays.size()), all(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    const auto throws = [](std::size_t ray, const HitOf<T>&) {
      return ray > 9000 ? throw std::runtime_error("enough") : false;
    };
    for (const int threads : {1, 2}) {
      EXPECT_THROW(tree.closest(rays, hits, throws, {.path = path, .threads = threads}), std::runtime_error);
      EXPECT_THROW(tree.occluded(rays, occluded, throws, {.path = path, .threads = threads}),
                   std::runtime_error);
      tree.closest(rays, again, [](std::size_t, const HitOf<T>&) { return false; }, {.path = path});
      tree.closest(rays, all, {.path = path});
      EXPECT_TRUE(same_bytes(again, all));
    }
  });
}

}  // namespace
}  // namespace raylanes::testing
