// Scenes of parts: hits are as if all instances were asked one after the other, whatever the top level does.
#include "triangle_parts.hpp"

namespace raylanes::testing {
namespace {

TEST(Scene, decides_by_exact_arithmetic_on_the_ray_of_an_instance) {
  Random random(73);
  const TriangleParts parts = random_parts(9, 1, 3, random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, by_level(300), 5, random);
  std::vector<SceneHit> expected;
  for (const Ray& ray : rays) expected.push_back(parts.by_rationals(ray));
  expect_hits(parts.scene, rays, expected);
}

// Rounding a ray in a part's space moves it far in the scene where origins are far away or transforms stretch.
TEST(Scene, misses_nothing_that_rounded_rays_hit) {
  Random random(74);
  for (const auto& [shift, reach, stretch] :
       {std::tuple{1e5f, 2e5f, 1.0f}, {10.0f, 1e6f, 1.0f}, {10.0f, 20.0f, 3e5f}, {1e3f, 1e4f, 1e-6f}}) {
    TriangleParts parts;
    parts.add(ellipsoid(1, {0, 0, 0}, {1, 1, 1}));
    parts.add(triangle_soup(40, 0.2f, 75));
    for (int i = 0; i < 40; ++i) {
      Transform transform = random_transform(random, 1, shift);
      for (float& x : transform.row[i % 3]) x *= stretch;
      if (i % 5 == 0)  // nearly singular
        for (std::size_t k = 0; k < 3; ++k)
          transform.row[2][k] = transform.row[0][k] + transform.row[1][k] + random.number(-1e-6f, 1e-6f);
      parts.scene.place(static_cast<std::uint32_t>(i % 2), transform);
    }
    parts.scene.update();
    SCOPED_TRACE(std::to_string(shift) + ", " + std::to_string(stretch));
    expect_all(parts, rays_to_instances(parts.scene, by_level(1500), reach, random));
  }
}

// Aimed along the silhouettes of boxes: flat parts, and rays that graze them.
TEST(Scene, misses_nothing_at_the_edges_of_flat_parts) {
  Random random(76);
  TriangleParts parts;
  parts.add(integer_grid(4));
  for (int i = 0; i < 30; ++i) {
    Transform turned;
    const double angle = random.real(0, 7);
    turned.row[0][0] = turned.row[2][2] = static_cast<float>(std::cos(angle));
    turned.row[0][2] = static_cast<float>(std::sin(angle)), turned.row[2][0] = -turned.row[0][2];
    turned.row[1][3] = static_cast<float>(5 * i), turned.row[0][3] = random.number(-1000, 1000);
    parts.scene.place(0, turned);
  }
  parts.scene.update();
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(2400); ++i) {
    const Transform t = parts.scene.transform_of(static_cast<std::uint32_t>(i % 30));
    const float x = static_cast<float>(random.integer(0, 4)), y = static_cast<float>(random.integer(0, 4));
    Float3 target, from = random.point(3000), direction;
    for (std::size_t axis = 0; axis < 3; ++axis)
      target[axis] = t.row[axis][0] * x + t.row[axis][1] * y + t.row[axis][3],
      direction[axis] = target[axis] - from[axis];
    rays.push_back(make_ray(from, direction));
  }
  expect_all(parts, rays, ~0u, rays.size() / 8);
}

// From the scene's zero past the corners where parts far away end, along an axis on which they are not far: rounding
// moves rays there by a share of the whole distance, slabs round by nearly nothing.
TEST(Scene, misses_nothing_at_the_ends_of_parts_far_away) {
  Random random(77);
  const Mesh mesh = cube(-1, 1);  // as large as its box
  TriangleParts parts;
  parts.add(mesh);
  for (std::size_t i = 0; i < 30; ++i) {
    Transform transform = random_transform(random, 1, 1);
    transform.row[i % 3][3] = i % 2 == 0 ? 3e4f : -3e4f;
    parts.scene.place(0, transform);
  }
  parts.scene.update();
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(3000); ++i) {
    const Transform t = parts.scene.transform_of(static_cast<std::uint32_t>(i % 30));
    const std::size_t far = i % 3, near = (far + 1 + i / 30 % 2) % 3;
    const double side = i / 60 % 2 == 0 ? 1.0 : -1.0;
    double at[3], most = -1e30;
    for (const Float3& v : mesh.vertices) {
      double to[3];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        to[axis] = static_cast<double>(t.row[axis][3]);
        for (std::size_t k = 0; k < 3; ++k)
          to[axis] += static_cast<double>(t.row[axis][k]) * static_cast<double>(v[k]);
      }
      if (side * to[near] > most) most = side * to[near], std::copy_n(to, 3, at);
    }
    at[near] += side * random.real(0, 0x1p-9);  // an ULP of the distance
    const Float3 from = random.point(1);
    Float3 direction;
    for (std::size_t axis = 0; axis < 3; ++axis)
      direction[axis] = static_cast<float>(at[axis] - static_cast<double>(from[axis]));
    rays.push_back(make_ray(from, direction));
  }
  expect_all(parts, rays, ~0u, rays.size() / 64);
}

// Ties in t go to the first instance, also where exact distances differ by less than an ULP.
TEST(Scene, orders_equal_hits_by_instances) {
  TriangleParts parts;
  parts.add({{{-4, -4, 0}, {8, -4, 0}, {-4, 8, 0}}, {{0, 1, 2}}});
  for (int i = 0; i < 40; ++i)
    parts.scene.place(0, moved_by(0, 0, std::ldexp(static_cast<float>((i * 7) % 20), -27)));
  parts.scene.update();
  Random random(77);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(600); ++i)
    rays.push_back(make_ray({random.number(-1, 1), random.number(-1, 1), i % 2 == 0 ? -1.0f : 1.0f},
                            {random.number(-1, 1), random.number(-1, 1), i % 2 == 0 ? 1.0f : -1.0f}, 0,
                            i % 3 == 0 ? 1.0f : infinity));
  expect_all(parts, rays, ~0u, rays.size() / 2);
}

TEST(Scene, is_hit_by_nothing_where_transforms_have_no_inverse) {
  TriangleParts parts;
  parts.add(ellipsoid(1, {0, 0, 0}));
  const Transform zero{{{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}},
      flat{{{1, 2, 3, 0}, {2, 4, 6, 0}, {0, 0, 1, 0}}},
      sevenths{{{1 / 7.0f, 2 / 7.0f, 3 / 7.0f, 0}, {0.1f, 0.2f, 0.3f, 0}, {0.7f, 0.9f, 0.1f, 0}}};
  for (const Transform& transform : {zero, flat, moved_by(nan, 0, 0), moved_by(0, infinity, 0),
                                     moved_by(0, 0, 0, nan), moved_by(0, 0, 0, infinity)})
    parts.scene.place(0, transform);
  parts.scene.update();
  EXPECT_GT(parts.scene.bounds().lo[0], parts.scene.bounds().hi[0]);
  Random random(78);
  const std::vector<Ray> rays = rays_to_instances({}, 200, 5, random);
  expect_all(parts, rays, ~0u, 0);
  Scene beyond;  // the largest float
  beyond.place(beyond.add(Bvh(parts.meshes[0])), moved_by(3e38f, 0, 0, 3e38f));
  beyond.update();
  EXPECT_FALSE(beyond.closest(make_ray({3e38f, 0, 0}, {-1, 0, 0})));
  Scene large;
  large.place(large.add(Bvh(parts.meshes[0])), moved_by(0, 0, 0, 3e37f));
  large.update();
  EXPECT_TRUE(large.closest(make_ray({0, 0, 0}, {0, 0, 1})));
  for (const Path* path : supported_paths())  // subnormal in the part's space
    EXPECT_FALSE(large.closest(make_ray({0, 0, 2.7e37f}, {0, 0, 0.1f}), {.path = path})) << path->name;
  parts.scene.place(0, sevenths);
  parts.scene.place(0, moved_by(0, 0, 0, 1e-40f));
  parts.scene.place(0, moved_by(1, 0, 0, 1e-30f));
  parts.scene.place(0, moved_by(0, 0, 0, 1e30f));
  parts.scene.update();
  expect_all(parts, rays, ~0u, 1);
}

}  // namespace
}  // namespace raylanes::testing
