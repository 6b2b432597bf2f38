// Every query of rays in a scene of doubles against rational numbers, on every path; parts and rays for such scenes.
#pragma once

#include "../../oracles/peeled.hpp"
#include "../../queries/query_trees.hpp"
#include "../../support/filtered.hpp"
#include "scene_d_oracle.hpp"

namespace raylanes::testing {

inline void expect_rays(const SceneD& scene, const std::vector<RayD>& rays, const ExpectedD& expected,
                        TraceOptionsD options) {
  options.facing = expected.facing, options.mask = expected.mask, options.skip = expected.skip;
  const std::size_t n = rays.size();
  const RayColumns columns(rays);
  std::vector<SceneHitD> hits(n), arrays(n);
  std::vector<std::uint8_t> occluded(n, 7);
  scene.closest(rays, hits, options), scene.closest(columns.view(), arrays, options);
  scene.occluded(rays, occluded, options);
  for (std::size_t i = 0; i < n; ++i) {
    const SceneHitD wanted = expected.nearest(i);
    ASSERT_TRUE(same_bytes(hits[i], wanted)) << "ray " << i << ": t " << hits[i].t << ", not " << wanted.t;
    ASSERT_TRUE(same_bytes(arrays[i], wanted)) << "ray " << i;
    ASSERT_EQ(occluded[i], wanted ? 1 : 0) << "ray " << i;
    TraceOptionsD alone = options;
    if (!expected.skip.empty()) alone.skip = expected.skip[i];
    ASSERT_TRUE(same_bytes(scene.closest(rays[i], alone), wanted)) << "ray " << i;
    ASSERT_EQ(scene.occluded(rays[i], alone), static_cast<bool>(wanted)) << "ray " << i;
  }
  if (n > 20) {  // few rays take another way; inactive rays keep their hits
    std::vector<SceneHitD> few(20);
    TraceOptionsD some = options;
    some.skip = expected.skip.empty() ? PrimitiveView() : PrimitiveView(std::span(expected.skip).first(20));
    scene.closest(std::span(rays).first(20), few, some);
    EXPECT_TRUE(same_bytes(few, std::span(hits).first(20)));
    const std::vector<std::uint8_t> active(n / 8 + 1, 0x5a);
    std::vector<SceneHitD> kept(n);
    TraceOptionsD masked = options;
    masked.active = active.data();
    scene.closest(rays, kept, masked);
    for (std::size_t i = 0; i < n; ++i)
      ASSERT_TRUE(same_bytes(kept[i], (0x5a >> i % 8 & 1) != 0 ? hits[i] : SceneHitD())) << i;
  }
  expect_peeled(rays, expected.hits, options, hits_of(scene, rays, expected.skip));
  expect_peeled(rays, expected.closest_crossings, options, closest_crossings_of(scene, rays, expected.skip));
}

inline void expect_lists(const SceneD& scene, const std::vector<RayD>& rays, const ExpectedD& expected,
                         const TraceOptionsD& by) {
  for (const std::uint32_t most : {~0u, 0u, 2u}) {
    const ListOptions options{.max_count = most,
                              .facing = expected.facing,
                              .path = by.path,
                              .threads = by.threads,
                              .skip = expected.skip,
                              .mask = expected.mask};
    const auto hits = scene.all_hits(rays, options);
    const auto crossings = scene.crossings(rays, options);
    std::vector<CrossingCount> counts(rays.size());
    scene.count_crossings(rays, counts, options);
    ASSERT_TRUE(hits.size() == rays.size() && crossings.size() == rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto first = [&](const auto& list) {
        return std::span(list).first(std::min<std::size_t>(most, list.size()));
      };
      ASSERT_TRUE(same_bytes(hits[i], first(expected.hits[i]))) << "ray " << i;
      ASSERT_TRUE(std::ranges::equal(crossings[i], first(expected.crossings[i]))) << "ray " << i;
      CrossingCount count;
      for (const auto& crossing : expected.crossings[i]) ++count.crossings, count.winding += crossing.side;
      ASSERT_EQ(counts[i], count) << "ray " << i;
    }
  }
}

// A primitive of an instance for each ray: that of its nearest hit or the next, of some rays another instance's, or
// none.
inline std::vector<SceneHitD> some_skips(const ExpectedD& all) {
  std::vector<SceneHitD> skips;
  for (const auto& hits : all.hits) {
    const std::size_t i = skips.size();
    skips.push_back(hits.empty() || i % 6 == 5 ? SceneHitD() : hits[std::min(i % 2, hits.size() - 1)]);
    if (i % 6 == 3) ++skips.back().instance;
  }
  return skips;
}

// Returns how many hits there are.
inline std::size_t expect_every_query(const PartsD& parts, const std::vector<RayD>& rays) {
  const ExpectedD all(parts, rays, Facing::any, ~0u);
  const std::vector<SceneHitD> skips = some_skips(all);
  for (const ExpectedD& expected :
       {all, ExpectedD(parts, rays, Facing::front, 0b0111u), ExpectedD(parts, rays, Facing::back, ~0u, skips),
        ExpectedD(parts, rays, Facing::any, 0b0100u, skips)}) {
    SCOPED_TRACE(std::string(facing_names[static_cast<std::size_t>(expected.facing)]) + ", mask " +
                 std::to_string(expected.mask) + (expected.skip.empty() ? "" : ", without some"));
    on_each_path([&](const Path* path, int threads) {
      expect_rays(parts.scene, rays, expected, {.path = path, .threads = threads});
      expect_lists(parts.scene, rays, expected, {.path = path, .threads = threads});
    });
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_TRUE(same_bytes(parts.scene.closest(rays[i]), all.nearest(i))) << i;
    EXPECT_EQ(parts.scene.occluded(rays[i]), static_cast<bool>(all.nearest(i))) << i;
  }
  std::size_t hits = 0;
  for (const auto& of_ray : all.hits) hits += of_ray.size();
  return hits;
}

inline TransformD random_transform_d(Random& random, double size, double shift) {
  TransformD transform;
  for (auto& row : transform.row)
    for (double& x : row) x = random.real(-1, 1) * (&x == row + 3 ? shift : size);
  return transform;
}
// A turn about z, and a move.
inline TransformD turned(double angle, const Double3& to) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{{c, -s, 0, to[0]}, {s, c, 0, to[1]}, {0, 0, 1, to[2]}}};
}
// From points around an instance to points of it, as its transform places them.
inline std::vector<RayD> rays_to_parts(const PartsD& parts, std::size_t count, double reach, Random& random) {
  std::vector<RayD> rays;
  const auto coordinate = [&] { return random.real(-1, 1); };
  while (rays.size() < count) {
    const TransformD to =
        parts.scene.transform_of(static_cast<std::uint32_t>(random.index(parts.scene.instance_count())));
    const Double3 local{coordinate(), coordinate(), coordinate()};
    RayD& ray = rays.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const double at = to.row[i][0] * local[0] + to.row[i][1] * local[1] + to.row[i][2] * local[2];
      ray.origin[i] = to.row[i][3] + reach * coordinate();
      ray.direction[i] = to.row[i][3] + at - ray.origin[i];
    }
    ray.tmin = rays.size() % 5 == 0 ? -0.5 : 0;
    if (rays.size() % 7 == 0) ray.tmax = 1;
  }
  return rays;
}

inline PartsD parts_of(std::initializer_list<DoubleMesh> meshes) {
  PartsD parts;
  for (const DoubleMesh& mesh : meshes) parts.add(mesh);
  return parts;
}
inline DoubleMesh soup(std::size_t triangles) {
  return moved(triangle_soup(triangles, 0.7f, 182), 1, {});
}
// Ties in t, edges and corners are many.
inline DoubleMesh soup_on_lattice(Random& random) {
  DoubleMesh mesh;
  for (std::uint32_t i = 0; i < 90; ++i) {
    mesh.vertices.emplace_back();
    for (double& x : mesh.vertices.back()) x = random.integer(-2, 2);
    if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
  }
  return mesh;
}
inline std::vector<RayD> rays_on_lattice(Random& random, std::size_t count) {
  std::vector<RayD> rays(count);
  for (RayD& ray : rays) {
    for (double& x : ray.origin) x = random.integer(-3, 3);
    for (double& x : ray.direction) x = random.integer(-2, 2);
    ray.tmin = random.chance(0.25) ? -HUGE_VAL : 0;
  }
  return rays;
}

}  // namespace raylanes::testing
