// Balls against whole lines: in the plane across the direction the line is a point.
#pragma once

#include "../ray/ray_columns.hpp"
#include "../simd/vec3.hpp"

namespace raylanes {
namespace {

// Two unit vectors across a direction, so that their products with the vector to a centre are the two
// coordinates in which the line is a point: five multiplications for the distance instead of nine. The second
// has no component along `axis[0]`, the axis of the least |direction|. In double, once per ray.
struct LineFrame {
  int axis[3];
  float first[3], second[3];  // components in the order of `axis`; second[0] is 0
};

inline LineFrame line_frame(const Float3& direction) {
  const auto magnitude = [&](int k) { return direction[k] < 0.0f ? -direction[k] : direction[k]; };
  int least = magnitude(1) < magnitude(0) ? 1 : 0;
  if (magnitude(2) < magnitude(least)) least = 2;
  LineFrame frame{{least, (least + 1) % 3, (least + 2) % 3}, {}, {}};
  double d[3], length = 0.0;
  for (int k = 0; k < 3; ++k) {
    d[k] = static_cast<double>(direction[frame.axis[k]]);
    length += d[k] * d[k];
  }
  length = __builtin_sqrt(length);
  const double across = __builtin_sqrt(d[1] * d[1] + d[2] * d[2]);
  const double s[3] = {0.0, d[2] / across, -d[1] / across};
  const double f[3] = {d[1] * s[2] - d[2] * s[1], -d[0] * s[2], d[0] * s[1]};
  for (int k = 0; k < 3; ++k) {
    frame.first[k] = static_cast<float>(f[k] / length);
    frame.second[k] = static_cast<float>(s[k]);
  }
  return frame;
}

// to_origin leads from the centre, in the order of the frame's axes.
template <Grade grade>
inline FloatMask<W> line_hits(const Vec3<Floats<W>>& first, const Vec3<Floats<W>>& second,
                              const Vec3<Floats<W>>& to_origin, Floats<W> squared_radius) {
  Floats<W> x = Arithmetic<grade>::dot(first, to_origin);
  Floats<W> y = multiply_add<grade>(second.z, to_origin.z, second.y * to_origin.y);
  return multiply_add<grade>(x, x, y * y) <= squared_radius;
}

}  // namespace
}  // namespace raylanes
