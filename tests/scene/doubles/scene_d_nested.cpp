// Scenes of doubles in scenes, which change and are saved; masks of triangles. The judge is rational.
#include <sstream>

#include "../../support/message_of.hpp"
#include "expect_scene_d.hpp"

namespace raylanes::testing {
namespace {

constexpr TransformD identity, turned_about_y{{{0, 0, 1, 1}, {0, 1, 0, -0.5}, {-1, 0, 0, 2}}};

// A cube twice and a soup, these in two places beside a cube, all that within another scene.
struct Levels {
  PartsD part, row, whole;

  explicit Levels(Random& random, double far_away = 0) {
    part.add(moved(cube(-0.5f, 0.5f), 1, {})), part.add(soup(20));
    part.scene.place(0), part.scene.place(0, turned(0.3, {2, 0, 0}), 0b0110), part.scene.place(1, {}, 0b1101);
    row.add(part), row.add(moved(cube(-1, 1), 0.75, {}));
    row.scene.place(0), row.scene.place(3, turned(1, {0, 3, 0})), row.scene.place(0, turned_about_y, 0b0111);
    whole.add(row);
    whole.scene.place(0, turned(-2, {far_away, 2 * far_away, 0})), whole.scene.place(1, {}, 0b0011);
    whole.scene.place(0), whole.scene.place(2, random_transform_d(random, 1, 2));
    whole.scene.update();
  }
};

mpq_class entry(const TransformD& transform, std::size_t i, std::size_t j) {
  return i < 3 ? mpq_class(transform.row[i][j]) : mpq_class(j == 3 ? 1 : 0);
}
// Checks the product of two maps against the exact one; returns how many numbers are not the nearest doubles.
std::size_t expect_product(const TransformD& outer, const TransformD& inner, const TransformD& product) {
  std::size_t others = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      mpq_class exact = 0, size = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const mpq_class term = entry(outer, i, k) * entry(inner, k, j);
        exact += term, size += abs(term);
      }
      const mpq_class bound =
          abs(exact) * mpq_class(0x1p-53) + size * mpq_class(0x1p-100) + mpq_class(0x1p-1000);
      const double number = product.row[i][j];
      if (!std::isfinite(number)) {
        EXPECT_GE(size, mpq_class(0x1p1022));
        continue;
      }
      EXPECT_LE(abs(mpq_class(number) - exact), bound) << i << ", " << j;
      others += number != nearest_double(exact);
    }
  return others;
}

TEST(NestedScenesOfDoubles, compose_transforms_as_rational_numbers_do) {
  Random random(195);
  std::size_t others = 0, infinite = 0;
  for (int round = 0; round < 400; ++round) {
    const double size = std::ldexp(1.0, random.integer(-42, 42) * (round % 4 == 0 ? 13 : 1));
    SceneD inner, outer;
    const TransformD a = random_transform_d(random, size, 1e6 * size);
    TransformD b = random_transform_d(random, size, 1e6);
    if (round % 4 == 1)  // what cancels but for the last digits
      for (std::size_t j = 0; j < 4; ++j)
        b.row[1][j] = 0, b.row[2][j] = -(a.row[0][0] * b.row[0][j]) / a.row[0][2];
    inner.place(inner.add(BvhD()), b, 0b0110), outer.place(outer.add(inner), a, 0b1011);
    EXPECT_EQ(outer.mask_of(1), 0b0010u);
    const std::size_t not_nearest = expect_product(a, b, outer.transform_of(1));
    others += round % 4 > 1 ? not_nearest : 0;
    infinite += !std::isfinite(outer.transform_of(1).row[0][0]);
    outer.update();
    EXPECT_FALSE(outer.closest({{0, 0, 0}, 0, {0, 0, 1}, 1}));
  }
  EXPECT_LT(others, 10u);
  EXPECT_GT(infinite, 0u);
  SceneD inner, outer;
  inner.place(inner.add(BvhD())), outer.place(outer.add(inner));
  const TransformD product = outer.transform_of(1);
  EXPECT_TRUE(same_bytes(product, identity));
}

TEST(NestedScenesOfDoubles, answer_as_rational_numbers_say) {
  for (const double far_away : {0.0, 4.6e6}) {
    Random random(196);
    const Levels levels(random, far_away);
    const std::vector<RayD> rays = rays_to_parts(levels.whole, by_level(50), 4, random);
    EXPECT_GT(expect_every_query(levels.whole, rays), by_level(50));
    EXPECT_GT(levels.whole.scene.report().common_instances, 2u);
  }
}

TEST(NestedScenesOfDoubles, name_the_way_to_each_instance) {
  Random random(197);
  const Levels all(random);
  const SceneD& whole = all.whole.scene;
  // A row has 2 scenes of 3 and a cube, with the instances that place them.
  EXPECT_EQ(all.row.scene.instance_count(), 9u);
  EXPECT_EQ(whole.instance_count(), 10u + 4 + 10 + 1);
  using Way = std::vector<InstanceLevel>;
  EXPECT_EQ(whole.levels_of(0), (Way{{0, 0}}));
  EXPECT_EQ(whole.levels_of(5), (Way{{0, 0}, {4, 3}}));
  EXPECT_EQ(whole.levels_of(9), (Way{{0, 0}, {5, 0}, {2, 1}}));
  EXPECT_EQ(whole.levels_of(13), (Way{{10, 1}, {2, 1}}));
  EXPECT_EQ(whole.geometry_of(9), 3u);
  EXPECT_EQ(whole.mask_of(9), 0b0101u);
  EXPECT_EQ(whole.geometry_count(), 5u);
  for (std::uint32_t i = 0; i < 9; ++i)
    EXPECT_EQ(expect_product(whole.transform_of(0), all.row.scene.transform_of(i), whole.transform_of(1 + i)),
              0u);
  EXPECT_THROW(whole.levels_of(25), std::out_of_range);
}

TEST(NestedScenesOfDoubles, change_as_a_whole) {
  Random random(198);
  Levels all(random);
  PartsD& whole = all.whole;
  SceneD& scene = whole.scene;
  const PartsD before = whole;
  const std::vector<RayD> rays = rays_to_parts(whole, by_level(25), 4, random);
  scene.move(0, turned_about_y), scene.set_mask(14, 0b0100), scene.set_moving(10);
  EXPECT_THROW(scene.closest(rays[0]), std::logic_error);
  EXPECT_EQ(expect_product(turned_about_y, all.row.scene.transform_of(5), scene.transform_of(6)), 0u);
  EXPECT_EQ(scene.mask_of(15), 0b0100u);
  EXPECT_EQ(scene.mask_of(18), 0b0100u);
  for (const std::uint32_t instance : {1u, 9u})
    for (const auto& change : {std::function<void()>([&] { scene.move(instance, {}); }),
                               {[&] { scene.set_mask(instance, 1); }},
                               {[&] { scene.set_moving(instance); }}})
      expect_words(message_of<std::invalid_argument>(change),
                   {"instance " + std::to_string(instance), "instance 0"});
  for (const auto& change : {std::function<void()>([&] { scene.replace(1, BvhD()); }),
                             {[&] { scene.refit(0, VertexViewD(), IndexView()); }},
                             {[&] { scene.set_triangle_masks(0, {}); }}})
    expect_words(message_of<std::invalid_argument>(change), {"geometry", "is a scene"});
  whole.meshes[2] = moved(cube(-0.25f, 0.5f), 1.5, {0.25, 0, 0});
  scene.refit(2, whole.meshes[2].vertices, whole.meshes[2].triangles, 2);
  scene.update();
  expect_every_query(whole, rays), expect_every_query(before, rays);
  EXPECT_EQ(scene.report().common_instances, 2u);  // of instance 14
  all.part.scene = SceneD();
  EXPECT_EQ(scene.add(scene), 5u);
  EXPECT_EQ(scene.tree(5).bytes(), 0u);
  EXPECT_THROW(scene.refit(2, VertexViewD(), IndexView()), std::invalid_argument);
}

TEST(ScenesOfDoubles, hide_triangles_by_masks_from_all_rays) {
  Random random(199);
  PartsD parts = parts_of({soup_on_lattice(random), moved(cube(-1, 1), 1, {}), soup(30)});
  for (std::uint32_t i = 0; i < 8; ++i)
    parts.scene.place(i % 3, i < 5 ? TransformD() : random_transform_d(random, 1, 2), i == 2 ? 0b0101 : ~0u);
  const auto some_masks = [&](std::size_t count) {
    std::vector<std::uint32_t> words(count);
    for (std::uint32_t& word : words) word = random.chance(0.3) ? 0 : 1u << random.index(3);
    return words;
  };
  parts.set_masks(0, some_masks(30)), parts.set_masks(1, some_masks(5));
  EXPECT_THROW(parts.scene.closest(RayD{}), std::logic_error);
  parts.scene.update();
  std::vector<RayD> rays = rays_to_parts(parts, by_level(30), 3, random);
  for (const RayD& ray : rays_on_lattice(random, by_level(30))) rays.push_back(ray);
  // Rays that touch edges of the cube, where one of two triangles may be hidden.
  for (std::size_t i = 0; i < 6; ++i) {
    RayD& ray = rays.emplace_back(RayD{{}, 0, {}, HUGE_VAL});
    const std::size_t x = i % 3, z = (i + 1) % 3;
    ray.origin = {0.125, 0.125, 0.125}, ray.origin[x] = -3, ray.origin[z] = i < 3 ? -5 : 5;
    ray.direction[x] = 1, ray.direction[z] = i < 3 ? 1 : -1;
  }
  expect_every_query(parts, rays);
  PartsD outer;
  outer.add(soup(1)), outer.add(parts), outer.scene.place(1, turned_about_y), outer.scene.update();
  expect_every_query(outer, rays);
  const SceneClosestPointD nearest = parts.scene.closest_point({0.25, 0.125, 0.5});
  parts.set_masks(1, some_masks(40)), parts.set_masks(0, {});
  parts.scene.refit(1, parts.meshes[1].vertices, parts.meshes[1].triangles), parts.scene.update();
  expect_every_query(parts, rays);
  const SceneClosestPointD again = parts.scene.closest_point({0.25, 0.125, 0.5});
  EXPECT_TRUE(same_bytes(again, nearest));
  std::ostringstream file;
  expect_words(message_of<std::invalid_argument>([&] { parts.scene.save(file); }), {"geometry 1", "masks"});
  parts.scene.replace(1, BvhD(parts.meshes[1].vertices, parts.meshes[1].triangles)), parts.masks.clear();
  parts.scene.update();
  expect_every_query(parts, rays);
  EXPECT_THROW(parts.scene.set_triangle_masks(3, {}), std::out_of_range);
}

std::string saved(const SceneD& scene) {
  std::ostringstream file;
  scene.save(file);
  return file.str();
}
SceneD loaded(const std::string& bytes) {
  std::istringstream file(bytes);
  return SceneD::load(file);
}

TEST(SavedSceneOfDoubles, has_the_same_hits_and_the_same_bytes_again) {
  Random random(200);
  Levels levels(random, 4.6e6);
  levels.whole.scene.place(4, {{{std::nan(""), 0, 0, HUGE_VAL}}});
  levels.whole.scene.update();
  const std::string file = saved(levels.whole.scene);
  PartsD again = levels.whole;
  again.scene = loaded(file);
  EXPECT_EQ(saved(again.scene), file);
  ASSERT_EQ(again.scene.instance_count(), levels.whole.scene.instance_count());
  for (std::uint32_t i = 0; i < again.scene.instance_count(); ++i) {
    EXPECT_EQ(again.scene.levels_of(i), levels.whole.scene.levels_of(i));
    EXPECT_EQ(again.scene.mask_of(i), levels.whole.scene.mask_of(i));
    const TransformD saved_one = levels.whole.scene.transform_of(i), loaded_one = again.scene.transform_of(i);
    EXPECT_TRUE(same_bytes(loaded_one, saved_one));
  }
  again.scene.move(25, {}), again.scene.update();
  expect_every_query(again, rays_to_parts(again, by_level(25), 4, random));
  EXPECT_EQ(saved(loaded(saved(SceneD()))), saved(SceneD()));
}

TEST(SavedSceneOfDoubles, that_was_cut_or_damaged_or_is_another_is_refused) {
  Random random(201);
  const std::string file = saved(Levels(random).whole.scene);
  for (std::size_t size = 0; size < file.size(); size += size < 4000 ? 7 : 997)
    expect_words(message_of<std::runtime_error>([&] { loaded(file.substr(0, size)); }), {"tree file: "});
  for (std::size_t bit = 0; bit < 8 * file.size(); bit += bit < 8000 ? 3 : 4999) {
    std::string damaged = file;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ 1 << bit % 8);
    expect_words(message_of<std::runtime_error>([&] { loaded(damaged); }), {"tree file: "});
  }
  std::ostringstream of_floats, full;
  Scene().save(of_floats);
  expect_words(message_of<std::runtime_error>([&] { loaded(of_floats.str()); }), {"a Scene", "a SceneD"});
  std::istringstream stream(file);
  expect_words(message_of<std::runtime_error>([&] { Scene::load(stream); }), {"a SceneD", "a Scene"});
  full.setstate(std::ios::badbit);
  EXPECT_THROW(SceneD().save(full), std::runtime_error);
}

}  // namespace
}  // namespace raylanes::testing
