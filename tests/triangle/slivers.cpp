// All triangle forms on triangles of aspect 1e-4 … 1e-7, aimed inside, straight and at grazing angles.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "../support/random_input.hpp"
#include "answers.hpp"
#include "judge.hpp"

namespace raylanes::testing {
namespace {

using Double3 = std::array<double, 3>;

Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Double3& a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}
Double3 unit(const Double3& a) {
  const double size = length(a);
  return {a[0] / size, a[1] / size, a[2] / size};
}

struct Sliver {
  Triangle triangle;
  Double3 normal, across;  // unit vectors: of its plane, and in it across the long edge
};

// The long edge from 0 to a corner about 1 away. A needle has its third corner near 0, a cap near the middle.
Sliver sliver(double aspect, bool needle, Random& random) {
  const Float3 b = random.point(1);
  const Double3 along{double(b[0]), double(b[1]), double(b[2])};
  Sliver s;
  s.normal = unit(cross(along, {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}));
  s.across = cross(s.normal, unit(along));
  const double foot = needle ? 0 : 0.5, height = aspect * length(along);
  Float3 c;
  for (std::size_t k = 0; k < 3; ++k) c[k] = static_cast<float>(foot * along[k] + height * s.across[k]);
  s.triangle = make_triangle({0, 0, 0}, b, c);
  return s;
}

// Height over length, of the triangle that the floats make.
double aspect_of(const Triangle& t) {
  const Double3 b{t.corner[1][0], t.corner[1][1], t.corner[1][2]},
      c{t.corner[2][0], t.corner[2][1], t.corner[2][2]};
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

// least_decided: of the rays, for each form; the others are within rounding of the edges.
struct SliverCase {
  double aspect, slope, least_decided;
};

class Slivers : public ::testing::TestWithParam<SliverCase> {};

TEST_P(Slivers, are_right_outside_their_bound_when_aimed_inside) {
  const auto [aspect, slope, least_decided] = GetParam();
  for (const TriangleForm form : all_triangle_forms) {
    Random random(112);
    std::size_t rays_aimed = 0, inside = 0, decided = 0;
    for (int round = 0; round < (quick() ? 1 : 12); ++round) {
      const Sliver s = sliver(aspect, round % 2 == 0, random);
      ASSERT_NEAR(std::log10(aspect_of(s.triangle)), std::log10(aspect), 0.35);
      std::vector<Ray> rays;
      for (int i = 0; i < 5; ++i) rays.push_back(ray_inside(s, slope, random));
      const std::vector<Triangle> orders = corner_orders(s.triangle);
      std::vector<TriangleJudgement> judgements;
      for (const Triangle& order : orders)
        for (const Ray& ray : rays) judgements.push_back(judge(form, ray, order));
      for (const TriangleJudgement& j : judgements) {
        ++rays_aimed;
        inside += j.exact.hit;
        decided += j.decision == oracle::Class::must_hit;
      }
      for (const FormVariant& variant : all_variants<TriangleForm>())
        for (const FloatMode mode : float_modes) {
          if (variant.test != form) continue;
          const auto results = answers(variant, rays, orders, mode);
          for (std::size_t i = 0; i < results.size(); ++i)
            ASSERT_EQ(fault(results[i], rays[i % rays.size()], judgements[i]), "")
                << variant.name() << ' ' << name_of(mode) << " pair " << i;
        }
    }
    if (quick()) continue;
    EXPECT_GE(double(decided), least_decided * double(rays_aimed)) << name_of(form);
    EXPECT_GE(double(inside), 0.99 * double(rays_aimed)) << "the rays are aimed badly";
  }
}

INSTANTIATE_TEST_SUITE_P(Aspects, Slivers,
                         ::testing::Values(SliverCase{1e-4, 0.9, 0.3}, SliverCase{1e-5, 0.9, 0.25},
                                           SliverCase{1e-6, 0.9, 0.005}, SliverCase{1e-7, 0.9, 0},
                                           SliverCase{1e-4, 0.009, 0.2}, SliverCase{1e-6, 0.009, 0}));

}  // namespace
}  // namespace raylanes::testing
