// Scenes of doubles that are made, change and are copied: what calls refuse, memory that runs out, trees that are kept.
#include <sstream>

#include <raylanes/kdtree.hpp>
#include <raylanes/scene_d.hpp>

#include "../../doubles/both_numbers.hpp"
#include "../../support/limited_memory.hpp"
#include "../../support/same_bytes.hpp"

namespace raylanes::testing {
namespace {

const TransformD beside{{{1, 0, 0, 4}, {0, 0, 1, 0}, {0, -1, 0, 0}}};

SceneD two_cubes(bool stand) {
  const DoubleMesh mesh = moved(cube(-1, 1), 1, {});
  SceneD scene;
  const std::uint32_t part = scene.add(mesh.vertices, mesh.triangles);
  scene.place(part), scene.place(part, stand ? TransformD() : beside, 2);
  return scene;
}
std::vector<RayD> some_rays() {
  std::vector<RayD> rays;
  for (int i = 0; i < 90; ++i) rays.push_back({{0.1 * i - 2, 0.3, -5}, 0, {0, 0, 1}, HUGE_VAL});
  return rays;
}

template <class T>
concept Addable = requires(SceneD scene, T tree) {
  scene.add(std::move(tree));
};
static_assert(Addable<BvhD> && Addable<std::shared_ptr<const BvhD>> && Addable<std::shared_ptr<BvhD>>);
static_assert(!Addable<Bvh> && !Addable<std::shared_ptr<const Bvh>> && !Addable<KdTree>);
static_assert(requires(const SceneD& s, std::vector<SceneHitD>& h) { s.closest(some_rays(), h); });
template <class Hits>
concept Writable = requires(const SceneD& scene, const std::vector<RayD>& rays, Hits& hits) {
  scene.closest(rays, hits);
};
static_assert(Writable<std::vector<SceneHitD>> && !Writable<std::vector<HitD>>);

TEST(ScenesOfDoubles, refuse_what_is_wrong) {
  SceneD scene = two_cubes(false);
  const std::vector<RayD> rays = some_rays();
  std::vector<SceneHitD> hits(rays.size());
  std::vector<SceneClosestPointD> closest(1);
  const std::vector<Double3> points{{0, 0, 0}};
  EXPECT_THROW(scene.closest(rays, hits), std::logic_error);
  EXPECT_THROW(scene.closest(rays[0]), std::logic_error);
  EXPECT_THROW(scene.all_hits(rays), std::logic_error);
  EXPECT_THROW(scene.closest_points(points, closest), std::logic_error);
  EXPECT_THROW(scene.containing_parts(points), std::logic_error);
  EXPECT_THROW(scene.update(-1), std::invalid_argument);
  scene.update();
  const std::vector<std::uint32_t> names(rays.size());
  const std::vector<HitD> of_tree(rays.size());
  const std::uint32_t masks[] = {1};
  EXPECT_THROW(scene.closest(rays, hits, {.threads = -1}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, hits, {.skip = names}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, hits, {.after = of_tree}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, hits, {.masks = masks}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.skip = names[0]}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.facing = Facing{7}}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, std::span(hits).first(3)), std::invalid_argument);
  TraceCounters counters;
  EXPECT_THROW(scene.all_hits(rays, {.counters = &counters}), std::invalid_argument);
  EXPECT_THROW(scene.containing_parts(points, {.counters = &counters}), std::invalid_argument);
  EXPECT_THROW(scene.add(std::shared_ptr<const BvhD>()), std::invalid_argument);
  EXPECT_THROW(scene.place(1), std::out_of_range);
  EXPECT_THROW(scene.move(2, {}), std::out_of_range);
  EXPECT_THROW(scene.set_mask(2, 1), std::out_of_range);
  EXPECT_THROW(scene.replace(1, BvhD()), std::out_of_range);
  EXPECT_THROW(scene.set_moving(2), std::out_of_range);
  EXPECT_THROW(scene.refit(0, points, IndexView()), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(scene.tree(1)), std::out_of_range);
  EXPECT_NO_THROW(scene.closest(rays, hits));  // nothing of that was a change
}

TEST(ScenesOfDoubles, that_are_empty_have_nothing) {
  SceneD scene;
  scene.add(BvhD());
  scene.place(0), scene.place(0, beside);
  for (int round = 0; round < 2; ++round) {
    scene.update();
    EXPECT_FALSE(scene.closest(some_rays()[0]));
    EXPECT_FALSE(scene.closest_point({0, 0, 0}));
    EXPECT_TRUE(scene.all_hits(some_rays()).items.empty());
    EXPECT_GT(scene.bounds().lo[0], scene.bounds().hi[0]);
    scene = SceneD();
  }
}

TEST(ScenesOfDoubles, follow_their_changes_and_no_copys) {
  for (const bool stand : {false, true}) {
    SceneD scene = two_cubes(stand);
    scene.update();
    const std::vector<RayD> rays = some_rays();
    std::vector<SceneHitD> before(rays.size()), after(rays.size()), of_copy(rays.size());
    scene.closest(rays, before);
    const SceneD copy = scene;
    scene.move(0, {{{1, 0, 0, 100}, {0, 1, 0, 0}, {0, 0, 1, 0}}}), scene.set_mask(1, 8);
    scene.update();
    scene.closest(rays, after), copy.closest(rays, of_copy);
    EXPECT_TRUE(same_bytes(of_copy, before));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_TRUE(!after[i] || after[i].instance == 1) << i;
      EXPECT_FALSE(scene.closest(rays[i], {.mask = 3})) << i;
    }
    EXPECT_EQ(scene.mask_of(1), 8u);
    EXPECT_EQ(scene.transform_of(0).row[0][3], 100);
    scene.replace(0, BvhD()), scene.update();
    EXPECT_FALSE(scene.closest(rays[20]));
    SceneD moved = copy;
    const SceneD other = std::move(moved);
    moved.update();
    EXPECT_EQ(moved.instance_count(), 0u);
    EXPECT_TRUE(same_bytes(other.closest(rays[30]), before[30]));
  }
}

// An update that changes no part of a common tree builds none: it takes no memory for one.
TEST(ScenesOfDoubles, keep_their_common_tree) {
  const DoubleMesh mesh = moved(ellipsoid(4, {0, 0, 0}), 1, {});
  SceneD scene;
  scene.add(mesh.vertices, mesh.triangles);
  scene.place(0), scene.place(0), scene.place(0, beside);
  scene.update();
  const std::size_t bytes = scene.bytes();
  EXPECT_GT(bytes, scene.tree(0).bytes());  // of twice the triangles
  scene.move(2, {{{1, 0, 0, 9}, {0, 1, 0, 0}, {0, 0, 1, 0}}});
  std::size_t allocations = 0;
  while (runs_out(allocations, 64 * 1024, [&] { scene.update(); })) ASSERT_LT(++allocations, 200u);
  EXPECT_EQ(scene.bytes(), bytes);
  // One that changes a part builds it again.
  const DoubleMesh larger = moved(ellipsoid(4, {0, 0, 0}), 2, {});
  const RayD ray{{0, 0, -9}, 0, {0, 0, 1}, HUGE_VAL};
  const double t = scene.closest(ray).t;
  scene.replace(0, BvhD(larger.vertices, larger.triangles)), scene.update();
  EXPECT_NEAR(9 - scene.closest(ray).t, 2 * (9 - t), 1e-9);
}

TEST(ScenesOfDoubles, survive_memory_that_runs_out) {
  const std::vector<RayD> rays = some_rays();
  std::vector<Double3> points;
  for (const RayD& ray : rays) points.push_back(ray.origin);
  for (const bool stand : {false, true}) {
    SceneD scene = two_cubes(stand);
    const auto expect_clean = [](const char* name, const std::function<void()>& call) {
      SCOPED_TRACE(name);
      std::size_t allocations = 0;
      while (allocations < 100'000 && runs_out(allocations, unlimited, call))
        allocations += 1 + allocations / 4;
      EXPECT_LT(allocations, 100'000u);
    };
    expect_clean("update", [&] { scene.update(2); });
    std::vector<SceneHitD> hits(rays.size()), again(rays.size());
    std::vector<SceneClosestPointD> closest(rays.size()), closest_again(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    std::vector<ContainingPart> parts(rays.size());
    scene.closest(rays, hits), scene.closest_points(points, closest);
    const auto lists = scene.all_hits(rays);
    for (const int threads : {1, 2}) {
      RayLists<SceneHitD> found;
      expect_clean("all_hits", [&] { found = scene.all_hits(rays, {.threads = threads}); });
      EXPECT_TRUE(same_bytes(found.items, lists.items) && found.offsets == lists.offsets);
      scene.closest(rays, again, {.threads = threads});
      EXPECT_TRUE(same_bytes(again, hits));
      expect_clean("after", [&] { scene.closest(rays, again, {.threads = threads, .after = hits}); });
      expect_clean("closest_points",
                   [&] { scene.closest_points(points, closest_again, {.threads = threads}); });
      EXPECT_TRUE(same_bytes(closest_again, closest));
      expect_clean("innermost_parts", [&] { scene.innermost_parts(points, parts, {.threads = threads}); });
    }
    expect_clean("copy", [&] { SceneD(scene).update(); });
    // Each of these does all of it, or nothing.
    const BvhD& tree = scene.tree(0);
    expect_clean("add a scene", [&] { scene.add(scene); });
    EXPECT_EQ(scene.geometry_count(), 3u);
    expect_clean("place it", [&] { scene.place(1, beside); });
    EXPECT_EQ(scene.instance_count(), 5u);
    const DoubleMesh mesh = moved(cube(-1, 1), 1, {});
    expect_clean("refit", [&] {
      EXPECT_EQ(&scene.tree(0), &tree);
      scene.refit(0, mesh.vertices, mesh.triangles);
    });
    expect_clean("update", [&] { scene.update(); });
    std::ostringstream file;
    scene.save(file);
    expect_clean("load", [&] {
      std::istringstream stream(file.str());
      SceneD::load(stream);
    });
    const std::uint32_t masks[] = {0, 1};
    expect_clean("set_triangle_masks", [&] { scene.set_triangle_masks(0, masks); });
    scene.update();
    EXPECT_GT(scene.closest(rays[20], {.mask = 2}).primitive, 1u);
  }
}

}  // namespace
}  // namespace raylanes::testing
