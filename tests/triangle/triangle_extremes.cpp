// All triangle forms at the extremes: a table of named cases, exact edges and corners.
#include "../support/float_modes.hpp"
#include "../support/random_input.hpp"
#include "judge/triangle_answers.hpp"

namespace raylanes::testing {
namespace {

struct NamedCase {
  const char* name;
  Ray ray;
  Triangle triangle;
  enum Answer { miss, hit, no_nan } answer;  // no_nan: out of range, either, but never a NaN in a hit
  float t;                                   // of a hit
};

constexpr float largest = 0x1.fffffep127f, least = 0x1p-149f;

const NamedCase named_cases[] = {
    {"inside", make_ray({1, 1, 2}, {0, 0, -1}), floor_triangle, NamedCase::hit, 2},
    {"from below", make_ray({1, 1, -2}, {0, 0, 1}), floor_triangle, NamedCase::hit, 2},
    {"outside across the first edge", make_ray({1, -1, 2}, {0, 0, -1}), floor_triangle, NamedCase::miss, 0},
    {"outside across the second edge", make_ray({3, 3, 2}, {0, 0, -1}), floor_triangle, NamedCase::miss, 0},
    {"outside across the third edge", make_ray({-1, 1, 2}, {0, 0, -1}), floor_triangle, NamedCase::miss, 0},
    {"beyond a corner", make_ray({-1, -1, 2}, {0, 0, -1}), floor_triangle, NamedCase::miss, 0},
    {"aslant", make_ray({-1, -1, 2}, {1, 1, -1}), floor_triangle, NamedCase::hit, 2},
    {"aslant past it", make_ray({-1, -1, 2}, {-1, 1, -1}), floor_triangle, NamedCase::miss, 0},
    {"a long direction", make_ray({1, 1, 2}, {0, 0, -16}), floor_triangle, NamedCase::hit, 0.125f},
    {"a short direction", make_ray({1, 1, 2}, {0, 0, -0x1p-10f}), floor_triangle, NamedCase::hit, 2048},
    {"minus zeros", make_ray({1, 1, 2}, {-0.0f, -0.0f, -1}), floor_triangle, NamedCase::hit, 2},
    {"one zero", make_ray({1, 0, 2}, {0, 0.5f, -1}), floor_triangle, NamedCase::hit, 2},
    {"behind", make_ray({1, 1, 2}, {0, 0, 1}), floor_triangle, NamedCase::miss, 0},
    {"behind, but within the segment", make_ray({1, 1, 2}, {0, 0, 1}, -3), floor_triangle, NamedCase::hit,
     -2},
    {"t = tmin", make_ray({1, 1, 2}, {0, 0, -1}, 2), floor_triangle, NamedCase::hit, 2},
    {"t = tmax", make_ray({1, 1, 2}, {0, 0, -1}, 0, 2), floor_triangle, NamedCase::hit, 2},
    {"tmin above t", make_ray({1, 1, 2}, {0, 0, -1}, 0x1.000002p1f), floor_triangle, NamedCase::miss, 0},
    {"tmax below t", make_ray({1, 1, 2}, {0, 0, -1}, 0, 0x1.fffffep0f), floor_triangle, NamedCase::miss, 0},
    {"on the plane, tmin 0", make_ray({1, 1, 0}, {0, 0, -1}), floor_triangle, NamedCase::hit, 0},
    {"on the plane, tmin > 0", make_ray({1, 1, 0}, {0, 0, -1}, 1e-30f), floor_triangle, NamedCase::miss, 0},
    {"tmin = -inf", make_ray({1, 1, 2}, {0, 0, 1}, -infinity), floor_triangle, NamedCase::hit, -2},
    {"tmin = -inf, tmax = t", make_ray({1, 1, 2}, {0, 0, -1}, -infinity, 2), floor_triangle, NamedCase::hit,
     2},
    {"tmin = inf, tmax = -inf", make_ray({1, 1, 2}, {0, 0, -1}, infinity, -infinity), floor_triangle,
     NamedCase::miss, 0},
    {"tmin > tmax", make_ray({1, 1, 2}, {0, 0, -1}, 3, 1), floor_triangle, NamedCase::miss, 0},
    {"tmin NaN", make_ray({1, 1, 2}, {0, 0, -1}, nan), floor_triangle, NamedCase::miss, 0},
    {"tmax NaN", make_ray({1, 1, 2}, {0, 0, -1}, 0, nan), floor_triangle, NamedCase::miss, 0},
    {"in the plane, crossing", make_ray({-1, 1, 0}, {1, 0, 0}), floor_triangle, NamedCase::miss, 0},
    {"in the plane, along an edge", make_ray({-1, 0, 0}, {1, 0, 0}), floor_triangle, NamedCase::miss, 0},
    {"in the plane, aslant", make_ray({1, 1, 0}, {1, -1, 0}), floor_triangle, NamedCase::miss, 0},
    {"parallel to the plane", make_ray({-1, 1, 1}, {1, 0, 0}), floor_triangle, NamedCase::miss, 0},
    {"direction 0", make_ray({1, 1, 0}, {0, -0.0f, 0}), floor_triangle, NamedCase::miss, 0},
    {"two corners beside the ray", make_ray({1, 1, 2}, {0, 0, -1}),
     make_triangle({2, 2, 0}, {0, 0, 0}, {2, 2, 0}), NamedCase::miss, 0},
    {"two equal corners", make_ray({1, 1, 2}, {0, 0, -1}), make_triangle({0, 0, 0}, {4, 4, 0}, {4, 4, 0}),
     NamedCase::miss, 0},
    {"collinear", make_ray({1, 1, 2}, {0, 0, -1}), make_triangle({0, 0, 0}, {1, 1, 0}, {4, 4, 0}),
     NamedCase::miss, 0},
    {"a point", make_ray({1, 1, 2}, {0, 0, -1}), make_triangle({1, 1, 0}, {1, 1, 0}, {1, 1, 0}),
     NamedCase::miss, 0},
    {"small scene", make_ray({0x1p-40f, 0x1p-40f, 0x1p-39f}, {0, 0, -1}),
     make_triangle({0, 0, 0}, {0x1p-38f, 0, 0}, {0, 0x1p-38f, 0}), NamedCase::hit, 0x1p-39f},
    {"large scene", make_ray({0x1p38f, 0x1p38f, 0x1p39f}, {0, 0, -1}),
     make_triangle({0, 0, 0}, {0x1p40f, 0, 0}, {0, 0x1p40f, 0}), NamedCase::hit, 0x1p39f},
    {"|d| = 1e-30", make_ray({1, 1, 2}, {0, 0, -1e-30f}), floor_triangle, NamedCase::hit, 2e30f},
    {"|d| = 1e18", make_ray({1, 1, 2}, {0, 0, -1e18f}), floor_triangle, NamedCase::hit, 2e-18f},
    {"a small component of d", make_ray({1, 1, 2}, {1e-30f, -1e-30f, -1}), floor_triangle, NamedCase::hit, 2},
    {"a subnormal component of d", make_ray({1, 1, 2}, {least, -64 * least, -1}), floor_triangle,
     NamedCase::hit, 2},
    {"the whole line", make_ray({1, 1, 2}, {0, 0, -1}, -infinity, infinity), floor_triangle, NamedCase::hit,
     2},
    {"all that is infinitely far", make_ray({1, 1, 2}, {0, 0, -1}, infinity, infinity), floor_triangle,
     NamedCase::miss, 0},
    {"all that is infinitely far behind", make_ray({1, 1, 2}, {0, 0, -1}, -infinity, -infinity),
     floor_triangle, NamedCase::miss, 0},
    {"both ends at t", make_ray({1, 1, 2}, {0, 0, -1}, 2, 2), floor_triangle, NamedCase::hit, 2},
    {"both ends NaN", make_ray({1, 1, 2}, {0, 0, -1}, nan, nan), floor_triangle, NamedCase::miss, 0},
    {"|d| the largest", make_ray({1, 1, 2}, {0, 0, -largest}), floor_triangle, NamedCase::no_nan, 0},
    {"|d| the least", make_ray({1, 1, 2}, {0, 0, -least}), floor_triangle, NamedCase::no_nan, 0},
    {"a far triangle of the largest numbers", make_ray({1, 1, 2}, {0, 0, -1}),
     make_triangle({-largest, -largest, 0}, {largest, 0, 0}, {0, largest, 0}), NamedCase::no_nan, 0},
    {"the least triangle", make_ray({0, 0, 1}, {0, 0, -1}),
     make_triangle({0, 0, 0}, {least, 0, 0}, {0, least, 0}), NamedCase::no_nan, 0},
};

void check_case(const TriangleVariant& variant, const NamedCase& c, const Triangle& triangle) {
  const TriangleResult result = single(variant, c.ray, triangle);
  if (c.answer == NamedCase::miss) {
    EXPECT_EQ(result, triangle_missed) << variant.name() << ": " << c.name;
  } else if (c.answer == NamedCase::hit) {
    EXPECT_EQ(result.hit, hit_flag) << variant.name() << ": " << c.name;
    EXPECT_FLOAT_EQ(result.t, c.t) << variant.name() << ": " << c.name;
    EXPECT_FALSE(std::signbit(result.t) && result.t == 0) << variant.name() << ": " << c.name;
  } else if (result.hit != 0) {
    EXPECT_TRUE(result.t >= c.ray.tmin && result.t <= c.ray.tmax && std::isfinite(result.t))
        << variant.name() << ": " << c.name;
  }
}

TEST(TriangleExtremes, named_cases_in_all_corner_orders_and_float_modes) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    SCOPED_TRACE(name_of(mode));
    for (const TriangleVariant& variant : all_variants<TriangleTest>())
      for (const NamedCase& c : named_cases)
        for (const Triangle& triangle : corner_orders(c.triangle)) check_case(variant, c, triangle);
  }
}

// A determinant that underflows to zero with all weights, where t would be infinite. The sheared test has no such
// determinant, but a t that overflows.
TEST(TriangleExtremes, a_determinant_that_underflows_is_a_miss) {
  const Ray ray = make_ray({0.0625f, 0.0625f, 2}, {0, 0, -least});
  const Triangle triangle = make_triangle({0, 0, 0}, {0.25f, 0, 0}, {0, 0.25f, 0});
  for (const TriangleVariant& variant : all_variants<TriangleTest>())
    for (const Triangle& t : corner_orders(triangle))
      EXPECT_EQ(single(variant, ray, t), triangle_missed) << variant.name();
}

// One rule for all tests and queries: where t is infinite it is a miss, whichever ends the segment has.
TEST(TriangleExtremes, an_infinite_t_is_a_miss) {
  const Triangle triangle = make_triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  struct End {
    float tmin, tmax;
  };
  constexpr End ends[] = {{0, infinity},        {-infinity, infinity}, {-infinity, largest},
                          {-largest, infinity}, {infinity, infinity},  {-infinity, -infinity}};
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    for (const float direction : {-0x1p-125f, 0x1p-125f})  // t = 2^130, or minus that
      for (const End& end : ends)
        for (const TriangleVariant& variant : all_variants<TriangleTest>())
          for (const Triangle& t : corner_orders(triangle))
            EXPECT_EQ(single(variant, make_ray({1, 1, 32}, {0, 0, direction}, end.tmin, end.tmax), t),
                      triangle_missed)
                << variant.name() << ' ' << name_of(mode) << ' ' << direction << ' ' << end.tmin << ' '
                << end.tmax;
  }
}

// The largest finite t are hits.
TEST(TriangleExtremes, a_t_just_below_infinity_is_a_hit) {
  const Triangle triangle = make_triangle({0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0});
  for (const TriangleVariant& variant : all_variants<TriangleTest>())
    for (const float tmax : {infinity, largest, 0x1p127f}) {
      const Ray ray = make_ray({0.125f, 0.125f, 8}, {0, 0, -0x1p-124f}, 0, tmax);
      const TriangleResult result = single(variant, ray, triangle);
      EXPECT_EQ(result.hit, hit_flag) << variant.name();
      EXPECT_EQ(result.t, 0x1p127f) << variant.name();
    }
}

// Edges and corners of a triangle with integer coordinates and an area that is a power of two: nothing rounds
// in any test, and they are closed.
TEST(TriangleExtremes, exact_edges_and_corners_are_hit) {
  const Triangle triangle = floor_triangle;
  const double weights[][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0, 0.5}, {0.5, 0.5}, {0.25, 0.75}};
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    for (const auto& w : weights)
      for (const Triangle& t : corner_orders(triangle)) {
        const Ray ray = ray_to({1, 2, 8}, triangle, w[0], w[1], 0.125);
        EXPECT_EQ(single(variant, ray, t).hit, hit_flag) << variant.name();
      }
  }
}

}  // namespace
}  // namespace raylanes::testing
