// Scenes in scenes that change, are copied and saved, and what they refuse.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <raylanes/scene_d.hpp>

#include "../../support/message_of.hpp"
#include "nested_cases.hpp"

namespace raylanes::testing {
namespace {

// As if all of it had been placed just now.
void expect_leaves(const NestedCase& nested, const std::vector<Ray>& rays) {
  const Scene flat = nested.flat();
  for (const std::uint32_t mask : {~0u, 0b0010u}) {
    std::vector<SceneHit> hits(rays.size());
    flat.closest(rays, hits, {.mask = mask});
    expect_hits(nested.scene, rays, nested.renamed(hits), mask);
  }
}

struct Changed {
  NestedCase part, nested;
  std::uint32_t moved, standing, alone;
  std::vector<Ray> rays;

  explicit Changed(Random& random) {
    part.add(cube(0, 1)), part.add(triangle_soup(30, 0.5f, 1801));
    part.place(0), part.place(1, {}, 0b0011), part.place(0, moved_by(1, 0, 0, 0.5f), 0b0110);
    nested.add(part);
    alone = nested.place(nested.add(ellipsoid(1, {0, 0, 2})));
    moved = nested.place(0, moved_by(-1, -1, 0));
    standing = nested.place(0);
    nested.scene.update();
    rays = rays_to_instances(nested.scene, by_level<std::size_t>(100, 200, 800), 3, random);
  }
  // The leaves again after instance `placed` has another transform or mask.
  void place_again(std::uint32_t placed, const Transform& transform, std::uint32_t mask) {
    for (NestedCase::Leaf& leaf : nested.leaves)
      for (const NestedCase::Leaf& from : part.leaves)
        if (leaf.instance == placed + 1 + from.instance)
          leaf.transform = product_of(transform, from.transform), leaf.mask = mask & from.mask;
  }
};

TEST(NestedScene, moves_and_masks_as_a_whole) {
  Random random(1800);
  Changed all(random);
  Scene& scene = all.nested.scene;
  EXPECT_GT(scene.report().common_instances, 2u);  // the identity at both levels
  expect_leaves(all.nested, all.rays);
  const Transform turned{{{0, 0, 1, 1}, {0, 1, 0, 0}, {-1, 0, 0, 1}}};
  scene.move(all.moved, turned);
  EXPECT_THROW(scene.closest(all.rays[0]), std::logic_error);
  scene.update();
  all.place_again(all.moved, turned, ~0u);
  expect_leaves(all.nested, all.rays);
  for (const std::uint32_t mask : {0b0010u, 0b0100u, ~0u, 0u, 0b0011u}) {  // without update()
    scene.set_mask(all.moved, mask), scene.set_mask(all.standing, mask);
    all.place_again(all.moved, turned, mask), all.place_again(all.standing, {}, mask);
    expect_leaves(all.nested, all.rays);
    EXPECT_EQ(scene.mask_of(all.standing + 2), mask & 0b0011u);
    if (mask == 0b0100u) scene.update();
  }
  scene.set_mask(all.alone, 0b0100), all.nested.leaves[0].mask = 0b0100;
  expect_leaves(all.nested, all.rays);
  scene.set_moving(all.standing), scene.update();
  EXPECT_EQ(scene.report().common_instances, 0u);
  expect_leaves(all.nested, all.rays);
}

TEST(NestedScene, sees_changes_of_its_own_geometries_alone) {
  Random random(1810);
  Changed all(random);
  const NestedCase before = all.nested;
  const Bvh* const shared = all.part.scene.tree(0);
  const Mesh mesh = cube(-0.5f, 0.25f);
  all.nested.scene.refit(1, mesh.vertices, mesh.triangles);
  all.nested.meshes[1] = mesh;
  all.nested.meshes[2] = triangle_soup(10, 0.9f, 1811);
  all.nested.scene.replace(2, Bvh(all.nested.meshes[2]));
  all.nested.scene.update();
  expect_leaves(all.nested, all.rays);
  expect_leaves(before, all.rays);
  EXPECT_EQ(all.part.scene.tree(0), shared);
  all.part.scene.move(0, moved_by(5, 5, 5)), all.part.scene.place(0);
  const Mesh other = cube(3, 4);
  all.part.scene.refit(0, other.vertices, other.triangles);
  all.part.scene = Scene();
  expect_leaves(all.nested, all.rays);
  all.nested.place(2, moved_by(0, 2, 0)), all.nested.place(0, moved_by(0, -2, 0), 0b0111);
  all.nested.scene.update();
  expect_leaves(all.nested, all.rays);
}

TEST(NestedScene, keeps_trees_that_the_added_scene_refits) {
  const Mesh mesh = cube(-1, 1), other = cube(2, 3);
  const Ray ray = make_ray({0.25f, 0.125f, -5}, {0, 0, 1});
  Scene part, whole;
  part.add(Bvh(mesh)), part.place(0);
  whole.place(whole.add(part)), whole.update();
  part.refit(0, other.vertices, other.triangles), part.update();
  EXPECT_FALSE(part.closest(ray));
  EXPECT_EQ(whole.closest(ray).t, 4);
  EXPECT_NE(part.tree(0), whole.tree(1));
}

TEST(NestedScene, refuses_changes_of_what_another_instance_places) {
  Random random(1820);
  Changed all(random);
  Scene outer;
  const std::uint32_t whole = outer.place(outer.add(all.nested.scene));
  outer.update();
  const std::uint32_t inner = whole + 1 + all.moved, part = inner + 2;
  for (const std::uint32_t instance : {inner, part})
    for (const auto& change : {std::function<void()>([&] { outer.move(instance, {}); }),
                               {[&] { outer.set_mask(instance, 1); }},
                               {[&] { outer.set_moving(instance); }}})
      expect_words(message_of<std::invalid_argument>(change),
                   {"instance " + std::to_string(instance), "instance " + std::to_string(whole)});
  expect_words(message_of<std::invalid_argument>([&] { outer.replace(0, Bvh()); }), {"geometry 0", "scene"});
  expect_words(message_of<std::invalid_argument>([&] { outer.refit(0, VertexView(), IndexView()); }),
               {"geometry 0", "no triangles"});
  EXPECT_EQ(outer.tree(0), nullptr);
  EXPECT_THROW(outer.place(static_cast<std::uint32_t>(outer.geometry_count())), std::out_of_range);
  EXPECT_EQ(outer.levels_of(part).size(), 3u);
  EXPECT_TRUE(outer.closest(all.rays[0]).t >= 0);
}

TEST(NestedScene, may_be_empty_itself_or_a_thousand_levels_deep) {
  Scene scene;
  EXPECT_EQ(scene.add(Scene()), 0u);
  EXPECT_EQ(scene.place(0), 0u);
  EXPECT_EQ(scene.add(scene), 1u);  // two geometries, one instance
  EXPECT_EQ(scene.geometry_count(), 3u);
  EXPECT_EQ(scene.place(1), 1u);
  EXPECT_EQ(scene.instance_count(), 3u);
  EXPECT_EQ(scene.geometry_of(2), 2u);
  scene.update();
  EXPECT_FALSE(scene.closest(make_ray({0, 0, 0}, {0, 0, 1})));
  EXPECT_GT(scene.bounds().lo[0], scene.bounds().hi[0]);

  Scene deep;
  deep.place(deep.add(cube(-1, 1)));
  for (int level = 0; level < 1000; ++level) {
    Scene outer;
    outer.place(outer.add(deep), moved_by(1, 0, 0));
    deep = std::move(outer);
  }
  deep.update();
  const SceneHit hit = deep.closest(make_ray({1000.25f, 0.125f, -5}, {0, 0, 1}));
  EXPECT_EQ(hit.t, 4);
  EXPECT_EQ(hit.instance, 1000u);
  EXPECT_EQ(deep.levels_of(hit.instance).size(), 1001u);
  EXPECT_EQ(deep.levels_of(hit.instance).back(), (InstanceLevel{0, 0}));
}

TEST(NestedScene, has_spheres_and_primitives_of_the_callers) {
  std::vector<std::uint32_t> instances;
  const auto plane = [&](const LeafVisit& leaf) {
    for (const std::uint32_t ray : leaf.rays) {
      instances.push_back(leaf.instance);
      leaf.keep(ray, {-leaf.ray[ray].origin[2] / leaf.ray[ray].direction[2], 0, 0, 0});
    }
  };
  Scene part, whole;
  part.place(part.add(SphereTree(std::vector<Sphere>{{{0, 0, 0}, 1}, {{4, 0, 0}, 1}})), moved_by(0, 0, 3));
  part.place(part.add(BoundedTree(std::vector<Box>{{{-9, -9, 0}, {9, 9, 0}}}), plane));
  const std::uint32_t there = whole.place(whole.add(part), moved_by(100, 0, 0, 2));
  whole.update();
  const Ray ray = make_ray({108.5f, 0.5f, 20}, {0, 0, -1});
  const SceneHit hit = whole.closest(ray), behind = whole.closest(ray, {.skip = hit});
  EXPECT_EQ(hit.instance, there + 1);
  EXPECT_EQ(hit.geometry, 1u);
  EXPECT_EQ(hit.primitive, 1u);
  EXPECT_LT(behind.t, 20);  // out of the same sphere
  EXPECT_EQ(whole.closest(make_ray({104, 0.5f, 20}, {0, 0, -1})).t, 20);
  EXPECT_EQ(instances.back(), there + 2);
  EXPECT_THROW(whole.crossings(std::vector{ray}), std::invalid_argument);
  EXPECT_THROW(whole.closest(ray, {.facing = Facing::front}), std::invalid_argument);
}

template <class AnyScene>
std::string saved(const AnyScene& scene) {
  std::ostringstream file;
  scene.save(file);
  return file.str();
}
template <class AnyScene = Scene>
AnyScene loaded(const std::string& bytes) {
  std::istringstream file(bytes);
  return AnyScene::load(file);
}

TEST(NestedScene, is_saved_with_all_that_is_in_it) {
  Random random(1830);
  NestedCase nested = nested_case(random, 3, false);
  nested.scene.update();
  const Scene again = loaded(saved(nested.scene));
  EXPECT_EQ(saved(again), saved(nested.scene));
  EXPECT_EQ(again.instance_count(), nested.scene.instance_count());
  const std::vector<Ray> rays = rays_to_instances(nested.scene, 200, 4, random);
  for (const Ray& ray : rays) EXPECT_TRUE(same_bytes(again.closest(ray), nested.scene.closest(ray)));
  for (const NestedCase::Leaf& leaf : nested.leaves) EXPECT_EQ(again.levels_of(leaf.instance), leaf.levels);
  nested.scene = again;
  nested.place(nested.placeable.back(), moved_by(0, 0, 2));
  nested.scene.update();
  expect_leaves(nested, rays);
}

template <class AnyScene>
class NestedSceneFile : public ::testing::Test {};
using Kinds = ::testing::Types<Scene, SceneD>;
TYPED_TEST_SUITE(NestedSceneFile, Kinds);

TYPED_TEST(NestedSceneFile, that_is_none_is_refused_whatever_its_checksum) {
  constexpr bool is_of_floats = std::is_same_v<TypeParam, Scene>;
  TypeParam part, scene;
  const decltype(part.transform_of(0)) moved{{{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  part.place(part.add(std::conditional_t<is_of_floats, Bvh, BvhD>())), part.place(0, moved);
  scene.place(scene.add(part), moved);
  scene.place(2 - 1);
  const std::string file = saved(scene);
  constexpr std::size_t start = 32, header = 24, instances = start + header + 2 * 8,
                        record = 8 + sizeof moved, nested = instances + 4 * record,
                        nested_instances = nested + start + 16, nested_record = 12 + sizeof moved;
  // Changes numbers at these places in the tables or, behind them, in the scene within.
  const auto refusal = [&](std::vector<std::pair<std::size_t, std::uint32_t>> numbers) {
    std::string damaged = file;
    for (const auto& [at, number] : numbers) std::memcpy(damaged.data() + at, &number, sizeof number);
    for (const auto& [begin, end] :
         {std::pair{std::size_t{0}, nested}, {nested, nested_instances + 2 * nested_record}}) {
      const std::uint64_t checksum = XXH3_64bits(damaged.data() + begin + start, end - begin - start);
      std::memcpy(damaged.data() + begin + 24, &checksum, sizeof checksum);
    }
    return message_of<std::runtime_error>([&] { loaded<TypeParam>(damaged); });
  };
  const auto instance = [](std::size_t i) { return instances + i * record; };
  expect_words(refusal({{instance(0) + 8, 1}}),
               {"instance 1", "not where"});  // the first number of its transform
  expect_words(refusal({{instance(2) + 4, 7}}), {"instance 2", "not where"});
  expect_words(refusal({{instance(3), 0}}), {"more instances"});
  expect_words(refusal({{nested + start, 2}}), {"scene 0", "more geometries"});
  expect_words(refusal({{nested + start + 4, 1}}), {"counts"});
  expect_words(refusal({{nested + start + 12, 1}}), {"counts"});
  expect_words(refusal({{nested + start + 8, 3000}}), {"ends"});
  expect_words(refusal({{nested_instances, 1}}), {"geometry 1"});
  expect_words(refusal({{nested_instances + 8, 0}}), {"placed by instance 0"});
  expect_words(refusal({{nested_instances + nested_record + 8, 0}}), {"placed by instance 0"});
  if (!is_of_floats) {
    expect_words(refusal({{start + header, 1}}), {"kind 1"});
  }
  EXPECT_EQ(message_of<std::runtime_error>([&] {
              loaded<TypeParam>(file);
              throw std::runtime_error("good");
            }),
            "good");
}

}  // namespace
}  // namespace raylanes::testing
