// Lists of hits and crossings in scenes, compared with the lists of each instance's tree and the ray in its space.
#include "../../support/filtered.hpp"
#include "../../support/same_bytes.hpp"
#include "../../support/supported_paths.hpp"
#include "lattice_scenes.hpp"

namespace raylanes::testing {
namespace {

std::vector<SceneCrossing> all_scene_crossings(const Scene& scene, const Ray& ray, std::uint32_t mask) {
  std::vector<SceneCrossing> all;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const Instance instance(scene.geometry_of(i), scene.transform_of(i), scene.mask_of(i));
    if ((instance.mask & mask) == 0) continue;
    const auto lists = scene.tree(instance.geometry)->crossings(std::vector{mapped_ray(ray, instance)});
    for (const Crossing& crossing : lists.items) all.push_back({crossing, instance.geometry, i});
  }
  std::ranges::sort(all, {}, [](const SceneCrossing& c) { return std::tuple(c.t, c.instance, c.primitive); });
  return all;
}

// The options of one call; skip: for each ray, or empty.
struct Call {
  std::uint32_t mask = ~0u, max_count = ~0u;
  Facing facing = Facing::any;
  int threads = 1;
  std::vector<SceneHit> skip = {};
};

template <class Item>
void keep_counted(std::vector<Item>& items, const Call& call, std::size_t ray) {
  if (!call.skip.empty())
    std::erase_if(items, [&](const Item& item) {
      return item.primitive == call.skip[ray].primitive && item.instance == call.skip[ray].instance;
    });
  if (items.size() > call.max_count) items.resize(call.max_count);
}

void expect_lists(const Scene& scene, const std::vector<Ray>& rays, const Path* path, const Call& call) {
  const std::size_t n = rays.size();
  std::vector<std::uint8_t> active(n / 8 + 1, 0b11011111);
  ListOptions options{.max_count = call.max_count,
                      .facing = call.facing,
                      .path = path,
                      .threads = call.threads,
                      .active = active.data(),
                      .mask = call.mask};
  if (!call.skip.empty()) options.skip = call.skip;
  const auto hits = scene.all_hits(rays, options);
  const auto of_arrays = scene.all_hits(RayColumns(rays).view(), options);
  const auto crossings = scene.crossings(rays, options);
  std::vector<CrossingCount> counts(n, {77, 77});
  scene.count_crossings(rays, counts, options);
  ASSERT_TRUE(hits.size() == n && crossings.size() == n);
  EXPECT_TRUE(same_bytes(hits.items, of_arrays.items));
  for (std::size_t i = 0; i < n; ++i) {
    if (i % 8 == 5) {
      EXPECT_TRUE(hits[i].empty() && crossings[i].empty());
      EXPECT_EQ(counts[i], (CrossingCount{77, 77}));
      continue;
    }
    auto wanted = all_scene_hits(scene, rays[i], call.mask, call.facing);
    keep_counted(wanted, call, i);
    ASSERT_TRUE(same_bytes(hits[i], std::span<const SceneHit>(wanted)))
        << "ray " << i << ": " << hits[i].size() << " hits, not " << wanted.size();
    auto crossed = all_scene_crossings(scene, rays[i], call.mask);
    if (call.facing != Facing::any)
      std::erase_if(crossed,
                    [&](const SceneCrossing& c) { return (c.side < 0) != (call.facing == Facing::front); });
    keep_counted(crossed, {.skip = call.skip}, i);
    CrossingCount count{};
    for (const SceneCrossing& crossing : crossed) ++count.crossings, count.winding += crossing.side;
    EXPECT_EQ(counts[i], count) << "ray " << i;
    keep_counted(crossed, {.max_count = call.max_count}, i);
    ASSERT_TRUE(std::ranges::equal(crossings[i], crossed)) << "ray " << i;
  }
}

TEST(SceneLists, are_those_of_all_instances_in_order) {
  Random random(904);
  for (const std::size_t instances : {std::size_t{1}, std::size_t{2}, std::size_t{9}})
    for (const Path* path : supported_paths()) {
      SCOPED_TRACE(std::string(path->name) + ", " + std::to_string(instances) + " instances");
      const Scene scene = scene_of_soups(random, instances);
      const std::vector<Ray> rays = lattice_rays(random, by_level(200));
      std::vector<SceneHit> skip(rays.size());
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto all = all_scene_hits(scene, rays[i], ~0u);
        if (!all.empty()) skip[i] = all[i % all.size()];
      }
      for (const Call& call : {Call{}, Call{.max_count = 0}, Call{.max_count = 2, .threads = 3},
                               Call{.mask = 0b101u}, Call{.facing = Facing::front, .skip = skip},
                               Call{.facing = Facing::back}, Call{.max_count = 3, .skip = skip}})
        expect_lists(scene, rays, path, call);
      if (HasFailure()) return;
    }
}

TEST(SceneLists, of_meshes_that_came_without_a_tree) {
  Scene scene;
  for (const float x : {0.0f, 1.0f, 2.0f}) scene.place(scene.add(cube(x, x + 1)));
  scene.set_moving(2, true);
  scene.update();
  Random random(905);
  expect_lists(scene, lattice_rays(random, 300), nullptr, {});
}

TEST(SceneLists, refuse_what_trees_refuse) {
  Random random(906);
  Scene scene = scene_of_soups(random, 3);
  const std::vector<Ray> rays = lattice_rays(random, 4);
  std::vector<CrossingCount> counts(3);
  EXPECT_THROW(scene.count_crossings(rays, counts), std::invalid_argument);
  EXPECT_THROW(scene.all_hits(rays, {.skip = std::vector<std::uint32_t>(4)}), std::invalid_argument);
  EXPECT_THROW(scene.all_hits(rays, {.threads = -1}), std::invalid_argument);
  scene.place(scene.add(SphereTree(std::vector<Sphere>{{{0, 0, 0}, 1}})));
  EXPECT_THROW(scene.all_hits(rays), std::logic_error);
  scene.update();
  EXPECT_EQ(scene.all_hits(rays).size(), 4u);
  EXPECT_THROW(scene.crossings(rays), std::invalid_argument);
  EXPECT_TRUE(Scene().all_hits(rays).items.empty());
}

}  // namespace
}  // namespace raylanes::testing
