// Triangle tests as plain float code, written apart from the library, and seeded cases for them: what the
// exact oracle's bounds are held against.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "../../bench/support/oracles/exact_triangle.hpp"
#include "../support/system/fused.hpp"

namespace raylanes::oracle {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();
using Float = std::array<float, 3>;

inline Ray make_ray(Float o, Float d, float tmin = 0, float tmax = infinity) {
  return {{o[0], o[1], o[2]}, tmin, {d[0], d[1], d[2]}, tmax};
}
inline Triangle make_triangle(Float a, Float b, Float c) {
  return {{{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, {c[0], c[1], c[2]}}};
}
inline Float minus(const Float3& a, const Float3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// Float tests under test: what they computed, in the names and the scale of ExactTriangleTest.
struct FloatTest {
  bool hit;
  float weight[3], det, depth, t, u, v;
};

inline float difference_of_products(float a, float b, float c, float d, bool fused) {
  return fused ? testing::fused_multiply_add(a, b, -(c * d)) : a * b - c * d;
}
inline Float cross(const Float& a, const Float& b, bool fused) {
  return {difference_of_products(a[1], b[2], a[2], b[1], fused),
          difference_of_products(a[2], b[0], a[0], b[2], fused),
          difference_of_products(a[0], b[1], a[1], b[0], fused)};
}
inline float dot(const Float& a, const Float& b, bool fused) {
  if (fused)
    return testing::fused_multiply_add(a[2], b[2], testing::fused_multiply_add(a[1], b[1], a[0] * b[0]));
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline FloatTest float_moller_trumbore(const Ray& ray, const Triangle& tri, bool fused) {
  const Float d = {ray.direction[0], ray.direction[1], ray.direction[2]};
  const Float e1 = minus(tri.corner[1], tri.corner[0]), e2 = minus(tri.corner[2], tri.corner[0]);
  const Float s = minus(ray.origin, tri.corner[0]);
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
inline FloatTest float_sheared(const Ray& ray, const Triangle& tri) {
  const Float3& d = ray.direction;
  int kz = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(d[i]) > std::abs(d[kz])) kz = i;
  int kx = (kz + 1) % 3, ky = (kx + 1) % 3;
  if (d[kz] < 0) std::swap(kx, ky);
  const float sx = d[kx] / d[kz], sy = d[ky] / d[kz], sz = 1 / d[kz];
  float x[3], y[3], z[3];
  for (int i = 0; i < 3; ++i) {
    const Float p = minus(tri.corner[i], ray.origin);
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

enum class Cases { uniform, edge_aimed, far, offset };
inline const char* name(Cases c) {
  constexpr const char* names[] = {"uniform", "edge_aimed", "far", "offset"};
  return names[static_cast<int>(c)];
}

struct Case {
  Ray ray;
  Triangle triangle;
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
  FloatTest (*run)(const Ray&, const Triangle&);
};
inline const Method methods[] = {
    {"moller_trumbore", Form::moller_trumbore,
     [](const Ray& r, const Triangle& t) { return float_moller_trumbore(r, t, false); }},
    {"moller_trumbore fused", Form::moller_trumbore,
     [](const Ray& r, const Triangle& t) { return float_moller_trumbore(r, t, true); }},
    {"sheared", Form::sheared, float_sheared},
};

// The scale of a form's weights against the exact ones.
inline mpq_class form_scale(Form form, const Ray& ray) {
  if (form != Form::sheared) return 1;
  return mpq_class(
      std::max({std::abs(ray.direction[0]), std::abs(ray.direction[1]), std::abs(ray.direction[2])}));
}

inline double ratio(float computed, const mpq_class& scale, const mpq_class& exact, const mpq_class& bound) {
  const mpq_class error = abs(mpq_class(computed) * scale - exact);
  return error == 0 ? 0 : mpq_class(error / bound).get_d();
}

struct Ratios {
  double weight = 0, det = 0, depth = 0, t = 0, uv = 0;
};

inline void measure(const FloatTest& f, const mpq_class& scale, const ExactTriangleTest& e,
                    const ErrorBounds& b, Ratios& worst) {
  for (std::size_t i = 0; i < 3; ++i)
    worst.weight = std::max(worst.weight, ratio(f.weight[i], scale, e.weight[i], b.weight[i]));
  worst.det = std::max(worst.det, ratio(f.det, scale, e.det, b.det));
  worst.depth = std::max(worst.depth, ratio(f.depth, scale, e.depth, b.depth));
  if (!b.t) return;
  worst.t = std::max(worst.t, ratio(f.t, 1, e.t, *b.t));
  worst.uv = std::max({worst.uv, ratio(f.u, 1, e.u, *b.u), ratio(f.v, 1, e.v, *b.v)});
}

inline bool contradicts(Class c, bool hit) {
  return (c == Class::must_hit && !hit) || (c == Class::must_miss && hit);
}

inline const Triangle floor_triangle = make_triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});

// Two triangles (p,q,s) and (q,p,w) and a ray at their shared edge pq.
struct SharedEdge {
  Ray ray;
  Triangle first, second;
};
inline SharedEdge shared_edge(Float o, Float d, Float p, Float q, Float s, Float w) {
  return {make_ray(o, d), make_triangle(p, q, s), make_triangle(q, p, w)};
}
// Möller and Trumbore's test lets this one through.
inline const SharedEdge moller_trumbore_leak = shared_edge(
    {0, 0, 0}, {-0x1.2569cp-1f, 0x1.99509ep-2f, 0x1.b64bcap+0f},
    {-0x1.9769dcp-1f, 0x1.70ab2cp-1f, 0x1.93d2d4p+0f}, {0x1.3e1aap-4f, -0x1.12ade8p-1f, 0x1.0d85bep+1f},
    {0x1.dee458p-1f, 0x1.5e3d58p-1f, 0x1.8e7fdp+0f}, {-0x1.80d8b6p-1f, -0x1.10c542p-1f, 0x1.8ef12ap+0f});

}  // namespace raylanes::oracle
