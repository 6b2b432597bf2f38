// Masks of triangles in scenes: every call with rays has the results of a scene whose meshes have a point in the place
// of each triangle that its mask does not see.
#include <raylanes/stretches.hpp>

#include "../../support/filtered.hpp"
#include "../../support/message_of.hpp"
#include "../expect_queries.hpp"
#include "../nested/nested_cases.hpp"

namespace raylanes::testing {
namespace {

using Words = std::vector<std::uint32_t>;

Mesh seen_part(Mesh mesh, const Words& words, std::uint32_t mask) {
  for (std::size_t i = 0; i < std::min(words.size(), mesh.triangles.size()); ++i)
    if ((words[i] & mask) == 0) mesh.triangles[i] = {0, 0, 0};
  return mesh;
}

// Two soups with masks, a cube without, and spheres far away, by transforms of all kinds and by none.
struct Masked {
  Scene scene;
  std::vector<Mesh> meshes;
  std::vector<Words> words;

  explicit Masked(Random& random, std::size_t instances) {
    for (const Mesh& mesh : {triangle_soup(80, 0.6f, 1901), double_fan(12, 0.25f), cube(-1, 1)})
      scene.add(mesh), meshes.push_back(mesh), words.emplace_back();
    for (std::size_t i = 0; i < instances; ++i)
      scene.place(static_cast<std::uint32_t>(i % 3), nested_transform(random, false), nested_mask(random));
    set(0, random, 80), set(1, random, 9);
    scene.update();
  }
  void set(std::uint32_t geometry, Random& random, std::size_t count) {
    words[geometry].clear();
    for (std::size_t i = 0; i < count; ++i)
      words[geometry].push_back(random.chance(0.3) ? 0 : 1u << random.index(3));
    scene.set_triangle_masks(geometry, words[geometry]);
  }
  Scene seen(std::uint32_t mask) const {
    Scene seen;
    for (std::size_t i = 0; i < meshes.size(); ++i) seen.add(Bvh(seen_part(meshes[i], words[i], mask)));
    for (std::uint32_t i = 0; i < scene.instance_count(); ++i)
      seen.place(scene.geometry_of(i), scene.transform_of(i), scene.mask_of(i));
    seen.update();
    return seen;
  }
};

template <class Lists>
void expect_same_lists(const Lists& lists, const Lists& expected) {
  EXPECT_EQ(lists.offsets, expected.offsets);
  EXPECT_TRUE(std::ranges::equal(lists.items, expected.items,
                                 [](const auto& a, const auto& b) { return same_bytes(a, b); }));
}

void expect_same_queries(const Scene& scene, const Scene& seen, const std::vector<Ray>& rays,
                         const TraceOptions& given) {
  const std::size_t n = rays.size();
  std::vector<SceneHit> nearest(n), hits(n), expected(n);
  seen.closest(rays, nearest, given);
  for (const bool skips : {false, true}) {
    TraceOptions by = given;
    if (skips) by.skip = nearest;
    seen.closest(rays, expected, by);
    expect_hits_on(by.path, scene, rays, expected, by.mask, by.facing,
                   skips ? nearest : std::vector<SceneHit>());
    scene.closest(rays, hits, reject_even<SceneHit>, by),
        seen.closest(rays, expected, reject_even<SceneHit>, by);
    EXPECT_TRUE(same_bytes(hits, expected));
    scene.closest_crossing(rays, hits, by), seen.closest_crossing(rays, expected, by);
    EXPECT_TRUE(same_bytes(hits, expected));
    by.after = nearest;
    scene.closest(rays, hits, by), seen.closest(rays, expected, by);
    EXPECT_TRUE(same_bytes(hits, expected));
    const ListOptions lists{
        .facing = by.facing, .path = by.path, .threads = by.threads, .skip = by.skip, .mask = by.mask};
    expect_same_lists(scene.all_hits(rays, lists), seen.all_hits(rays, lists));
    expect_same_lists(scene.crossings(rays, lists), seen.crossings(rays, lists));
    if (lists.facing == Facing::any)
      expect_same_lists(stretches(scene, rays, lists), stretches(seen, rays, lists));
  }
}

TEST(TriangleMasks, hide_triangles_of_scenes_from_all_rays) {
  for (const std::size_t instances : {1, 4, 30}) {
    SCOPED_TRACE(instances);
    Random random(1900 + instances);
    Masked masked(random, instances);
    std::vector<Ray> rays = rays_to_instances(masked.scene, by_level<std::size_t>(150, 300, 1000), 4, random);
    for (std::size_t i = 0; i < 200; ++i) rays.push_back(make_ray({0, 0, -3}, random.point(1)));  // packets
    for (const std::uint32_t mask : {~0u, 0b0011u, 0b0100u})
      for (const Facing facing : {Facing::any, Facing::back}) {
        const Scene seen = masked.seen(mask);
        on_each_path([&](const Path* path, int threads) {
          expect_same_queries(masked.scene, seen, rays,
                              {.path = path, .threads = threads, .facing = facing, .mask = mask});
        });
      }
    std::vector<Float3> points{{0, 0, 0}, {0.25f, 0.25f, 0.25f}};
    std::vector<SceneClosestPoint> closest(2), expected(2);
    masked.scene.closest_points(points, closest);
    masked.words = {{}, {}, {}};
    masked.seen(~0u).closest_points(points, expected);  // whatever the masks
    EXPECT_TRUE(same_bytes(closest, expected));
  }
}

TEST(TriangleMasks, stay_with_their_geometry) {
  Random random(1950);
  Masked masked(random, 12);
  Scene& scene = masked.scene;
  const std::vector<Ray> rays = rays_to_instances(scene, by_level<std::size_t>(150, 300, 1000), 4, random);
  const auto expect_seen = [&](const Scene& of) {
    for (const std::uint32_t mask : {~0u, 0b0001u}) {
      std::vector<SceneHit> expected(rays.size());
      masked.seen(mask).closest(rays, expected, {.mask = mask});
      expect_hits(of, rays, expected, mask);
    }
  };
  const Scene copy = scene;
  for (Float3& vertex : masked.meshes[0].vertices) vertex[2] += 0.25f;
  scene.refit(0, masked.meshes[0].vertices, masked.meshes[0].triangles);
  masked.set(2, random, 300);  // more than it has
  EXPECT_THROW(scene.closest(rays[0]), std::logic_error);
  scene.update();
  expect_seen(scene);
  scene.replace(0, Bvh(masked.meshes[0])), masked.words[0].clear();
  scene.set_triangle_masks(1, {}), masked.words[1].clear();
  scene.update();
  expect_seen(scene);
  Scene outer;
  outer.place(outer.add(Bvh())), outer.place(outer.add(scene));
  outer.update();
  const std::vector<SceneHit> none;
  for (const Ray& ray : rays) {
    SceneHit expected = scene.closest(ray, {.mask = 0b0010});
    if (expected) expected.instance += 2, expected.geometry += 2;
    EXPECT_TRUE(same_bytes(outer.closest(ray, {.mask = 0b0010}), expected));
  }
  EXPECT_NE(copy.closest(rays[0], {.mask = 0}).t, 0);
}

TEST(TriangleMasks, are_refused_where_they_mean_nothing) {
  Scene scene;
  scene.add(SphereTree()), scene.place(scene.add(cube(-1, 1)));
  scene.add(scene);
  const Words words(12, 1);
  expect_words(message_of<std::invalid_argument>([&] { scene.set_triangle_masks(0, words); }),
               {"geometry 0", "no triangles"});
  expect_words(message_of<std::invalid_argument>([&] { scene.set_triangle_masks(2, words); }),
               {"geometry 2"});
  EXPECT_THROW(scene.set_triangle_masks(5, words), std::out_of_range);
  scene.set_triangle_masks(1, words);
  scene.update();
  EXPECT_EQ(scene.report().common_instances, 0u);
  const Ray ray = make_ray({0.25f, 0.5f, -5}, {0, 0, 1});
  EXPECT_TRUE(scene.closest(ray));
  EXPECT_FALSE(scene.closest(ray, {.mask = 2}));
  EXPECT_FALSE(scene.occluded(ray, {.mask = 2}));
  EXPECT_THROW(scene.closest(ray, {.test = TriangleTest::watertight}), std::invalid_argument);
  std::ostringstream file;
  expect_words(message_of<std::invalid_argument>([&] { scene.save(file); }), {"geometry 1", "masks"});
  scene.set_triangle_masks(1, {});
  scene.update();
  EXPECT_TRUE(scene.closest(ray, {.mask = 2}));
}

}  // namespace
}  // namespace raylanes::testing
