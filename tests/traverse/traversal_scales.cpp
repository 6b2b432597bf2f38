// Scenes of any size, anywhere, and directions of any length: what overflows or is flushed loses no hit.
#include "../../bench/support/oracles/exact_rays.hpp"
#include "../support/float_modes.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"
#include "reference/traced.hpp"

namespace raylanes::testing {
namespace {

// Towards points of triangles, from some of their size away: directions of about that length, now and then along axes.
std::vector<Ray> rays_at(const Mesh& mesh, float size, float length, Random& random) {
  std::vector<Ray> rays;
  for (int i = 0; i < 64; ++i) {
    const Triangle target =
        triangle_of(mesh.vertices, mesh.triangles[static_cast<std::size_t>(i) % mesh.triangles.size()]);
    Ray ray = ray_to(target.corner[0], target, 0.25, 0.25);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float inside = ray.origin[axis] + ray.direction[axis];
      ray.direction[axis] = random.chance(0.3) ? 0.0f : random.number(-length, length);
      ray.origin[axis] = inside - ray.direction[axis] / length * size;
    }
    ray.tmin = 0x1p-20f * size / length;  // a t of zero may be a flushed one
    rays.push_back(ray);
  }
  return rays;
}

// The same from one place, side by side, and to a light.
void expect_exact_in_batches(const Mesh& mesh, const std::vector<Ray>& rays, float length_by_size) {
  const Bvh bvh(mesh);
  expect_exact_hits(bvh, mesh, rays);
  std::vector<Ray> shared = rays, beam = rays, to_light = rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Float3 target = mesh.vertices[i % mesh.vertices.size()];
    shared[i].origin = to_light[i].origin = rays[0].origin;
    beam[i].direction = rays[i / 32 * 32].direction;
    to_light[i].origin = target, to_light[i].tmax = 1 / length_by_size;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      shared[i].direction[axis] = (target[axis] - rays[0].origin[axis]) * length_by_size;
      to_light[i].direction[axis] = -shared[i].direction[axis];
    }
  }
  for (const auto& batch : {shared, beam, to_light}) expect_exact_hits(bvh, mesh, batch);
}

TEST(Scales, lose_no_hit) {
  Random random(101);
  const Mesh unit = triangle_soup(20, 0.5f, 102);
  for (int size = -105; size <= 95; size += 20)
    for (int offset = quick() ? 18 : 0; offset <= 18 && size + offset <= 110; offset += 18)
      for (const int length : {-28, 0, 28, 100}) {
        if (std::abs(size - length) > 100) continue;
        SCOPED_TRACE("size 2^" + std::to_string(size) + " at 2^" + std::to_string(size + offset) +
                     ", directions 2^" + std::to_string(length));
        Mesh mesh = unit;
        const auto axis = random.index(3);
        for (Float3& vertex : mesh.vertices) {
          for (float& x : vertex) x = std::ldexp(x, size);
          if (offset > 0) vertex[axis] += std::ldexp(1.0f, size + offset);
        }
        const float by_size = std::ldexp(1.0f, length - size);
        expect_exact_in_batches(mesh, rays_at(mesh, std::ldexp(1.0f, size), std::ldexp(1.0f, length), random),
                                by_size);
      }
}

// A batch so large that it becomes streams by itself.
TEST(Scales, lose_no_hit_in_streams_far_from_zero) {
  Random random(103);
  Mesh mesh = triangle_soup(40, 0.5f, 104);
  for (Float3& vertex : mesh.vertices)
    for (std::size_t axis = 0; axis < 3; ++axis)
      vertex[axis] = vertex[axis] * 0x1p50f + (axis == 1 ? 0x1p68f : 0.0f);
  std::vector<Ray> rays;
  for (int i = 0; i < 4096; ++i) {
    const Float3 p = random.point(0x1p50f, {0, 0x1p68f, 0});
    rays.push_back(make_ray({-0x1p52f, p[1], p[2]}, {0x1p-30f, 0, 0}));
  }
  const Bvh bvh(mesh);
  const std::vector<Hit> expected = trace(bvh, rays, {.mode = TraversalMode::single});
  EXPECT_GT(std::count_if(expected.begin(), expected.end(), [](const Hit& hit) { return !!hit; }), 1000);
  expect_hits(bvh, rays, expected);
  for (const Path* path : supported_paths())
    EXPECT_EQ(trace_occluded(bvh, rays, {.path = path}),
              trace_occluded(bvh, rays, {.mode = TraversalMode::single}));
}

// The padding of boxes stays small against the tree, as long as flushed coordinates are small. Otherwise each ray would
// be tested against all triangles.
TEST(Scales, of_tiny_trees_take_few_triangle_tests) {
  const Mesh unit = ellipsoid(4, {0, 0, 0}, {1, 1, 1});
  const std::vector<Ray> rays = mixed_rays(unit, 1000, 2, {0, 0, 0}, 105);
  struct Scaled {
    int size;
    Mesh mesh;
    std::vector<Ray> rays;
    Bvh bvh;

    Scaled(int of, const Mesh& unit_mesh, const std::vector<Ray>& unit_rays)
        : size(of), mesh(unit_mesh), rays(unit_rays) {
      for (Float3& vertex : mesh.vertices)
        for (float& x : vertex) x = std::ldexp(x, size);
      for (Ray& ray : rays)
        for (float& x : ray.origin) x = std::ldexp(x, size);
      bvh = Bvh(mesh);
    }
    double tests(TraversalMode mode, const Path* path) const {
      TraceCounters counters;
      std::vector<Hit> hits(rays.size());
      bvh.closest(rays, hits, {.mode = mode, .path = path, .counters = &counters});
      return static_cast<double>(counters.triangle_tests);
    }
  };
  for (const FloatMode float_mode : float_modes) {
    const FloatModeScope scope(float_mode);
    std::vector<Scaled> scaled;
    for (const int size : {0, -59, -62, -70, -90, -110, -119}) scaled.emplace_back(size, unit, rays);
    for (const Path* path : supported_paths()) {
      SCOPED_TRACE(path->name);
      for (const TraversalMode mode :
           {TraversalMode::automatic, TraversalMode::single, TraversalMode::packet, TraversalMode::stream}) {
        const double usual = scaled[0].tests(mode, path);
        for (const Scaled& tiny : std::span(scaled).subspan(1))
          EXPECT_LT(tiny.tests(mode, path), (tiny.size < -110 ? 20 : 3) * usual) << tiny.size;
      }
    }
  }
}

// Coherent packets of rays that begin in the plane of a mesh so small that a share of its size is zero.
TEST(Scales, lose_no_hit_where_coherent_packets_have_no_length) {
  for (const float size : {0x1p-120f, 0x1p-142f}) {
    Mesh mesh = integer_grid(6);
    scale(mesh, size);
    std::vector<Ray> rays;
    for (int i = 0; i < 144; ++i)
      rays.push_back(
          make_ray({(static_cast<float>(i % 12) + 0.5f) / 2 * size, static_cast<float>(i / 12) / 2 * size, 0},
                   {0.25f, 0.5f, -1}));
    const Bvh bvh(mesh);
    const std::vector<Hit> hits = oracle::nearest_hits(mesh, rays);
    EXPECT_EQ(std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return !!hit; }), 144);
    expect_hits(bvh, rays, hits);
    if (size < 0x1p-126f) continue;
    const FloatModeScope scope(FloatMode::flush);
    expect_hits(bvh, rays, hits);
  }
}

}  // namespace
}  // namespace raylanes::testing
