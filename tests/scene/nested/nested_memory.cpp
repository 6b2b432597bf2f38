// Memory that runs out while scenes are placed in scenes: a clean std::bad_alloc, and the scene is as it was.
#include "../../support/limited_memory.hpp"
#include "nested_cases.hpp"

namespace raylanes::testing {
namespace {

// A call that changes a copy of the scene does all of it, or nothing.
template <class Call>
void expect_strong(const char* name, const Scene& scene, const Call& call) {
  SCOPED_TRACE(name);
  const Ray ray = make_ray({0.25f, 0.125f, -5}, {0, 0, 1});
  const SceneHit hit = scene.closest(ray);
  std::size_t allocations = 0;
  for (;; ++allocations) {
    ASSERT_LT(allocations, 100'000u);
    Scene changed = scene;
    if (!runs_out(allocations, unlimited, [&] { call(changed); })) break;
    EXPECT_EQ(changed.geometry_count(), scene.geometry_count());
    EXPECT_EQ(changed.instance_count(), scene.instance_count());
    EXPECT_EQ(changed.mask_of(0), scene.mask_of(0));
    EXPECT_EQ(changed.mask_of(1), scene.mask_of(1));
    EXPECT_TRUE(same_bytes(changed.closest(ray), hit));
  }
  EXPECT_GT(allocations, 0u);
}

TEST(NestedSceneMemory, that_runs_out_leaves_the_scene_as_it_was) {
  Scene part, scene;
  for (int i = 0; i < 3; ++i) part.place(part.add(cube(0, 1)));
  scene.place(scene.add(part)), scene.place(0, moved_by(2, 0, 0));
  scene.update();
  EXPECT_GT(scene.report().common_instances, 1u);
  expect_strong("add", scene, [&](Scene& changed) { changed.add(part); });
  expect_strong("place", scene, [](Scene& changed) { changed.place(0); });
  const std::vector<std::uint32_t> masks(12, 0b0010);
  expect_strong("set_triangle_masks", scene, [&](Scene& changed) { changed.set_triangle_masks(1, masks); });
  expect_strong("set_mask", scene, [](Scene& changed) { changed.set_mask(0, 0b0010); });
}

}  // namespace
}  // namespace raylanes::testing
