// Tests of the exact ray-triangle oracle: its decisions against integers, its error bounds against float
// code, its classes against mutants, and its judgement of disagreements.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "oracles/disagreement.hpp"
#include "oracles/exact_triangle.hpp"

namespace raylanes::oracle {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
using Float = std::array<float, 3>;

Ray make_ray(Float o, Float d, float tmin = 0, float tmax = infinity) {
  return {{o[0], o[1], o[2]}, tmin, {d[0], d[1], d[2]}, tmax};
}
TriangleVertices make_triangle(Float a, Float b, Float c) {
  return {{{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, {c[0], c[1], c[2]}}};
}
Float minus(const float* a, const float* b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// Float tests under test: what they computed, in the names and the scale of ExactTriangleTest.
struct FloatTest {
  bool hit;
  float weight[3], det, depth, t, u, v;
};

float difference_of_products(float a, float b, float c, float d, bool fused) {
  return fused ? std::fma(a, b, -(c * d)) : a * b - c * d;
}
Float cross(const Float& a, const Float& b, bool fused) {
  return {difference_of_products(a[1], b[2], a[2], b[1], fused),
          difference_of_products(a[2], b[0], a[0], b[2], fused),
          difference_of_products(a[0], b[1], a[1], b[0], fused)};
}
float dot(const Float& a, const Float& b, bool fused) {
  if (fused) return std::fma(a[2], b[2], std::fma(a[1], b[1], a[0] * b[0]));
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

FloatTest float_moller_trumbore(const Ray& ray, const TriangleVertices& tri, bool fused) {
  const Float d = {ray.direction[0], ray.direction[1], ray.direction[2]};
  const Float e1 = minus(tri.vertex[1], tri.vertex[0]), e2 = minus(tri.vertex[2], tri.vertex[0]);
  const Float s = minus(ray.origin, tri.vertex[0]);
  const Float p = cross(d, e2, fused), q = cross(s, e1, fused);
  FloatTest r{};
  r.det = dot(e1, p, fused);
  r.weight[1] = dot(s, p, fused);
  r.weight[2] = dot(d, q, fused);
  r.weight[0] = r.det - r.weight[1] - r.weight[2];
  r.depth = dot(e2, q, fused);
  r.t = r.depth / r.det;
  r.u = r.weight[1] / r.det;
  r.v = r.weight[2] / r.det;
  const float sign = std::copysign(1.0f, r.det), u = r.weight[1] * sign, v = r.weight[2] * sign;
  r.hit = r.det != 0 && u >= 0 && v >= 0 && u + v <= r.det * sign && r.t >= ray.tmin && r.t <= ray.tmax;
  return r;
}

// The canonical sheared test with the fallback to double; weights are per |d[kz]|.
FloatTest float_sheared(const Ray& ray, const TriangleVertices& tri) {
  const float* d = ray.direction;
  int kz = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(d[i]) > std::abs(d[kz])) kz = i;
  int kx = (kz + 1) % 3, ky = (kx + 1) % 3;
  if (d[kz] < 0) std::swap(kx, ky);
  const float sx = d[kx] / d[kz], sy = d[ky] / d[kz], sz = 1 / d[kz];
  float x[3], y[3], z[3];
  for (int i = 0; i < 3; ++i) {
    const Float p = minus(tri.vertex[i], ray.origin);
    const auto at = [&p](int k) { return p[static_cast<std::size_t>(k)]; };
    x[i] = at(kx) - sx * at(kz);
    y[i] = at(ky) - sy * at(kz);
    z[i] = sz * at(kz);
  }
  FloatTest r{};
  const auto edges = [&](auto real) {
    using Real = decltype(real);
    const auto edge = [&](int p, int q) {
      return static_cast<float>(static_cast<Real>(x[p]) * static_cast<Real>(y[q]) -
                                static_cast<Real>(y[p]) * static_cast<Real>(x[q]));
    };
    r.weight[0] = edge(2, 1);
    r.weight[1] = edge(0, 2);
    r.weight[2] = edge(1, 0);
  };
  const auto inside = [&] {
    const float* w = r.weight;
    return (w[0] >= 0 && w[1] >= 0 && w[2] >= 0) || (w[0] <= 0 && w[1] <= 0 && w[2] <= 0);
  };
  edges(0.0f);
  if (inside() && (r.weight[0] == 0 || r.weight[1] == 0 || r.weight[2] == 0)) edges(0.0);
  r.det = (r.weight[0] + r.weight[1]) + r.weight[2];
  r.depth = (r.weight[0] * z[0] + r.weight[1] * z[1]) + r.weight[2] * z[2];
  r.t = r.depth / r.det;
  r.u = r.weight[1] / r.det;
  r.v = r.weight[2] / r.det;
  r.hit = inside() && r.det != 0 && r.t >= ray.tmin && r.t <= ray.tmax;
  return r;
}

// Seeded cases -------------------------------------------------------------------------------------------

enum class Cases { uniform, edge_aimed, far, offset };
const char* name(Cases c) {
  constexpr const char* names[] = {"uniform", "edge_aimed", "far", "offset"};
  return names[static_cast<int>(c)];
}

struct Case {
  Ray ray;
  TriangleVertices triangle;
};

class Generator {
 public:
  explicit Generator(unsigned seed) : random_(seed) {}

  Case next(Cases kind) {
    Float v[3] = {point(1), point(1), point(1)}, origin = point(3);
    float weight[3] = {unit(), unit(), unit()};
    if (kind == Cases::far)
      for (float& x : origin) x *= 1000;
    if (kind == Cases::offset)
      for (Float* p : {&v[0], &v[1], &v[2], &origin})
        for (float& x : *p) x += 1e4f;
    if (kind == Cases::edge_aimed) weight[random_() % 3] = 0;
    const float sum = weight[0] + weight[1] + weight[2];
    Float direction = point(1);
    if (kind != Cases::uniform)
      for (std::size_t k = 0; k < 3; ++k) {
        const float target = (weight[0] * v[0][k] + weight[1] * v[1][k] + weight[2] * v[2][k]) / sum;
        direction[k] = target - origin[k];
      }
    // Half of the far rays pass beside the triangle.
    if (kind == Cases::far && random_() % 2 == 0) direction[random_() % 3] += 2 * unit() - 1;
    return {make_ray(origin, direction, 0, random_() % 8 == 0 ? 0.5f : 100.0f),
            make_triangle(v[0], v[1], v[2])};
  }

 private:
  float unit() { return std::uniform_real_distribution<float>(0, 1)(random_); }
  float signed_unit() { return std::uniform_real_distribution<float>(-1, 1)(random_); }
  Float point(float scale) { return {scale * signed_unit(), scale * signed_unit(), scale * signed_unit()}; }
  std::mt19937 random_;
};

struct Method {
  const char* name;
  Form form;
  FloatTest (*run)(const Ray&, const TriangleVertices&);
};
const Method methods[] = {
    {"moller_trumbore", Form::moller_trumbore,
     [](const Ray& r, const TriangleVertices& t) { return float_moller_trumbore(r, t, false); }},
    {"moller_trumbore fused", Form::moller_trumbore,
     [](const Ray& r, const TriangleVertices& t) { return float_moller_trumbore(r, t, true); }},
    {"sheared", Form::sheared, float_sheared},
};

// The scale of a form's weights against the exact ones.
mpq_class form_scale(Form form, const Ray& ray) {
  if (form != Form::sheared) return 1;
  return mpq_class(
      std::max({std::abs(ray.direction[0]), std::abs(ray.direction[1]), std::abs(ray.direction[2])}));
}

double ratio(float computed, const mpq_class& scale, const mpq_class& exact, const mpq_class& bound) {
  const mpq_class error = abs(mpq_class(computed) * scale - exact);
  return error == 0 ? 0 : mpq_class(error / bound).get_d();
}

struct Ratios {
  double weight = 0, det = 0, depth = 0, t = 0, uv = 0;
};

void measure(const FloatTest& f, const mpq_class& scale, const ExactTriangleTest& e, const ErrorBounds& b,
             Ratios& worst) {
  for (std::size_t i = 0; i < 3; ++i)
    worst.weight = std::max(worst.weight, ratio(f.weight[i], scale, e.weight[i], b.weight[i]));
  worst.det = std::max(worst.det, ratio(f.det, scale, e.det, b.det));
  worst.depth = std::max(worst.depth, ratio(f.depth, scale, e.depth, b.depth));
  if (!b.t) return;
  worst.t = std::max(worst.t, ratio(f.t, 1, e.t, *b.t));
  worst.uv = std::max({worst.uv, ratio(f.u, 1, e.u, *b.u), ratio(f.v, 1, e.v, *b.v)});
}

bool contradicts(Class c, bool hit) {
  return (c == Class::must_hit && !hit) || (c == Class::must_miss && hit);
}

// Exact decisions ----------------------------------------------------------------------------------------

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
    const TriangleVertices tri = make_triangle(as_float(0), as_float(1), as_float(2));
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

const TriangleVertices floor_triangle = make_triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});

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
      TriangleVertices tri = floor_triangle;
      tri.vertex[k][(k + 1) % 3] = bad;
      EXPECT_FALSE(exact_triangle(good, tri).hit);
      EXPECT_EQ(classify(good, tri, Form::moller_trumbore), Class::must_miss);
    }
  EXPECT_FALSE(exact_triangle(make_ray(o, {0, -0.0f, 0}), floor_triangle).valid);
  EXPECT_FALSE(exact_triangle(make_ray(o, d, 3, 1), floor_triangle).valid);
  EXPECT_FALSE(exact_triangle(make_ray(o, d, nan, 1), floor_triangle).valid);
  EXPECT_FALSE(exact_triangle(make_ray(o, d, 0, nan), floor_triangle).valid);
  EXPECT_FALSE(exact_triangle(make_ray({-1, 1, 0}, {1, 0, 0}), floor_triangle).hit) << "in its plane";
  const TriangleVertices two_equal = make_triangle({1, 1, 0}, {3, 1, 0}, {1, 1, 0});
  EXPECT_FALSE(exact_triangle(good, two_equal).hit);
  EXPECT_EQ(classify(good, two_equal, Form::sheared), Class::must_miss);
  EXPECT_EQ(classify(good, two_equal, Form::moller_trumbore), Class::must_miss);
}

// Bounds -------------------------------------------------------------------------------------------------

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
        for (auto& vertex : c.triangle.vertex)
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
  const TriangleVertices huge = make_triangle({0, 0, 0}, {4e30f, 0, 0}, {0, 4e30f, 0});
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

// Known failures -----------------------------------------------------------------------------------------

// Two triangles (p,q,s) and (q,p,w) and a ray at their shared edge pq.
struct SharedEdge {
  Ray ray;
  TriangleVertices first, second;
};
SharedEdge shared_edge(Float o, Float d, Float p, Float q, Float s, Float w) {
  return {make_ray(o, d), make_triangle(p, q, s), make_triangle(q, p, w)};
}
const SharedEdge moller_trumbore_leak = shared_edge(
    {0, 0, 0}, {-0x1.2569cp-1f, 0x1.99509ep-2f, 0x1.b64bcap+0f},
    {-0x1.9769dcp-1f, 0x1.70ab2cp-1f, 0x1.93d2d4p+0f}, {0x1.3e1aap-4f, -0x1.12ade8p-1f, 0x1.0d85bep+1f},
    {0x1.dee458p-1f, 0x1.5e3d58p-1f, 0x1.8e7fdp+0f}, {-0x1.80d8b6p-1f, -0x1.10c542p-1f, 0x1.8ef12ap+0f});

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
  const TriangleVertices tri =
      make_triangle({0x1.18p-1f, 0x1.cp-3f, 0x1.2fp+0f}, {-0x1.8p-5f, 0x1.3p-1f, 0x1.36p+0f},
                    {-0x1.8p-1f, 0x1.2p-3f, 0x1.9p-1f});
  EXPECT_EQ(classify(ray, tri, Form::moller_trumbore), Class::either);
  EXPECT_EQ(classify(ray, tri, Form::sheared), Class::either);
}

// Disagreements ------------------------------------------------------------------------------------------

constexpr Hit miss = {infinity, 0, 0, no_primitive};

// Two floors, z = 0 and z = -1, and a copy of the first.
const std::vector<Float3> vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, -1}, {4, 0, -1}, {0, 4, -1}};
const std::vector<Index3> triangles = {{0, 1, 2}, {3, 4, 5}, {0, 1, 2}};

Explanation explain_floors(const Ray& ray, const Hit& ours, const Hit& theirs) {
  return explain(ray, vertices, triangles, ours, Form::sheared, theirs, Form::embree_fast);
}

TEST(Disagreement, is_about_hits_and_t_only) {
  EXPECT_FALSE(disagree(miss, miss));
  EXPECT_FALSE(disagree({2, 0.25f, 0.25f, 0}, {2, 0.25f, 0.25f, 2})) << "coincident triangles";
  EXPECT_FALSE(disagree({2, 0, 0, 0}, {2.0001f, 0, 0, 1}));
  EXPECT_TRUE(disagree({2, 0, 0, 0}, {2.001f, 0, 0, 0}));
  EXPECT_TRUE(disagree({2, 0, 0, 0}, miss));
  EXPECT_TRUE(disagree(miss, {2, 0, 0, 0}));
  EXPECT_TRUE(disagree({nan, 0, 0, 0}, {2, 0, 0, 0}));
  EXPECT_FALSE(disagree({0, 0, 0, 0}, {0, 0, 0, 1}));
}

TEST(Disagreement, rounding_of_an_edge_is_an_excuse) {
  const SharedEdge& c = moller_trumbore_leak;
  std::vector<Float3> corners;
  for (const TriangleVertices& tri : {c.first, c.second})
    for (const auto& v : tri.vertex) corners.push_back({v[0], v[1], v[2]});
  const std::vector<Index3> pair = {{0, 1, 2}, {3, 4, 5}};
  const std::uint32_t prim = float_sheared(c.ray, c.first).hit ? 0 : 1;
  const FloatTest hit = float_sheared(c.ray, prim == 0 ? c.first : c.second);
  const Explanation why =
      explain(c.ray, corners, pair, {hit.t, hit.u, hit.v, prim}, Form::sheared, miss, Form::moller_trumbore);
  EXPECT_EQ(why.excuse, Excuse::edge_rounding) << why.sentence;
  const Explanation late = explain(c.ray, corners, pair, {hit.t * 1.01f, hit.u, hit.v, prim}, Form::sheared,
                                   miss, Form::moller_trumbore);
  EXPECT_EQ(late.excuse, Excuse::ours_wrong) << late.sentence;
}

TEST(Disagreement, clear_errors_are_blamed_on_their_side) {
  const Ray ray = make_ray({1, 1, 2}, {0, 0, -1});
  const Hit good = {2, 0.25f, 0.25f, 0}, below = {3, 0.25f, 0.25f, 1};
  for (const Hit& bad : {miss, below, Hit{2.5f, 0, 0, 0}, Hit{nan, 0, 0, 0}, Hit{1, 0, 0, 1}}) {
    const Explanation theirs = explain_floors(ray, good, bad), ours = explain_floors(ray, bad, good);
    EXPECT_EQ(theirs.excuse, Excuse::theirs_wrong) << theirs.sentence;
    EXPECT_EQ(theirs.sentence.rfind("theirs ", 0), 0u) << theirs.sentence;
    EXPECT_EQ(ours.excuse, Excuse::ours_wrong) << ours.sentence;
    EXPECT_EQ(ours.sentence.rfind("ours ", 0), 0u) << ours.sentence;
  }
  const Ray beside = make_ray({3, 3, 2}, {0, 0, -1});
  EXPECT_EQ(explain_floors(beside, good, miss).excuse, Excuse::ours_wrong);
  EXPECT_EQ(explain_floors(ray, good, {2, 0.25f, 0.25f, 2}).excuse, Excuse::none_needed);
}

TEST(Disagreement, the_ends_of_the_segment_and_flat_views_are_excuses) {
  const Hit good = {2, 0.25f, 0.25f, 0};
  const Explanation end = explain_floors(make_ray({1, 1, 2}, {0, 0, -1}, 2, 2.5f), good, miss);
  EXPECT_EQ(end.excuse, Excuse::depth_rounding) << end.sentence;
  const Explanation flat = explain_floors(make_ray({-1, 1, 0}, {1, 0, 0}), miss, {1, 0, 0.25f, 0});
  EXPECT_EQ(flat.excuse, Excuse::degenerate_triangle) << flat.sentence;
}

TEST(Disagreement, a_primitive_out_of_range_is_an_error) {
  try {
    explain_floors(make_ray({1, 1, 2}, {0, 0, -1}), {2, 0, 0, 7}, miss);
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "hit: primitive 7 is out of range, the mesh has 3 triangles");
  }
}

}  // namespace
}  // namespace raylanes::oracle
