// Vectors of double precision for scenes, ray sets and pictures, none of which is timed.
#pragma once

#include <raylanes/mesh.hpp>

#include "../std.hpp"

namespace raylanes::bench {

using Double3 = std::array<double, 3>;

inline Double3 to_double(const Float3& v) {
  return {v[0], v[1], v[2]};
}
inline Double3 to_double(const float v[3]) {
  return {v[0], v[1], v[2]};
}
inline Float3 to_float(const Double3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}
inline Double3 add(const Double3& a, const Double3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Double3 subtract(const Double3& a, const Double3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Double3 scale(const Double3& v, double s) {
  return {v[0] * s, v[1] * s, v[2] * s};
}
inline double dot(const Double3& a, const Double3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Double3& v) {
  return std::hypot(v[0], v[1], v[2]);
}
// v scaled to length 1; NaN for a zero vector.
inline Double3 normalized(const Double3& v) {
  return scale(v, 1 / length(v));
}

}  // namespace raylanes::bench
