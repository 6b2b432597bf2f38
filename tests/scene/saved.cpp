// Scenes as bytes and back: the same hits, and nothing but a scene is taken for one.

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "../support/level.hpp"
#include "../support/message_of.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "expect_scene.hpp"

namespace raylanes::testing {
namespace {

std::string saved(const Scene& scene) {
  std::ostringstream file;
  scene.save(file);
  return file.str();
}
Scene loaded(const std::string& bytes) {
  std::istringstream file(bytes);
  return Scene::load(file);
}

// Trees of all kinds, an empty one among them; spheres, of which some cannot be hit; places that are singular, not
// finite, turned, masked.
Scene scene_of_all_kinds() {
  Scene scene;
  scene.add(Bvh(triangle_soup(200, 0.4f, 1)));
  scene.add(SphereTree(std::vector<Sphere>{{{0, 0, 0}, 0.5f},
                                           {{1, 1, 1}, -1},
                                           {{2, 0, 0}, 0.3f},
                                           {{0, 3, 0}, 1e30f},
                                           {{0, 0, nan}, 1},
                                           {{0, 1, 2}, 0}}));
  scene.add(Bvh());
  scene.add(SphereTree());
  scene.add(Bvh(triangle_soup(50, 0.6f, 2), {.builder = TreeBuilder::spatial_splits, .optimize = true}));
  Random random(3);
  for (std::uint32_t i = 0; i < 40; ++i) {
    Transform transform;
    for (auto& row : transform.row)
      for (float& x : row) x = random.number(-1.5f, 1.5f);
    if (i == 7) transform.row[1][2] = nan;
    if (i == 8) transform = {.row = {{1, 2, 3, 0}, {2, 4, 6, 0}, {0, 0, 1, 0}}};
    scene.place(i % 5, transform, i % 6 == 0 ? 2u : ~0u);
  }
  scene.update();
  return scene;
}

std::vector<SceneHit> hits_of(const Scene& scene, const std::vector<Ray>& rays, std::uint32_t mask) {
  std::vector<SceneHit> hits(rays.size());
  scene.closest(rays, hits, {.mask = mask});
  return hits;
}
void expect_same_hits(const Scene& a, const Scene& b) {
  const std::vector<Ray> rays = mixed_rays(triangle_soup(100, 1, 4), by_level(3000), 3, {0, 0, 0}, 5);
  for (const std::uint32_t mask : {~0u, 1u, 2u}) {
    const std::vector<SceneHit> of_a = hits_of(a, rays, mask), of_b = hits_of(b, rays, mask);
    EXPECT_TRUE(same_bytes(of_a, of_b)) << mask;
    EXPECT_GT(std::ranges::count_if(of_a, [](const SceneHit& hit) { return bool{hit}; }), 10) << mask;
  }
}

TEST(SavedScene, has_the_same_hits_and_the_same_bytes_again) {
  const Scene scene = scene_of_all_kinds(), again = loaded(saved(scene));
  EXPECT_EQ(again.geometry_count(), scene.geometry_count());
  EXPECT_EQ(again.instance_count(), scene.instance_count());
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    EXPECT_EQ(again.geometry_of(i), scene.geometry_of(i));
    EXPECT_EQ(again.mask_of(i), scene.mask_of(i));
    const Transform ours = scene.transform_of(i), theirs = again.transform_of(i);
    EXPECT_TRUE(same_bytes(ours, theirs));
  }
  expect_same_hits(scene, again);
  EXPECT_EQ(saved(again), saved(scene));
  EXPECT_EQ(saved(loaded(saved(Scene()))), saved(Scene()));
}

TEST(SavedScene, can_be_changed_as_any_other) {
  Scene scene = loaded(saved(scene_of_all_kinds()));
  const Mesh mesh = triangle_soup(200, 0.4f, 6);
  scene.refit(0, mesh.vertices, mesh.triangles);
  scene.move(3, {});
  scene.update();
  expect_same_hits(scene, loaded(saved(scene)));
}

TEST(SavedScene, lies_between_other_things_in_a_stream) {
  std::stringstream stream;
  stream << "before";
  scene_of_all_kinds().save(stream);
  Scene().save(stream);
  stream << "behind";
  stream.seekg(6);
  EXPECT_EQ(Scene::load(stream).geometry_count(), 5u);
  EXPECT_EQ(Scene::load(stream).geometry_count(), 0u);
  std::string rest;
  stream >> rest;
  EXPECT_EQ(rest, "behind");
}

TEST(SavedScene, is_none_with_primitives_of_a_user) {
  Scene scene;
  auto never = [](std::uint32_t, const Ray&, Hit&) { return false; };
  scene.add(Bvh(triangle_soup(3, 0.4f, 7)));
  scene.add(BoundedTree(std::vector<Box>{{{0, 0, 0}, {1, 1, 1}}}), never);
  std::ostringstream file;
  expect_words(message_of<std::invalid_argument>([&] { scene.save(file); }), {"geometry 1", "user"});
  EXPECT_EQ(file.str(), "");
}

TEST(SavedScene, that_was_cut_or_damaged_is_refused) {
  const std::string file = saved(scene_of_all_kinds());
  for (std::size_t size = 0; size < file.size(); size += size < 4000 ? 1 : 997)
    expect_words(message_of<std::runtime_error>([&] { loaded(file.substr(0, size)); }), {"tree file: "});
  for (std::size_t bit = 0; bit < 8 * file.size(); bit += bit < 8000 ? 1 : 4999) {
    std::string damaged = file;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ 1 << bit % 8);
    expect_words(message_of<std::runtime_error>([&] { loaded(damaged); }), {"tree file: "});
  }
  std::ostringstream full;
  full.setstate(std::ios::badbit);
  EXPECT_THROW(scene_of_all_kinds().save(full), std::runtime_error);
}

// Damage that a right checksum covers up: numbers at their places in the file, and what the refusal says.
TEST(SavedScene, that_is_none_is_refused_whatever_its_checksum) {
  const std::string file = saved(scene_of_all_kinds());
  constexpr std::size_t header = 32, geometries = 56, instances = geometries + 5 * 8;
  const auto refusal = [&](std::size_t at, std::uint64_t number, std::size_t size) {
    std::string damaged = file;
    std::memcpy(damaged.data() + at, &number, size);
    const std::uint64_t checksum =
        XXH3_64bits(damaged.data() + header, instances + 40 * 56 + 6 * 16 - header);
    std::memcpy(damaged.data() + 24, &checksum, sizeof checksum);
    return message_of<std::runtime_error>([&] { loaded(damaged); });
  };
  expect_words(refusal(header, std::uint64_t{1} << 60, 8), {"counts"});
  expect_words(refusal(header + 8, std::uint64_t{1} << 60, 8), {"counts"});
  expect_words(refusal(header + 16, std::uint64_t{1} << 60, 8), {"counts"});
  expect_words(refusal(geometries, 3, 4), {"kind 3"});
  expect_words(refusal(geometries + 4, 1, 4), {"spheres", "another kind"});
  expect_words(refusal(geometries + 12, 7, 4), {"spheres"});
  expect_words(refusal(geometries + 12, (std::uint64_t{1} << 28) + 1, 4), {"268435457 spheres", "2^28"});
  expect_words(refusal(instances + 56, 5, 4), {"geometry 5"});
}

}  // namespace
}  // namespace raylanes::testing
