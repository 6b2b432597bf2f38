// The nearest hit among spheres: the least distance at which the segment meets a surface.
#include "../support/same_bytes.hpp"
#include "sphere_answers.hpp"

namespace raylanes::testing {
namespace {

using oracle::exact_sphere;
using oracle::ExactSphere;

const Sphere unit = ball({0, 0, 0}, 1);

struct NamedCase {
  const char* name;
  Ray ray;
  Sphere sphere;
  float t;  // infinite: a miss
};
const NamedCase named_cases[] = {
    {"from outside, where it enters", make_ray({0, 0, 5}, {0, 0, -1}), unit, 4},
    {"from inside, where it leaves", make_ray({0, 0, 0.5f}, {0, 0, 1}), unit, 0.5f},
    {"from the surface outwards", make_ray({0, 0, 1}, {0, 0, 1}), unit, 0},
    {"from the surface inwards", make_ray({0, 0, 1}, {0, 0, -1}), unit, 0},
    {"tmin behind the entry", make_ray({0, 0, 5}, {0, 0, -1}, 4.5f), unit, 6},
    {"tmin at the exit", make_ray({0, 0, 5}, {0, 0, -1}, 6), unit, 6},
    {"tmax at the entry", make_ray({0, 0, 5}, {0, 0, -1}, 0, 4), unit, 4},
    {"tmax before the entry", make_ray({0, 0, 5}, {0, 0, -1}, 0, 3.5f), unit, infinity},
    {"tmin behind the exit", make_ray({0, 0, 5}, {0, 0, -1}, 6.5f), unit, infinity},
    {"a segment inside meets no surface", make_ray({0, 0, 0}, {0, 0, 1}, -0.25f, 0.25f), unit, infinity},
    {"behind", make_ray({0, 0, 5}, {0, 0, 1}), unit, infinity},
    {"behind, with a negative tmin", make_ray({0, 0, 5}, {0, 0, 1}, -5), unit, -4},
    {"behind, with all of the line", make_ray({0, 0, 5}, {0, 0, 1}, -infinity), unit, -6},
    {"a point", make_ray({-1, -2, -3}, {1, 2, 3}), ball({0, 0, 0}, 0), 1},
    {"a negative radius", make_ray({0, 0, 5}, {0, 0, -1}), ball({0, 0, 0}, -1), infinity},
    {"all of space has no surface", make_ray({0, 0, 5}, {0, 0, -1}), ball({0, 0, 0}, 1e30f), infinity},
    {"all of space, all of the line", make_ray({0, 0, 5}, {0, 0, -1}, -infinity), ball({0, 0, 0}, 1e30f),
     infinity},
    {"all of space, from infinity on", make_ray({0, 0, 5}, {0, 0, -1}, infinity), ball({0, 0, 0}, 1e30f),
     infinity},
    {"direction 0", make_ray({0, 0, 0}, {0, -0.0f, 0}), unit, infinity},
    {"tmin > tmax", make_ray({0, 0, 5}, {0, 0, -1}, 4.5f, 3.5f), unit, infinity},
    {"tmin NaN", make_ray({0, 0, 5}, {0, 0, -1}, nan), unit, infinity},
    {"tmax NaN", make_ray({0, 0, 5}, {0, 0, -1}, 0, nan), unit, infinity},
};

TEST(ClosestSphere, named_cases) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    for (const SphereVariant& variant : all_variants<SphereTest>())
      for (const NamedCase& c : named_cases) {
        SCOPED_TRACE(variant.name() + ' ' + name_of(mode) + ": " + c.name);
        const Hit hit = closest_answer(variant, c.ray, {&c.sphere, 1});
        EXPECT_EQ(hit.primitive, std::isinf(c.t) ? no_primitive : 0u);
        EXPECT_FLOAT_EQ(hit.t, c.t);
        EXPECT_EQ(std::bit_cast<std::uint32_t>(hit.u) | std::bit_cast<std::uint32_t>(hit.v), 0u);
      }
  }
}

// The promised result of closest_hit, from the result of `distances`.
Hit expected_of(const SphereVariant& variant, const Ray& ray, const std::vector<Sphere>& spheres) {
  const std::vector<IntervalResult> all = answers(variant, {&ray, 1}, spheres);
  Hit nearest;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto is_met = [&](float t) { return std::isfinite(t) && t >= ray.tmin && t <= ray.tmax; };
    if (all[i].hit == 0) continue;
    const float t = is_met(all[i].from) ? all[i].from : all[i].to;
    if (is_met(t) && t < nearest.t) nearest = {t, 0, 0, static_cast<std::uint32_t>(i)};
  }
  return nearest;
}

TEST(ClosestSphere, is_the_least_of_the_distances_in_the_segment) {
  Random random(314);
  std::size_t hits = 0, leaving = 0;
  for (int round = 0; round < (quick() ? 2 : 40); ++round) {
    SphereScene scene = sphere_scene(round % 2 == 0 ? 1 : 10, random);
    for (int copies = 0; copies < 3; ++copies)  // equal ones: the first wins
      scene.primitives.insert(scene.primitives.end(), scene.primitives.begin(), scene.primitives.begin() + 9);
    for (Ray& ray : scene.rays) {
      if (random.chance(0.2)) ray.tmin = -infinity;
      if (random.chance(0.3)) ray.origin = {scene.primitives[0].value[0], scene.primitives[0].value[1], 0};
    }
    for (const SphereVariant& variant : all_variants<SphereTest>())
      for (const Ray& ray : scene.rays) {
        const Hit hit = closest_answer(variant, ray, scene.primitives),
                  expected = expected_of(variant, ray, scene.primitives);
        ASSERT_TRUE(same_bytes(hit, expected)) << variant.name() << ' ' << hit.t << ' ' << expected.t;
        hits += static_cast<bool>(hit);
        ASSERT_TRUE(!hit || hit.primitive < 9) << "an equal one that comes later";
        if (!hit || variant.test != SphereTest::perpendicular) continue;
        const ExactSphere exact = exact_sphere(ray, scene.primitives[hit.primitive]);
        leaving += exact.near < double(ray.tmin);
      }
  }
  EXPECT_GT(hits, quick() ? 100u : 1000u);
  EXPECT_GT(leaving, quick() ? 10u : 100u) << "rays from inside are tested too";
}

// The decision is rounded to a hit of a segment that begins just behind the surface.
TEST(ClosestSphere, is_never_before_the_segment) {
  Random random(316);
  std::size_t rounded = 0;
  for (int round = 0; round < (quick() ? 4 : 30); ++round) {
    const SphereScene scene = sphere_scene(1e4, random);
    for (const SphereVariant& variant : all_variants<SphereTest>())
      for (std::size_t i = 0; i < scene.rays.size(); ++i) {
        Ray ray = scene.rays[i];
        ray.tmin = -infinity, ray.tmax = infinity;
        const std::vector<Sphere> sphere{scene.primitives[i / 3]};
        const IntervalResult whole = answers(variant, {&ray, 1}, sphere)[0];
        if (whole.hit == 0) continue;
        ray.tmin = std::nextafter(whole.to, infinity);
        const Hit hit = closest_answer(variant, ray, sphere), expected = expected_of(variant, ray, sphere);
        ASSERT_TRUE(same_bytes(hit, expected)) << variant.name() << ' ' << hit.t;
        rounded += answers(variant, {&ray, 1}, sphere)[0].hit != 0;
      }
  }
  EXPECT_GT(rounded, 0u);
}

TEST(ClosestSphere, among_far_and_near_ones_in_any_order) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < 37; ++i)
    spheres.push_back(ball({0, 0, static_cast<float>(-3 * ((i * 11 + 5) % 37))}, 1));
  const Ray ray = make_ray({0, 0, 10}, {0, 0, -1});
  for (const SphereVariant& variant : all_variants<SphereTest>()) {
    const Hit hit = closest_answer(variant, ray, spheres);
    EXPECT_EQ(hit.primitive, 13u) << variant.name();
    EXPECT_EQ(hit.t, 9) << variant.name();
    Ray later = ray;
    later.tmin = 11.5f;  // behind the first, before the second
    EXPECT_EQ(closest_answer(variant, later, spheres).t, 12) << variant.name();
  }
}

TEST(ClosestSphere, nowhere_among_none) {
  for (const SphereVariant& variant : all_variants<SphereTest>())
    EXPECT_FALSE(closest_answer(variant, make_ray({0, 0, 5}, {0, 0, -1}), {})) << variant.name();
}

}  // namespace
}  // namespace raylanes::testing
