// The decisions of the exact ray-triangle oracle against integers, at the ends of segments, on invalid input,
// and on the known failures of float tests.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "../../bench/support/oracles/double_triangle.hpp"
#include "float_triangle_tests.hpp"

namespace raylanes::oracle {
namespace {

TEST(ExactTriangle, agrees_with_integers_and_exact_floats_on_a_lattice) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> coordinate(-6, 6);
  int hits = 0, on_edge = 0, flat = 0;
  for (int n = 0; n < 3000; ++n) {
    std::array<std::array<std::int64_t, 3>, 5> p;  // a, b, c, o, d
    for (auto& q : p)
      for (auto& x : q) x = coordinate(random);
    const auto as_float = [&p](std::size_t i) {
      return Float{static_cast<float>(p[i][0]), static_cast<float>(p[i][1]), static_cast<float>(p[i][2])};
    };
    const Ray ray = make_ray(as_float(3), as_float(4), 0, 2);
    const Triangle tri = make_triangle(as_float(0), as_float(1), as_float(2));
    const auto determinant = [](const auto& a, const auto& b, const auto& c) {
      return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
             a[2] * (b[0] * c[1] - b[1] * c[0]);
    };
    auto r = p;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) r[i][k] -= p[3][k];
    const std::int64_t u = determinant(r[4], r[2], r[1]), v = determinant(r[4], r[0], r[2]),
                       w = determinant(r[4], r[1], r[0]), t = determinant(r[2], r[1], r[0]), det = u + v + w;
    const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    const std::int64_t sign = det < 0 ? -1 : 1;
    const bool expected = det != 0 && inside && t * sign >= 0 && t * sign <= 2 * det * sign;
    const ExactTriangleTest exact = exact_triangle(ray, tri);
    ASSERT_EQ(exact.hit, expected) << "case " << n;
    ASSERT_EQ(float_moller_trumbore(ray, tri, n % 2 == 0).hit, expected) << "case " << n;
    ASSERT_EQ(double_triangle(ray, tri).hit, expected) << "case " << n;
    if (det != 0) {
      ASSERT_EQ(exact.t, mpq_class(mpz_class(t)) / mpz_class(det));
    }
    for (const Method& m : methods)
      ASSERT_FALSE(contradicts(classify(ray, tri, m.form), expected)) << m.name << ", case " << n;
    hits += expected;
    on_edge += expected && (u == 0 || v == 0 || w == 0);
    flat += det == 0;
  }
  EXPECT_GT(hits, 50);
  EXPECT_GT(on_edge, 5);
  EXPECT_GT(flat, 15);
}

TEST(ExactTriangle, gives_the_weights_of_the_vertices) {
  const ExactTriangleTest test =
      exact_triangle(make_ray({2, 3, -1}, {2, 1, -4}), make_triangle({3, -1, -4}, {3, 4, -3}, {0, -1, 3}));
  EXPECT_EQ(test.det, -7);
  EXPECT_EQ(test.weight[0], 0);
  EXPECT_EQ(test.weight[1], -6);
  EXPECT_EQ(test.weight[2], -1);
  EXPECT_EQ(test.depth, -2);
  EXPECT_TRUE(test.hit) << "an exact edge belongs to the triangle";
  EXPECT_EQ(test.t, mpq_class(2, 7));
  EXPECT_EQ(test.u, mpq_class(6, 7));
  EXPECT_EQ(test.v, mpq_class(1, 7));
}

TEST(ExactTriangle, the_segment_is_closed_and_may_be_infinite) {
  const Float o = {1, 1, 2}, d = {0, 0, -1};
  const auto hit = [&](float tmin, float tmax) {
    return exact_triangle(make_ray(o, d, tmin, tmax), floor_triangle).hit;
  };
  EXPECT_TRUE(hit(2, 2));
  EXPECT_TRUE(hit(0, 2));
  EXPECT_TRUE(hit(2, 3));
  EXPECT_FALSE(hit(0, std::nextafter(2.0f, 0.0f)));
  EXPECT_FALSE(hit(std::nextafter(2.0f, 3.0f), infinity));
  EXPECT_TRUE(hit(-infinity, infinity));
  EXPECT_FALSE(hit(-infinity, 1));
  EXPECT_FALSE(hit(infinity, infinity));
  EXPECT_FALSE(hit(-infinity, -infinity));
  EXPECT_FALSE(exact_triangle(make_ray(o, {0, 0, 1}, 0, infinity), floor_triangle).hit) << "behind";
  EXPECT_TRUE(exact_triangle(make_ray(o, {0, 0, 1}, -3, 0), floor_triangle).hit) << "behind, allowed by tmin";
}

TEST(ExactTriangle, invalid_and_degenerate_input_is_no_hit) {
  const Float o = {1, 1, 2}, d = {0, 0, -1};
  const Ray good = make_ray(o, d);
  ASSERT_TRUE(exact_triangle(good, floor_triangle).hit);
  for (const float bad : {nan, infinity, -infinity})
    for (std::size_t k = 0; k < 3; ++k) {
      Ray ray = good;
      ray.origin[k] = bad;
      EXPECT_FALSE(exact_triangle(ray, floor_triangle).valid);
      ray = good;
      ray.direction[k] = bad;
      EXPECT_EQ(classify(ray, floor_triangle, Form::sheared), Class::must_miss);
      Triangle tri = floor_triangle;
      tri.corner[k][(k + 1) % 3] = bad;
      EXPECT_FALSE(exact_triangle(good, tri).hit);
      EXPECT_EQ(classify(good, tri, Form::moller_trumbore), Class::must_miss);
    }
  EXPECT_FALSE(exact_triangle(make_ray(o, {0, -0.0f, 0}), floor_triangle).valid);
  EXPECT_FALSE(exact_triangle(make_ray(o, d, 3, 1), floor_triangle).valid);
  EXPECT_FALSE(exact_triangle(make_ray(o, d, nan, 1), floor_triangle).valid);
  EXPECT_FALSE(exact_triangle(make_ray(o, d, 0, nan), floor_triangle).valid);
  EXPECT_FALSE(exact_triangle(make_ray({-1, 1, 0}, {1, 0, 0}), floor_triangle).hit) << "in its plane";
  const Triangle two_equal = make_triangle({1, 1, 0}, {3, 1, 0}, {1, 1, 0});
  EXPECT_FALSE(exact_triangle(good, two_equal).hit);
  EXPECT_EQ(classify(good, two_equal, Form::sheared), Class::must_miss);
  EXPECT_EQ(classify(good, two_equal, Form::moller_trumbore), Class::must_miss);
}

TEST(DoubleTriangle, agrees_with_the_exact_test_off_the_edges) {
  for (const Cases kind : {Cases::uniform, Cases::far, Cases::offset}) {
    Generator generator(31);
    for (int n = 0; n < 2000; ++n) {
      const Case c = generator.next(kind);
      const ExactTriangleTest exact = exact_triangle(c.ray, c.triangle);
      const DoubleTriangleTest test = double_triangle(c.ray, c.triangle);
      ASSERT_EQ(test.hit, exact.hit) << name(kind) << n;
      if (!test.hit) continue;
      ASSERT_NEAR(test.t, exact.t.get_d(), 1e-9 * std::abs(test.t));
      ASSERT_NEAR(test.u, exact.u.get_d(), 1e-8);
      ASSERT_NEAR(test.v, exact.v.get_d(), 1e-8);
    }
  }
  EXPECT_FALSE(double_triangle(make_ray({nan, 1, 2}, {0, 0, -1}), floor_triangle).hit);
  EXPECT_FALSE(double_triangle(make_ray({1, 1, 2}, {0, 0, 0}), floor_triangle).hit);
}

TEST(KnownFailures, a_ray_that_moller_trumbore_lets_through) {
  const SharedEdge& c = moller_trumbore_leak;
  EXPECT_FALSE(float_moller_trumbore(c.ray, c.first, false).hit);
  EXPECT_FALSE(float_moller_trumbore(c.ray, c.second, false).hit);
  EXPECT_TRUE(exact_triangle(c.ray, c.first).hit || exact_triangle(c.ray, c.second).hit);
  EXPECT_TRUE(float_sheared(c.ray, c.first).hit || float_sheared(c.ray, c.second).hit);
  for (const Method& m : methods) {
    EXPECT_NE(classify(c.ray, c.first, m.form), Class::must_hit) << m.name;
    EXPECT_NE(classify(c.ray, c.second, m.form), Class::must_hit) << m.name;
  }
}

TEST(KnownFailures, a_ray_that_a_contracted_sheared_test_lets_through) {
  const SharedEdge c =
      shared_edge({-0x1.cp-4f, 0x1.cp-4f, 0x1.ep-3f}, {0x1.4245cp-1f, -0x1.29c144p-2f, 0x1.70f1c2p-1f},
                  {-0x1p-6f, -0x1.f8p-1f, 0x1.f6p-1f}, {0x1.cp-2f, -0x1.cp-4f, 0x1.aep-1f},
                  {-0x1.2p-3f, 0x1.ep-1f, 0x1.06p+0f}, {0x1.b8p-1f, -0x1.a8p-1f, 0x1.33p+0f});
  EXPECT_TRUE(exact_triangle(c.ray, c.first).hit || exact_triangle(c.ray, c.second).hit);
  EXPECT_TRUE(float_sheared(c.ray, c.first).hit || float_sheared(c.ray, c.second).hit);
  EXPECT_EQ(classify(c.ray, c.first, Form::sheared), Class::either);
  EXPECT_EQ(classify(c.ray, c.second, Form::sheared), Class::either);
}

TEST(KnownFailures, a_hit_that_depends_on_fused_multiply_add) {
  const Ray ray = make_ray({0x1.6p-3f, 0, 0x1.cp-3f}, {0x1.f24224p-3f, 0x1.20d156p-2f, 0x1.db2812p-1f});
  const Triangle tri = make_triangle({0x1.18p-1f, 0x1.cp-3f, 0x1.2fp+0f}, {-0x1.8p-5f, 0x1.3p-1f, 0x1.36p+0f},
                                     {-0x1.8p-1f, 0x1.2p-3f, 0x1.9p-1f});
  EXPECT_EQ(classify(ray, tri, Form::moller_trumbore), Class::either);
  EXPECT_EQ(classify(ray, tri, Form::sheared), Class::either);
}

}  // namespace
}  // namespace raylanes::oracle
