// A scene places trees by affine maps; a hit says which geometry and which instance it is of.
#include "example.hpp"

namespace raylanes::testing {
namespace {

Transform moved_by(float x) {
  return {{{1, 0, 0, x}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
}
Ray along_z(float x) {
  return {.origin = {x, 0.5f, 3}, .direction = {0, 0, -1}};
}

TEST(ScenesByExample, instances_of_one_tree) {
  Scene scene;
  const std::uint32_t box = scene.add(Bvh(cube));
  const std::uint32_t here = scene.place(box), there = scene.place(box, moved_by(10), 2);
  scene.update();
  for (const Path* path : supported_paths()) {
    const SceneHit first = scene.closest(along_z(0.25f), {.path = path});
    EXPECT_TRUE(first.t == 2 && first.primitive == 3 && first.geometry == box && first.instance == here);
    const SceneHit second = scene.closest(along_z(10.25f), {.path = path});
    EXPECT_TRUE(second.t == 2 && second.primitive == 3 && second.geometry == box && second.instance == there);
    EXPECT_FALSE(scene.closest(along_z(5), {.path = path})) << path->name << ": between them";
    EXPECT_FALSE(scene.closest(along_z(10.25f), {.path = path, .mask = 1}))
        << path->name << ": a mask without it";
  }
}

TEST(ScenesByExample, what_moves_is_updated) {
  Scene scene;
  const std::uint32_t instance = scene.place(scene.add(Bvh(cube)));
  scene.update();
  scene.move(instance, {{{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}}});  // twice as large
  scene.update();
  for (const Path* path : supported_paths())
    EXPECT_EQ(scene.closest(along_z(1.75f), {.path = path}).t, 1) << path->name;
}

TEST(ScenesByExample, ties_singular_maps_and_nothing) {
  Scene scene;
  const std::uint32_t box = scene.add(Bvh(cube));
  scene.place(box, {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 2}}});  // flat: never hit
  const std::uint32_t first = scene.place(box);
  scene.place(box);
  scene.update();
  for (const Path* path : supported_paths()) {
    EXPECT_EQ(scene.closest(along_z(0.25f), {.path = path}).instance, first) << path->name;
    EXPECT_FALSE(Scene().closest(along_z(0.25f), {.path = path})) << path->name;
  }
}

}  // namespace
}  // namespace raylanes::testing
