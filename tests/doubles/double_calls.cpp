// Trees of doubles: layouts, ends of batches and of segments, and what is reported of them.
#include "../support/guarded_array.hpp"
#include "../support/message_of.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

struct Sample {
  DoubleMesh mesh = moved(double_fan(40, 0.3f), 0.7, {0.1, 0.2, 0.3});
  BvhD tree{mesh.vertices, mesh.triangles};
  std::vector<RayD> rays = aimed_rays(mesh, 300, 1);
  std::vector<HitD> hits = traced();

  std::vector<HitD> traced() const {
    std::vector<HitD> result(rays.size());
    tree.closest(rays, result);
    return result;
  }
};

TEST(DoubleCalls, records_of_any_stride_and_alignment) {
  const Sample sample;
  const std::size_t n = sample.rays.size();
  for (const std::size_t stride : {64, 67, 128}) {
    std::vector<std::byte> rays(stride * n + 3), hits(stride * n + 1, std::byte{0x5a});
    for (std::size_t i = 0; i < n; ++i) std::memcpy(&rays[3 + i * stride], &sample.rays[i], sizeof(RayD));
    sample.tree.closest(RayViewD(&rays[3], n, stride), HitViewD(&hits[1], n, stride));
    for (std::size_t i = 0; i < n; ++i) {
      HitD hit;
      std::memcpy(static_cast<void*>(&hit), &hits[1 + i * stride], sizeof hit);
      ASSERT_TRUE(same_bytes(hit, sample.hits[i]));
      for (std::size_t k = sizeof hit; k < stride && i + 1 < n; ++k)
        ASSERT_EQ(hits[1 + i * stride + k], std::byte{0x5a});
    }
  }
  // Vertices, too.
  std::vector<std::byte> vertices(29 * sample.mesh.vertices.size() + 5);
  for (std::size_t i = 0; i < sample.mesh.vertices.size(); ++i)
    std::memcpy(&vertices[5 + 29 * i], &sample.mesh.vertices[i], sizeof(Double3));
  const BvhD tree(VertexViewD(&vertices[5], sample.mesh.vertices.size(), 29), sample.mesh.triangles);
  std::vector<HitD> hits(n);
  tree.closest(sample.rays, hits);
  EXPECT_TRUE(same_bytes(hits, sample.hits));
}

TEST(DoubleCalls, batches_of_any_size_end_where_they_end) {
  const Sample sample;
  for (const Path* path : paths_with_own_queries())
    for (std::size_t n = 0; n < 40; ++n) {
      GuardedArray<RayD> rays(n, Place::before_guard);
      GuardedArray<HitD> hits(n, Place::before_guard);
      GuardedArray<std::uint8_t> occluded(n, Place::before_guard);
      rays.fill(std::span(sample.rays).first(n));
      sample.tree.closest(RayViewD(rays.data(), n), HitViewD(hits.data(), n), {.path = path});
      sample.tree.occluded(RayViewD(rays.data(), n), {occluded.data(), n}, {.path = path});
      ASSERT_TRUE(hits.holds(std::span(sample.hits).first(n)));
      ASSERT_TRUE(rays.is_intact() && hits.is_intact() && occluded.is_intact());
    }
}

TEST(DoubleCalls, rays_that_are_none_miss) {
  const Sample sample;
  const double nan_d = std::numeric_limits<double>::quiet_NaN(),
               inf = std::numeric_limits<double>::infinity();
  const RayD good{{0.1, 0.2, 5}, 0, {0, 0, -1}, inf};
  ASSERT_TRUE(sample.tree.closest(good));
  for (int number = 0; number < 8; ++number)
    for (const double value : {nan_d, inf, -inf, 0.0}) {
      RayD ray = good;
      double* const numbers[] = {&ray.origin[0],    &ray.origin[1],    &ray.origin[2],    &ray.tmin,
                                 &ray.direction[0], &ray.direction[1], &ray.direction[2], &ray.tmax};
      *numbers[number] = value;
      const bool is_fine = (number < 3 && value == 0) || (number == 3 && (value == 0 || value == -inf)) ||
                           (number > 3 && number < 6 && value == 0) || (number == 7 && value == inf);
      if (is_fine) continue;
      SCOPED_TRACE(::testing::Message() << number << ' ' << value);
      EXPECT_FALSE(sample.tree.closest(ray));
      EXPECT_FALSE(sample.tree.occluded(ray));
      EXPECT_TRUE(sample.tree.all_hits(std::span(&ray, 1)).items.empty());
      // Among rays from a point that hit the mesh.
      std::vector<RayD> rays(100, good);
      for (std::size_t i = 1; i < rays.size(); i += 3) rays[i] = ray;
      std::vector<HitD> hits(rays.size());
      std::vector<std::uint8_t> occluded(rays.size());
      for (const Path* path : paths_with_own_queries()) {
        sample.tree.closest(rays, hits, {.path = path}), sample.tree.occluded(rays, occluded, {.path = path});
        for (std::size_t i = 0; i < rays.size(); ++i)
          ASSERT_TRUE(static_cast<bool>(hits[i]) == (i % 3 != 1) && occluded[i] == (i % 3 != 1 ? 1 : 0)) << i;
      }
    }
}

TEST(DoubleCalls, ends_of_segments_are_doubles) {
  const double wall = 1000 - 1e-5;  // ten micrometres before a point that is a kilometre away
  const std::vector<Double3> corners{{wall, -1, -1}, {wall, 2, -1}, {wall, -1, 2}};
  const BvhD tree(corners, std::vector<Index3>{{0, 1, 2}});
  const auto is_occluded = [&](double x, const SegmentEndsD& ends) {
    const Double3 point{x, 0, 0};
    std::uint8_t occluded = 7;
    tree.occluded_from({0, 0, 0}, VertexViewD(&point, 1), {&occluded, 1}, ends);
    return occluded != 0;
  };
  EXPECT_TRUE(is_occluded(1000, {}));
  EXPECT_TRUE(is_occluded(1000, {0, 1 - 9.9e-9}));
  EXPECT_FALSE(is_occluded(1000, {0, 1 - 1.01e-8}));
  EXPECT_TRUE(is_occluded(wall, {}));
  EXPECT_FALSE(is_occluded(wall, {0, std::nextafter(1.0, 0.0)}));
}

// The sphere measures two millimetres at 1e5 metres, where floats are 8 mm apart.
TEST(DoubleCalls, a_small_sphere_far_away_is_hit_by_all_rays_to_it) {
  const Mesh sphere = ellipsoid(3, {0, 0, 0}, {1, 1, 1});
  const Double3 at{1e5, 1e5, 1e5};
  const DoubleMesh mesh = moved(sphere, 1e-3, at);
  const BvhD tree(mesh.vertices, mesh.triangles);
  Random random(5);
  std::vector<RayD> rays;
  for (int i = 0; i < 20000; ++i) {
    RayD ray{{at[0] + random.real(-1, 1), at[1] + random.real(-1, 1), at[2] + 1}, 0, {}, 2};
    for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = at[k] + 1e-4 * random.real(-1, 1) - ray.origin[k];
    rays.push_back(ray);
  }
  std::vector<HitD> hits(rays.size());
  tree.closest(rays, hits);
  std::vector<CrossingCount> counts(rays.size());
  tree.count_crossings(rays, counts);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_TRUE(hits[i]);
    ASSERT_EQ(counts[i], (CrossingCount{2, 0}));
  }
}

TEST(DoubleCalls, are_not_counted) {
  TraceCounters counters;
  const std::vector<RayD> rays(3);
  expect_words(message_of<std::invalid_argument>([&] { BvhD().all_hits(rays, {.counters = &counters}); }),
               {"counted"});
}

// Triangles of floats have the same boxes in both trees but for the frame, so the same tree is made.
TEST(DoubleTrees, cost_what_trees_of_floats_cost) {
  const Mesh mesh = triangle_soup(3000, 0.1f, 4);
  const DoubleMesh doubles = moved(mesh, 1, {0, 0, 0});
  const TreeReport of_floats = Bvh(mesh).report(),
                   report = BvhD(doubles.vertices, doubles.triangles).report();
  EXPECT_NEAR(report.sah_cost, of_floats.sah_cost, 0.01 * of_floats.sah_cost);
  EXPECT_NEAR(report.overlap, of_floats.overlap, 0.01);
}

TEST(DoubleTrees, say_what_was_chosen) {
  const DoubleMesh mesh = moved(triangle_soup(2000, 0.1f, 5), 1, {0, 0, 0});
  const TreeReport few = BvhD(mesh.vertices, mesh.triangles, {.choose = true, .rays = 1}).report(),
                   many = BvhD(mesh.vertices, mesh.triangles, {.choose = true}).report();
  EXPECT_NE(few.choice, "");
  EXPECT_NE(few.choice, many.choice);
  EXPECT_NE(std::pair(few.builder, few.optimized), std::pair(many.builder, many.optimized));
}

// Batches that pass the tree by but for a ray that no sample looks at: calls with one ray must keep what options ask.
TEST(DoubleCalls, keep_options_for_the_ray_that_does_not_pass_by) {
  const std::vector<Double3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Index3> triangle{{0, 1, 2}};
  const BvhD tree(corners, triangle);
  constexpr std::size_t hitting = 1;
  std::vector<RayD> rays(100, {{5, 5, 1}, 0, {0, 0, -1}, std::numeric_limits<double>::infinity()});
  rays[hitting].origin = {0.25, 0.25, 1};
  const std::vector<std::uint32_t> masks{2}, skips(rays.size(), 0);
  const auto finds = [&](const TraceOptionsD& options) {
    std::vector<HitD> hits(rays.size());
    tree.closest(rays, hits, options);
    return static_cast<bool>(hits[hitting]);
  };
  EXPECT_TRUE(finds({}));
  EXPECT_TRUE(finds({.facing = Facing::front}));
  EXPECT_FALSE(finds({.facing = Facing::back}));
  EXPECT_FALSE(finds({.skip = skips}));
  EXPECT_TRUE(finds({.mask = 2, .masks = masks}));
  EXPECT_FALSE(finds({.mask = 1, .masks = masks}));
}

TEST(DoubleTrees, tell_of_each_triangle_once) {
  DoubleMesh mesh = moved(double_fan(600, 0.3f), 0.7, {5e6, 0.2, -0.3});
  mesh.triangles.push_back({0, 1, 1});
  BvhD tree(mesh.vertices, mesh.triangles);
  const auto expect_triangles = [&] {
    std::vector<int> times(mesh.triangles.size());
    tree.each_triangle([&](std::uint32_t primitive, const std::array<Double3, 3>& corners) {
      ++times.at(primitive);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(corners[k], mesh.vertices[mesh.triangles[primitive][k]]) << primitive;
    });
    for (std::size_t i = 0; i < times.size(); ++i) {
      const auto [a, b, c] = corners_of(mesh, i);
      EXPECT_EQ(times[i], a == b || b == c || c == a ? 0 : 1) << i;
    }
  };
  expect_triangles();
  // Those that collapse at a refit are not there.
  mesh.vertices[mesh.triangles[7][1]] = mesh.vertices[mesh.triangles[7][0]];
  tree.refit(mesh.vertices, mesh.triangles);
  expect_triangles();

  EXPECT_THROW(tree.each_triangle([](std::uint32_t, const std::array<Double3, 3>&) { throw 7; }), int);
  EXPECT_THROW(tree.each_triangle({}), std::bad_function_call);
  BvhD().each_triangle({});
}

}  // namespace
}  // namespace raylanes::testing
