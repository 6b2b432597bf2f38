// The inputs of every row: the same few rays and primitives on every machine.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <raylanes/types.hpp>

#include "../../bench/support/scenes/splitmix.hpp"

namespace raylanes::testing {

// Arrays of such sizes, some of whose elements take part.
inline constexpr std::size_t most = 67, sizes[] = {1, 7, 16, 33, most};
inline constexpr float infinity = std::numeric_limits<float>::infinity(), untouched = 7;
inline const std::vector<std::uint8_t> some_lanes(most / 8 + 1, 0xb5);

template <class Element, std::size_t count>
struct Columns {
  std::vector<Element> elements;
  std::vector<float> number[count];
  template <class NumbersOf>
  Columns(std::vector<Element> all, NumbersOf numbers_of) : elements(std::move(all)) {
    for (const Element& element : elements) {
      const std::array<float, count> numbers = numbers_of(element);
      for (std::size_t k = 0; k < count; ++k) number[k].push_back(numbers[k]);
    }
  }
  const float* operator[](std::size_t k) const { return number[k].data(); }
};

class Source {
 public:
  explicit Source(std::uint64_t seed) : bits_(seed) {}
  float number(double lo, double hi) { return static_cast<float>(lo + (hi - lo) * bits_.uniform()); }
  Float3 point(double half) { return {number(-half, half), number(-half, half), number(-half, half)}; }

 private:
  bench::SplitMix bits_;
};

inline std::vector<Triangle> some_triangles() {
  Source source(1);
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < most; ++i)
    triangles.push_back({{source.point(1), source.point(1), source.point(1)}});
  return triangles;
}

// From anywhere or from `eye`, some parallel to an axis, some short, some that hit nothing; all with `direction`.
inline std::vector<Ray> some_rays(const Float3* eye = nullptr, const Float3* direction = nullptr) {
  Source source(2);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < most; ++i) {
    Ray ray{eye != nullptr ? *eye : source.point(2), 0, source.point(1), infinity};
    if (i % 11 == 3) ray.direction[i % 3] = 0;
    if (direction != nullptr) ray.direction = *direction;
    if (i % 7 == 2) ray.tmin = 0.5f, ray.tmax = 1.5f;
    if (i % 13 == 5) ray.origin[1] = std::numeric_limits<float>::quiet_NaN();
    if (i % 17 == 9) ray.tmax = -1;
    rays.push_back(ray);
  }
  return rays;
}

// From anywhere to `end`, of which some stop short.
inline std::vector<Ray> rays_to(const Float3& end) {
  std::vector<Ray> rays = some_rays();
  for (std::size_t i = 0; i < most; ++i) {
    Ray& ray = rays[i];
    for (std::size_t axis = 0; axis < 3; ++axis) ray.direction[axis] = end[axis] - ray.origin[axis];
    ray.tmin = 0, ray.tmax = i % 5 == 4 ? 0.5f : 1.0f;
  }
  return rays;
}

struct RayColumns : Columns<Ray, 8> {
  explicit RayColumns(const Float3* direction = nullptr)
      : Columns(some_rays(nullptr, direction), [](const Ray& ray) {
          const auto& [o, tmin, d, tmax] = ray;
          return std::array{o[0], o[1], o[2], d[0], d[1], d[2], tmin, tmax};
        }) {}
  RayArrays arrays(std::size_t n) const {
    const RayColumns& p = *this;
    return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, p[6], p[7], n};
  }
};

struct TriangleColumns : Columns<Triangle, 9> {
  TriangleColumns()
      : Columns(some_triangles(), [](const Triangle& triangle) {
          const auto& [a, b, c] = triangle.corner;
          return std::array{a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]};
        }) {}
  TriangleArrays arrays(std::size_t n) const {
    const TriangleColumns& p = *this;
    return {{{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, {p[6], p[7], p[8]}}, n};
  }
};

struct BoxColumns : Columns<Box, 6> {
  BoxColumns()
      : Columns(boxes(), [](const Box& box) {
          return std::array{box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1], box.hi[2]};
        }) {}
  static std::vector<Box> boxes() {
    std::vector<Box> all;
    for (const Triangle& triangle : some_triangles()) {
      const auto& [a, b, c] = triangle.corner;
      all.push_back({a, a});
      for (std::size_t k = 0; k < 3; ++k)
        all.back().lo[k] = std::min(a[k], b[k]), all.back().hi[k] = std::max(a[k], b[k]);
    }
    return all;
  }
  BoxArrays arrays(std::size_t n) const {
    const BoxColumns& p = *this;
    return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, n};
  }
};

struct SphereColumns : Columns<Sphere, 4> {
  SphereColumns()
      : Columns(spheres(), [](const Sphere& sphere) {
          const Float3& c = sphere.centre;
          return std::array{c[0], c[1], c[2], signed_square(sphere.radius)};
        }) {}
  static std::vector<Sphere> spheres() {
    Source source(3);
    std::vector<Sphere> all;
    for (std::size_t i = 0; i < most; ++i) all.push_back({source.point(1), source.number(0.2, 1)});
    return all;
  }
  SphereArrays arrays(std::size_t n) const {
    const SphereColumns& p = *this;
    return {{p[0], p[1], p[2]}, p[3], n};
  }
};

}  // namespace raylanes::testing
