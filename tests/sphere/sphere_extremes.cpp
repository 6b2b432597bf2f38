// Sphere tests at the extremes: named cases, bad numbers, scales.
#include "sphere_answers.hpp"

namespace raylanes::testing {
namespace {

struct NamedCase {
  const char* name;
  Ray ray;
  Sphere sphere;
  bool hit;
  float near, far;
};

const Sphere unit = ball({0, 0, 0}, 1);
const NamedCase named_cases[] = {
    {"through the centre", make_ray({0, 0, 5}, {0, 0, -1}), unit, true, 4, 6},
    {"a chord of a triangle 3-4-5", make_ray({3, 0, 10}, {0, 0, -1}), ball({0, 0, 0}, 5), true, 6, 14},
    {"a chord along y", make_ray({0, 10, 4}, {0, -1, 0}), ball({0, 0, 0}, 5), true, 7, 13},
    {"a chord along x", make_ray({-10, 4, 0}, {1, 0, 0}), ball({0, 0, 0}, 5), true, 7, 13},
    {"tangent", make_ray({5, 0, 10}, {0, 0, -1}), ball({0, 0, 0}, 5), true, 10, 10},
    {"tangent aslant in a plane", make_ray({3, 4, 7}, {0, 0, -2}), ball({0, 0, 0}, 5), true, 3.5f, 3.5f},
    {"tangent at the origin", make_ray({5, 0, 0}, {0, 0, -1}), ball({0, 0, 0}, 5), true, 0, 0},
    {"just outside", make_ray({0x1.400002p2f, 0, 10}, {0, 0, -1}), ball({0, 0, 0}, 5), false, 0, 0},
    {"just outside on y", make_ray({0, 0x1.400002p2f, 10}, {0, 0, -1}), ball({0, 0, 0}, 5), false, 0, 0},
    {"just outside on z", make_ray({10, 0, 0x1.400002p2f}, {-1, 0, 0}), ball({0, 0, 0}, 5), false, 0, 0},
    {"a long direction", make_ray({0, 0, 5}, {0, 0, -0x1p20f}), unit, true, 0x1p-18f, 0x1.8p-18f},
    {"a short direction", make_ray({0, 0, 5}, {0, 0, -0x1p-100f}), unit, true, 0x1p102f, 0x1.8p102f},
    {"from the centre", make_ray({0, 0, 0}, {0, 0, 2}), unit, true, -0.5f, 0.5f},
    {"from inside", make_ray({0, 0, 0.5f}, {0, 0, 1}), unit, true, -1.5f, 0.5f},
    {"from the surface, outwards", make_ray({0, 0, 1}, {0, 0, 1}), unit, true, -2, 0},
    {"from the surface, inwards", make_ray({0, 0, 1}, {0, 0, -1}), unit, true, 0, 2},
    {"behind", make_ray({0, 0, 5}, {0, 0, 1}), unit, false, 0, 0},
    {"behind, but within the segment", make_ray({0, 0, 5}, {0, 0, 1}, -5), unit, true, -6, -4},
    {"tmax before it", make_ray({0, 0, 5}, {0, 0, -1}, 0, 3.5f), unit, false, 0, 0},
    {"tmax at it", make_ray({0, 0, 5}, {0, 0, -1}, 0, 4), unit, true, 4, 6},
    {"tmin behind it", make_ray({0, 0, 5}, {0, 0, -1}, 6.5f), unit, false, 0, 0},
    {"tmin at its end", make_ray({0, 0, 5}, {0, 0, -1}, 6), unit, true, 4, 6},
    {"a segment inside", make_ray({0, 0, 0}, {0, 0, 1}, -0.25f, 0.25f), unit, true, -1, 1},
    {"a point hit exactly", make_ray({-1, -2, -3}, {1, 2, 3}), ball({0, 0, 0}, 0), true, 1, 1},
    {"a point passed", make_ray({-1, -2, -3}, {1, 2, 3}), ball({0, 0, 1}, 0), false, 0, 0},
    {"a negative radius", make_ray({0, 0, 5}, {0, 0, -1}), ball({0, 0, 0}, -1), false, 0, 0},
    {"a radius of FLT_MIN is a point", make_ray({1e-3f, 0, 5}, {0, 0, -1}), ball({0, 0, 0}, 0x1p-126f), false,
     0, 0},
    {"a radius of 1e18", make_ray({0, 0, 2e18f}, {0, 0, -1}), ball({0, 0, 0}, 0x1p59f), true, 2e18f - 0x1p59f,
     2e18f + 0x1p59f},
    {"all of space", make_ray({0, 0, 5}, {0, 0, -1}), ball({0, 0, 0}, 1e30f), true, -infinity, infinity},
    {"direction 0", make_ray({0, 0, 0}, {0, -0.0f, 0}), unit, false, 0, 0},
    {"tmin > tmax", make_ray({0, 0, 5}, {0, 0, -1}, 5.5f, 4.5f), unit, false, 0, 0},
    {"tmin NaN", make_ray({0, 0, 5}, {0, 0, -1}, nan), unit, false, 0, 0},
    {"tmax NaN", make_ray({0, 0, 5}, {0, 0, -1}, 0, nan), unit, false, 0, 0},
};

TEST(SphereExtremes, named_cases) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    for (const SphereVariant& variant : all_variants<SphereTest>()) {
      for (const NamedCase& c : named_cases) {
        const IntervalResult result = answers(variant, {&c.ray, 1}, {&c.sphere, 1})[0];
        SCOPED_TRACE(variant.name() + ' ' + name_of(mode) + ": " + c.name);
        EXPECT_EQ(result.hit, c.hit ? hit_flag : 0);
        if (!c.hit) {
          EXPECT_EQ(result, interval_missed);
          continue;
        }
        EXPECT_FLOAT_EQ(result.from, c.near);
        EXPECT_FLOAT_EQ(result.to, c.far);
      }
    }
  }
}

TEST(SphereExtremes, directions_scaled_by_powers_of_two_scale_the_distances_only) {
  Random random(305);
  const SphereScene scene = sphere_scene(10, random);
  for (const int exponent : {-60, -7, 60}) {
    SphereScene longer = scene;
    for (Ray& ray : longer.rays) {
      for (float& x : ray.direction) x = std::ldexp(x, exponent);
      ray.tmin = std::ldexp(ray.tmin, -exponent), ray.tmax = std::ldexp(ray.tmax, -exponent);
    }
    for (const FloatMode mode : float_modes)
      for (const SphereVariant& variant : all_variants<SphereTest>()) {
        auto results = answers(variant, scene.rays, scene.primitives, mode);
        for (IntervalResult& r : results)
          if (r.hit != 0) r.from = std::ldexp(r.from, -exponent), r.to = std::ldexp(r.to, -exponent);
        ASSERT_EQ(answers(variant, longer.rays, longer.primitives, mode), results)
            << variant.name() << ' ' << name_of(mode) << " 2^" << exponent;
      }
  }
}

// Scenes of any size: coordinates, radii and ends of segments alike.
TEST(SphereExtremes, scenes_scaled_by_powers_of_two_change_no_decision) {
  Random random(307);
  const SphereScene scene = sphere_scene(10, random);
  for (const int exponent : {-40, -20, 20, 40}) {
    SphereScene scaled = scene;
    for (Ray& ray : scaled.rays)
      for (int axis = 0; axis < 3; ++axis) {
        ray.origin[axis] = std::ldexp(ray.origin[axis], exponent);
        ray.direction[axis] = std::ldexp(ray.direction[axis], exponent);
      }
    for (Sphere& sphere : scaled.primitives)
      for (int k = 0; k < 4; ++k)
        sphere.value[k] = std::ldexp(sphere.value[k], k < 3 ? exponent : 2 * exponent);
    for (const FloatMode mode : float_modes)
      for (const SphereVariant& variant : all_variants<SphereTest>())
        ASSERT_EQ(answers(variant, scaled.rays, scaled.primitives, mode),
                  answers(variant, scene.rays, scene.primitives, mode))
            << variant.name() << ' ' << name_of(mode) << " 2^" << exponent;
  }
}

TEST(SphereExtremes, a_nan_anywhere_is_a_miss_and_disturbs_no_other_lane) {
  for (const FloatMode mode : float_modes)
    for (const SphereVariant& variant : all_variants<SphereTest>())
      for (std::size_t k = 0; k < 12; ++k)
        for (const float bad : {nan, -nan, infinity, -infinity}) {
          std::vector<Ray> rays(3, make_ray({0.1f, 0.2f, 5}, {0, 0.01f, -1}));
          std::vector<Sphere> spheres(3, unit);
          if (k >= 9 && std::isinf(bad)) continue;  // radius and ends of the segment may be infinite
          if (k < 6)
            (k < 3 ? rays[1].origin : rays[1].direction)[k % 3] = bad;
          else if (k < 10)
            spheres[1].value[k - 6] = bad;
          else
            (k == 10 ? rays[1].tmin : rays[1].tmax) = bad;
          const std::vector<IntervalResult> results = answers(variant, rays, spheres, mode);
          for (std::size_t i = 0; i < 9; ++i) {
            const bool spoiled = k >= 6 && k < 10 ? i / 3 == 1 : i % 3 == 1;
            ASSERT_EQ(results[i].hit, spoiled ? 0 : hit_flag)
                << variant.name() << " input " << k << " " << bad;
          }
        }
}

}  // namespace
}  // namespace raylanes::testing
