// Stretches of rays within the instances of scenes, compared with the tree of each instance and the ray in its space.
#include <raylanes/stretches.hpp>

#include "../support/meshes.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {
namespace {

// A place of a mesh by powers of two and whole numbers: rays are mapped without rounding. side: 1, or -1 for a mirror.
struct Place {
  std::uint32_t geometry;
  float scale;
  Float3 at;
  float side = 1;
  std::uint32_t mask = ~0u;
};

// Cubes that touch, overlap and contain each other; some stand where they were made.
class CubesInScene : public ::testing::Test {
 public:
  CubesInScene() {
    for (const auto& [lo, hi] : {std::pair{0.0f, 4.0f}, {4.0f, 8.0f}, {2.0f, 6.0f}, {-1.0f, 1.0f}}) {
      trees.emplace_back(cube(lo, hi));
      place({scene.add(Bvh(cube(lo, hi))), 1, {0, 0, 0}});
    }
    place({3, 2, {4, 0, 2}});
    place({0, 0.5f, {4, 4, 0}, -1});
    place({1, 1, {-4, 0, 0}, 1, 2});
    place({2, 4, {-16, -16, -16}, 1, 0});
    Random random(229);
    for (std::size_t i = 0; i < by_level(4000); ++i) {
      Ray ray;
      for (std::size_t k = 0; k < 3; ++k) {
        ray.origin[k] = static_cast<float>(random.integer(-20, 40)) / 2;
        ray.direction[k] = static_cast<float>(random.integer(-2, 10)) - ray.origin[k];
      }
      if (i % 8 == 1) ray.tmin = 0.25f;
      if (i % 8 == 2) ray.tmax = 0.75f;
      if (i % 8 == 3) ray.tmin = -3;
      rays.push_back(ray);
    }
  }
  void place(const Place& p) {
    places.push_back(p);
    Transform transform;
    for (std::size_t k = 0; k < 3; ++k)
      transform.row[k][k] = k == 0 ? p.side * p.scale : p.scale, transform.row[k][3] = p.at[k];
    scene.place(p.geometry, transform, p.mask);
  }
  Ray in_space_of(const Place& p, Ray ray) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const float scale = k == 0 ? p.side * p.scale : p.scale;
      ray.origin[k] = (ray.origin[k] - p.at[k]) / scale, ray.direction[k] /= scale;
    }
    return ray;
  }
  std::vector<SceneStretch> expected(std::size_t i, std::uint32_t mask = ~0u, SceneHit skip = {}) const {
    std::vector<SceneStretch> all;
    for (std::uint32_t instance = 0; instance < places.size(); ++instance) {
      const Place& p = places[instance];
      if ((p.mask & mask) == 0) continue;
      const std::uint32_t skipped = skip.instance == instance ? skip.primitive : no_primitive;
      const auto lists =
          stretches(trees[p.geometry], std::vector{in_space_of(p, rays[i])}, {.skip = skipped});
      for (const Stretch& stretch : lists[0]) all.push_back({stretch, p.geometry, instance});
    }
    std::ranges::stable_sort(all, {}, &SceneStretch::entry);
    return all;
  }

  std::vector<Bvh> trees;
  std::vector<Place> places;
  Scene scene;
  std::vector<Ray> rays;
};

TEST_F(CubesInScene, have_the_stretches_of_their_trees) {
  for (const bool moving : {false, true}) {
    for (std::uint32_t i = 0; i < 4; ++i) scene.set_moving(i, moving);
    scene.update();
    EXPECT_EQ(scene.report().common_instances, moving ? 0u : 4u);
    for (const std::uint32_t mask : {~0u, 2u, 1u}) {
      const auto usual = stretches(scene, rays, {.mask = mask});
      std::size_t most = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto wanted = expected(i, mask);
        ASSERT_TRUE(std::ranges::equal(usual[i], wanted)) << "ray " << i;
        most = std::max(most, wanted.size());
      }
      EXPECT_GE(most, 5u);
      for (const Path* path : paths_with_own_queries())
        for (const int threads : {1, 2}) {
          const auto again = stretches(scene, rays, {.path = path, .threads = threads, .mask = mask});
          EXPECT_EQ(again.items, usual.items);
          EXPECT_EQ(again.offsets, usual.offsets);
        }
    }
  }
}

TEST_F(CubesInScene, take_the_options_of_lists) {
  scene.update();
  const auto whole = stretches(scene, rays);
  std::vector<SceneHit> skip(rays.size());
  scene.closest(rays, skip);
  std::vector<std::uint8_t> active(rays.size() / 8 + 1, 0x5a);
  const auto two = stretches(scene, rays, {.max_count = 2}),
             some = stretches(scene, rays, {.active = active.data()}),
             others = stretches(scene, rays, {.skip = skip});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_TRUE(std::ranges::equal(two[i], whole[i].first(std::min<std::size_t>(2, whole[i].size()))));
    const bool is_active = (active[i / 8] >> i % 8 & 1) != 0;
    ASSERT_TRUE(std::ranges::equal(some[i], is_active ? whole[i] : whole[i].first(0)));
    ASSERT_TRUE(std::ranges::equal(others[i], expected(i, ~0u, skip[i]))) << "ray " << i;
  }
}

TEST_F(CubesInScene, refuse_what_closest_crossing_refuses) {
  EXPECT_THROW(stretches(scene, rays), std::logic_error);
  scene.update();
  EXPECT_THROW(stretches(scene, rays, {.facing = Facing::back}), std::invalid_argument);
  EXPECT_THROW(stretches(scene, RayView(nullptr, 3)), std::invalid_argument);
  EXPECT_THROW(stretches(scene, rays, {.threads = -1}), std::invalid_argument);
  const std::vector<std::uint32_t> no_instances(rays.size());
  EXPECT_THROW(stretches(scene, rays, {.skip = no_instances}), std::invalid_argument);
  EXPECT_EQ(stretches(scene, std::vector<Ray>()).size(), 0u);
  EXPECT_EQ(stretches(Scene(), rays).items.size(), 0u);
  scene.place(scene.add(SphereTree(std::vector<Sphere>{{{0, 0, 0}, 1}})));
  scene.update();
  EXPECT_THROW(stretches(scene, rays), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::testing
