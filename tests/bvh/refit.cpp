// Trees that follow meshes in motion: hits of exact arithmetic over the moved mesh, byte for byte, whatever happens to
// its triangles; and how much worse than new a tree says it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "../../bench/support/oracles/exact_hit.hpp"
#include "../support/message_of.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"

namespace raylanes::testing {
namespace {

constexpr int thread_counts[] = {1, 2, 0};

std::size_t expect_exact(const Bvh& bvh, const Mesh& mesh, std::span<const Ray> rays) {
  const std::vector<Hit> expected = oracle::exact_hits(mesh.vertices, mesh.triangles, rays);
  expect_hits(bvh, rays, expected);
  return static_cast<std::size_t>(
      std::count_if(expected.begin(), expected.end(), [](const Hit& hit) { return static_cast<bool>(hit); }));
}

// Each vertex somewhere else, by up to `by` along each axis.
Mesh moved(Mesh mesh, float by, std::uint64_t seed) {
  Random random(seed);
  for (Float3& vertex : mesh.vertices) vertex = random.point(by, vertex);
  return mesh;
}

void expect_empty_unused_lanes(const BvhView& view) {
  for (const LeafBlock<9>& leaf : view.leaves)
    for (std::size_t lane = 0; lane < tree_width; ++lane)
      for (const auto& row : leaf.number)
        EXPECT_EQ(std::isnan(row[lane]), leaf.primitive[lane] == no_primitive);
}

// Corners of a triangle for which nothing but its box matters.
void set_corners(Mesh& mesh, std::size_t triangle, const Float3& a, const Float3& b, const Float3& c) {
  const Index3& corners = mesh.triangles[triangle];
  mesh.vertices[corners[0]] = a, mesh.vertices[corners[1]] = b, mesh.vertices[corners[2]] = c;
}

TEST(Refit, of_any_small_size) {
  for (const std::size_t size : {1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 16u, 17u, 63u, 64u, 65u, 129u}) {
    SCOPED_TRACE(size);
    const Mesh mesh = triangle_soup(size, 0.5f, size), far = moved(mesh, 3, size);
    for (const int threads : thread_counts) {
      Bvh bvh(mesh);
      bvh.refit(far.vertices, far.triangles, threads);
      EXPECT_GT(expect_exact(bvh, far, mixed_rays(far, by_level(300), 4, {0, 0, 0}, size)), 0u);
      EXPECT_EQ(bvh.bounds().lo, Bvh(far).bounds().lo);
      EXPECT_EQ(bvh.bounds().hi, Bvh(far).bounds().hi);
      expect_empty_unused_lanes(bvh.view());
    }
  }
}

TEST(Refit, time_and_again) {
  Mesh mesh = triangle_soup(by_level(2000), 0.1f, 50);
  Bvh bvh(mesh);
  for (std::uint64_t frame = 0; frame < 4; ++frame) {
    SCOPED_TRACE(frame);
    mesh = moved(mesh, 0.3f, frame);
    bvh.refit(mesh.vertices, mesh.triangles, thread_counts[frame % 3]);
    EXPECT_GT(expect_exact(bvh, mesh, mixed_rays(mesh, by_level(800), 2, {0, 0, 0}, frame)), 10u);
  }
}

// More nodes than are updated one by one where there are threads.
TEST(Refit, of_many_subtrees_on_threads) {
  const Mesh mesh = triangle_soup(40000, 0.02f, 71), far = moved(mesh, 0.1f, 72);
  Bvh alone(mesh);
  alone.refit(far.vertices, far.triangles);
  EXPECT_GT(expect_exact(alone, far, mixed_rays(far, 60, 2, {0, 0, 0}, 73)), 10u);
  for (const int threads : {2, 0}) {
    Bvh bvh(mesh);
    bvh.refit(far.vertices, far.triangles, threads);
    EXPECT_GT(bvh.node_count(), 1000u);
    EXPECT_TRUE(same_bytes(bvh.view().nodes, alone.view().nodes)) << threads;
    EXPECT_TRUE(same_bytes(bvh.view().leaves, alone.view().leaves)) << threads;
    EXPECT_EQ(bvh.bounds().lo, alone.bounds().lo);
    EXPECT_EQ(bvh.bounds().hi, alone.bounds().hi);
  }
}

// The other tree has the bytes of a refit, and shares nothing.
TEST(Refit, of_a_copy) {
  const Mesh mesh = triangle_soup(2000, 0.1f, 77), far = moved(mesh, 0.3f, 78);
  const std::vector<Ray> rays = mixed_rays(mesh, by_level(300), 2, {0, 0, 0}, 79);
  Bvh refitted(mesh);
  refitted.refit(far.vertices, far.triangles);
  const Bvh original(mesh), unchanged(mesh);
  std::vector<float> before(1), after(1);
  original.winding_numbers(VertexView(&mesh.vertices[0], 1), before);
  const Bvh other = original.refitted(far.vertices, far.triangles, 2);
  EXPECT_TRUE(same_bytes(other.view().nodes, refitted.view().nodes));
  EXPECT_TRUE(same_bytes(other.view().leaves, refitted.view().leaves));
  EXPECT_TRUE(same_bytes(original.view().leaves, unchanged.view().leaves));
  EXPECT_GT(expect_exact(original, mesh, rays), 10u);
  EXPECT_GT(expect_exact(other, far, rays), 10u);
  other.winding_numbers(VertexView(&mesh.vertices[0], 1), after);
  refitted.winding_numbers(VertexView(&mesh.vertices[0], 1), before);
  EXPECT_EQ(after, before) << "of the moved boundary";
  EXPECT_EQ(Bvh().refitted({}, {}).node_count(), 0u);
  EXPECT_THROW(original.refitted(far.vertices, mesh.triangles, -1), std::invalid_argument);
}

// Spatial splits have clipped boxes, in which moved triangles are not.
TEST(Refit, of_trees_by_every_builder) {
  const Mesh mesh = triangle_soup(by_level(600), 0.6f, 74), far = moved(mesh, 0.5f, 75);
  Mesh dead = mesh;
  dead.vertices[mesh.triangles[0][0]] = mesh.vertices[mesh.triangles[0][1]];
  const std::vector<Ray> rays = mixed_rays(far, by_level(300), 2, {0, 0, 0}, 76);
  for (std::size_t i = 0; i <= tree_builder_names.size(); ++i) {
    const bool optimize = i == tree_builder_names.size();  // once more by spatial splits
    const BuildOptions options{
        .builder = optimize ? TreeBuilder::spatial_splits : static_cast<TreeBuilder>(i),
        .optimize = optimize};
    SCOPED_TRACE(i);
    Bvh bvh(mesh, options), once_dead(dead, options);
    bvh.refit(far.vertices, far.triangles, 2);
    EXPECT_GT(expect_exact(bvh, far, rays), 10u);
    EXPECT_GT(expect_exact(once_dead.refitted(far.vertices, far.triangles), far, rays), 10u);
    once_dead.refit(far.vertices, far.triangles);
    EXPECT_GT(expect_exact(once_dead, far, rays), 10u);
    EXPECT_EQ(once_dead.report().builder, options.builder) << "also where a refit is a build";
    EXPECT_EQ(once_dead.report().references, Bvh(far, options).report().references);
  }
}

TEST(Refit, to_a_point_to_a_plane_and_back) {
  const Mesh mesh = triangle_soup(300, 0.4f, 51);
  const std::vector<Ray> rays = mixed_rays(mesh, by_level(500), 2, {0, 0, 0}, 52);
  Bvh bvh(mesh);
  Mesh point = mesh, plane = mesh;
  for (Float3& vertex : point.vertices) vertex = {1, 2, 3};
  for (Float3& vertex : plane.vertices) vertex[2] = 0.5f;
  bvh.refit(point.vertices, point.triangles);
  EXPECT_EQ(expect_exact(bvh, point, rays), 0u);
  EXPECT_EQ(bvh.bounds().lo, (Float3{1, 2, 3}));
  EXPECT_EQ(bvh.bounds().hi, (Float3{1, 2, 3}));
  bvh.refit(plane.vertices, plane.triangles);
  EXPECT_GT(expect_exact(bvh, plane, rays), 10u);
  bvh.refit(mesh.vertices, mesh.triangles);
  EXPECT_GT(expect_exact(bvh, mesh, rays), 10u);
}

TEST(Refit, to_the_ends_of_the_usable_scale) {
  const Mesh mesh = triangle_soup(200, 0.4f, 53);
  for (const float scaling : {1e-12f, 1e12f}) {
    Mesh scaled = mesh;
    std::vector<Ray> rays = mixed_rays({}, by_level(600), 0.5f, {0, 0, 0}, 54);
    scale(scaled, scaling), scale(rays, scaling);
    Bvh bvh(mesh);
    bvh.refit(scaled.vertices, scaled.triangles);
    EXPECT_GT(expect_exact(bvh, scaled, rays), 10u);
  }
}

// The build leaves triangles with two equal corners out; what lives later is hit, what dies is not.
TEST(Refit, triangles_that_come_to_life_and_die) {
  const Mesh alive = triangle_soup(100, 0.5f, 55);
  Mesh half_dead = alive, dead = alive;
  for (std::size_t i = 0; i < 100; ++i) {
    const Index3& corners = alive.triangles[i];
    const Float3& a = alive.vertices[corners[0]];
    set_corners(dead, i, a, a, i % 3 == 0 ? a : alive.vertices[corners[2]]);
    if (i % 2 == 0) set_corners(half_dead, i, a, alive.vertices[corners[1]], a);
  }
  const std::vector<Ray> rays = mixed_rays(alive, by_level(500), 2, {0, 0, 0}, 56);
  const Mesh* const frames[] = {&half_dead, &alive, &dead, &alive, &dead, &half_dead, &dead};
  for (const Mesh* const first : {frames[0], frames[1], frames[2]}) {
    Bvh bvh(*first);
    for (const Mesh* frame : frames) {
      bvh.refit(frame->vertices, frame->triangles);
      EXPECT_EQ(expect_exact(bvh, *frame, rays) > 10, frame != &dead);
    }
  }
}

TEST(Refit, takes_other_indices_and_other_views) {
  const Mesh mesh = triangle_soup(150, 0.5f, 57), other = triangle_soup(150, 0.5f, 58);
  struct Wide {
    float x, y, z, w;
  };
  std::vector<Wide> vertices;
  std::vector<std::int32_t> flat;
  for (const Float3& vertex : other.vertices) vertices.push_back({vertex[0], vertex[1], vertex[2], nan});
  for (const Index3& triangle : other.triangles)
    for (const std::uint32_t index : triangle) flat.push_back(static_cast<std::int32_t>(index));
  Bvh bvh(mesh);
  bvh.refit(vertices, flat);
  EXPECT_GT(expect_exact(bvh, other, mixed_rays(other, by_level(500), 2, {0, 0, 0}, 59)), 10u);
  // Fewer vertices than before, shared by all.
  Mesh fan{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}};
  for (std::uint32_t i = 0; i < 150; ++i) fan.triangles.push_back({i % 4, (i + 1) % 4, (i + 2) % 4});
  bvh.refit(fan.vertices, fan.triangles);
  EXPECT_GT(expect_exact(bvh, fan, mixed_rays(fan, by_level(500), 2, {0, 0, 0}, 60)), 10u);
}

TEST(Refit, serves_every_test) {
  const Mesh mesh = triangle_soup(300, 0.4f, 61), far = moved(mesh, 0.5f, 62);
  Random random(63);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(600); ++i)
    rays.push_back(make_ray(random.point(2), {0.25f, -0.5f, 1}));
  Bvh refitted(mesh);
  refitted.refit(far.vertices, far.triangles);
  const Bvh built(far);
  for (const TriangleTestInfo& test : triangle_tests) {
    if (!test.serves_trees) continue;
    for (const TraceOptions& way : ways_to_trace({.test = test.test}))
      EXPECT_TRUE(same_bytes(trace(refitted, rays, way), trace(built, rays, way))) << name_of(way);
  }
}

TEST(Refit, of_empty_trees) {
  Bvh none;
  none.refit(std::vector<Float3>{}, std::vector<Index3>{});
  none.refit(std::vector<Float3>{{1, 2, 3}}, std::vector<Index3>{});
  EXPECT_FALSE(none.closest(make_ray({0, 0, 0}, {1, 2, 3})));
  EXPECT_EQ(none.sah_cost(), 0);
  EXPECT_EQ(none.decay(), 1);
  Bvh empty{Mesh{}};
  empty.refit(std::vector<Float3>{}, std::vector<Index3>{});
  EXPECT_EQ(empty.sah_cost(), 0);
  EXPECT_EQ(empty.decay(), 1);
}

TEST(Refit, refuses_what_is_no_such_mesh_and_leaves_the_tree_alone) {
  const Mesh mesh = triangle_soup(50, 0.5f, 64), far = moved(mesh, 1, 65);
  const std::vector<Ray> rays = mixed_rays(mesh, 300, 2, {0, 0, 0}, 66);
  Bvh bvh(mesh);
  const auto expect_refused = [&](const Mesh& wrong, int threads, const std::vector<std::string>& words) {
    expect_words(
        message_of<std::invalid_argument>([&] { bvh.refit(wrong.vertices, wrong.triangles, threads); }),
        words);
    EXPECT_GT(expect_exact(bvh, mesh, rays), 10u);
  };
  Mesh spoilt = far;
  spoilt.triangles.pop_back();
  expect_refused(spoilt, 1, {"refit", "49", "50"});
  for (const float value : {nan, infinity, -infinity}) {
    spoilt = far;
    spoilt.vertices.back()[2] = value;
    expect_refused(spoilt, 1, {"vertex 149", "z"});
  }
  spoilt = far;
  spoilt.triangles.back()[1] = 150;
  expect_refused(spoilt, 1, {"triangle 49", "150"});
  expect_refused(far, -2, {"-2", "thread"});
  Bvh none;
  expect_words(message_of<std::invalid_argument>([&] { none.refit(mesh.vertices, mesh.triangles); }),
               {"50", "0"});
}

TEST(Decay, is_one_after_a_build_and_on_the_way_back) {
  const Mesh mesh = triangle_soup(2000, 0.05f, 67);
  Bvh bvh(mesh);
  const double cost = bvh.sah_cost();
  EXPECT_EQ(bvh.decay(), 1);
  double last = 1;
  for (const float by : {0.01f, 0.1f, 0.5f}) {
    const Mesh far = moved(mesh, by, 68);
    bvh.refit(far.vertices, far.triangles);
    EXPECT_GT(bvh.decay(), last) << by;
    EXPECT_EQ(bvh.decay(), bvh.sah_cost() / cost);
    last = bvh.decay();
    EXPECT_GT(bvh.sah_cost(), Bvh(far).sah_cost()) << "a new tree is better";
  }
  bvh.refit(mesh.vertices, mesh.triangles);
  EXPECT_EQ(bvh.decay(), 1);
}

TEST(Decay, costs_of_a_leaf) {
  EXPECT_FLOAT_EQ(static_cast<float>(Bvh(triangle_soup(4, 0.4f, 69)).sah_cost()), 0.9f);
  const Mesh once = triangle_soup(1, 0.4f, 70);
  EXPECT_FLOAT_EQ(static_cast<float>(Bvh(once.vertices, std::vector<Index3>(8, {0, 1, 2})).sah_cost()), 0.9f);
}

}  // namespace
}  // namespace raylanes::testing
