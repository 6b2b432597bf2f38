// The exact oracle's error bounds against float code, and its classes against mutants.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>

#include "float_triangle_tests.hpp"

namespace raylanes::oracle {
namespace {

TEST(ErrorBoundsOfTriangle, float_code_never_exceeds_them_and_comes_near) {
  for (const Method& m : methods) {
    Ratios over_all;
    for (const Cases kind : {Cases::uniform, Cases::edge_aimed, Cases::far, Cases::offset}) {
      Generator generator(101);
      Ratios worst;
      int wrong = 0;
      for (int n = 0; n < 1500; ++n) {
        const Case c = generator.next(kind);
        const ExactTriangleTest exact = exact_triangle(c.ray, c.triangle);
        ASSERT_TRUE(exact.valid);
        const ErrorBounds bounds = error_bounds(c.ray, c.triangle, exact, m.form);
        ASSERT_TRUE(bounds.in_range);
        const FloatTest computed = m.run(c.ray, c.triangle);
        measure(computed, form_scale(m.form, c.ray), exact, bounds, worst);
        wrong += contradicts(classify(c.ray, exact, bounds), computed.hit);
      }
      const std::string where = std::string(m.name) + ", " + name(kind);
      EXPECT_EQ(wrong, 0) << where;
      EXPECT_LE(worst.weight, 1) << where;
      EXPECT_LE(worst.det, 1) << where;
      EXPECT_LE(worst.depth, 1) << where;
      EXPECT_LE(worst.t, 1) << where;
      EXPECT_LE(worst.uv, 1) << where;
      over_all.weight = std::max(over_all.weight, worst.weight);
      over_all.depth = std::max(over_all.depth, worst.depth);
      over_all.t = std::max(over_all.t, worst.t);
    }
    RecordProperty(m.name, std::to_string(over_all.weight) + " " + std::to_string(over_all.depth) + " " +
                               std::to_string(over_all.t));
    EXPECT_GT(over_all.weight, 0.15) << m.name << ": a bound nobody comes near says nothing";
    EXPECT_GT(over_all.depth, 0.1) << m.name;
    EXPECT_GT(over_all.t, 0.1) << m.name;
  }
}

TEST(ErrorBoundsOfTriangle, hold_where_products_underflow_and_give_up_where_they_overflow) {
  for (const Method& m : methods)
    for (const int exponent : {-60, -48, -40, -20, 20, 36}) {
      Generator generator(7);
      Ratios worst;
      for (int n = 0; n < 300; ++n) {
        Case c = generator.next(Cases::edge_aimed);
        for (auto& vertex : c.triangle.corner)
          for (float& x : vertex) x = std::ldexp(x, exponent);
        for (std::size_t k = 0; k < 3; ++k) {
          c.ray.origin[k] = std::ldexp(c.ray.origin[k], exponent);
          c.ray.direction[k] = std::ldexp(c.ray.direction[k], exponent);
        }
        const ExactTriangleTest exact = exact_triangle(c.ray, c.triangle);
        const ErrorBounds bounds = error_bounds(c.ray, c.triangle, exact, m.form);
        ASSERT_TRUE(bounds.in_range);
        const FloatTest computed = m.run(c.ray, c.triangle);
        measure(computed, form_scale(m.form, c.ray), exact, bounds, worst);
        ASSERT_FALSE(contradicts(classify(c.ray, exact, bounds), computed.hit)) << m.name << exponent;
      }
      EXPECT_LE(std::max({worst.weight, worst.det, worst.depth, worst.t, worst.uv}), 1)
          << m.name << ", scale 2^" << exponent;
    }
  const Triangle huge = make_triangle({0, 0, 0}, {4e30f, 0, 0}, {0, 4e30f, 0});
  const Ray ray = make_ray({1e30f, 1e30f, 2e30f}, {0, 0, -1});
  EXPECT_TRUE(exact_triangle(ray, huge).hit);
  EXPECT_EQ(classify(ray, huge, Form::moller_trumbore), Class::either);
  EXPECT_EQ(classify(ray, huge, Form::sheared), Class::either);
}

double share_of_either(Cases kind, Form form) {
  Generator generator(5);
  int either = 0;
  constexpr int count = 1500;
  for (int n = 0; n < count; ++n) {
    const Case c = generator.next(kind);
    either += classify(c.ray, c.triangle, form) == Class::either;
  }
  return double(either) / count;
}

TEST(ClassOfTriangle, shares_of_either_stay_where_they_belong) {
  for (const Form form : {Form::moller_trumbore, Form::sheared, Form::embree_fast, Form::embree_robust}) {
    const int id = static_cast<int>(form);
    EXPECT_LE(share_of_either(Cases::uniform, form), 0.002) << "form " << id;
    EXPECT_GE(share_of_either(Cases::edge_aimed, form), 0.7) << "form " << id;
    EXPECT_LE(share_of_either(Cases::edge_aimed, form), 0.95) << "form " << id;
  }
  EXPECT_LE(share_of_either(Cases::offset, Form::moller_trumbore), 0.01);
  EXPECT_LE(share_of_either(Cases::offset, Form::sheared), 0.01);
  EXPECT_LE(share_of_either(Cases::far, Form::moller_trumbore), 0.02);
  EXPECT_LE(share_of_either(Cases::far, Form::sheared), 0.05);
}

TEST(ClassOfTriangle, catches_mutants) {
  struct Mutant {
    const char* name;
    bool (*hit)(const Ray&, const FloatTest&);
  };
  static const auto within = [](const FloatTest& f, float slack) {
    return f.det != 0 && f.u >= -slack && f.v >= -slack && f.u + f.v <= 1 + slack;
  };
  const Mutant mutants[] = {
      {"no t test", [](const Ray&, const FloatTest& f) { return within(f, 0); }},
      {"no tmax", [](const Ray& r, const FloatTest& f) { return within(f, 0) && f.t >= r.tmin; }},
      {"culls one side",
       [](const Ray& r, const FloatTest& f) {
         return f.det > 0 && within(f, 0) && f.t >= r.tmin && f.t <= r.tmax;
       }},
      {"culls |det| < 1e-1",
       [](const Ray& r, const FloatTest& f) {
         return std::abs(f.det) > 0.1f && within(f, 0) && f.t >= r.tmin && f.t <= r.tmax;
       }},
      {"u, v <= 1 only",
       [](const Ray& r, const FloatTest& f) {
         return f.det != 0 && f.u >= 0 && f.v >= 0 && f.u <= 1 && f.v <= 1 && f.t >= r.tmin && f.t <= r.tmax;
       }},
      {"epsilon 1e-3",
       [](const Ray& r, const FloatTest& f) { return within(f, 1e-3f) && f.t >= r.tmin && f.t <= r.tmax; }},
  };
  std::array<int, std::size(mutants)> caught{};
  for (const Cases kind : {Cases::uniform, Cases::far, Cases::offset}) {
    Generator generator(23);
    for (int n = 0; n < 2000; ++n) {
      const Case c = generator.next(kind);
      const FloatTest f = float_moller_trumbore(c.ray, c.triangle, false);
      const Class expected = classify(c.ray, c.triangle, Form::moller_trumbore);
      ASSERT_FALSE(contradicts(expected, f.hit));
      for (std::size_t i = 0; i < std::size(mutants); ++i)
        caught[i] += contradicts(expected, mutants[i].hit(c.ray, f));
    }
  }
  for (std::size_t i = 0; i < std::size(mutants); ++i) EXPECT_GT(caught[i], 0) << mutants[i].name;
}

}  // namespace
}  // namespace raylanes::oracle
