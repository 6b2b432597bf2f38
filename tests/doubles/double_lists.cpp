// Lists of rays of doubles: cut at a number of items, longer than their room; rays as an array for each number.
#include <gtest/gtest.h>

#include "../../accel/doubles/bvh_d_arrays.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../support/filtered.hpp"
#include "../support/meshes.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

DoubleMesh stack() {
  return moved(stack_of(3000), 1, {0, 0, 0});
}
constexpr RayD through_stack{{0.2, 0.2, -1}, 0, {0, 0, 1}, 10000};

TEST(DoubleLists, that_outgrow_their_room) {
  const DoubleMesh mesh = stack();
  const BvhD tree(mesh.vertices, mesh.triangles);
  const std::vector<RayD> rays(5, through_stack);
  for (const std::uint32_t most : {ListOptions{}.max_count, 70u}) {
    const RayLists<HitD> list = tree.all_hits(rays, {.max_count = most});
    ASSERT_EQ(list.size(), 5u);
    ASSERT_EQ(list[4].size(), std::min(most, 3000u));
    for (std::size_t i = 0; i < 5; ++i)
      for (std::size_t k = 0; k < list[i].size(); ++k) ASSERT_EQ(list[i][k].primitive, k);
  }
}

TEST(DoubleLists, cut_are_the_first_of_all) {
  for (const DoubleCase& c : double_cases(by_level<std::size_t>(200, 400, 2000))) {
    const BvhD tree(c.mesh.vertices, c.mesh.triangles);
    for (const Facing facing : {Facing::any, Facing::back}) {
      const RayLists<HitD> all = tree.all_hits(c.rays, {.facing = facing});
      for (const Path* path : paths_with_own_queries())
        for (const std::uint32_t most : {0u, 1u, 2u, 5u, 64u, 65u}) {
          const RayLists<HitD> some =
              tree.all_hits(c.rays, {.max_count = most, .facing = facing, .path = path});
          for (std::size_t i = 0; i < c.rays.size(); ++i) {
            const auto first = all[i].first(std::min<std::size_t>(most, all[i].size()));
            ASSERT_TRUE(same_bytes(some[i], first)) << c.name << ' ' << path->name << ' ' << most << ' ' << i;
          }
        }
    }
  }
}

// By the room that it takes: of 3000 triangles a ray looks for the nearest few only.
TEST(DoubleLists, of_a_few_hits_end_the_search) {
  const DoubleMesh mesh = stack();
  const BvhDArrays tree = build_bvh_d(mesh.vertices, mesh.triangles, {});
  for (const Path* path : paths_with_own_queries())
    for (const std::uint32_t most : {1u, 3u, 64u}) {
      std::vector<ListEntryOf<double>> list(300);
      std::vector<HitD> hits(list.size());
      std::size_t end = 0;
      DoubleListBatch batch;
      batch.rays = &through_stack, batch.size = 1, batch.max_count = most;
      batch.list = list.data(), batch.hits = hits.data(), batch.room = list.size(), batch.end = &end;
      ASSERT_EQ(kernels_of(*path).doubles.list(tree.view(), batch), 1u) << path->name << ' ' << most;
      ASSERT_GE(end, most);
    }
}

// The exact t of the first triangle is larger, but rounds to that of the second.
TEST(DoubleLists, of_one_hit_take_the_lower_index_of_equal_t) {
  const double above = 1 + 0x1p-52;
  const DoubleMesh mesh{{{-1, -1, 1}, {3, -1, 1}, {-1, 3, above}, {-1, -1, 1}, {3, -1, 1}, {-1, 3, 1}},
                        {{0, 1, 2}, {3, 4, 5}}};
  const BvhD tree(mesh.vertices, mesh.triangles);
  const RayD ray{{0, 0, 0}, 0, {0, 0, 1}, 9};
  const RayLists<HitD> list = tree.all_hits(std::span(&ray, 1), {.max_count = 1});
  ASSERT_EQ(list[0].size(), 1u);
  EXPECT_EQ(list[0][0].t, 1.0);
  EXPECT_EQ(list[0][0].primitive, 0u);
}

TEST(DoubleLists, rays_as_an_array_for_each_number) {
  const DoubleMesh mesh = moved(double_fan(40, 0.3f), 0.7, {5e6, 0.2, 0.3});
  const BvhD tree(mesh.vertices, mesh.triangles);
  const std::vector<RayD> rays = aimed_rays(mesh, 3000, 7);
  const RayColumns columns(rays);
  const RayArraysD arrays = columns.view();
  Random random(3);
  std::vector<std::vector<std::uint8_t>> masks = masks_for(rays.size(), random);
  masks.emplace_back();  // all
  for (const auto& mask : masks)
    for (const int threads : {1, 2}) {
      const LaneBits active = mask.empty() ? nullptr : mask.data();
      const TraceOptionsD options{.threads = threads, .active = active};
      const ListOptions of_lists{.threads = threads, .active = active};
      std::vector<HitD> hits[2];
      std::vector<std::uint8_t> occluded[2];
      std::vector<CrossingCount> counts[2];
      for (int i = 0; i < 2; ++i)
        hits[i].resize(rays.size()), occluded[i].resize(rays.size()), counts[i].resize(rays.size());
      tree.closest(rays, hits[0], options), tree.closest(arrays, hits[1], options);
      EXPECT_TRUE(same_bytes(hits[0], hits[1]));
      tree.occluded(rays, occluded[0], options), tree.occluded(arrays, occluded[1], options);
      EXPECT_EQ(occluded[0], occluded[1]);
      tree.count_crossings(rays, counts[0], of_lists);
      tree.count_crossings(arrays, counts[1], of_lists);
      EXPECT_EQ(counts[0], counts[1]);
      EXPECT_TRUE(same_bytes(tree.all_hits(arrays, of_lists).items, tree.all_hits(rays, of_lists).items));
      EXPECT_EQ(tree.crossings(arrays, of_lists).items, tree.crossings(rays, of_lists).items);
      EXPECT_EQ(tree.crossings(arrays, of_lists).offsets, tree.crossings(rays, of_lists).offsets);
    }
}

}  // namespace
}  // namespace raylanes::testing
