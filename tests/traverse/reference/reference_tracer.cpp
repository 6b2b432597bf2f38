#include "reference_tracer.hpp"

#include "../../support/random_input.hpp"
#include "../../support/system/fused.hpp"

namespace raylanes::testing {
namespace {

constexpr Hit no_hit{infinity, 0, 0, no_primitive};

bool all_finite(const Float3& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

bool is_valid(const Ray& ray, const Triangle& triangle) {
  const bool still = ray.direction[0] == 0 && ray.direction[1] == 0 && ray.direction[2] == 0;
  return all_finite(ray.origin) && all_finite(ray.direction) && !still && ray.tmin <= ray.tmax &&
         std::all_of(triangle.corner, triangle.corner + 3, all_finite);
}

struct Axes {
  std::size_t kx, ky, kz;
};

Axes axes_of(const Float3& direction) {
  const float x = std::fabs(direction[0]), y = std::fabs(direction[1]), z = std::fabs(direction[2]);
  const std::size_t kz = x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
  Axes axes{(kz + 1) % 3, (kz + 2) % 3, kz};
  if (direction[kz] < 0) std::swap(axes.kx, axes.ky);
  return axes;
}

// The weights of the three corners: twice the areas that the origin spans with the opposite edges.
template <class Real>
std::array<float, 3> weights(const ShearedTriangle& s) {
  const auto area = [&](std::size_t p, std::size_t q) {
    return static_cast<float>(Real(s.x[p]) * Real(s.y[q]) - Real(s.y[p]) * Real(s.x[q]));
  };
  return {area(2, 1), area(0, 2), area(1, 0)};
}

bool same_side(const std::array<float, 3>& w) {
  return std::all_of(w.begin(), w.end(), [](float x) { return x >= 0; }) ||
         std::all_of(w.begin(), w.end(), [](float x) { return x <= 0; });
}

}  // namespace

ShearedTriangle shear_triangle(const Ray& ray, const Triangle& triangle, bool fused) {
  const auto [kx, ky, kz] = axes_of(ray.direction);
  const float depth = ray.direction[kz];
  const float shear_x = ray.direction[kx] / depth, shear_y = ray.direction[ky] / depth, unit = 1 / depth;
  const auto sheared = [fused](float p, float shear, float z) {
    return fused ? fused_multiply_add(-shear, z, p) : p - shear * z;
  };
  ShearedTriangle s{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Float3& v = triangle.corner[i];
    const float z = v[kz] - ray.origin[kz];
    s.x[i] = sheared(v[kx] - ray.origin[kx], shear_x, z);
    s.y[i] = sheared(v[ky] - ray.origin[ky], shear_y, z);
    s.z[i] = unit * z;
  }
  return s;
}

bool axis_passes(const ShearedTriangle& s) {
  // 24 + 24 bits fit a double: the products are exact, and comparing them is too.
  const auto sign = [&](std::size_t p, std::size_t q) {
    const double a = double(s.x[p]) * s.y[q], b = double(s.y[p]) * s.x[q];
    return a > b ? 1 : (a < b ? -1 : 0);
  };
  const auto [least, most] = std::minmax({sign(2, 1), sign(0, 2), sign(1, 0)});
  return least * most >= 0 && (least != 0 || most != 0);
}

Hit canonical_hit(const Ray& ray, const Triangle& triangle) {
  if (!is_valid(ray, triangle)) return no_hit;
  const ShearedTriangle s = shear_triangle(ray, triangle, false);
  std::array<float, 3> w = weights<float>(s);
  if (same_side(w) && std::count(w.begin(), w.end(), 0.0f) > 0) w = weights<double>(s);
  const float det = w[0] + w[1] + w[2];
  if (!same_side(w) || det == 0) return no_hit;
  const float depth = w[0] * s.z[0] + w[1] * s.z[1] + w[2] * s.z[2];
  // The sign of a zero must not depend on the winding: adding +0 makes it positive.
  const float t = depth / det + 0.0f;
  if (!(t >= ray.tmin && t <= ray.tmax && t < infinity)) return no_hit;
  return {t, w[1] / det + 0.0f, w[2] / det + 0.0f, 0};
}

std::vector<Hit> brute_force(std::span<const Float3> vertices, std::span<const Index3> triangles,
                             std::span<const Ray> rays) {
  std::vector<Triangle> flat;
  for (const Index3& triangle : triangles) flat.push_back(triangle_of(vertices, triangle));
  std::vector<Hit> hits;
  for (const Ray& ray : rays) {
    Hit best = no_hit;
    for (std::uint32_t i = 0; i < flat.size(); ++i) {
      const Hit hit = canonical_hit(ray, flat[i]);
      // Primitives come in rising order: of equal t the first stays.
      if (hit.primitive == 0 && (best.primitive == no_primitive || hit.t < best.t)) {
        best = hit;
        best.primitive = i;
      }
    }
    hits.push_back(best);
  }
  return hits;
}

}  // namespace raylanes::testing
