// The decisions of the exact ray-triangle oracle against integers, at the ends of segments and on invalid input.
// tests/triangle holds the library to the oracle's bounds, from both sides of each edge.
#include "../../bench/support/oracles/double_triangle.hpp"
#include "../../bench/support/oracles/exact_triangle.hpp"
#include "../support/triangle_scenes.hpp"

namespace raylanes::oracle {
namespace {

using namespace testing;

TEST(ExactTriangle, agrees_with_integers_on_a_lattice) {
  Random random(11);
  int hits = 0, on_edge = 0, flat = 0;
  for (int n = 0; n < 3000; ++n) {
    std::array<std::array<std::int64_t, 3>, 5> p;  // a, b, c, o, d
    std::array<Float3, 5> as_float;
    for (std::size_t i = 0; i < p.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        p[i][k] = random.integer(-6, 6), as_float[i][k] = static_cast<float>(p[i][k]);
    const auto& [a, b, c, o, d] = as_float;
    const Ray ray = make_ray(o, d, 0, 2);
    const Triangle tri = make_triangle(a, b, c);
    const auto determinant = [](const auto& x, const auto& y, const auto& z) {
      return x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0]) +
             x[2] * (y[0] * z[1] - y[1] * z[0]);
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
    ASSERT_EQ(double_triangle(ray, tri).hit, expected) << "case " << n;
    if (det != 0) {
      ASSERT_EQ(exact.t, mpq_class(mpz_class(t)) / mpz_class(det));
    }
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
  const Float3 o = {1, 1, 2}, d = {0, 0, -1};
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
  const Float3 o = {1, 1, 2}, d = {0, 0, -1};
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

TEST(ErrorBounds, say_nothing_where_products_overflow) {
  const Triangle huge = make_triangle({0, 0, 0}, {4e30f, 0, 0}, {0, 4e30f, 0});
  const Ray ray = make_ray({1e30f, 1e30f, 2e30f}, {0, 0, -1});
  EXPECT_TRUE(exact_triangle(ray, huge).hit);
  EXPECT_EQ(classify(ray, huge, Form::moller_trumbore), Class::either);
  EXPECT_EQ(classify(ray, huge, Form::sheared), Class::either);
}

TEST(DoubleTriangle, agrees_with_the_exact_test_off_the_edges) {
  Random random(31);
  for (const Aim aim : {Aim::anywhere, Aim::off_edge}) {
    const TriangleScene scene = aimed_scene(aim, 300, 20, random);
    for (std::size_t i = 0; i < scene.size(); ++i) {
      const ExactTriangleTest exact = exact_triangle(scene.ray(i), scene.triangle(i));
      const DoubleTriangleTest test = double_triangle(scene.ray(i), scene.triangle(i));
      ASSERT_EQ(test.hit, exact.hit) << i;
      if (!test.hit) continue;
      ASSERT_NEAR(test.t, exact.t.get_d(), 1e-9 * std::abs(test.t));
      ASSERT_NEAR(test.u, exact.u.get_d(), 1e-8);
      ASSERT_NEAR(test.v, exact.v.get_d(), 1e-8);
    }
  }
  EXPECT_FALSE(double_triangle(make_ray({nan, 1, 2}, {0, 0, -1}), floor_triangle).hit);
  EXPECT_FALSE(double_triangle(make_ray({1, 1, 2}, {0, 0, 0}), floor_triangle).hit);
}

}  // namespace
}  // namespace raylanes::oracle
