// Trees against a brute force over all triangles with the canonical test, byte for byte, on every path and in
// every mode: soups, shared edges, coincident triangles, flat and degenerate meshes, far ones, deep trees.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "generators.hpp"
#include "oracles/exact_triangle.hpp"
#include "reference_tracer.hpp"
#include "supported_paths.hpp"
#include "traced.hpp"

namespace raylanes::testing {
namespace {

std::size_t fewer_if_quick(std::size_t count) {
  return quick() ? std::max<std::size_t>(count / 6, 60) : count;
}

// `copies` of one triangle's corners.
Mesh repeated(const TriangleVertices& triangle, std::size_t copies) {
  Mesh mesh;
  for (const auto& corner : triangle.vertex) mesh.vertices.push_back({corner[0], corner[1], corner[2]});
  mesh.triangles.assign(copies, {0, 1, 2});
  return mesh;
}

void move(Mesh& mesh, const Float3& by) {
  for (Float3& vertex : mesh.vertices)
    for (std::size_t axis = 0; axis < 3; ++axis) vertex[axis] += by[axis];
}

TEST(Bvh, without_triangles_is_hit_by_nothing) {
  const std::vector<Ray> rays = mixed_rays({}, 40, 2, {0, 0, 0}, 1);
  EXPECT_EQ(expect_brute_force({}, rays), 0u);
  const Mesh corners_only{{{0, 0, 0}, {1, 0, 0}}, {}};
  EXPECT_EQ(expect_brute_force(corners_only, rays), 0u);
}

TEST(Bvh, of_any_small_size) {
  for (const std::size_t size : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 15u, 16u, 17u, 63u, 64u, 65u, 129u}) {
    SCOPED_TRACE(size);
    const Mesh mesh = triangle_soup(size, 0.5f, size);
    EXPECT_GT(expect_brute_force(mesh, mixed_rays(mesh, fewer_if_quick(400), 2, {0, 0, 0}, size)), 0u);
  }
}

TEST(Bvh, random_soups) {
  for (const float size : {0.02f, 0.2f, 2.0f}) {
    SCOPED_TRACE(size);
    const Mesh mesh = triangle_soup(fewer_if_quick(3000), size, 7);
    EXPECT_GT(expect_brute_force(mesh, mixed_rays(mesh, fewer_if_quick(2000), 2, {0, 0, 0}, 8)), 10u);
  }
}

// Rays from lattice points above and below, straight and aslant, through corners and edges of the grid.
std::vector<Ray> grid_rays(std::uint32_t cells, Random& random) {
  std::vector<Ray> rays;
  const int last = 2 * static_cast<int>(cells);
  for (std::size_t i = 0; i < fewer_if_quick(2000); ++i) {
    const float z = random.chance(0.5) ? 4.0f : -4.0f;
    const Float3 direction{static_cast<float>(random.integer(-1, 1)),
                           static_cast<float>(random.integer(-1, 1)), z > 0 ? -1.0f : 1.0f};
    const auto coordinate = [&](float d) {
      return 0.5f * static_cast<float>(random.integer(0, last)) - 4 * d;
    };
    rays.push_back(make_ray({coordinate(direction[0]), coordinate(direction[1]), z}, direction));
  }
  return rays;
}

TEST(Bvh, a_grid_hit_exactly_on_edges_and_corners) {
  Random random(9);
  const std::vector<Ray> rays = grid_rays(12, random);
  EXPECT_EQ(expect_brute_force(integer_grid(12), rays), rays.size()) << "closed edges: no ray may pass";
}

TEST(Bvh, flat_meshes_and_axis_aligned_rays) {
  Mesh mesh = integer_grid(8);
  for (std::size_t normal = 0; normal < 3; ++normal) {
    SCOPED_TRACE(normal);
    Random random(10);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < fewer_if_quick(1200); ++i) {
      Float3 origin, direction;
      for (float& x : origin) x = 0.5f * static_cast<float>(random.integer(-2, 18));
      for (float& x : direction) x = random.chance(0.5) ? 0.0f : -0.0f;
      direction[static_cast<std::size_t>(random.integer(0, 2))] = random.chance(0.5) ? 1.0f : -1.0f;
      rays.push_back(make_ray(origin, direction));
    }
    EXPECT_GT(expect_brute_force(mesh, rays), 10u);
    for (Float3& v : mesh.vertices) std::rotate(v.begin(), v.begin() + 1, v.end());
  }
}

TEST(Bvh, of_coincident_triangles_the_smallest_primitive_wins) {
  const Mesh mesh = repeated(make_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}), 1000);
  const std::vector<Ray> rays = mixed_rays(mesh, fewer_if_quick(500), 2, {0, 0, 0}, 11);
  EXPECT_GT(expect_brute_force(mesh, rays), 10u);
  const Bvh bvh(mesh.vertices, mesh.triangles);
  const std::vector<Ray> straight(33, make_ray({0, 0, 5}, {0, 0, -1}));
  for (const TraceOptions& options : ways_to_trace())
    for (const Hit& hit : trace(bvh, straight, options)) EXPECT_EQ(hit.primitive, 0u) << name_of(options);
}

TEST(Bvh, of_coincident_surfaces_in_any_order_the_smallest_primitive_wins) {
  // Each triangle thrice, the copies far apart in the numbering, so that ties meet across leaves.
  Mesh mesh = integer_grid(10);
  const std::vector<Index3> once = mesh.triangles;
  mesh.triangles.insert(mesh.triangles.begin(), once.rbegin(), once.rend());
  mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
  Random random(12);
  EXPECT_GT(expect_brute_force(mesh, grid_rays(10, random)), 10u);
}

TEST(Bvh, triangles_with_one_centre) {
  Mesh mesh;
  Random random(13);
  for (std::uint32_t i = 0; i < 256; ++i) {
    const Float3 half = random.point(1);
    // The box of these corners has its centre at 0.
    mesh.vertices.push_back({-half[0], -half[1], -half[2]});
    mesh.vertices.push_back(half);
    mesh.vertices.push_back({half[0], -half[1], half[2]});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  EXPECT_GT(expect_brute_force(mesh, mixed_rays(mesh, fewer_if_quick(1000), 2, {0, 0, 0}, 14)), 10u);
}

TEST(Bvh, needles) {
  Mesh mesh;
  Random random(15);
  for (std::uint32_t i = 0; i < 500; ++i) {
    const Float3 a = random.point(1), b = random.point(1);
    mesh.vertices.insert(mesh.vertices.end(), {a, b, random.point(1e-6f, b)});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  EXPECT_GT(expect_brute_force(mesh, mixed_rays(mesh, fewer_if_quick(2000), 2, {0, 0, 0}, 16)), 10u);
}

TEST(Bvh, far_from_the_origin) {
  for (const Float3& offset :
       {Float3{1e4f, -3e4f, 2e4f}, Float3{148376, 1234, -223423}, Float3{0, 4e6f, 0}}) {
    SCOPED_TRACE(offset[0]);
    Mesh mesh = triangle_soup(fewer_if_quick(1500), 0.3f, 17);
    move(mesh, offset);
    EXPECT_GT(expect_brute_force(mesh, mixed_rays(mesh, fewer_if_quick(1500), 3, offset, 18)), 10u);
    // And rays from the origin of the coordinates, far from the mesh.
    expect_brute_force(mesh, mixed_rays(mesh, fewer_if_quick(500), 3, {0, 0, 0}, 19));
  }
}

TEST(Bvh, of_tiny_triangles_seen_from_far_away) {
  const Mesh mesh = triangle_soup(fewer_if_quick(2000), 1e-5f, 20);
  EXPECT_GT(expect_brute_force(mesh, mixed_rays(mesh, fewer_if_quick(2000), 50, {0, 0, 0}, 21)), 10u);
}

TEST(Bvh, at_the_ends_of_the_usable_scale) {
  for (const float scale : {1e-12f, 1e-6f, 1e6f, 1e12f}) {
    SCOPED_TRACE(scale);
    Mesh mesh = triangle_soup(200, 0.4f, 22);
    for (Float3& vertex : mesh.vertices)
      for (float& x : vertex) x *= scale;
    std::vector<Ray> rays = mixed_rays({}, fewer_if_quick(1000), 0.5f, {0, 0, 0}, 23);
    for (Ray& ray : rays)
      for (float& x : ray.origin) x *= scale;
    EXPECT_GT(expect_brute_force(mesh, rays), 10u);
  }
}

// Each triangle half as large as the one before and beside it: splits by area take one off at a time.
TEST(Bvh, a_chain_of_shrinking_triangles) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 240; ++i) {
    const float size = std::ldexp(1.0f, 100 - static_cast<int>(i));
    mesh.vertices.insert(mesh.vertices.end(), {{size, 0, 0}, {1.5f * size, 0, 0}, {size, size / 4, 0}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  std::vector<Ray> rays;
  for (int exponent = 100; exponent >= -60; --exponent) {
    const float size = std::ldexp(1.0f, exponent);
    rays.push_back(make_ray({1.125f * size, size / 16, size}, {0, 0, -1}));
    rays.push_back(make_ray({1.9f * size, size / 16, size}, {0, 0, -1}));
  }
  EXPECT_GT(expect_brute_force(mesh, rays), 20u);
}

// Rays in the plane of a triangle up to rounding: its det is little but rounding, and its t may lie far from
// the triangle. Such a hit counts, so the boxes must not hide it.
TEST(Bvh, rays_in_the_planes_of_triangles) {
  for (const float height : {1.0f, 1e-3f}) {
    Mesh mesh = triangle_soup(200, 0.3f, 41);
    for (Float3& vertex : mesh.vertices) vertex[2] *= height;
    Random random(42);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < fewer_if_quick(6000); ++i) {
      const TriangleVertices target = triangle_of(mesh.vertices, mesh.triangles[i % 200]);
      const Ray across = ray_to({0, 0, 0}, target, random.real(-3, 3), random.real(-3, 3));
      const Float3 origin{across.direction[0], across.direction[1], across.direction[2]};
      rays.push_back(ray_to(origin, target, random.real(0, 1), random.real(0, 0.5)));
      if (random.chance(0.3)) rays.back().tmin = -infinity;
    }
    EXPECT_GT(expect_brute_force(mesh, rays), 10u);
  }
}

TEST(Bvh, rays_of_all_directions_and_bad_ones_in_one_batch) {
  const Mesh mesh = triangle_soup(300, 0.4f, 24);
  std::vector<Ray> rays = mixed_rays(mesh, fewer_if_quick(1000), 2, {0, 0, 0}, 25);
  const float bad[] = {nan, infinity, -infinity};
  for (std::size_t i = 0; i < rays.size(); i += 5) {
    const std::size_t kind = i / 5 % 9, axis = i % 3;
    if (kind < 3) rays[i].origin[axis] = bad[kind];
    if (kind >= 3 && kind < 6) rays[i].direction[axis] = bad[kind - 3];
    if (kind == 6) rays[i].tmin = nan;
    if (kind == 7) rays[i].tmax = nan;
    if (kind == 8) std::fill_n(rays[i].direction, 3, 0.0f);
  }
  EXPECT_GT(expect_brute_force(mesh, rays), 10u);
}

TEST(Bvh, coherent_rays_that_form_packets) {
  Mesh mesh = triangle_soup(1000, 0.1f, 26);
  std::vector<Ray> rays;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 64; ++x)
      rays.push_back(make_ray({0.01f, 0.02f, 4}, {0.5f + 0.01f * static_cast<float>(x),
                                                  0.3f + 0.01f * static_cast<float>(y), -4.0f}));
  // Some share the packet but not the segment.
  for (std::size_t i = 0; i < rays.size(); i += 7) rays[i].tmax = 0.9f + 0.001f * static_cast<float>(i % 64);
  for (std::size_t i = 3; i < rays.size(); i += 11) rays[i].tmin = 1.0f;
  EXPECT_GT(expect_brute_force(mesh, std::span(rays).first(fewer_if_quick(rays.size()))), 10u);
}

TEST(Bvh, batches_of_any_length) {
  const Mesh mesh = triangle_soup(100, 0.4f, 27);
  std::vector<Ray> rays = mixed_rays(mesh, 33, 2, {0, 0, 0}, 28);
  // A run of rays that agree, so that packets and rests of them occur.
  for (std::size_t i = 0; i < rays.size(); i += 2)
    rays[i] = rays[i + 1 < rays.size() ? i + 1 : i - 1] = make_ray({0, 0, 3}, {0.1f, 0.2f, -1});
  const Bvh bvh(mesh.vertices, mesh.triangles);
  const std::vector<Hit> expected = brute_force(mesh.vertices, mesh.triangles, rays);
  for (std::size_t n = 0; n <= rays.size(); ++n) {
    SCOPED_TRACE(n);
    expect_hits(bvh, std::span(rays).first(n), std::span(expected).first(n));
    expect_hits(bvh, std::span(rays).last(n), std::span(expected).last(n));
  }
}

TEST(Bvh, segments_are_closed_at_hits_and_beside_them) {
  const Mesh mesh = triangle_soup(300, 0.4f, 29);
  const std::vector<Ray> whole = mixed_rays(mesh, fewer_if_quick(600), 2, {0, 0, 0}, 30);
  const std::vector<Hit> hits = brute_force(mesh.vertices, mesh.triangles, whole);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (hits[i].primitive == no_primitive) continue;
    const float t = hits[i].t, before = std::nextafter(t, -infinity), behind = std::nextafter(t, infinity);
    for (const auto& [tmin, tmax] : {std::pair{t, t},
                                     {t, infinity},
                                     {0.0f, t},
                                     {0.0f, before},
                                     {behind, infinity},
                                     {t, before},
                                     {-infinity, infinity},
                                     {-infinity, 0.0f}}) {
      rays.push_back(whole[i]);
      rays.back().tmin = tmin, rays.back().tmax = tmax;
    }
  }
  EXPECT_GT(expect_brute_force(mesh, rays), 100u);
}

TEST(Bvh, many_rays_on_two_threads) {
  const Mesh mesh = triangle_soup(200, 0.3f, 31);
  const Bvh bvh(mesh.vertices, mesh.triangles);
  // More than one task's share of rays, and no multiple of it.
  const std::vector<Ray> rays = mixed_rays(mesh, 3 * 4096 + 17, 2, {0, 0, 0}, 32);
  for (TraceOptions options : ways_to_trace()) {
    const std::vector<Hit> alone = trace(bvh, rays, options);
    for (options.threads = 2; options.threads >= 0; options.threads -= 2)
      EXPECT_EQ(std::memcmp(trace(bvh, rays, options).data(), alone.data(), alone.size() * sizeof(Hit)), 0)
          << name_of(options);
  }
}

TEST(Bvh, can_be_moved) {
  const Mesh mesh = triangle_soup(50, 0.4f, 33);
  Bvh first(mesh.vertices, mesh.triangles);
  Bvh second(std::move(first));
  EXPECT_GT(second.bytes(), 0u);
  EXPECT_GT(second.leaf_count(), 0u);
  first = std::move(second);
  const std::vector<Ray> rays = mixed_rays(mesh, 50, 2, {0, 0, 0}, 34);
  expect_hits(first, rays, brute_force(mesh.vertices, mesh.triangles, rays));
}

// --- Closed meshes
// -------------------------------------------------------------------------------------------

class ClosedMeshInATree : public ::testing::TestWithParam<Float3> {};

TEST_P(ClosedMeshInATree, does_not_leak_in_either_grade) {
  const Mesh mesh = ellipsoid(quick() ? 1 : 3, GetParam());
  const Bvh bvh(mesh.vertices, mesh.triangles);
  Random random(35);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < fewer_if_quick(60000); ++i) {
    const Index3& corners = mesh.triangles[i % mesh.triangles.size()];
    rays.push_back(ray_to(random.point(0.4f, GetParam()), triangle_of(mesh.vertices, corners),
                          random.chance(0.5) ? 0 : random.real(0, 1), 0));
  }
  for (const Grade grade : {Grade::reproducible, Grade::fast})
    for (const TraceOptions& options : ways_to_trace({.grade = grade})) {
      const std::vector<Hit> hits = trace(bvh, rays, options);
      const auto leaks = std::count_if(hits.begin(), hits.end(),
                                       [](const Hit& hit) { return hit.primitive == no_primitive; });
      EXPECT_EQ(leaks, 0) << name_of(options);
      const std::vector<std::uint8_t> occluded = trace_occluded(bvh, rays, options);
      EXPECT_EQ(std::count(occluded.begin(), occluded.end(), 0), 0) << name_of(options);
    }
}

INSTANTIATE_TEST_SUITE_P(Offsets, ClosedMeshInATree,
                         ::testing::Values(Float3{0, 0, 0}, Float3{148376, 1234, -223423}));

// --- The other tests and grades
// ------------------------------------------------------------------------------

oracle::DoubleTriangleTest nearest_in_double(const Mesh& mesh, const Ray& ray) {
  oracle::DoubleTriangleTest best;
  for (const Index3& corners : mesh.triangles) {
    const oracle::DoubleTriangleTest test = oracle::double_triangle(ray, triangle_of(mesh.vertices, corners));
    if (test.hit && (!best.hit || test.t < best.t)) best = test;
  }
  return best;
}

TEST(Bvh, every_test_and_grade_agrees_with_double_precision) {
  const Mesh mesh = triangle_soup(fewer_if_quick(500), 0.3f, 36);
  const Bvh bvh(mesh.vertices, mesh.triangles);
  // Rays anywhere: none comes within rounding of an edge.
  const std::vector<Ray> rays = mixed_rays({}, fewer_if_quick(2000), 2, {0, 0, 0}, 37);
  std::vector<oracle::DoubleTriangleTest> expected;
  for (const Ray& ray : rays) expected.push_back(nearest_in_double(mesh, ray));
  for (const TriangleTest test : {TriangleTest::watertight, TriangleTest::moller_trumbore})
    for (const Grade grade : {Grade::reproducible, Grade::fast})
      for (const TraceOptions& options : ways_to_trace({.test = test, .grade = grade})) {
        const std::vector<Hit> hits = trace(bvh, rays, options);
        const std::vector<std::uint8_t> occluded = trace_occluded(bvh, rays, options);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          ASSERT_EQ(hits[i].primitive != no_primitive, expected[i].hit) << name_of(options) << " ray " << i;
          ASSERT_EQ(occluded[i] != 0, expected[i].hit) << name_of(options) << " ray " << i;
          if (!expected[i].hit) continue;
          ASSERT_NEAR(hits[i].t, expected[i].t, 1e-4 * std::max(1.0, expected[i].t)) << name_of(options);
          ASSERT_NEAR(hits[i].u, expected[i].u, 1e-3) << name_of(options) << " ray " << i;
          ASSERT_NEAR(hits[i].v, expected[i].v, 1e-3) << name_of(options) << " ray " << i;
        }
      }
}

// --- Errors
// --------------------------------------------------------------------------------------------------

// The message of the std::invalid_argument that `call` throws: one line, or a test failure.
template <class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    return e.what();
  }
  ADD_FAILURE() << "no std::invalid_argument";
  return {};
}

void expect_words(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(message.find(word), std::string::npos) << "\"" << word << "\" is not in: " << message;
}

TEST(BvhErrors, meshes_that_are_none) {
  const std::vector<Float3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Index3> good{{0, 1, 2}}, bad{{0, 1, 2}, {0, 3, 2}};
  expect_words(message_of([&] { Bvh(corners, bad); }), {"triangle 1", "3"});
  for (const float value : {nan, infinity, -infinity}) {
    std::vector<Float3> spoilt = corners;
    spoilt[2][1] = value;
    expect_words(message_of([&] { Bvh(spoilt, good); }), {"vertex 2", "y"});
  }
}

TEST(BvhErrors, batches_and_threads) {
  const Mesh mesh = triangle_soup(3, 0.4f, 38);
  const Bvh bvh(mesh.vertices, mesh.triangles);
  const std::vector<Ray> rays(3, make_ray({0, 0, 3}, {0, 0, -1}));
  std::vector<Hit> two_hits(2), hits(3);
  std::vector<std::uint8_t> four_flags(4), flags(3);
  const TraceOptions negative{.threads = -1};
  expect_words(message_of([&] { bvh.closest(rays, two_hits); }), {"3", "2"});
  expect_words(message_of([&] { bvh.occluded(rays, four_flags); }), {"3", "4"});
  expect_words(message_of([&] { bvh.closest(rays, hits, negative); }), {"-1", "thread"});
  expect_words(message_of([&] { bvh.occluded(rays, flags, negative); }), {"-1", "thread"});
}

TEST(BvhErrors, a_path_that_this_machine_lacks) {
  const Mesh mesh = triangle_soup(3, 0.4f, 39);
  const Bvh bvh(mesh.vertices, mesh.triangles);
  const auto lacking =
      std::find_if(paths().begin(), paths().end(), [](const Path& p) { return !supported(p); });
  if (lacking == paths().end()) GTEST_SKIP() << "this machine supports all paths";
  std::vector<Hit> hits(1);
  const Ray ray = make_ray({0, 0, 3}, {0, 0, -1});
  const TraceOptions options{.path = &*lacking};
  expect_words(message_of([&] { bvh.closest({&ray, 1}, hits, options); }), {lacking->name});
}

TEST(BvhErrors, progress_may_give_up) {
  const Mesh mesh = triangle_soup(40000, 0.01f, 40);
  double last = 0;
  Bvh(mesh.vertices, mesh.triangles, [&](double share) {
    EXPECT_GT(share, last);
    EXPECT_LE(share, 1.0);
    last = share;
  });
  EXPECT_GT(last, 0);
  EXPECT_THROW(Bvh(mesh.vertices, mesh.triangles, [](double) { throw std::runtime_error("enough"); }),
               std::runtime_error);
}

}  // namespace
}  // namespace raylanes::testing
