// Sphere tests on every path: decisions against rational arithmetic, distances in 256 bits, near and far.
#include "sphere_answers.hpp"

namespace raylanes::testing {
namespace {

using oracle::exact_sphere;
using oracle::ExactSphere;

struct Counts {
  std::size_t pairs = 0, hits = 0, wrong = 0, open = 0;
  double share_open() const { return static_cast<double>(open) / static_cast<double>(pairs); }
};

double ulp(float x) {
  return std::nextafter(std::abs(x), infinity) - std::abs(x);
}

// The perpendicular test leaves a decision open within 64u·r·D, its contract, or 64u·l·D outside of the ball.
// Distances are within 16 ULP of (D + r)/|d| where r² − l² > r²/100.
//
// The textbook test computes (b² − 4ac)/4a = r² − l² in units of |d|² = 1, with D the way to the centre:
//   f rounds once, b = 2f·d four times with it: b² is off by 9u·4D²; a, c = f·f − r² and their product by 10u
//   of 4(D² + r²); the difference rounds once more: 22u·(D² + r²) together. Half the chord is √(r² − l²), off
//   by that over the root itself; the middle by 8u·D.
double open_range(SphereTest test, const ExactSphere& exact) {
  const double u = 0x1p-24, d = exact.distance, r = exact.radius;
  if (test == SphereTest::textbook) return 22 * u * (d * d + r * r);
  return 64 * u * d * std::max(r, std::sqrt(std::max(0.0, r * r - exact.free)));
}

double distance_bound(SphereTest test, const ExactSphere& exact) {
  if (test == SphereTest::perpendicular)
    return 16 * ulp(static_cast<float>((exact.distance + exact.radius) / exact.speed));
  return (open_range(test, exact) / std::sqrt(exact.line_free) +
          8 * 0x1p-24 * (exact.distance + exact.radius)) /
         exact.speed;
}

// Whether rounding may decide about the ray. The textbook test compares distances with the ends of the
// segment.
bool is_open(SphereTest test, const Ray& ray, const ExactSphere& exact) {
  const double range = open_range(test, exact);
  if (test == SphereTest::perpendicular) return std::abs(exact.free) <= range;
  if (exact.line_free < -range) return false;
  if (exact.line_free <= 2 * range) return true;
  const double bound = distance_bound(test, exact);
  return std::abs(exact.near - double(ray.tmax)) <= bound || std::abs(exact.far - double(ray.tmin)) <= bound;
}

bool has_exact_distances(SphereTest test, const ExactSphere& exact) {
  if (test == SphereTest::perpendicular) return exact.line_free >= 0.01 * exact.radius * exact.radius;
  return exact.line_free > 2 * open_range(test, exact);
}

// Why the result is wrong, or "".
std::string fault(SphereTest test, const IntervalResult& result, const Ray& ray, const ExactSphere& exact) {
  const bool hit = result.hit != 0;
  if (hit && result.hit != hit_flag) return "a hit flag that is neither 0 nor all ones";
  if (hit != exact.hit && !is_open(test, ray, exact)) return hit ? "hit" : "missed";
  if (!hit) return result == interval_missed ? "" : "a miss with other values than those of a miss";
  if (!(result.from <= result.to)) return "near behind far";
  if (!exact.hit || !has_exact_distances(test, exact)) return "";
  const double bound = distance_bound(test, exact);
  if (!(std::abs(result.from - exact.near) <= bound)) return "near beyond its bound";
  return std::abs(result.to - exact.far) <= bound ? "" : "far beyond its bound";
}

void check(SphereTest test, const SphereScene& scene, Counts& counts) {
  std::vector<ExactSphere> exact;
  for (std::size_t i = 0; i < scene.size(); ++i)
    exact.push_back(exact_sphere(scene.ray(i), scene.primitive(i)));
  counts.pairs += exact.size();
  for (std::size_t i = 0; i < exact.size(); ++i) {
    counts.hits += exact[i].hit;
    counts.open += is_open(test, scene.ray(i), exact[i]);
  }
  for (const SphereVariant& variant : all_variants<SphereTest>())
    for (const FloatMode mode : float_modes) {
      if (variant.test != test) continue;
      const auto results = answers(variant, scene.rays, scene.primitives, mode);
      for (std::size_t i = 0; i < results.size(); ++i) {
        ASSERT_EQ(fault(test, results[i], scene.ray(i), exact[i]), "")
            << variant.name() << ' ' << name_of(mode) << " pair " << i << " D/r "
            << exact[i].distance / exact[i].radius;
        counts.wrong += variant.path == &paths().front() && (results[i].hit != 0) != exact[i].hit;
      }
    }
}

// The ladder of distances in radii, and the share of pairs that are decided by rounding: outside, the
// generator has lost its point.
struct DistanceCase {
  SphereTest test;
  double distance, min_open, max_open;
};

class SpheresAtDistance : public ::testing::TestWithParam<DistanceCase> {};

TEST_P(SpheresAtDistance, are_decided_right_outside_the_bound) {
  const DistanceCase& c = GetParam();
  Random random(301);
  Counts counts;
  for (int round = 0; round < by_level(1, 5, 15); ++round) {
    check(c.test, sphere_scene(c.distance, random), counts);
    if (HasFailure()) return;
  }
  if (quick()) return;
  EXPECT_GT(counts.hits, counts.pairs / 30);
  EXPECT_GE(counts.share_open(), c.min_open);
  EXPECT_LE(counts.share_open(), c.max_open);
  // The textbook test is there to be seen failing.
  if (c.test == SphereTest::textbook && c.distance >= 1e4) {
    EXPECT_GT(counts.wrong, counts.pairs / 50);
  }
}

constexpr SphereTest perpendicular = SphereTest::perpendicular, textbook = SphereTest::textbook;
INSTANTIATE_TEST_SUITE_P(Perpendicular, SpheresAtDistance,
                         ::testing::Values(DistanceCase{perpendicular, 1e0, 0, 0.002},
                                           DistanceCase{perpendicular, 1e1, 0, 0.002},
                                           DistanceCase{perpendicular, 1e2, 0, 0.002},
                                           DistanceCase{perpendicular, 1e3, 0, 0.004},
                                           DistanceCase{perpendicular, 1e4, 0.002, 0.02},
                                           DistanceCase{perpendicular, 1e5, 0.04, 0.15}));
INSTANTIATE_TEST_SUITE_P(
    Textbook, SpheresAtDistance,
    ::testing::Values(DistanceCase{textbook, 1e0, 0, 0.002}, DistanceCase{textbook, 1e1, 0, 0.002},
                      DistanceCase{textbook, 1e2, 0.001, 0.02}, DistanceCase{textbook, 1e3, 0.15, 0.5},
                      DistanceCase{textbook, 1e4, 0.9, 1}, DistanceCase{textbook, 1e5, 0.9, 1}));

// Huge balls close by: the ground of a planet.
TEST(Spheres, huge_ones_keep_their_distances) {
  Random random(304);
  for (const float radius : {1e3f, 1e5f, 1e6f})
    for (int i = 0; i < 50; ++i) {
      const Sphere sphere = ball({0, 0, -radius}, radius);
      const Ray ray = make_ray({random.number(-1, 1), random.number(-1, 1), random.number(0.5f, 2)},
                               {random.number(-1, 1), random.number(-1, 1), -1});
      const ExactSphere exact = exact_sphere(ray, sphere);
      for (const SphereVariant& variant : all_variants<SphereTest>()) {
        if (variant.test != SphereTest::perpendicular) continue;
        const IntervalResult result = answers(variant, {&ray, 1}, {&sphere, 1})[0];
        ASSERT_EQ(result.hit, hit_flag) << variant.name();
        // centre − origin is rounded once in float for the middle of the chord, a relative error of t.
        ASSERT_NEAR(result.from, exact.near, 1e-5 * exact.near) << variant.name() << " radius " << radius;
        ASSERT_NEAR(result.to, exact.far, 1e-6 * exact.far) << variant.name() << " radius " << radius;
      }
    }
}

}  // namespace
}  // namespace raylanes::testing
