// The line test for spheres: decisions against rational arithmetic, outside its own bound.
#include "sphere_answers.hpp"

namespace raylanes::testing {
namespace {

using oracle::exact_sphere;
using oracle::ExactSphere;

bool line_hits(const Path& path, Grade grade, const Ray& ray, const Sphere& sphere) {
  return line_answers(path, grade, {&ray, 1}, {&sphere, 1})[0];
}

// The bound of the decision. With f the way to the centre, D = |f| and l the line's distance:
//   the two unit vectors round once each from double, f once; x = first·f is a sum of three products (3u), y
//   = second·f of two (2u): by Cauchy |Δx| <= 5u·D, |Δy| <= 4u·D; l² = x² + y² then is off by 2·√(25 +
//   16)u·l·D, by 41u²·D², and by 2u·l² for its own roundings, l <= D: 15u·l·D + 42u²·D² together.
double open_range(const ExactSphere& exact) {
  const double u = 0x1p-24, away = std::sqrt(std::max(0.0, exact.radius * exact.radius - exact.line_free));
  return 15 * u * away * exact.distance + 42 * u * u * exact.distance * exact.distance;
}

// Distance in radii, and the share of pairs that are decided by rounding.
struct LineCase {
  double distance, max_open;
};

class LinesAtDistance : public ::testing::TestWithParam<LineCase> {};

TEST_P(LinesAtDistance, are_decided_right_outside_the_bound) {
  const auto [distance, max_open] = GetParam();
  Random random(303);
  std::size_t pairs = 0, hits = 0, open = 0;
  for (int round = 0; round < by_level(1, 5, 15); ++round) {
    SphereScene scene = sphere_scene(distance, random);
    for (Ray& ray : scene.rays) ray.tmin = -infinity, ray.tmax = infinity;
    std::vector<ExactSphere> exact;
    for (std::size_t i = 0; i < scene.size(); ++i) {
      exact.push_back(exact_sphere(scene.ray(i), scene.primitive(i)));
      ++pairs, hits += exact.back().hit, open += std::abs(exact.back().line_free) <= open_range(exact.back());
    }
    for (const Path* path : supported_paths())
      for (const Grade grade : grades)
        for (const FloatMode mode : float_modes) {
          const auto results = line_answers(*path, grade, scene.rays, scene.primitives, mode);
          for (std::size_t i = 0; i < results.size(); ++i)
            if (std::abs(exact[i].line_free) > open_range(exact[i])) {
              ASSERT_EQ(results[i], exact[i].hit) << path->name << ' ' << name_of(mode) << " pair " << i;
            }
        }
  }
  if (quick()) return;
  EXPECT_GT(hits, pairs / 30);
  EXPECT_LE(static_cast<double>(open), max_open * static_cast<double>(pairs));
}

INSTANTIATE_TEST_SUITE_P(Ladder, LinesAtDistance,
                         ::testing::Values(LineCase{1e0, 0.001}, LineCase{1e1, 0.001}, LineCase{1e2, 0.001},
                                           LineCase{1e3, 0.002}, LineCase{1e4, 0.01}, LineCase{1e5, 0.05}));

// Past the ball at k times the bound, to either side: a step sideways in the plane of the line and the
// centre.
TEST(Lines, climb_the_ladder_beside_the_tangent) {
  Random random(309);
  std::size_t decided = 0, lines = 0;
  for (const double rung : {2.0, 4.0, 16.0, 100.0})
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i < (quick() ? 5 : 60); ++i) {
        const Float3 away = random.point(4);
        const float radius = random.number(0.5f, 2);
        const Sphere sphere = ball({0, 0, 0}, radius);
        // Unit vectors from the origin of the ray to the centre and across, in double.
        const double d = std::hypot(away[0], away[1], away[2]);
        if (d < 1.1 * double(radius)) continue;
        const double to[3] = {-away[0] / d, -away[1] / d, -away[2] / d}, flat = std::hypot(to[0], to[1]);
        const double across[3] = {to[1] / flat, -to[0] / flat, 0};
        // l·D at the tangent is r·D: the step in l that moves l² by the bound.
        const double step = rung * (15 * 0x1p-24 * d + 42 * 0x1p-48 * d * d / radius) / 2;
        const double sine = (radius + side * step) / d, cosine = std::sqrt(1 - sine * sine);
        Float3 direction;
        for (std::size_t k = 0; k < 3; ++k)
          direction[k] = static_cast<float>(cosine * to[k] + sine * across[k]);
        const Ray ray = make_ray(away, direction, -infinity);
        const ExactSphere exact = exact_sphere(ray, sphere);
        ++lines;
        if (std::abs(exact.line_free) <= open_range(exact)) continue;
        ++decided;
        EXPECT_EQ(exact.hit, side < 0) << "the direction was rounded across the tangent";
        for (const Path* path : supported_paths())
          for (const Grade grade : grades)
            EXPECT_EQ(line_hits(*path, grade, ray, sphere), exact.hit) << path->name << " rung " << rung;
      }
  EXPECT_GE(decided * 10, lines * 9);
}

// A tangent on integers along an axis is a hit, exactly.
TEST(Lines, meet_balls_behind_and_ahead) {
  for (const Path* path : supported_paths())
    for (const Grade grade : {Grade::reproducible, Grade::fast}) {
      EXPECT_TRUE(line_hits(*path, grade, make_ray({0, 0, 5}, {0, 0, 1}), ball({0, 0, 0}, 1))) << path->name;
      EXPECT_TRUE(line_hits(*path, grade, make_ray({5, 0, 10}, {0, 0, 1}), ball({0, 0, 0}, 5))) << path->name;
      EXPECT_TRUE(line_hits(*path, grade, make_ray({0, 5, 10}, {0, 0, 1}), ball({0, 0, 0}, 5))) << path->name;
      EXPECT_FALSE(line_hits(*path, grade, make_ray({0, 5.01f, 10}, {0, 0, 1}), ball({0, 0, 0}, 5)));
      EXPECT_FALSE(line_hits(*path, grade, make_ray({5.01f, 0, 10}, {0, 0, 1}), ball({0, 0, 0}, 5)));
      EXPECT_FALSE(line_hits(*path, grade, make_ray({0, 0, 5}, {0, 0, 0}), ball({0, 0, 0}, 1))) << path->name;
      EXPECT_FALSE(line_hits(*path, grade, make_ray({0, 0, 5}, {0, 0, 1}), ball({nan, 0, 0}, 1)))
          << path->name;
      EXPECT_FALSE(line_hits(*path, grade, make_ray({0, 0, 5}, {0, 0, 1}), {{0, 0, 0, nan}})) << path->name;
      EXPECT_FALSE(line_hits(*path, grade, make_ray({0, 0, 5}, {0, 0, 1}), {{0, 0, 0, -nan}})) << path->name;
      EXPECT_FALSE(line_hits(*path, grade, make_ray({0, 0, 5}, {0, 0, 1}), {{infinity, 0, 0, 1}}))
          << path->name;
    }
}

TEST(Lines, with_a_bad_number_anywhere_are_a_miss) {
  const Ray good = make_ray({0.1f, 0.2f, 5}, {0, 0.01f, -1});
  for (const Path* path : supported_paths())
    for (const Grade grade : grades)
      for (const FloatMode mode : float_modes)
        for (std::size_t k = 0; k < 10; ++k)
          for (const float bad : {nan, -nan, infinity, -infinity}) {
            if (k == 9 && bad == infinity) continue;  // all of space
            std::vector<Ray> rays(3, good);
            std::vector<Sphere> spheres(3, ball({0, 0, 0}, 1));
            float* const inputs[] = {rays[1].origin.data(), rays[1].direction.data(), spheres[1].value};
            inputs[std::min<std::size_t>(k / 3, 2)][k < 6 ? k % 3 : k - 6] = bad;
            const auto results = line_answers(*path, grade, rays, spheres, mode);
            for (std::size_t i = 0; i < 9; ++i) {
              const bool spoiled = k < 6 ? i % 3 == 1 : i / 3 == 1;
              ASSERT_EQ(results[i], !spoiled) << path->name << " input " << k << " = " << bad;
            }
          }
}

TEST(Lines, change_no_decision_with_the_length_or_sense_of_the_direction) {
  Random random(310);
  const SphereScene scene = sphere_scene(10, random);
  for (const Path* path : supported_paths())
    for (const Grade grade : grades)
      for (const float factor : {0x1p-60f, 0x1p60f, -1.0f}) {
        SphereScene longer = scene;
        for (Ray& ray : longer.rays)
          for (float& x : ray.direction) x *= factor;
        ASSERT_EQ(line_answers(*path, grade, longer.rays, longer.primitives),
                  line_answers(*path, grade, scene.rays, scene.primitives))
            << path->name << " times " << factor;
      }
}

}  // namespace
}  // namespace raylanes::testing
