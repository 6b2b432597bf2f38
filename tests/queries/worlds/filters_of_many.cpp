// Filters of batches large enough for lists of hits, on rays through many layers: which hits are kept, and the order in
// which a filter is asked.
#include <raylanes/scene_d.hpp>

#include "../../support/filtered.hpp"
#include "worlds.hpp"

namespace raylanes::testing {
namespace {

// Triangle k is at about z = k, and is hit by all rays.
Mesh layers(std::uint32_t count) {
  Mesh mesh;
  for (std::uint32_t k = 0; k < count; ++k) {
    const float z = static_cast<float>(k), tilt = static_cast<float>(k % 3) / 8;
    mesh.vertices.insert(mesh.vertices.end(), {{-4, -4, z}, {8, -4, z + tilt}, {-4, 8, z - tilt}});
    mesh.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  return mesh;
}

std::vector<Ray> rays_up(std::size_t count) {
  Random random(4711);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = random.point(1), ray.origin[2] = -1;
    ray.direction = {random.number(-1, 1) / 256, random.number(-1, 1) / 256, 1};
    ray.tmin = 0, ray.tmax = infinity;
  }
  return rays;
}

// Which layers a filter keeps: ray and layer.
using Keeps = bool (*)(std::size_t, std::uint32_t);
struct Case {
  const char* name;
  std::uint32_t layers;
  Keeps keeps;
};
constexpr Case cases[] = {
    {"every other", 12, [](std::size_t ray, std::uint32_t k) { return (ray + k) % 2 == 0; }},
    {"one of eleven", 12, [](std::size_t ray, std::uint32_t k) { return (ray * 5 + k) % 11 == 0; }},
    {"nearly all", 12, [](std::size_t ray, std::uint32_t k) { return (ray * 7 + k) % 41 != 0; }},
    {"none", 12, [](std::size_t, std::uint32_t) { return false; }},
    {"one far behind", 700, [](std::size_t ray, std::uint32_t k) { return k == 600 + ray % 64; }},
    {"many for few rays", 300, [](std::size_t ray, std::uint32_t k) { return ray % 50 != 0 || k == 299; }}};

// The layer of a hit in a tree, or in a scene that has a part for each.
template <class AnyHit>
std::uint32_t layer_of(const AnyHit& hit) {
  if constexpr (requires { hit.instance; })
    return hit.instance;
  else
    return hit.primitive;
}

// A filter is asked about each hit once, in the order of the ray, up to the one that it keeps; for occlusion in no
// order. Calls hold a ray once.
template <class AnyHit, class Tree, class AnyRay, class Options, class Name = std::uint32_t>
void expect_kept(const Tree& tree, const std::vector<AnyRay>& rays, const Case& of, Options options,
                 const std::vector<Name>& skip = {}) {
  if (!skip.empty()) options.skip = skip;
  const std::size_t n = rays.size();
  std::vector<std::size_t> call_of(n);
  std::vector<std::int64_t> last(n, -1);
  std::size_t calls = 0, wrong = 0;
  bool in_order = true;
  const auto filter = [&](std::span<const std::size_t> some, std::span<const AnyHit> hits,
                          std::span<std::uint8_t> rejected) {
    ++calls;
    for (std::size_t k = 0; k < some.size(); ++k) {
      const std::int64_t layer = layer_of(hits[k]);
      const bool was_kept = last[some[k]] == std::numeric_limits<std::int64_t>::max();
      const bool is_late = in_order && layer <= last[some[k]];
      wrong += was_kept || is_late || call_of[some[k]] == calls || rejected[k] != 0 ? 1 : 0;
      last[some[k]] = layer, call_of[some[k]] = calls;
      rejected[k] = of.keeps(some[k], layer_of(hits[k])) ? 0 : 1;
      if (rejected[k] == 0) last[some[k]] = std::numeric_limits<std::int64_t>::max();
    }
  };
  std::vector<AnyHit> hits(n);
  std::vector<std::uint8_t> occluded(n, 7);
  tree.closest(rays, hits, filter, options);
  EXPECT_EQ(wrong, 0u);
  std::ranges::fill(last, -1);
  in_order = false;
  tree.occluded(rays, occluded, filter, options);
  EXPECT_EQ(wrong, 0u);
  const auto rejects = [&](std::size_t ray, const AnyHit& hit) { return !of.keeps(ray, layer_of(hit)); };
  std::vector<AnyHit> within(n);
  std::vector<std::uint8_t> occluded_within(n, 7);
  tree.closest(rays, within, rejects, options);
  tree.occluded(rays, occluded_within, rejects, options);
  EXPECT_TRUE(same_bytes(within, hits));
  EXPECT_EQ(occluded_within, occluded);
  for (std::size_t i = 0; i < n; i += 3) {
    Options alone = options;
    if (!skip.empty()) alone.skip = skip[i];
    const AnyHit wanted = tree.closest(
        rays[i], [&](const AnyHit& hit) { return !of.keeps(i, layer_of(hit)); }, alone);
    ASSERT_TRUE(same_bytes(hits[i], wanted)) << "ray " << i << ": layer " << layer_of(hits[i]);
    ASSERT_EQ(occluded[i], wanted ? 1 : 0) << "ray " << i;
  }
}

template <class T>
class FiltersOfMany : public ::testing::Test {};
TYPED_TEST_SUITE(FiltersOfMany, Numbers, NumberNames);

TYPED_TEST(FiltersOfMany, ask_along_each_ray) {
  using T = TypeParam;
  const auto rays = rays_of<T>(rays_up(2200));
  std::vector<std::uint32_t> skip;
  for (std::size_t i = 0; i < rays.size(); ++i) skip.push_back(static_cast<std::uint32_t>(i % 9));
  for (const Case& of : cases) {
    SCOPED_TRACE(of.name);
    const auto some = std::vector(rays.begin(), of.layers < 20 ? rays.end() : rays.begin() + 150);
    each_tree(mesh_of<T>(layers(of.layers)), [&](const auto& tree, const Path* path) {
      expect_kept<HitOf<T>>(tree, some, of, TraceOptionsOf<T>{.path = path});
      if (of.layers < 20)
        expect_kept<HitOf<T>>(tree, rays, of, TraceOptionsOf<T>{.path = path, .threads = 2}, skip);
    });
  }
}

TYPED_TEST(FiltersOfMany, ask_along_each_ray_of_scenes) {
  using T = TypeParam;
  using AnyScene = std::conditional_t<std::is_same_v<T, float>, Scene, SceneD>;
  using AnyHit = typename AnyScene::Hit;
  const auto rays = rays_of<T>(rays_up(2200));
  for (const Case& of : cases) {
    SCOPED_TRACE(of.name);
    AnyScene scene;
    const auto mesh = mesh_of<T>(layers(of.layers));
    for (const Index3& triangle : mesh.triangles) scene.place(scene.add(mesh.vertices, std::array{triangle}));
    scene.update();
    std::vector<AnyHit> skip(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
      skip[i].primitive = 0, skip[i].instance = static_cast<std::uint32_t>(i % 9);
    expect_kept<AnyHit>(scene, rays, of, TraceOptionsOf<T>{});
    expect_kept<AnyHit>(scene, rays, of, TraceOptionsOf<T>{}, skip);
  }
}

}  // namespace
}  // namespace raylanes::testing
