// Few rays that go one way from about one place, which are traced together: the hits of exact arithmetic.
#include <raylanes/scene.hpp>

#include "../../bench/support/oracles/exact_rays.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "reference/traced.hpp"

namespace raylanes::testing {
namespace {

enum class Alike { origin, end, parallel };

// Rays of one octant past a point near the origin. Some pass through the mesh's vertices.
std::vector<Ray> alike_rays(const Mesh& mesh, Alike kind, int octant, std::size_t count, Random& random) {
  Float3 way, eye;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    way[axis] = (octant >> axis & 1) != 0 ? -random.number(1, 2) : random.number(1, 2);
    eye[axis] = -2 * way[axis];
  }
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Float3 target =
        random.chance(0.3) ? mesh.vertices[random.index(mesh.vertices.size())] : random.point(0.4f);
    Float3 from = kind == Alike::origin ? eye : random.point(0.3f, eye), direction;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (kind == Alike::parallel) from[axis] = target[axis] - 2 * way[axis];
      direction[axis] = kind == Alike::parallel ? way[axis] : target[axis] - from[axis];
      if (kind == Alike::end) direction[axis] = 2 * way[axis] - from[axis];
    }
    rays.push_back(make_ray(from, direction, 0, random.chance(0.3) ? random.number(0.3f, 1) : infinity));
  }
  return rays;
}

void expect_together(const Bvh& bvh, const Mesh& mesh, std::span<const Ray> rays) {
  const std::vector<Hit> hits = oracle::nearest_hits(mesh, rays);
  expect_hits(bvh, rays, hits);
  std::vector<std::uint32_t> skip;
  for (const Hit& hit : hits) skip.push_back(skip.size() % 3 == 0 ? no_primitive : hit.primitive);
  for (const Facing facing : {Facing::any, Facing::front, Facing::back}) {
    const TraceOptions chosen{.facing = facing, .skip = skip};
    TraceOptions scalar = chosen;
    scalar.mode = TraversalMode::single, scalar.path = &paths().front();
    expect_hits(bvh, rays, trace(bvh, rays, scalar), chosen);
  }
}

TEST(FewRays, that_are_alike_have_the_hits_of_exact_arithmetic) {
  Random random(2901);
  for (const Mesh& mesh : {triangle_soup(400, 0.2f, 2902), triangle_soup(9, 0.9f, 2903)}) {
    const Bvh bvh(mesh);
    for (const Alike kind : {Alike::origin, Alike::end, Alike::parallel})
      for (int octant = 0; octant < 8; ++octant)
        for (const std::size_t count : {std::size_t{3}, std::size_t{8}, std::size_t{17}, std::size_t{63},
                                        std::size_t{64}, std::size_t{150}, std::size_t{1100}}) {
          if (count > 1000 && octant != 3) continue;
          SCOPED_TRACE(count);
          expect_together(bvh, mesh, alike_rays(mesh, kind, octant, count, random));
          if (HasFailure()) return;
        }
  }
}

// One of them is unusual, or of another octant.
TEST(FewRays, take_others_along) {
  Random random(2904);
  const Mesh mesh = triangle_soup(300, 0.2f, 2905);
  const Bvh bvh(mesh);
  for (int kind = 0; kind < 5; ++kind)
    for (const std::size_t at : {std::size_t{1}, std::size_t{30}}) {
      std::vector<Ray> rays = alike_rays(mesh, Alike::origin, kind, 31, random);
      if (kind == 0) rays[at].tmin = nan;
      if (kind == 1) rays[at].tmin = -1;
      if (kind == 2) rays[at].direction[0] = 0;
      if (kind == 3) rays[at].direction[1] = -rays[at].direction[1];
      if (kind == 4) rays[at].origin[2] = 1e30f;
      expect_together(bvh, mesh, rays);
    }
}

// Hits in planes of boxes, beside them by roundings, and boxes that are flat: where frusta are widened too little, they
// are lost.
TEST(FewRays, hit_in_planes_of_boxes) {
  Random random(2906);
  for (const float far : {0.0f, 3.0f, 40.0f}) {
    Mesh mesh = integer_grid(6);
    for (Float3& vertex : mesh.vertices)
      for (float& x : vertex) x = x * 0.3f + far;
    const Bvh bvh(mesh);
    for (int i = 0; i < static_cast<int>(by_level(20, 100, 400)); ++i) {
      const Float3 eye = random.point(4, {far, far, far});
      std::vector<Ray> rays;
      for (std::size_t k = 0; k < 24; ++k) {
        const Float3& target = mesh.vertices[random.index(mesh.vertices.size())];
        rays.push_back(make_ray(eye, {target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]}));
      }
      const auto octant_of = [](const Ray& ray) {
        return (ray.direction[0] < 0) | (ray.direction[1] < 0) << 1 | (ray.direction[2] < 0) << 2;
      };
      std::ranges::sort(rays, {}, octant_of);
      for (std::size_t first = 0, end; first < rays.size(); first = end) {
        for (end = first; end < rays.size() && octant_of(rays[end]) == octant_of(rays[first]);) ++end;
        expect_together(bvh, mesh, std::span(rays).subspan(first, end - first));
      }
      if (HasFailure()) return;
    }
  }
}

// Batches by default options.
TEST(FewRays, by_default_options_have_the_hits_of_calls) {
  Random random(2907);
  const Mesh mesh = triangle_soup(500, 0.2f, 2908);
  const Bvh bvh(mesh);
  Scene scene;
  for (const Mesh& part : {mesh, triangle_soup(50, 0.3f, 2909)}) scene.place(scene.add(Bvh(part)));
  scene.update();
  for (std::size_t count = 1; count <= 64; ++count) {
    const std::vector<Ray> rays = alike_rays(mesh, Alike::origin, static_cast<int>(count % 8), count, random);
    std::vector<Hit> hits(count);
    std::vector<std::uint8_t> occluded(count);
    std::vector<SceneHit> of_scene(count);
    std::vector<std::uint8_t> occluded_in_scene(count);
    bvh.closest(rays, hits), bvh.occluded(rays, occluded);
    scene.closest(rays, of_scene), scene.occluded(rays, occluded_in_scene);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_TRUE(same_bytes(hits[i], bvh.closest(rays[i]))) << count;
      EXPECT_EQ(occluded[i] != 0, bvh.occluded(rays[i])) << count;
      EXPECT_TRUE(same_bytes(of_scene[i], scene.closest(rays[i]))) << count;
      EXPECT_EQ(occluded_in_scene[i] != 0, scene.occluded(rays[i])) << count;
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
