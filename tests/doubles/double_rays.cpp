// Batches of rays of doubles that go as streams or as packets: single calls, which rational arithmetic judges in
// tests/queries/worlds/every_query.cpp, have their hits. And what ends the search of lists.
#include "../../accel/doubles/bvh_d_arrays.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../support/meshes.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/in_flight.hpp"
#include "../traverse/reference/segment_to.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

std::string text_of(const RayD& ray) {
  char line[400];
  std::snprintf(line, sizeof line, "o %a %a %a d %a %a %a t %a %a", ray.origin[0], ray.origin[1],
                ray.origin[2], ray.direction[0], ray.direction[1], ray.direction[2], ray.tmin, ray.tmax);
  return line;
}

void expect_single_calls(const BvhD& tree, const std::vector<RayD>& rays, TraceOptionsD options) {
  std::vector<HitD> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  tree.closest(rays, hits, options);
  tree.occluded(rays, occluded, options);
  const PrimitiveView skip = options.skip;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::uint32_t skipped = skip.first != nullptr ? skip[i] : no_primitive;
    if (skip.first != nullptr) options.skip = skipped;
    const HitD hit = tree.closest(rays[i], options);
    ASSERT_TRUE(same_bytes(hits[i], hit)) << i << ' ' << text_of(rays[i]);
    ASSERT_EQ(occluded[i], hit ? 1 : 0) << i << ' ' << text_of(rays[i]);
  }
}

// One side, without the first hits, and by masks.
void expect_chosen(const BvhD& tree, const std::vector<RayD>& rays, const TraceOptionsD& options) {
  std::vector<HitD> first(rays.size());
  tree.closest(rays, first, options);
  std::vector<std::uint32_t> masks(tree.report().triangles);
  for (std::size_t i = 0; i < masks.size(); ++i) masks[i] = i % 3 == 0 ? 2 : 1;
  TraceOptionsD skips = options, turns = options, chooses = options;
  skips.skip = first, turns.facing = rays.size() % 2 == 0 ? Facing::back : Facing::front;
  chooses.masks = masks, chooses.mask = 1, chooses.skip = first, chooses.facing = turns.facing;
  expect_single_calls(tree, rays, skips);
  expect_single_calls(tree, rays, turns);
  expect_single_calls(tree, rays, chooses);
}

// As segments from points to a light, which sees the other side.
void expect_chosen_shadows(const BvhD& tree, const std::vector<RayD>& rays, const Double3& light,
                           TraceOptionsD options) {
  std::vector<Double3> points;
  std::vector<HitD> nearest(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  for (const RayD& ray : rays) points.push_back(ray.origin);
  tree.closest(rays, nearest, options);
  for (const Facing side : {Facing::any, Facing::front}) {
    options.facing = side, options.skip = nearest;
    tree.occluded_from(light, points, occluded, {}, options);
    if (side == Facing::front) options.facing = Facing::back;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      options.skip = nearest[i];
      const RayD ray = segment_to<double>(light, points[i]);
      ASSERT_EQ(occluded[i] != 0, tree.occluded(ray, options)) << i << ' ' << text_of(ray);
    }
  }
}

// Streams take so many rays if most begin in the box, packets runs of one origin. Below level all each case on one
// path, all paths in turn.
TEST(DoubleRays, large_batches_agree_with_single_calls) {
  const std::vector<const Path*> paths = paths_with_own_queries();
  std::size_t turn = 0;
  for (const DoubleCase& c : double_cases(0)) {
    const BvhD tree(c.mesh.vertices, c.mesh.triangles);
    std::vector<std::vector<RayD>> batches{aimed_rays(c.mesh, 5000, 77, 0.9)};
    for (const std::size_t run :
         {std::size_t{64}, std::size_t{700}, by_level<std::size_t>(2000, 17000, 40000)})
      batches.push_back(aimed_rays_from_points(c.mesh, run < 1000 ? 3 * run + 50 : run + 50, run, run));
    for (std::size_t p = 0; p < paths.size(); ++p) {
      if (by_level(true, true, false) && turn % paths.size() != p) continue;
      SCOPED_TRACE(c.name + " on " + paths[p]->name);
      for (const bool fly : {false, true}) {
        let_rays_fly(tree, fly);
        for (const std::vector<RayD>& rays : batches)
          expect_single_calls(tree, rays, {.path = paths[p], .threads = rays.size() == 2150 ? 2 : 1});
        for (const std::vector<RayD>& rays :
             {aimed_rays(c.mesh, 5000, 78, 0.9), aimed_rays_from_points(c.mesh, 400, 100, 6)}) {
          expect_chosen(tree, rays, {.path = paths[p]});
          expect_chosen_shadows(tree, rays, rays[0].origin, {.path = paths[p]});
        }
      }
      if (HasFailure()) return;
    }
    ++turn;
  }
}

// In rows of 16, by steps of a 300th; or side by side.
std::vector<RayD> neighbours_of(const RayD& first, std::size_t count, bool share_origin) {
  std::vector<RayD> rays;
  const auto size = std::max_element(first.direction.begin(), first.direction.end(),
                                     [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto axis = static_cast<std::size_t>(size - first.direction.begin());
  for (std::size_t i = 0; i < count; ++i) {
    RayD ray = first;
    Double3& moved = share_origin ? ray.direction : ray.origin;
    moved[(axis + 1) % 3] += static_cast<double>(i % 16) / 300 * std::abs(*size);
    moved[(axis + 2) % 3] += static_cast<double>(i / 16) / 300 * std::abs(*size);
    rays.push_back(ray);
  }
  return rays;
}

// Few of them go as packets or streams, where single rays would not.
TEST(DoubleRays, few_neighbours_agree_with_single_calls) {
  for (const DoubleCase& c : double_cases(by_level<std::size_t>(2, 4, 12))) {
    const BvhD tree(c.mesh.vertices, c.mesh.triangles);
    for (const Path* path : paths_with_own_queries())
      for (const RayD& ray : c.rays)
        for (const std::size_t count : {32, 40, 63, 64, 270})
          for (const bool share_origin : {false, true}) {
            SCOPED_TRACE(c.name + " on " + path->name);
            const std::vector<RayD> rays = neighbours_of(ray, count, share_origin);
            expect_single_calls(tree, rays, {.path = path});
            if (count == 64) expect_chosen(tree, rays, {.path = path});
          }
    if (HasFailure()) return;
  }
}

// By the room that it takes: of 3000 triangles a ray looks for the nearest few only.
TEST(DoubleLists, of_a_few_hits_end_the_search) {
  const DoubleMesh mesh = moved(stack_of(3000), 1, {0, 0, 0});
  constexpr RayD through_stack{{0.2, 0.2, -1}, 0, {0, 0, 1}, 10000};
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

}  // namespace
}  // namespace raylanes::testing
