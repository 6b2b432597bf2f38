// Trees over spheres, alone and in scenes beside triangles and boxes.
#include "boxed_cases.hpp"

namespace raylanes::testing {
namespace {

TEST(SphereTree, has_the_bytes_of_closest_hit) {
  Random random(98);
  const std::vector<Sphere> spheres = random_spheres(300, random);
  const SphereTree tree(spheres);
  const SphereRows rows(spheres);
  const auto closest_of = [&](const Ray& ray) { return rows.closest(ray); };
  for (const float reach : {0.5f, 3.0f, 1e3f, 1e5f}) {
    SCOPED_TRACE(reach);
    expect_batches(tree, rays_around(by_level(900), reach, 99), closest_of);
    expect_batches(tree, rays_from_a_point(by_level(900), reach, 108), closest_of);
  }
  SphereTree().closest(std::vector<Ray>(), std::span<Hit>());
}

// Rays that graze spheres, from near and far.
TEST(SphereTree, misses_nothing_that_grazes) {
  Random random(100);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 60; ++i) spheres.push_back({random.point(20), random.magnitude(1e-2, 2)});
  for (int i = 0; i < 40; ++i)
    spheres.push_back({{100.0f + static_cast<float>(i), 0, 0}, 0.01f});  // sides in a plane
  const SphereTree tree(spheres);
  const SphereRows rows(spheres);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(3000); ++i) {
    const float x = 100.0f + static_cast<float>(i % 40), y = 0.01f + random.magnitude(1e-6, 1e-3);
    rays.push_back(make_ray({x, y, -1e4f}, {0, 0, 1}));
    rays.push_back(make_ray({x + random.number(-900, 900), random.number(-900, 900), -1e4f}, {0, 0, 1}));
    for (std::size_t k = 0; k < 2; ++k) rays.back().direction[k] = (k == 0 ? x : y) - rays.back().origin[k];
    rays.back().direction[2] = 1e4f;
  }
  for (std::size_t i = 0; i < by_level(3000); ++i) {
    const Sphere& sphere = spheres[i % spheres.size()];
    const std::size_t axis = i / 7 % 3;
    Float3 from = random.point(i % 2 == 0 ? 30.0f : 1e4f), to = sphere.centre;
    to[axis] += sphere.radius, from[axis] = to[axis];
    rays.push_back(make_ray(from, {to[0] - from[0], to[1] - from[1], to[2] - from[2]}));
  }
  expect_batches(tree, rays, [&](const Ray& ray) { return rows.closest(ray); });
  for (std::size_t i = 0; i + 8 <= rays.size(); i += 8) {  // one by one, by boxes that are hardly widened
    std::vector<Hit> hits(8);
    tree.closest(std::span(rays).subspan(i, 8), hits);
    for (std::size_t k = 0; k < 8; ++k) {
      const Hit expected = rows.closest(rays[i + k]);
      ASSERT_TRUE(same_bytes(hits[k], expected)) << i + k;
    }
  }
}

// Spheres whose fronts are one plane, before which the test finds all of them, by more than walks through boxes round:
// the nearest one is not lost behind one that was found before it.
TEST(SphereTree, has_the_nearest_of_fronts_in_one_place) {
  Random random(104);
  constexpr double front = 0.25, beyond_walks = 9 * 0x1p-24;
  std::size_t found = 0;
  for (std::size_t n = 0; n < by_level(120); ++n) {
    const std::size_t axis = n % 3;
    const float side = n % 2 == 0 ? 1.0f : -1.0f;
    Ray ray = make_ray(random.point(1e-5f), random.point(1e-3f));
    ray.direction[axis] = side * random.number(0.5f, 1.5f);
    const double entry = (front - static_cast<double>(side * ray.origin[axis])) /
                         static_cast<double>(side * ray.direction[axis]);
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i < 20000 && spheres.size() < 64; ++i) {
      Sphere sphere{{}, std::ldexp(std::round(random.number(1.2f, 2.8f) * 0x1p20f), -20)};
      sphere.centre[axis] = side * (static_cast<float>(front) + sphere.radius);  // exact
      const Hit hit = SphereRows({sphere}).closest(ray);
      if (hit && static_cast<double>(hit.t) < entry * (1 - beyond_walks)) spheres.push_back(sphere);
    }
    found += spheres.size();
    const SphereTree tree(spheres);
    const SphereRows rows(spheres);
    expect_batches(tree, std::vector<Ray>(80, ray), [&](const Ray& r) { return rows.closest(r); });
  }
  EXPECT_GT(found, 10 * by_level(120));
}

TEST(Scene, has_triangles_spheres_and_others_side_by_side) {
  Random random(101);
  UserTriangles user = soup(80, 102);
  const std::vector<Sphere> spheres = random_spheres(40, random);
  const SphereRows rows(spheres);
  Scene scene;
  const Mesh mesh = ellipsoid(1, {0, 0, 0}, {1, 0.5f, 0.7f});
  scene.add(Bvh(mesh)), scene.add(SphereTree(spheres)), scene.add(BoundedTree(user.boxes()), user);
  scene.add(SphereTree()), scene.add(BoundedTree(), user);
  const auto closest_of = [&](std::uint32_t geometry, const Ray& ray) {
    return geometry == 0   ? scene.tree(0)->closest(ray)
           : geometry == 1 ? rows.closest(ray)
           : geometry == 2 ? user.closest(ray)
                           : Hit();
  };
  const auto expect_all = [&] {
    scene.update();
    const std::vector<Ray> rays = rays_around(by_level(900), 6, 103);
    std::vector<SceneHit> expected;
    for (const Ray& ray : rays) expected.push_back(expected_hit(scene, ray, ~0u, closest_of));
    expect_hits(scene, rays, expected);
  };
  for (std::uint32_t part = 0; part < 5; ++part) {  // one at a time
    if (part > 0) scene.move(part - 1, moved_by(nan, 0, 0));
    scene.place(part);
    expect_all();
    scene.move(part, random_transform(random, 1, 2));
    expect_all();
  }
  for (std::uint32_t i = 0; i < 60; ++i)
    scene.place(i % 5, i % 4 == 0 ? Transform() : random_transform(random, 1, 4));
  expect_all();
}

}  // namespace
}  // namespace raylanes::testing
