// Lists of hits and crossings: of thousands of hits, however rays come, and of trees without triangles.
#include "../support/filtered.hpp"
#include "worlds/worlds.hpp"

namespace raylanes::testing {
namespace {

template <class T>
class Lists : public ::testing::Test {};
TYPED_TEST_SUITE(Lists, Numbers, NumberNames);

// The first few of all hits are those that a shorter list has.
TYPED_TEST(Lists, of_thousands_of_hits_a_ray_need_more_room) {
  const auto mesh = mesh_of<TypeParam>(stack_of(3000));
  auto rays = rays_of<TypeParam>(std::vector(40, make_ray({0, 0, -1}, {0, 0, 1})));
  rays.resize(80, rays_of<TypeParam>({make_ray({5, 0, -1}, {0, 0, 1})})[0]);
  auto together = rays;
  together.resize(rays_for_streams, rays[79]);
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    ASSERT_EQ(tree.all_hits(together, {.path = path}).items.size(), 40u * 3000);
    for (const std::uint32_t most : {~0u, 1u, 2u, 7u, 64u, 65u, 1000u}) {
      const auto all = tree.all_hits(rays, {.max_count = most, .path = path});
      const std::size_t count = std::min(most, 3000u);
      ASSERT_EQ(all.items.size(), 40 * count);
      for (std::uint32_t k = 0; k < count; ++k) ASSERT_EQ(all[39][k].primitive, k);
      EXPECT_TRUE(all[40].empty());
      EXPECT_EQ(tree.crossings(rays, {.max_count = most, .path = path}).items.size(), 40 * count);
    }
  });
}

// Views, arrays, threads, rays that take no part, buffers of the caller: the same lists.
TYPED_TEST(Lists, do_not_depend_on_how_rays_come) {
  using T = TypeParam;
  const Mesh of_floats = triangle_soup(500, 0.5f, 42);
  const auto mesh = mesh_of<T>(of_floats);
  const auto rays = rays_of<T>(aimed_rays(of_floats, 3000, 2, 43));
  const RayColumns columns(rays);
  const auto arrays = columns.view();
  const auto tree = tree_of<T>(mesh);
  const auto all = tree.all_hits(rays);
  const auto crossed = tree.crossings(rays);
  std::vector<CrossingCount> counts(rays.size()), again(rays.size());
  tree.count_crossings(rays, counts);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CrossingCount expected;
    for (const auto& crossing : crossed[i]) ++expected.crossings, expected.winding += crossing.side;
    ASSERT_EQ(counts[i], expected) << "ray " << i;
  }
  const auto expect_same = [&](const auto& other) {
    EXPECT_EQ(other.offsets, all.offsets);
    EXPECT_TRUE(same_bytes(other.items, all.items));
  };
  for (const int threads : {1, 0, 2, 3}) {
    expect_same(tree.all_hits(rays, {.threads = threads}));
    expect_same(tree.all_hits(arrays, {.threads = threads}));
    EXPECT_EQ(tree.crossings(arrays, {.threads = threads}).items, crossed.items);
    tree.count_crossings(arrays, again, {.threads = threads});
    EXPECT_EQ(again, counts);
  }
  if constexpr (std::is_same_v<T, float>) {
    std::vector<std::size_t> offsets(rays.size() + 1);
    std::vector<Hit> room(all.items.size());
    EXPECT_EQ(tree.all_hits(rays, offsets, std::span(room).first(room.size() - 1)), room.size());
    EXPECT_EQ(offsets, all.offsets);
    EXPECT_FALSE(room[0]) << "not all: none";
    EXPECT_EQ(tree.all_hits(rays, offsets, room), room.size());
    EXPECT_TRUE(same_bytes(room, all.items));
  }
  const HitOf<T> untouched{7, 7, 7, 7};
  std::vector<HitOf<T>> nearest(rays.size()), passed(rays.size());
  tree.closest(rays, nearest), tree.closest_crossing(rays, passed);
  Random random(44);
  for (const std::vector<std::uint8_t>& mask : masks_for(rays.size(), random)) {
    const LaneBits active = mask.data();
    const auto some = tree.all_hits(arrays, {.threads = 2, .active = active});
    std::vector<CrossingCount> of_some(rays.size(), {77, 78});
    tree.count_crossings(arrays, of_some, {.active = active});
    std::vector<HitOf<T>> hits(rays.size(), untouched), of_arrays = hits, closest_crossings = hits;
    std::vector<std::uint8_t> occluded(rays.size(), 7), dark_arrays = occluded;
    tree.closest(rays, hits, {.threads = 2, .active = active});
    tree.closest(arrays, of_arrays, {.active = active});
    tree.closest_crossing(arrays, closest_crossings, {.active = active});
    tree.occluded(rays, occluded, {.threads = 2, .active = active});
    tree.occluded(arrays, dark_arrays, {.active = active});
    EXPECT_TRUE(same_bytes(hits, of_arrays));
    EXPECT_EQ(occluded, dark_arrays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool is_active = (mask[i / 8] >> i % 8 & 1) != 0;
      ASSERT_TRUE(same_bytes(some[i], is_active ? all[i] : all[i].first(0))) << i;
      ASSERT_EQ(of_some[i], is_active ? counts[i] : (CrossingCount{77, 78})) << i;
      ASSERT_TRUE(same_bytes(hits[i], is_active ? nearest[i] : untouched)) << i;
      ASSERT_TRUE(same_bytes(closest_crossings[i], is_active ? passed[i] : untouched)) << i;
      ASSERT_EQ(occluded[i], is_active ? (nearest[i] ? 1 : 0) : 7) << i;
    }
  }
}

TYPED_TEST(Lists, of_empty_trees_and_wrong_options) {
  const BvhOf<TypeParam> tree;
  const auto rays = rays_of<TypeParam>(std::vector(3, make_ray({0, 0, 0}, {1, 0, 0})));
  EXPECT_EQ(tree.all_hits(rays).offsets, std::vector<std::size_t>(4));
  EXPECT_TRUE(tree.crossings(rays).items.empty());
  EXPECT_TRUE(KdTree().crossings(std::vector<Ray>(3)).items.empty());
  EXPECT_EQ(tree.all_hits(RayRecords<RayOf<TypeParam>>()).size(), 0u);
  std::vector<CrossingCount> counts(2);
  EXPECT_THROW(tree.count_crossings(rays, counts), std::invalid_argument);
  EXPECT_THROW(tree.all_hits(rays, {.threads = -1}), std::invalid_argument);
  EXPECT_THROW(tree.all_hits(RayRecords<RayOf<TypeParam>>(nullptr, 3)), std::invalid_argument);
  if constexpr (std::is_same_v<TypeParam, float>) {
    std::vector<std::size_t> offsets(3);
    EXPECT_THROW(tree.all_hits(rays, offsets, {}), std::invalid_argument);
  }
}

class CountedLists : public Counting {};
TEST_F(CountedLists, have_the_same_bytes) {
  const Mesh mesh = triangle_soup(500, 0.5f, 45);
  for (const std::size_t count : {std::size_t{200}, rays_for_streams}) {
    const std::vector<Ray> rays = aimed_rays(mesh, count, 2, 46);
    each_tree(mesh, [&](const auto& tree, const Path* path) {
      TraceCounters counters;
      EXPECT_TRUE(same_bytes(tree.all_hits(rays, {.path = path, .counters = &counters}).items,
                             tree.all_hits(rays, {.path = path}).items));
      EXPECT_GT(counters.nodes, 0u);
      EXPECT_GT(counters.hits, 0u);
      EXPECT_GT(counters.triangle_tests, counters.hits);
    });
  }
}

}  // namespace
}  // namespace raylanes::testing
