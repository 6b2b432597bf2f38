// Stretches of rays within the instances of scenes, compared with the tree of each instance and the ray in its space.
#include <raylanes/stretches.hpp>

#include "../doubles/both_numbers.hpp"
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
template <class T>
class CubesInScene : public ::testing::Test {
 public:
  using SceneOf = std::conditional_t<std::is_same_v<T, float>, Scene, SceneD>;
  using SceneHitOf = typename raylanes::detail::QueryTypes<SceneOf>::Hit;
  using SceneStretchOf = typename decltype(stretches(SceneOf(), RayRecords<RayOf<T>>()).items)::value_type;

  CubesInScene() {
    for (const auto& [lo, hi] : {std::pair{0.0f, 4.0f}, {4.0f, 8.0f}, {2.0f, 6.0f}, {-1.0f, 1.0f}}) {
      trees.push_back(tree_of<T>(mesh_of<T>(cube(lo, hi))));
      place({scene.add(tree_of<T>(mesh_of<T>(cube(lo, hi)))), 1, {0, 0, 0}});
    }
    place({3, 2, {4, 0, 2}});
    place({0, 0.5f, {4, 4, 0}, -1});
    place({1, 1, {-4, 0, 0}, 1, 2});
    place({2, 4, {-16, -16, -16}, 1, 0});
    Random random(229);
    for (std::size_t i = 0; i < by_level(4000); ++i) {
      RayOf<T> ray;
      for (std::size_t k = 0; k < 3; ++k) {
        ray.origin[k] = T(random.integer(-20, 40)) / 2;
        ray.direction[k] = T(random.integer(-2, 10)) - ray.origin[k];
      }
      if (i % 8 == 1) ray.tmin = T(0.25);
      if (i % 8 == 2) ray.tmax = T(0.75);
      if (i % 8 == 3) ray.tmin = -3;
      rays.push_back(ray);
    }
  }
  void place(const Place& p) {
    places.push_back(p);
    std::conditional_t<std::is_same_v<T, float>, Transform, TransformD> transform;
    for (std::size_t k = 0; k < 3; ++k)
      transform.row[k][k] = k == 0 ? p.side * p.scale : p.scale, transform.row[k][3] = p.at[k];
    scene.place(p.geometry, transform, p.mask);
  }
  RayOf<T> in_space_of(const Place& p, RayOf<T> ray) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const T scale = k == 0 ? p.side * p.scale : p.scale;
      ray.origin[k] = (ray.origin[k] - p.at[k]) / scale, ray.direction[k] /= scale;
    }
    return ray;
  }
  std::vector<SceneStretchOf> expected(std::size_t i, std::uint32_t mask = ~0u, SceneHitOf skip = {}) const {
    std::vector<SceneStretchOf> all;
    for (std::uint32_t instance = 0; instance < places.size(); ++instance) {
      const Place& p = places[instance];
      if ((p.mask & mask) == 0) continue;
      const std::uint32_t skipped = skip.instance == instance ? skip.primitive : no_primitive;
      const auto lists =
          stretches(trees[p.geometry], std::vector{in_space_of(p, rays[i])}, {.skip = skipped});
      for (const auto& stretch : lists[0]) all.push_back({stretch, p.geometry, instance});
    }
    std::ranges::stable_sort(all, {}, &SceneStretchOf::entry);
    return all;
  }

  std::vector<BvhOf<T>> trees;
  std::vector<Place> places;
  SceneOf scene;
  std::vector<RayOf<T>> rays;
};
TYPED_TEST_SUITE(CubesInScene, Numbers, NumberNames);

TYPED_TEST(CubesInScene, have_the_stretches_of_their_trees) {
  auto& world = this->scene;
  const auto& given = this->rays;
  for (const bool moving : {false, true}) {
    if constexpr (std::is_same_v<TypeParam, float>) {
      for (std::uint32_t i = 0; i < 4; ++i) world.set_moving(i, moving);
      world.update();
      EXPECT_EQ(world.report().common_instances, moving ? 0u : 4u);
    }
    world.update();
    for (const std::uint32_t mask : {~0u, 2u, 1u}) {
      const auto usual = stretches(world, given, {.mask = mask});
      std::size_t most = 0;
      for (std::size_t i = 0; i < given.size(); ++i) {
        const auto wanted = this->expected(i, mask);
        ASSERT_TRUE(std::ranges::equal(usual[i], wanted)) << "ray " << i;
        most = std::max(most, wanted.size());
      }
      EXPECT_GE(most, 5u);
      for (const Path* path : paths_with_own_queries())
        for (const int threads : {1, 2}) {
          const auto again = stretches(world, given, {.path = path, .threads = threads, .mask = mask});
          EXPECT_EQ(again.items, usual.items);
          EXPECT_EQ(again.offsets, usual.offsets);
        }
    }
  }
}

TYPED_TEST(CubesInScene, take_the_options_of_lists) {
  auto& world = this->scene;
  const auto& given = this->rays;
  world.update();
  const auto whole = stretches(world, given);
  std::vector<typename TestFixture::SceneHitOf> skip(given.size());
  world.closest(given, skip);
  std::vector<std::uint8_t> active(given.size() / 8 + 1, 0x5a);
  const auto two = stretches(world, given, {.max_count = 2}),
             some = stretches(world, given, {.active = active.data()}),
             others = stretches(world, given, {.skip = skip});
  for (std::size_t i = 0; i < given.size(); ++i) {
    ASSERT_TRUE(std::ranges::equal(two[i], whole[i].first(std::min<std::size_t>(2, whole[i].size()))));
    const bool is_active = (active[i / 8] >> i % 8 & 1) != 0;
    ASSERT_TRUE(std::ranges::equal(some[i], is_active ? whole[i] : whole[i].first(0)));
    ASSERT_TRUE(std::ranges::equal(others[i], this->expected(i, ~0u, skip[i]))) << "ray " << i;
  }
}

TYPED_TEST(CubesInScene, refuse_what_closest_crossing_refuses) {
  using Rays = std::vector<RayOf<TypeParam>>;
  auto& world = this->scene;
  const auto& given = this->rays;
  EXPECT_THROW(stretches(world, given), std::logic_error);
  world.update();
  EXPECT_THROW(stretches(world, given, {.facing = Facing::back}), std::invalid_argument);
  EXPECT_THROW(stretches(world, RayRecords<RayOf<TypeParam>>(nullptr, 3)), std::invalid_argument);
  EXPECT_THROW(stretches(world, given, {.threads = -1}), std::invalid_argument);
  const std::vector<std::uint32_t> no_instances(given.size());
  EXPECT_THROW(stretches(world, given, {.skip = no_instances}), std::invalid_argument);
  EXPECT_EQ(stretches(world, Rays()).size(), 0u);
  EXPECT_EQ(stretches(typename TestFixture::SceneOf(), given).items.size(), 0u);
  if constexpr (std::is_same_v<TypeParam, float>) {
    world.place(world.add(SphereTree(std::vector<Sphere>{{{0, 0, 0}, 1}})));
    world.update();
    EXPECT_THROW(stretches(world, given), std::invalid_argument);
  }
}

}  // namespace
}  // namespace raylanes::testing
