// Rays at the ends of what floats hold: nothing but the tree's own triangles is ever looked at, and what brute
// force finds is found.
#include "../../accel/layout/bvh_arrays.hpp"
#include "../support/float_modes.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"
#include "reference/reference_tracer.hpp"
#include "reference/traced.hpp"

namespace raylanes::testing {
namespace {

// Traces in every test and grade, in both float modes. The hits of the promised ones are looked at by
// expect_brute_force; here they must be primitives of the mesh.
void expect_own_primitives(const Mesh& mesh, const std::vector<Ray>& rays) {
  const Bvh bvh(mesh);
  for (const FloatMode mode : float_modes)
    for (const TraceOptions& options : ways_by_every_test()) {
      const FloatModeScope scope(mode);
      for (const Hit& hit : trace(bvh, rays, options))
        ASSERT_TRUE(hit.primitive < mesh.triangles.size() || hit.primitive == no_primitive)
            << name_of(options) << ", " << name_of(mode);
      for (const std::uint8_t occluded : trace_occluded(bvh, rays, options))
        ASSERT_LE(occluded, 1) << name_of(options) << ", " << name_of(mode);
    }
}

// The slots without a child in the nodes of the mesh's tree.
int empty_slots(const Mesh& mesh) {
  const BvhArrays tree = build_bvh(mesh.vertices, mesh.triangles, {});
  int empty = 0;
  for (const WideNode& node : tree.nodes) empty += tree_width - std::popcount(node.occupied);
  return empty;
}

// NaN is in the slabs of an empty slot where each reciprocal is NaN (direction below 2^-128), or zero (beyond 2^126
// with FTZ), or a difference of plane and origin overflows.
TEST(BvhExtremes, an_empty_slot_is_followed_by_no_ray) {
  const Mesh mesh = triangle_soup(20, 0.1f, 51);
  ASSERT_GT(empty_slots(mesh), 0);
  Random random(52);
  std::vector<Ray> rays;
  for (int signs = 0; signs < (quick() ? 1 : 4); signs += 3) {
    const Float3 far{signs & 1 ? -3e38f : 3e38f, 2e38f, signs & 2 ? -2.5e38f : 2.5e38f};
    const float largest = std::numeric_limits<float>::max();
    for (const float scale : {1e-39f, 1e-38f, 1.0f, 0x1.8p126f, largest}) {
      for (int i = 0; i < by_level(1, 1, 3); ++i) {
        const Float3 any = random.point(1);
        rays.push_back(make_ray(far, {scale * any[0], scale * any[1], scale * any[2]}));
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Ray along = make_ray(far, {});
        along.direction[axis] = far[axis] > 0 ? -scale : scale;
        rays.push_back(along);
        along.direction[(axis + 1) % 3] = scale;
        rays.push_back(along);
      }
    }
    rays.push_back(make_ray(far, {-far[0], -far[1], -far[2]}));
  }
  // Runs that agree, too.
  const std::size_t different = rays.size();
  for (std::size_t i = 0; i < different; i += 3) rays.insert(rays.end(), 16, rays[i]);
  expect_own_primitives(mesh, rays);
  expect_brute_force(mesh, std::vector(rays.begin(), rays.begin() + static_cast<std::ptrdiff_t>(different)));
}

TEST(BvhExtremes, a_hit_from_the_end_of_the_number_line_is_not_lost) {
  Mesh mesh = triangle_soup(300, 0.3f, 53);
  std::vector<Ray> rays;
  for (const float far : {1e30f, 1e36f, 3e38f, std::numeric_limits<float>::max()})
    for (const float scale : {1e-3f, 1.0f, 1e3f, 0x1p100f, 0x1p127f})
      for (int i = 0; i < by_level(6, 6, 12); ++i) {
        const auto axis = static_cast<std::size_t>(i % 3);
        Random random(54 + static_cast<std::uint64_t>(i));
        Ray ray = make_ray(random.point(1), {});
        ray.origin[axis] = i % 2 == 0 ? far : -far;
        ray.direction[axis] = i % 2 == 0 ? -scale : scale;
        rays.push_back(ray);
      }
  EXPECT_GT(expect_brute_force(mesh, rays), rays.size() / 6);
}

// The entry of a ray into a box is kept with few digits while the ray waits in a list of a stream. Rounded to a later
// t, as a negative number is that loses digits, it would be behind the end of such a segment.
TEST(BvhExtremes, segments_before_the_origin_that_end_at_their_hit) {
  const Mesh mesh = triangle_soup(3000, 0.05f, 57);
  const Bvh bvh(mesh);
  std::vector<Ray> rays;
  for (Ray ray : mixed_rays(mesh, by_level(20000), 1.5f, {0, 0, 0}, 58)) {
    const Hit hit = bvh.closest(ray);
    if (!hit) continue;
    for (float& d : ray.direction) d = -d;
    ray.tmin = -1.01f * hit.t, ray.tmax = std::nextafter(-hit.t, 0.0f);
    rays.push_back(ray);
  }
  ASSERT_GT(rays.size(), by_level(20000) / 20);
  const std::vector<Hit> hits = trace(bvh, rays, {.mode = TraversalMode::single});
  for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_LE(hits[i].t, rays[i].tmax);
  expect_hits(bvh, rays, hits);
}

// Components whose reciprocal overflows: in the time that reaches the mesh they move the ray by up to a unit.
TEST(BvhExtremes, directions_below_the_normal_numbers) {
  const Mesh mesh = triangle_soup(300, 0.3f, 55);
  Random random(56);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(800); ++i) rays.push_back(ray_below_normal_numbers(random, i));
  EXPECT_GT(expect_brute_force(mesh, rays), 10u);
}

// With DAZ both ends of these segments are zeros, to integers as to floats: the rays hit where they begin, or nothing.
TEST(BvhExtremes, segments_whose_ends_are_flushed) {
  Mesh mesh;
  mesh.vertices = {
      {0, 0, 0x1.8p-100f}, {0x1p-100f, -0x1p-99f, 0x1.8p-100f}, {0x1p-101f, 0x1p-100f, 0x1.8p-100f}};
  mesh.triangles.assign(20, {0, 1, 2});
  Ray ray = make_ray(mesh.vertices[0], {0, 0x1p29f, 0x1p29f});
  ray.tmin = -0x1p-128f, ray.tmax = -0x1p-129f;
  const std::vector<Ray> rays(100, ray);
  const Bvh bvh(mesh);
  const FloatModeScope flushes(FloatMode::flush);
  for (const TraceOptions& options : ways_by_every_test())
    for (const Hit& hit : trace(bvh, rays, options))
      ASSERT_TRUE(hit.primitive == no_primitive || hit.t == 0) << name_of(options) << ": " << hit.t;
}

TEST(BvhExtremes, an_infinite_distance_is_no_hit) {
  Mesh mesh;
  mesh.vertices = {{-0.3f, -0.3f, 0}, {0.3f, -0.3f, 0}, {0, 0.3f, 0}};
  mesh.triangles.assign(20, {0, 1, 2});
  std::vector<Ray> rays;
  for (const float z : {2.0f, 5.0f}) rays.insert(rays.end(), 17, make_ray({0, 0, -z}, {0, 0, 1e-38f}));
  // 2 units away it is t = 2e38, 5 units away more than any float.
  EXPECT_EQ(expect_brute_force(mesh, rays), 17u);
  const Bvh bvh(mesh);
  for (const TraceOptions& options : ways_by_every_test()) {
    const std::vector<std::uint8_t> occluded = trace_occluded(bvh, rays, options);
    const std::vector<Hit> hits = trace(bvh, rays, options);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(occluded[i], hits[i].primitive != no_primitive) << name_of(options);
      EXPECT_EQ(hits[i].primitive != no_primitive, std::isfinite(hits[i].t)) << name_of(options);
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
