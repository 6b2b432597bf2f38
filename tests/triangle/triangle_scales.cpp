// All triangle tests in scenes of any size and place, with directions of any length, and on triangles of aspect 1e-4 …
// 1e-7, aimed inside, straight and at grazing angles.
#include "../../bench/support/scenes/vector3.hpp"
#include "../support/random_input.hpp"
#include "judge/triangle_answers.hpp"
#include "judge/triangle_judge.hpp"

namespace raylanes::testing {
namespace {

// A triangle of about `scale` and unit directions that pass it well inside or well outside.
TriangleScene scene_of_size(double scale, bool inside, Random& random) {
  const auto size = static_cast<float>(scale);
  TriangleScene scene{{},
                      {make_triangle({-size, -size, size / 8}, {size, -size / 2, 0}, {0, size, -size / 4})}};
  for (int i = 0; i < 8; ++i) {
    const Float3 origin{random.number(-size / 2, size / 2), random.number(-size / 2, size / 2), size};
    const double u = inside ? random.real(0.2, 0.4) : random.real(1.2, 1.5);
    const Ray ray = ray_to(origin, scene.triangles[0], u, inside ? 0.3 : -0.3, 1 / scale);
    const double length = std::hypot(ray.direction[0], ray.direction[1], ray.direction[2]);
    Float3 direction;
    for (std::size_t k = 0; k < 3; ++k) direction[k] = static_cast<float>(ray.direction[k] / length);
    scene.rays.push_back(make_ray(origin, direction));
  }
  return scene;
}

// Decides on products of four lengths where the others have three.
bool is_plane_edges(TriangleTest test) {
  return test == TriangleTest::plane_edges_plain || test == TriangleTest::plane_edges;
}

// The share of flushing in the error of t: six products in its numerator, each less than 2^-126, over det.
void allow_flushing(TriangleJudgement& judgement) {
  if (judgement.t) *judgement.t += 6 * 0x1p-126 / std::fabs(judgement.exact.det.get_d());
}

void expect_right(TriangleTest test, const TriangleScene& scene, FloatMode mode,
                  const std::vector<TriangleJudgement>& judgements) {
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    if (variant.test != test) continue;
    const Results results = answers(variant, scene.rays, scene.triangles, mode);
    for (std::size_t i = 0; i < results.size(); ++i)
      EXPECT_EQ(fault(results[i], scene.ray(i), judgements[i]), "")
          << variant.name() << ' ' << name_of(mode) << " pair " << i << " t " << results[i].t;
  }
}

class TriangleScales : public ::testing::TestWithParam<TriangleTest> {};

TEST_P(TriangleScales, all_usable_ones_are_decided_right) {
  const TriangleTest test = GetParam();
  for (int exponent = -12; exponent <= 12; ++exponent) {
    SCOPED_TRACE("10^" + std::to_string(exponent));
    if (is_plane_edges(test) && std::abs(exponent) > 8) continue;
    Random random(113);
    for (const bool inside : {true, false}) {
      const TriangleScene scene = scene_of_size(std::pow(10.0, exponent), inside, random);
      std::vector<TriangleJudgement> judgements;
      for (std::size_t i = 0; i < scene.size(); ++i) {
        judgements.push_back(judge(test, scene.ray(i), scene.triangle(i)));
        EXPECT_EQ(judgements.back().decision, inside ? oracle::Class::must_hit : oracle::Class::must_miss);
      }
      expect_right(test, scene, FloatMode::ieee, judgements);
      for (TriangleJudgement& judgement : judgements) allow_flushing(judgement);
      expect_right(test, scene, FloatMode::flush, judgements);
    }
  }
}

// Not plane_edges, whose products of four lengths mean nothing there.
class BeyondTriangleScales : public ::testing::TestWithParam<TriangleTest> {};

TEST_P(BeyondTriangleScales, nothing_is_hit_that_is_passed) {
  for (const double scale : {1e-14, 1e14})
    for (const FloatMode mode : float_modes) {
      Random random(114);
      const TriangleScene scene = scene_of_size(scale, false, random);
      // Flushed to 0, its n·s puts the plane at the ray's origin: a hit at t = 0.
      if (GetParam() == TriangleTest::precomputed && scale < 1 && mode == FloatMode::flush) continue;
      for (const TriangleVariant& variant : all_variants<TriangleTest>())
        if (variant.test == GetParam()) {
          EXPECT_EQ(answers(variant, scene.rays, scene.triangles, mode),
                    Results(scene.size(), triangle_missed))
              << variant.name() << ' ' << name_of(mode) << ' ' << scale;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Forms, BeyondTriangleScales,
                         ::testing::Values(TriangleTest::moller_trumbore, TriangleTest::moller_trumbore_edges,
                                           TriangleTest::watertight, TriangleTest::precomputed,
                                           TriangleTest::directional),
                         [](const auto& each) { return name_of(each.param); });

TEST_P(TriangleScales, directions_of_any_usable_length_are_decided_right) {
  Random random(115);
  for (const double length : {1e-30, 1e-18, 1e18, 1e30}) {
    SCOPED_TRACE(length);
    TriangleScene scene = scene_of_size(1, true, random);
    for (Ray& ray : scene.rays)
      for (float& d : ray.direction) d *= static_cast<float>(length);
    std::vector<TriangleJudgement> judgements;
    for (std::size_t i = 0; i < scene.size(); ++i) {
      judgements.push_back(judge(GetParam(), scene.ray(i), scene.triangle(i)));
      EXPECT_EQ(judgements.back().decision, oracle::Class::must_hit);
    }
    for (const FloatMode mode : float_modes) expect_right(GetParam(), scene, mode, judgements);
  }
}

struct Offset {
  const char* name;
  Float3 centre;
  double min_on_planes;  // the least share that plane_edges decides
};
constexpr Offset offsets[] = {{"1e2", {100, -100, 50}, 0.98},
                              {"1e4", {1e4f, -1e4f, 5e3f}, 0.85},
                              {"1e6", {1e6f, -1e6f, 5e5f}, 0},
                              {"Embree's", {148376, 1234, -223423}, 0.3}};

TEST_P(TriangleScales, far_from_the_origin_what_is_decided_is_right) {
  for (const Offset& offset : offsets) {
    SCOPED_TRACE(offset.name);
    Random random(116);
    std::size_t decided = 0, pairs = 0;
    for (int round = 0; round < by_level(1, 2, 6); ++round) {
      TriangleScene scene;
      for (int i = 0; i < 3; ++i) scene.triangles.push_back(random.triangle(1, offset.centre));
      for (std::size_t i = 0; i < 9; ++i)
        scene.rays.push_back(ray_to(random.point(2, offset.centre), scene.triangles[i % 3],
                                    random.real(-0.2, 0.8), random.real(-0.2, 0.8)));
      std::vector<TriangleJudgement> judgements;
      for (std::size_t i = 0; i < scene.size(); ++i) {
        judgements.push_back(judge(GetParam(), scene.ray(i), scene.triangle(i)));
        decided += judgements.back().decision != oracle::Class::either;
        ++pairs;
      }
      for (const FloatMode mode : float_modes) expect_right(GetParam(), scene, mode, judgements);
    }
    // The plane's n·p − n·o cancels what the distance put in; all other forms subtract first.
    const double least = is_plane_edges(GetParam()) ? offset.min_on_planes : 0.98;
    if (!quick()) {
      EXPECT_GE(static_cast<double>(decided), least * static_cast<double>(pairs));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Forms, TriangleScales, ::testing::ValuesIn(all_triangle_tests),
                         [](const auto& each) { return name_of(each.param); });

// --- Slivers

using bench::Double3, bench::cross, bench::length, bench::normalized;

struct Sliver {
  Triangle triangle;
  Double3 normal, across;  // unit vectors: of its plane, and in it across the long edge
};

// The long edge from 0 to a corner about 1 away. A needle has its third corner near 0, a cap near the middle.
Sliver sliver(double aspect, bool needle, Random& random) {
  const Float3 b = random.point(1);
  const Double3 along = bench::to_double(b);
  Sliver s;
  s.normal = normalized(cross(along, {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}));
  s.across = cross(s.normal, normalized(along));
  const double foot = needle ? 0 : 0.5, height = aspect * length(along);
  Float3 c;
  for (std::size_t k = 0; k < 3; ++k) c[k] = static_cast<float>(foot * along[k] + height * s.across[k]);
  s.triangle = make_triangle({0, 0, 0}, b, c);
  return s;
}

// Height over length, of the triangle that the floats make.
double aspect_of(const Triangle& t) {
  const Double3 b = bench::to_double(t.corner[1]), c = bench::to_double(t.corner[2]);
  return length(cross(b, c)) / (length(b) * length(b));
}

// To a point well inside, from so close by that the rounding of the direction, 2^-24 of 2^-10, leaves it
// there: `slope` is the sine of the angle with the plane.
Ray ray_inside(const Sliver& s, double slope, Random& random) {
  const double u = random.real(0.2, 0.4), v = random.real(0.2, 0.4), flat = std::sqrt(1 - slope * slope);
  const auto& vertex = s.triangle.corner;
  Float3 origin;
  for (std::size_t k = 0; k < 3; ++k) {
    const double target = vertex[1][k] * u + vertex[2][k] * v;
    origin[k] = static_cast<float>(target + 0x1p-10 * (slope * s.normal[k] + flat * s.across[k]));
  }
  return ray_to(origin, s.triangle, u, v, random.magnitude(0.1, 10));
}

// min_decided: of the rays, for each test; the others are within rounding of the edges.
struct SliverCase {
  double aspect, slope, min_decided;
};

class Slivers : public ::testing::TestWithParam<SliverCase> {};

TEST_P(Slivers, are_right_outside_their_bound_when_aimed_inside) {
  const auto [aspect, slope, min_decided] = GetParam();
  for (const TriangleTest test : all_triangle_tests) {
    Random random(112);
    std::size_t rays_aimed = 0, inside = 0, decided = 0;
    for (int round = 0; round < by_level(1, 4, 12); ++round) {
      const Sliver s = sliver(aspect, round % 2 == 0, random);
      ASSERT_NEAR(std::log10(aspect_of(s.triangle)), std::log10(aspect), 0.35);
      std::vector<Ray> rays;
      for (int i = 0; i < 5; ++i) rays.push_back(ray_inside(s, slope, random));
      const std::vector<Triangle> orders = corner_orders(s.triangle);
      std::vector<TriangleJudgement> judgements;
      for (const Triangle& order : orders)
        for (const Ray& ray : rays) judgements.push_back(judge(test, ray, order));
      for (const TriangleJudgement& j : judgements) {
        ++rays_aimed;
        inside += j.exact.hit;
        decided += j.decision == oracle::Class::must_hit;
      }
      for (const TriangleVariant& variant : all_variants<TriangleTest>())
        for (const FloatMode mode : float_modes) {
          if (variant.test != test) continue;
          const auto results = answers(variant, rays, orders, mode);
          for (std::size_t i = 0; i < results.size(); ++i)
            ASSERT_EQ(fault(results[i], rays[i % rays.size()], judgements[i]), "")
                << variant.name() << ' ' << name_of(mode) << " pair " << i;
        }
    }
    if (quick()) continue;
    EXPECT_GE(double(decided), min_decided * double(rays_aimed)) << name_of(test);
    EXPECT_GE(double(inside), 0.99 * double(rays_aimed)) << "the rays are aimed badly";
  }
}

INSTANTIATE_TEST_SUITE_P(Aspects, Slivers,
                         ::testing::Values(SliverCase{1e-4, 0.9, 0.3}, SliverCase{1e-5, 0.9, 0.25},
                                           SliverCase{1e-6, 0.9, 0.005}, SliverCase{1e-7, 0.9, 0},
                                           SliverCase{1e-4, 0.009, 0.2}, SliverCase{1e-6, 0.009, 0}));

}  // namespace
}  // namespace raylanes::testing
