// Lists of hits and crossings against rational numbers, on every path and in every tree.
#include <new>

#include "../support/same_bytes.hpp"
#include "query_trees.hpp"

namespace raylanes::testing {
namespace {

TEST(Lists, of_random_meshes) {
  for (const float size : {0.05f, 0.3f, 2.0f}) {
    SCOPED_TRACE(size);
    const Mesh mesh = triangle_soup(by_level(200), size, 31);
    expect_lists(mesh, aimed_rays(mesh, by_level(300), 2, 32));
  }
}

TEST(Lists, of_a_lattice_where_all_rays_meet_edges_and_vertices) {
  Random random(33);
  Mesh mesh = integer_grid(5);
  EXPECT_GT(expect_lists(mesh, grid_rays(5, by_level(300), random)), 15u);
  mesh = lattice_walls(2);
  EXPECT_GT(expect_lists(mesh, lattice_rays(2, by_level(400), 34)), 15u);
}

TEST(Lists, of_closed_meshes_aimed_at_vertices_and_edges) {
  for (const Mesh& mesh : {ellipsoid(1, {0, 0, 0}), double_fan(30, 0.25f), double_fan(30, 0.0f), cube(-1, 1)})
    EXPECT_GT(expect_lists(mesh, aimed_rays(mesh, by_level(400), 3, 35)), 15u);
}

TEST(Lists, of_coincident_degenerate_and_folded_triangles) {
  Mesh mesh = ellipsoid(0, {0, 0, 0}, {1, 1, 1});
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(),
                       {{0, 0, 0}, {0.5f, 0, 0}, {0.25f, 0, 0}, {1, 0, 0}, {0.25f, 1, 0}});
  append(mesh, mesh);
  for (std::uint32_t copy = 0; copy < 3; ++copy) {
    mesh.triangles.push_back({n, n + 1, n + 2});  // no area
    mesh.triangles.push_back({n, n + 1, n + 1});
    mesh.triangles.push_back({n, n + 3, n + 4});  // and its back
    mesh.triangles.push_back({n + 3, n, n + 4});
  }
  expect_lists(mesh, aimed_rays(mesh, by_level(400), 2, 36));
}

TEST(Lists, of_rays_in_planes_and_through_the_origin_s_own_triangle) {
  Mesh mesh = integer_grid(3);
  append(mesh, cube(1, 2));
  std::vector<Ray> rays;
  for (int x = -1; x < 8; ++x)
    for (int y = -1; y < 8; ++y)
      for (const Float3& d : std::initializer_list<Float3>{
               {1, 0, 0}, {0, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {1, 2, 0}, {0, 0, 1}, {1, 0, 1}, {1, -1, 1}})
        for (const float tmin : {0.0f, -8.0f, 0x1p-20f})  // the last one leaves out what is at the origin
          rays.push_back(
              make_ray({0.25f * float(x), 0.5f * float(y), (x + y) % 3 == 0 ? 1.0f : 0.0f}, d, tmin));
  EXPECT_GT(expect_lists(mesh, rays), 100u);
}

TEST(Lists, at_scales_of_1e_30_and_1e30) {
  for (const float scaling : {1e-30f, 1e-12f, 1e12f, 1e30f}) {
    SCOPED_TRACE(scaling);
    const ScaledScene scene(30, 120, 37, scaling);
    expect_lists(scene.mesh, scene.rays, ScaledScene::numbers_hold_at(scaling));
  }
}

TEST(Lists, of_layers_that_are_1e_6_apart_at_coordinates_of_1e6) {
  Mesh mesh;
  for (int i = 0; i < 40; ++i) {
    const float z = 1e-6f * static_cast<float>(i);
    append(mesh, {1e6f - 4, 1e6f - 4, z}, {1e6f + 8, 1e6f - 4, z}, {1e6f - 4, 1e6f + 8, z});
  }
  Random random(39);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(200); ++i)
    rays.push_back(make_ray(
        {1e6f + random.number(-2, 2), 1e6f + random.number(-2, 2), random.number(-1, 1)},
        {random.number(-1e-3f, 1e-3f), random.number(-1e-3f, 1e-3f), random.chance(0.5) ? 1.0f : -1.0f}, -2));
  EXPECT_EQ(expect_lists(mesh, rays), 40 * rays.size());
}

// The first of all hits is that of closest(), and the first few are the first few.
TEST(Lists, begin_with_the_nearest_hits) {
  const Mesh mesh = triangle_soup(by_level(800, 3000, 3000), 0.5f, 40);
  const std::vector<Ray> rays = repeated(aimed_rays(mesh, by_level(600), 2, 41));
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    const RayLists<Hit> all = tree.all_hits(rays, {.path = path});
    std::vector<Hit> closest(rays.size());
    tree.closest(rays, closest, {.path = path});
    std::size_t longest = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      longest = std::max(longest, all[i].size());
      const Hit first = all[i].empty() ? Hit() : all[i][0];
      ASSERT_TRUE(same_bytes(first, closest[i])) << i;
    }
    EXPECT_GT(longest, 20u);
    for (const std::uint32_t most : {0u, 1u, 2u, 7u, 64u, 65u, 1000u}) {
      const RayLists<Hit> few = tree.all_hits(rays, {.max_count = most, .path = path});
      const RayLists<Crossing> crossed = tree.crossings(rays, {.max_count = most, .path = path});
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(same_bytes(few[i], all[i].first(std::min<std::size_t>(most, all[i].size())))) << most;
        ASSERT_LE(crossed[i].size(), most);
      }
    }
  });
}

TEST(Lists, of_thousands_of_hits_a_ray_need_more_room) {
  const Mesh mesh = stack_of(5000);
  std::vector<Ray> rays(40, make_ray({0, 0, -1}, {0, 0, 1}));
  rays.resize(80, make_ray({5, 0, -1}, {0, 0, 1}));
  std::vector<Ray> together = rays;
  together.resize(rays_for_streams, rays[79]);
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    ASSERT_EQ(tree.all_hits(together, {.path = path}).items.size(), 40u * 5000);
    const RayLists<Hit> all = tree.all_hits(rays, {.path = path});
    ASSERT_EQ(all.items.size(), 40u * 5000);
    for (std::uint32_t k = 0; k < 5000; ++k) ASSERT_EQ(all[39][k].primitive, k);
    EXPECT_TRUE(all[40].empty());
    EXPECT_EQ(tree.crossings(std::span(rays).first(1), {.max_count = 3, .path = path}).items.size(), 3u);
  });
}

// Views, arrays, threads, rays that take no part, buffers of the caller: the same lists.
// counts holds the sizes of the lists, and the sums of their sides.
void expect_counts_of(const RayLists<Crossing>& lists, const std::vector<CrossingCount>& counts) {
  ASSERT_EQ(counts.size(), lists.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    CrossingCount expected;
    for (const Crossing& crossing : lists[i]) ++expected.crossings, expected.winding += crossing.side;
    ASSERT_EQ(counts[i], expected) << "ray " << i;
  }
}

TEST(Lists, do_not_depend_on_how_rays_come) {
  const Mesh mesh = triangle_soup(500, 0.5f, 42);
  const std::vector<Ray> rays = aimed_rays(mesh, 3000, 2, 43);
  const Bvh bvh(mesh);
  const RayLists<Hit> all = bvh.all_hits(rays);
  std::vector<float> columns[8];
  for (const Ray& ray : rays) {
    const float numbers[] = {ray.origin[0],    ray.origin[1],    ray.origin[2], ray.direction[0],
                             ray.direction[1], ray.direction[2], ray.tmin,      ray.tmax};
    for (std::size_t k = 0; k < 8; ++k) columns[k].push_back(numbers[k]);
  }
  const auto column = [&](std::size_t k) -> const float* { return columns[k].data(); };
  const RayArrays arrays{{column(0), column(1), column(2)},
                         {column(3), column(4), column(5)},
                         column(6),
                         column(7),
                         rays.size()};
  const auto expect_same = [&](const RayLists<Hit>& other) {
    EXPECT_EQ(other.offsets, all.offsets);
    EXPECT_TRUE(same_bytes(other.items, all.items));
  };
  expect_same(bvh.all_hits(arrays));
  const RayLists<Crossing> crossed = bvh.crossings(rays);
  std::vector<CrossingCount> counts(rays.size()), again(rays.size());
  bvh.count_crossings(rays, counts);
  expect_counts_of(crossed, counts);
  for (const TreeBuilder builder : {TreeBuilder::spatial_splits, TreeBuilder::median}) {
    Bvh(mesh, {.builder = builder}).count_crossings(rays, again);
    EXPECT_EQ(again, counts) << tree_builder_names[static_cast<std::size_t>(builder)];
  }
  KdTree(mesh).count_crossings(rays, again);
  EXPECT_EQ(again, counts);
  for (const int threads : {0, 2, 3}) {
    expect_same(bvh.all_hits(rays, {.threads = threads}));
    EXPECT_EQ(bvh.crossings(arrays, {.threads = threads}).items, crossed.items);
    bvh.count_crossings(arrays, again, {.threads = threads});
    EXPECT_EQ(again, counts);
  }
  std::vector<std::size_t> offsets(rays.size() + 1);
  std::vector<Hit> room(all.items.size());
  EXPECT_EQ(bvh.all_hits(rays, offsets, std::span(room).first(room.size() - 1)), room.size());
  EXPECT_EQ(offsets, all.offsets);
  EXPECT_FALSE(room[0]) << "not all: none";
  EXPECT_EQ(bvh.all_hits(rays, offsets, room), room.size());
  EXPECT_TRUE(same_bytes(room, all.items));
  Random random(44);
  for (const std::vector<std::uint8_t>& mask : masks_for(rays.size(), random)) {
    const RayLists<Hit> some = bvh.all_hits(rays, {.active = mask.data()});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool active = (mask[i / 8] >> i % 8 & 1) != 0;
      ASSERT_TRUE(same_bytes(some[i], active ? all[i] : std::span<const Hit>())) << i;
    }
    std::vector<CrossingCount> untouched(rays.size(), {77, 78});
    bvh.count_crossings(rays, untouched, {.active = mask.data()});
    for (std::size_t i = 0; i < rays.size(); ++i)
      ASSERT_EQ(untouched[i], (mask[i / 8] >> i % 8 & 1) != 0 ? counts[i] : (CrossingCount{77, 78})) << i;
  }
}

TEST(Lists, of_empty_trees_and_wrong_options) {
  const Bvh bvh;
  const KdTree kdtree;
  const std::vector<Ray> rays(3, make_ray({0, 0, 0}, {1, 0, 0}));
  EXPECT_EQ(bvh.all_hits(rays).offsets, std::vector<std::size_t>(4));
  EXPECT_TRUE(kdtree.crossings(rays).items.empty());
  EXPECT_EQ(bvh.all_hits(RayView()).size(), 0u);
  std::vector<CrossingCount> counts(2);
  EXPECT_THROW(bvh.count_crossings(rays, counts), std::invalid_argument);
  EXPECT_THROW(bvh.all_hits(rays, {.threads = -1}), std::invalid_argument);
  EXPECT_THROW(bvh.all_hits(RayView(nullptr, 3)), std::invalid_argument);
  std::vector<std::size_t> offsets(3);
  EXPECT_THROW(bvh.all_hits(rays, offsets, {}), std::invalid_argument);
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
