// Every query of rays in scenes of doubles: what rational numbers say of each instance, in the order of t, instance and
// primitive, on every path, of many rays and alone.
#include "expect_scene_d.hpp"

namespace raylanes::testing {
namespace {

TEST(ScenesOfDoubles, of_any_transforms) {
  Random random(181);
  PartsD parts = parts_of({moved(cube(-0.5f, 0.5f), 1, {}), soup(60), {}});
  for (std::uint32_t i = 0; i < 12; ++i)
    parts.scene.place(i % 3, i < 3 ? TransformD() : random_transform_d(random, 1, 2), 1u << i % 4);
  parts.scene.update();
  EXPECT_GT(expect_every_query(parts, rays_to_parts(parts, by_level(60), 3, random)), by_level(60));
}

// Buildings far from the origin, each turned: what cancels is exact.
TEST(ScenesOfDoubles, of_parts_in_utm_coordinates) {
  Random random(182);
  PartsD parts = parts_of({moved(cube(-5, 5), 1, {}), moved(double_fan(12, 0.25f), 8, {})});
  for (std::uint32_t i = 0; i < 9; ++i)
    parts.scene.place(i % 2,
                      turned(0.7 * i, {500123.456 + 20.25 * (i % 3), 4649776.22 + 20.5 * (i / 3), 31.7}),
                      1u << i % 4);
  parts.scene.update();
  EXPECT_GT(expect_every_query(parts, rays_to_parts(parts, by_level(60), 40, random)), by_level(60));
}

// Parts that stand: trees for four masks, one of them of one part, and a fifth mask.
TEST(ScenesOfDoubles, of_parts_that_stand) {
  Random random(183);
  PartsD parts = parts_of({moved(cube(-1, 1), 1, {}), soup(40), moved(cube(0, 2), 0.5, {})});
  const std::uint32_t masks[] = {1, 1, 2, 4, 6, 8, 1, 2};
  for (std::uint32_t i = 0; i < 8; ++i) parts.scene.place(i % 3, {}, masks[i]);
  parts.scene.update();
  EXPECT_GT(expect_every_query(parts, rays_to_parts(parts, by_level(60), 3, random)), by_level(60));
  PartsD one_tree = parts_of({moved(cube(-1, 1), 1, {}), soup(40)});
  for (std::uint32_t i = 0; i < 4; ++i) one_tree.scene.place(i % 2);
  one_tree.scene.update();
  expect_every_query(one_tree, rays_to_parts(one_tree, by_level(60), 3, random));
  const std::vector<RayD> many = repeated(rays_to_parts(one_tree, 100, 3, random), 5000);
  std::vector<SceneHitD> hits(many.size());
  one_tree.scene.closest(many, hits, {.threads = 2});
  for (std::size_t i = 0; i < many.size(); ++i)
    ASSERT_TRUE(same_bytes(hits[i], one_tree.scene.closest(many[i]))) << i;
}

// Parts that coincide, touch and are turned on a lattice: ties in t are many.
TEST(ScenesOfDoubles, of_ties) {
  Random random(184);
  PartsD parts = parts_of({soup_on_lattice(random), moved(cube(-1, 1), 1, {})});
  const TransformD places[] = {
      {}, {{{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 0}}}, {{{0, 0, 1, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}}}};
  for (std::uint32_t i = 0; i < 7; ++i) parts.scene.place(i % 2, places[(7 - i) % 3], 1u << i % 4);
  parts.scene.update();
  EXPECT_GT(expect_every_query(parts, rays_on_lattice(random, by_level(60))), by_level(60));
}

TEST(ScenesOfDoubles, ask_filters_about_each_hit) {
  Random random(185);
  PartsD parts = parts_of({moved(cube(-0.5f, 0.5f), 1, {}), soup(60)});
  for (const bool stand : {true, false}) {
    for (std::uint32_t i = 0; i < 5; ++i)
      parts.scene.place(i % 2, stand ? TransformD() : random_transform_d(random, 1, 2));
    parts.scene.update();
    const std::vector<RayD> rays = rays_to_parts(parts, by_level(60), 3, random);
    on_each_path([&](const Path* path, int threads) {
      expect_filtered<SceneHitD>(
          parts.scene, rays, TraceOptionsD{.path = path, .threads = threads},
          [&](const RayD& ray) { return ExpectedD(parts, {ray}, Facing::any, ~0u).hits[0]; });
    });
  }
}

// Sizes that floats do not have; transforms that nothing hits, beside one that something does.
TEST(ScenesOfDoubles, of_all_sizes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double size : {1e-140, 1e-30, 1e30, 1e140}) {
    SCOPED_TRACE(size);
    Random random(186);
    PartsD parts = parts_of({moved(cube(-1, 1), 1, {})});
    for (int i = 0; i < 4; ++i) parts.scene.place(0, random_transform_d(random, size, 3 * size));
    parts.scene.place(0, {{{size, 0, 0, 0}, {0, size, 0, 0}, {0, 0, size * 1e-30, 0}}});
    parts.scene.update();
    const std::vector<RayD> rays = rays_to_parts(parts, by_level(30), 3 * size, random);
    EXPECT_GT(expect_every_query(parts, rays), by_level(30));
    std::vector<SceneHitD> before(rays.size());
    parts.scene.closest(rays, before);
    for (const TransformD& never :
         {TransformD{{{size, size, 0, 0}, {size, size, 0, 0}, {0, 0, size, 0}}}, TransformD{{{nan}}},
          // a sheet that rays would hit: too thin for its size
          TransformD{{{size, size, 0, 0}, {size, size * (1 + 0x1p-50), 0, 0}, {0, 0, size, 0}}},
          TransformD{{{size, 0, 0, HUGE_VAL}, {0, size, 0, 0}, {0, 0, size, 0}}}, TransformD{{{}, {}, {}}}})
      parts.scene.place(0, never);
    parts.scene.update();
    for (std::size_t i = 0; i < rays.size(); ++i)
      EXPECT_TRUE(same_bytes(parts.scene.closest(rays[i]), before[i])) << i;
  }
}

}  // namespace
}  // namespace raylanes::testing
