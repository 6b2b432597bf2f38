// Batches of rays: with bad ones among neighbours, of any length, on threads, with segments that end at hits.
#include "../../bench/support/oracles/exact_rays.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "reference/traced.hpp"

namespace raylanes::testing {
namespace {

// Bad rays whose directions agree with their neighbours', in each lane of a register; an infinite direction would hit
// all that its origin sees, at t = 0.
TEST(Bvh, bad_rays_among_coherent_ones) {
  const Mesh mesh = integer_grid(4);
  const Ray good = make_ray({1.3f, 1.6f, -2}, {0.1f, 0.2f, 1});
  std::vector<Ray> bad(10, good);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bad[axis].origin[axis] = infinity;
    bad[3 + axis].direction[axis] = infinity;
  }
  bad[6].tmin = bad[7].tmax = nan;
  bad[8].tmin = 4;
  bad[8].tmax = 1;
  bad[9].direction = {};
  for (const Ray& one : bad) {
    std::vector<Ray> rays(17 * 16, good);
    for (std::size_t i = 0; i < rays.size(); i += 17) rays[i] = one;
    EXPECT_EQ(expect_brute_force(mesh, rays), rays.size() - 16);
  }
}

TEST(Bvh, of_any_small_size) {
  for (const std::size_t size : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 15u, 16u, 17u, 63u, 64u, 65u, 129u}) {
    SCOPED_TRACE(size);
    const Mesh mesh = triangle_soup(size, 0.5f, size);
    EXPECT_GT(expect_brute_force(mesh, mixed_rays(mesh, by_level(400), 2, {0, 0, 0}, size)), 0u);
  }
}

TEST(Bvh, batches_of_any_length) {
  const Mesh mesh = triangle_soup(100, 0.4f, 27);
  std::vector<Ray> rays = mixed_rays(mesh, 33, 2, {0, 0, 0}, 28);
  // A run of rays that agree, so that they are traced together.
  for (std::size_t i = 0; i < rays.size(); i += 2)
    rays[i] = rays[i + 1 < rays.size() ? i + 1 : i - 1] = make_ray({0, 0, 3}, {0.1f, 0.2f, -1});
  const Bvh bvh(mesh.vertices, mesh.triangles);
  const std::vector<Hit> expected = oracle::nearest_hits(mesh, rays);
  for (std::size_t n = 0; n <= rays.size(); ++n) {
    SCOPED_TRACE(n);
    expect_hits(bvh, std::span(rays).first(n), std::span(expected).first(n));
    expect_hits(bvh, std::span(rays).last(n), std::span(expected).last(n));
  }
}

TEST(Bvh, segments_are_closed_at_hits_and_beside_them) {
  const Mesh mesh = triangle_soup(300, 0.4f, 29);
  const std::vector<Ray> whole = mixed_rays(mesh, by_level(600), 2, {0, 0, 0}, 30);
  const std::vector<Hit> hits = oracle::nearest_hits(mesh, whole);
  std::vector<Ray> rays, coherent;  // these in runs of one ray, a box too is entered and left at one t
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
      if (i % 4 == 0) coherent.insert(coherent.end(), 16, rays.back());
    }
  }
  EXPECT_GT(expect_brute_force(mesh, rays), 100u);
  EXPECT_GT(expect_brute_force(mesh, coherent), 16u);
}

TEST(Bvh, many_rays_on_two_threads) {
  const Mesh mesh = triangle_soup(200, 0.3f, 31);
  const Bvh bvh(mesh.vertices, mesh.triangles);
  // More than one task's share of rays, and no multiple of it.
  const std::vector<Ray> rays = mixed_rays(mesh, 3 * 4096 + 17, 2, {0, 0, 0}, 32);
  for (TraceOptions options : ways_to_trace()) {
    const std::vector<Hit> alone = trace(bvh, rays, options);
    for (options.threads = 2; options.threads >= 0; options.threads -= 2)
      EXPECT_TRUE(same_bytes(trace(bvh, rays, options), alone)) << name_of(options);
  }
}

// Rays of a camera, rays to two lights by runs, and any rays: whatever a hint says of them.
TEST(Bvh, hints_change_no_hits) {
  const Mesh mesh = triangle_soup(by_level(400), 0.4f, 42);
  Random random(43);
  std::vector<Ray> rays = mixed_rays(mesh, 300, 2, {0, 0, 0}, 44);
  for (int i = 0; i < 300; ++i) rays.push_back(make_ray({0.1f, 0.2f, 3}, random.point(1, {0, 0, -2})));
  for (const Float3& light : {Float3{0.5f, 2, 0.1f}, Float3{-1, 0.2f, 2}})
    for (int i = 0; i < 4096; ++i) {
      Ray ray = make_ray(random.point(1), light, 0, 0.999f);
      for (std::size_t axis = 0; axis < 3; ++axis) ray.direction[axis] -= ray.origin[axis];
      rays.push_back(ray);
    }
  const Bvh bvh(mesh);
  const std::vector<Hit> hits = trace(bvh, rays, {.mode = TraversalMode::single});
  const std::vector<std::uint8_t> occluded = trace_occluded(bvh, rays, {.mode = TraversalMode::single});
  for (std::size_t i = 0; i < batch_hint_names.size(); ++i)
    for (const std::size_t first : {std::size_t{0}, std::size_t{600}}) {
      const auto hint = static_cast<BatchHint>(i);
      SCOPED_TRACE(batch_hint_names[i]);
      const std::span<const Ray> some = std::span(rays).subspan(first);
      EXPECT_TRUE(same_bytes(trace(bvh, some, {.hint = hint}), std::span(hits).subspan(first)));
      EXPECT_TRUE(
          std::ranges::equal(trace_occluded(bvh, some, {.hint = hint}), std::span(occluded).subspan(first)));
    }
}

}  // namespace
}  // namespace raylanes::testing
