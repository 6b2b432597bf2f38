// Positions of hits, and normals of the surface there: header-only, computed in doubles.
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>

#include <raylanes/scene_d.hpp>
#include <raylanes/types.hpp>

namespace raylanes {

namespace detail {

template <class Point>
[[gnu::always_inline]] inline Point unit_of(const double (&vector)[3]) {
  const double length = std::hypot(vector[0], vector[1], vector[2]);
  Point unit;
  for (std::size_t k = 0; k < 3; ++k) unit[k] = static_cast<typename Point::value_type>(vector[k] / length);
  return unit;
}
template <class Point>
[[gnu::always_inline]] inline Point unit_normal(const Point (&corner)[3]) {
  double first[3], second[3], normal[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const auto origin = static_cast<double>(corner[0][k]);
    first[k] = static_cast<double>(corner[1][k]) - origin;
    second[k] = static_cast<double>(corner[2][k]) - origin;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t y = (k + 1) % 3, z = (k + 2) % 3;
    normal[k] = first[y] * second[z] - first[z] * second[y];
  }
  return unit_of<Point>(normal);
}
template <class Point, class AnyRay>
Point point_at(const AnyRay& ray, double t) {
  Point point;
  for (std::size_t k = 0; k < 3; ++k)
    point[k] = static_cast<typename Point::value_type>(static_cast<double>(ray.origin[k]) +
                                                       t * static_cast<double>(ray.direction[k]));
  return point;
}

// Turns the normals of an instance: the cofactors of its transform, of the sign of its determinant.
class NormalMatrix {
 public:
  template <class AnyTransform>
  explicit NormalMatrix(const AnyTransform& transform) {
    double row[3][3], determinant = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) row[i][j] = static_cast<double>(transform.row[i][j]);
    for (std::size_t i = 0; i < 3; ++i) {
      const double(&a)[3] = row[(i + 1) % 3], (&b)[3] = row[(i + 2) % 3];
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t y = (j + 1) % 3, z = (j + 2) % 3;
        cofactor_[i][j] = a[y] * b[z] - a[z] * b[y];
        determinant += i == 0 ? cofactor_[i][j] * row[0][j] : 0;
      }
    }
    side_ = determinant / std::abs(determinant);
  }
  template <class Point>
  Point operator()(const Point& normal) const {
    double turned[3] = {};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) turned[i] += cofactor_[i][j] * static_cast<double>(normal[j]);
      turned[i] *= side_;
    }
    return unit_of<Point>(turned);
  }

 private:
  double cofactor_[3][3], side_;
};

}  // namespace detail

/// Returns the unit normal of a triangle, along (v1 − v0) × (v2 − v0), rounded to float; NaN without an area.
inline Float3 unit_normal(const Triangle& triangle) {
  return detail::unit_normal(triangle.corner);
}
/// Returns the unit normal of a triangle of doubles; NaN without an area, or if a product overflows.
inline Double3 unit_normal(const TriangleD& triangle) {
  return detail::unit_normal(triangle.corner);
}
/// Returns origin + t·direction, rounded to float: off along the ray by the rounding of t. NaN or infinite for a miss.
inline Float3 position(const Ray& ray, float t) {
  return detail::point_at<Float3>(ray, static_cast<double>(t));
}
/// Returns origin + t·direction of doubles; NaN or infinite for a miss.
inline Double3 position(const RayD& ray, double t) {
  return detail::point_at<Double3>(ray, t);
}
/// Returns the unit normal in the scene of a normal in the space of an instance. It points out of a solid if the normal
/// does, also where the transform mirrors the solid. NaN if the transform is singular.
inline Float3 normal_in_scene(const Transform& transform, const Float3& normal) {
  return detail::NormalMatrix(transform)(normal);
}
/// Returns the unit normal in a scene of doubles of a normal in the space of an instance; NaN also if a product of four
/// numbers of the transform overflows.
template <std::same_as<TransformD> AnyTransform>
Double3 normal_in_scene(const AnyTransform& transform, const Double3& normal) {
  return detail::NormalMatrix(transform)(normal);
}

}  // namespace raylanes
