// Every query of scenes of triangles, of all primitives, of one side of them, and of all but one for each ray: what the
// trees of instances return for mapped rays, in the order of t, then instance, then primitive.
#include "../oracles/closest_crossing_oracle.hpp"
#include "../queries/query_trees.hpp"
#include "expect_queries.hpp"
#include "in_order/lattice_scenes.hpp"

namespace raylanes::testing {
namespace {

// Returns how many hits are no crossings.
std::size_t expect_every_query(const Scene& scene, const std::vector<Ray>& rays) {
  std::size_t touched = 0, skipped = 0;
  for (const Expected& expected :
       {Expected(scene, rays, Facing::any, ~0u, false), Expected(scene, rays, Facing::front, 0b0111u, false),
        Expected(scene, rays, Facing::back, ~0u, true), Expected(scene, rays, Facing::any, 0b1101u, true)}) {
    SCOPED_TRACE(std::string(facing_names[static_cast<std::size_t>(expected.facing)]) +
                 (expected.skip.empty() ? "" : ", without some"));
    on_each_path([&](const Path* path, int threads) {
      expect_queries(scene, rays, expected, {.path = path, .threads = threads});
    });
    skipped += expected.skipped;
    for (std::size_t i = 0; i < rays.size(); ++i)
      touched += expected.hits[i].size() - expected.closest_crossings[i].size();
  }
  EXPECT_GT(skipped, rays.size() / 40);
  on_each_path([&](const Path* path, int threads) {
    expect_filtered<SceneHit>(scene, rays, TraceOptions{.path = path, .threads = threads},
                              [&](const Ray& ray) { return all_scene_hits(scene, ray, ~0u); });
  });
  return touched;
}

Scene scene_of(std::initializer_list<Mesh> meshes, const std::vector<Transform>& places) {
  Scene scene;
  for (const Mesh& mesh : meshes) scene.add(Bvh(mesh));
  for (std::uint32_t i = 0; i < places.size(); ++i)
    scene.place(static_cast<std::uint32_t>(i % meshes.size()), places[i], 1u << i % 4);
  scene.update();
  return scene;
}

TEST(SceneQueries, of_ties) {
  for (const std::size_t instances : {std::size_t{1}, std::size_t{2}, std::size_t{9}}) {
    SCOPED_TRACE(instances);
    Random random(811);
    const Scene scene = scene_of_soups(random, instances);
    expect_every_query(scene, lattice_rays(random, by_level(80)));
  }
}

TEST(SceneQueries, keep_the_order_with_subnormals_flushed) {
  const FloatModeScope scope(FloatMode::flush);
  Random random(812);
  std::vector<Ray> rays = lattice_rays(random, by_level(40));
  for (Ray& ray : rays) ray.tmin = -1;  // hits at t = 0 have hits on both sides
  expect_every_query(scene_of_soups(random, 6), rays);
}

// Cubes and fans on a lattice, aimed at so that many rays meet edges; one instance is turned, one is a mirror image.
TEST(SceneQueries, of_touched_edges) {
  std::size_t touched = 0;
  for (const std::size_t instances : {1, 2, 10}) {
    const Transform transforms[] = {Transform(),
                                    moved_by(1, 0, 0),
                                    {{{0, 0, 1, 0}, {0, 1, 0, 1}, {-1, 0, 0, 0}}},
                                    {{{-1, 0, 0, 2}, {0, 1, 0, 0}, {0, 0, 1, 0}}},
                                    moved_by(0, 2, 0, 0.5f)};
    std::vector<Transform> places;
    for (std::size_t i = 0; i < instances; ++i) places.push_back(transforms[i % 5]);
    const Scene scene = scene_of({cube(-1, 1), cube(-1, 1), double_fan(8, 0.25f)}, places);
    touched += expect_every_query(scene, touching_rays(cube(-1, 1), by_level(120), 211));
  }
  EXPECT_GT(touched, 50u);
}

// Instances that turn, stretch and mirror a solid and a soup; and the only instance.
TEST(SceneQueries, of_any_transforms) {
  Random random(181);
  std::vector<Transform> places{Transform()};
  while (places.size() < 11) places.push_back(random_transform(random, 1, 2));
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(300); ++i)
    rays.push_back(make_ray(random.point(3), random.point(1), i % 3 == 0 ? -2.0f : 0.0f));
  const Mesh soup = triangle_soup(400, 0.7f, 182);
  expect_every_query(scene_of({cube(-0.5f, 0.5f), soup}, places), rays);
  for (const Transform& only : {Transform(), Transform{{{0, 1, 0, 0.5f}, {1, 0, 0, 0}, {0, 0, 2, 0}}}})
    expect_every_query(scene_of({soup}, {only}), rays);
}

TEST(SceneQueries, write_results_of_any_stride) {
  Random random(813);
  const Scene scene = scene_of_soups(random, 5);
  const std::vector<Ray> rays = lattice_rays(random, 100);
  struct Wide {
    int before = 7;
    SceneHit hit;
    int behind = 7;
  };
  std::vector<Wide> wide(rays.size());
  const SceneHitView view(&wide[0].hit, wide.size(), sizeof(Wide));
  std::vector<SceneHit> first(rays.size()), second(rays.size());
  scene.closest(rays, first);
  scene.closest(rays, second, {.after = first});
  const std::vector<std::uint8_t> active(13, 0b01010101);
  scene.closest(rays, view, {.active = active.data(), .after = first});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_TRUE(same_bytes(wide[i].hit, i % 2 == 0 ? second[i] : SceneHit())) << i;
    EXPECT_EQ(wide[i].before + wide[i].behind, 14);
  }
}

// A mirrored solid is entered at its front, too, although its corners run clockwise as seen from outside.
TEST(SceneQueries, of_a_mirrored_solid_have_its_own_sides) {
  for (const float sign : {1.0f, -1.0f}) {
    const Scene scene = scene_of({cube(-1, 1)}, {{{{sign, 0, 0, 10}, {0, 1, 0, 0}, {0, 0, 1, 0}}}});
    const Ray ray = make_ray({5, 0.1f, 0.2f}, {1, 0, 0});
    EXPECT_EQ(scene.closest(ray, {.facing = Facing::front}).t, 4);
    EXPECT_EQ(scene.closest(ray, {.facing = Facing::back}).t, 6);
  }
}

}  // namespace
}  // namespace raylanes::testing
