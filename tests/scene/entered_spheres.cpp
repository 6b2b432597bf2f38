// Spheres that rays enter and leave from points on them: of a skipped sphere the hit at the ray's begin is not there.
#include "../queries/query_trees.hpp"
#include "boxed_cases.hpp"

namespace raylanes::testing {
namespace {

// Spheres that do not touch, and rays from points that were rounded on them: every other ray goes inwards.
struct RaysFromSpheres {
  std::vector<Sphere> spheres;
  std::vector<Ray> rays;
  std::vector<std::uint32_t> from;
  std::vector<double> exit, bound;  // t of the farther root by doubles, and how far off it may be

  RaysFromSpheres() {
    Random random(211);
    for (std::size_t i = 0; i < 125; ++i)
      spheres.push_back({{3.0f * static_cast<float>(i % 5), 3.0f * static_cast<float>(i / 5 % 5),
                          3.0f * static_cast<float>(i / 25)},
                         random.number(0.2f, 1.4f)});
    while (rays.size() < by_level(20000)) {
      const auto sphere = static_cast<std::uint32_t>(rays.size() % spheres.size());
      const auto& [centre, radius] = spheres[sphere];
      const Float3 out = random.point(1);
      Ray ray = make_ray({}, random.point(1), 0);
      double outwards = 0, length = 0, square = 0, excess = -double(radius) * double(radius);
      for (std::size_t k = 0; k < 3; ++k) length += double(out[k]) * double(out[k]);
      for (std::size_t k = 0; k < 3; ++k)
        ray.origin[k] =
            static_cast<float>(double(centre[k]) + double(radius) * double(out[k]) / std::sqrt(length));
      const bool is_inwards = rays.size() % 2 == 0;
      for (std::size_t k = 0; k < 3; ++k) {
        outwards += (double(ray.origin[k]) - double(centre[k])) * double(ray.direction[k]);
        square += double(ray.direction[k]) * double(ray.direction[k]);
        excess += (double(ray.origin[k]) - double(centre[k])) * (double(ray.origin[k]) - double(centre[k]));
      }
      // Steep enough for the bound of SphereTest::perpendicular.
      const double distance = std::sqrt(square), depth = double(radius);
      if (std::abs(outwards) < 0.11 * distance * depth || square < 0.01) continue;
      if ((outwards < 0) != is_inwards) {
        for (float& d : ray.direction) d = -d;
        outwards = -outwards;
      }
      rays.push_back(ray), from.push_back(sphere);
      const double middle = -outwards / square;
      exit.push_back(middle + std::sqrt(middle * middle - excess / square));
      bound.push_back(0x1p-17 * depth / distance);  // 16 ULP of twice the radius, and as much again
    }
  }
  // The exit of a ray that goes inwards; of another one nothing of its own sphere.
  bool is_good(std::size_t i, const auto& hit) const {
    if (i % 2 != 0) return hit.primitive != from[i];
    return hit.primitive == from[i] && std::abs(double(hit.t) - exit[i]) < bound[i];
  }
};

template <class Find>
void expect_exits(const RaysFromSpheres& of, const Find& find) {
  std::size_t lost = 0;
  for (std::size_t i = 0; i < of.rays.size(); ++i) lost += of.is_good(i, find(i)) ? 0 : 1;
  EXPECT_EQ(lost, 0u);
}

TEST(EnteredSpheres, are_left_by_rays_that_skip_them) {
  const RaysFromSpheres of;
  const std::size_t n = of.rays.size();
  const SphereTree tree(of.spheres);
  const auto none = [](const Hit&) { return false; };
  const HitFilter filter = [](auto, auto, auto) {};
  on_each_path([&](const Path* path, int threads) {
    const VisitOptions options{.path = path, .threads = threads, .skip = of.from};
    std::vector<Hit> hits(n), filtered(n), first(n, Hit{-infinity, 0, 0, 0});
    std::vector<std::uint8_t> occluded(n);
    tree.closest(of.rays, hits, options);
    expect_exits(of, [&](std::size_t i) { return hits[i]; });
    tree.closest(of.rays, filtered, filter, options);
    EXPECT_TRUE(same_bytes(filtered, hits));
    VisitOptions behind = options;
    behind.after = first;
    tree.closest(of.rays, filtered, behind);
    EXPECT_TRUE(same_bytes(filtered, hits));
    tree.occluded(of.rays, occluded, options);
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_EQ(occluded[i], hits[i] ? 1 : 0) << i;
      if (i % 5 != 0) continue;
      const VisitOptions one{.path = path, .skip = of.from[i]};
      ASSERT_TRUE(same_bytes(tree.closest(of.rays[i], one), hits[i])) << i;
      ASSERT_TRUE(same_bytes(tree.closest(of.rays[i], none, one), hits[i])) << i;
      ASSERT_EQ(tree.occluded(of.rays[i], one), occluded[i] != 0) << i;
    }
  });
}

TEST(EnteredSpheres, are_left_in_scenes) {
  const RaysFromSpheres of;
  const std::size_t n = of.rays.size();
  // Alone, and beside another instance; numbers of this transform are exact, as are the rays in its space.
  for (const std::uint32_t instances : {1u, 2u}) {
    Scene scene;
    const std::uint32_t spheres = scene.add(SphereTree(of.spheres));
    for (std::uint32_t i = 0; i < instances; ++i)
      scene.place(spheres, {{{0, 1, 0, 0}, {0, 0, 2, 0}, {1, 0, 0, 64.0f * static_cast<float>(i)}}});
    scene.update();
    std::vector<Ray> rays = of.rays;
    std::vector<SceneHit> skip(n), hits(n);
    for (std::size_t i = 0; i < n; ++i) {
      for (Float3* const v : {&rays[i].origin, &rays[i].direction}) *v = {(*v)[1], 2 * (*v)[2], (*v)[0]};
      skip[i].primitive = of.from[i], skip[i].instance = 0;
    }
    on_each_path([&](const Path* path, int threads) {
      scene.closest(rays, hits, {.path = path, .threads = threads, .skip = skip});
      expect_exits(of,
                   [&](std::size_t i) { return i % 2 != 0 && hits[i].instance != 0 ? SceneHit() : hits[i]; });
      for (std::size_t i = 0; i < n; i += 5)
        ASSERT_TRUE(same_bytes(scene.closest(rays[i], {.path = path, .skip = skip[i]}), hits[i])) << i;
    });
  }
}

// A ray that goes on, by its segment: in by one hit, out by the other, and away.
TEST(EnteredSpheres, are_passed_by_a_ray_that_goes_on) {
  const SphereTree tree(std::vector<Sphere>{{{5, 0, 0}, 1}, {{9, 0, 0}, 1}});
  Ray ray = make_ray({0, 0, 0}, {1, 0, 0}, 0);
  Hit last;
  for (const float t : {4.0f, 6.0f, 8.0f, 10.0f}) {
    last = last ? tree.closest(ray, {.skip = last}) : tree.closest(ray);
    EXPECT_EQ(last.t, t);
    ray.tmin = last.t;
  }
  EXPECT_FALSE(tree.closest(ray, {.skip = last}));
  // The first one is skipped if it is nearer to the begin, or as near.
  EXPECT_EQ(tree.closest(make_ray({5, 0, 0}, {1, 0, 0}, -2), {.skip = std::uint32_t{0}}).t, 1);
  EXPECT_EQ(tree.closest(make_ray({5, 0, 0}, {1, 0, 0}, 0), {.skip = std::uint32_t{0}}).t, 1);
}

}  // namespace
}  // namespace raylanes::testing
