// Memory that runs out while points of scenes are looked at: a clean std::bad_alloc, and the next call is right.
#include "../../support/limited_memory.hpp"
#include "point_scenes.hpp"

namespace raylanes::testing {
namespace {

void expect_clean(const char* name, const std::function<void()>& call,
                  const std::function<bool()>& is_right) {
  SCOPED_TRACE(name);
  std::size_t allocations = 0;
  while (allocations < 100'000 && runs_out(allocations, unlimited, call)) allocations += 1 + allocations / 8;
  EXPECT_TRUE(is_right());
  EXPECT_GT(allocations, 0u);
  EXPECT_LT(allocations, 100'000u);
}

TEST(ScenePointMemory, that_runs_out_is_a_clean_exception) {
  Random random(914);
  TriangleParts parts = parts_of_all_kinds(random, 12);
  const Scene& scene = parts.scene;
  const std::vector<Float3> points = points_near(scene, parts.meshes, 200, random);
  std::vector<SceneClosestPoint> closest(points.size()), closest_again(points.size());
  std::vector<float> numbers(points.size()), numbers_again(points.size());
  std::vector<ContainingPart> inner(points.size()), inner_again(points.size());
  RayLists<ContainingPart> lists_again;
  for (const int threads : {1, 2}) {
    scene.closest_points(points, closest);
    expect_clean(
        "closest_points", [&] { scene.closest_points(points, closest_again, {.threads = threads}); },
        [&] { return same_bytes(closest_again, closest); });
    scene.signed_distances(points, numbers);
    expect_clean(
        "signed_distances", [&] { scene.signed_distances(points, numbers_again, {.threads = threads}); },
        [&] { return same_bytes(numbers_again, numbers); });
    scene.winding_numbers(points, numbers);
    expect_clean(
        "winding_numbers", [&] { scene.winding_numbers(points, numbers_again, {.threads = threads}); },
        [&] { return same_bytes(numbers_again, numbers); });
    scene.innermost_parts(points, inner);
    expect_clean(
        "innermost_parts", [&] { scene.innermost_parts(points, inner_again, {.threads = threads}); },
        [&] { return inner_again == inner; });
    const RayLists<ContainingPart> lists = scene.containing_parts(points);
    expect_clean(
        "containing_parts", [&] { lists_again = scene.containing_parts(points, {.threads = threads}); },
        [&] { return lists_again.offsets == lists.offsets && lists_again.items == lists.items; });
  }
}

// Trees of meshes, their volumes and boundaries are made by the first call that needs them.
TEST(ScenePointMemory, that_runs_out_at_first_is_enough_later) {
  const Mesh open = without(ellipsoid(2, {0, 0, 0}), 0.1, 915);
  const std::vector<Float3> points{{0, 0, 0}, {3, 3, 3}};
  for (const InsideRule rule : {InsideRule::parity, InsideRule::winding}) {
    std::size_t failed = 0;
    Scene scene;
    scene.place(scene.add(open)), scene.place(scene.add(cube(-4, 4)));
    scene.update();
    std::vector<ContainingPart> parts(points.size());
    while (failed < 100'000 &&
           runs_out(failed, unlimited, [&] { scene.innermost_parts(points, parts, {.rule = rule}); }))
      ++failed;
    EXPECT_GT(failed, 5u);
    EXPECT_EQ(parts[1], (ContainingPart{1, 1, Location::inside}));
    EXPECT_EQ(parts[0], (ContainingPart{0, 0, Location::inside}));
  }
}

}  // namespace
}  // namespace raylanes::testing
