// Balls against segments: by the distance of the centre from the segment, and the textbook's quadratic.
#pragma once

#include <limits>

#include <raylanes/intersections.hpp>

#include "../ray/lane_order.hpp"
#include "../triangle/ray_triangle.hpp"

namespace raylanes {
namespace {

// A ray scaled by a power of two, so that its direction's largest component is in [1, 2): exact, and squares
// of directions of any usable length neither over- nor underflow. t counts `unit` times as much.
struct ScaledRay {
  Floats<W> origin[3], direction[3];
  Floats<W> against[3];      // −direction / |direction|²
  Floats<W> inverse_square;  // 1 / |direction|²
  Floats<W> square;          // |direction|²
  Floats<W> tmin, tmax, unit;
};

// What the direction alone determines.
struct DirectionScale {
  Floats<W> power, unit;             // of two, in which the largest component is counted; its reciprocal
  Floats<W> square, inverse_square;  // of the scaled direction
};

inline DirectionScale scale_of(const Floats<W> (&direction)[3]) {
  constexpr Grade plain = Grade::reproducible;  // once per ray: the same bits in both grades
  const Floats<W> largest = max(max(abs(direction[0]), abs(direction[1])), abs(direction[2]));
  DirectionScale scale;
  // A subnormal gives 0, and with it NaN everywhere: a miss.
  scale.power = as<float>(as<std::uint32_t>(largest) & FloatBits<W>(0x7f800000u));
  scale.unit = Floats<W>(1.0f) / scale.power;
  const Floats<W> scaled[3] = {direction[0] * scale.unit, direction[1] * scale.unit,
                               direction[2] * scale.unit};
  scale.square = dot<plain, W>(scaled, scaled);
  scale.inverse_square = Floats<W>(1.0f) / scale.square;
  return scale;
}

inline ScaledRay scale_ray(const Floats<W> (&origin)[3], const Floats<W> (&direction)[3], Floats<W> tmin,
                           Floats<W> tmax, const DirectionScale& scale) {
  ScaledRay ray;
  ray.unit = scale.unit;
  ray.square = scale.square;
  ray.inverse_square = scale.inverse_square;
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = origin[axis];
    ray.direction[axis] = direction[axis] * scale.unit;
    ray.against[axis] = ray.direction[axis] * -scale.inverse_square;
  }
  ray.tmin = tmin * scale.power;
  ray.tmax = tmax * scale.power;
  return ray;
}

struct BallDecision {
  FloatMask<W> hit;
  Floats<W> from_centre[3];  // to the origin: in this order the centre comes straight from memory
  Floats<W> middle;          // t of the line's point nearest to the centre
};

template <Grade grade>
inline Floats<W> square_of_offset(const ScaledRay& ray, const Floats<W> (&from_centre)[3], Floats<W> t) {
  Floats<W> offset[3];
  for (int axis = 0; axis < 3; ++axis)
    offset[axis] = multiply_add<grade>(t, ray.direction[axis], from_centre[axis]);
  return dot<grade, W>(offset, offset);
}

// sphere: centre and radius².
template <Grade grade>
inline BallDecision meets_ball(const ScaledRay& ray, const Floats<W> (&sphere)[4]) {
  BallDecision d;
  for (int axis = 0; axis < 3; ++axis) d.from_centre[axis] = ray.origin[axis] - sphere[axis];
  d.middle = dot<grade, W>(d.from_centre, ray.against);
  const Floats<W> nearest = min(max(d.middle, ray.tmin), ray.tmax);
  d.hit = square_of_offset<grade>(ray, d.from_centre, nearest) <= sphere[3];
  return d;
}

struct BallDistances {
  FloatMask<W> hit;
  Floats<W> near, far;
};

// D² − r² again in double, for the lanes in `cancelled`: products of floats are exact there. Out of line,
// lane by lane: only the surroundings of a sphere large against its distance need it.
[[gnu::noinline, maybe_unused]] void power_in_double(const ScaledRay& ray, const Floats<W> (&sphere)[4],
                                                     Floats<W>& power, std::uint32_t cancelled) {
  float origin[3][W], centre[3][W], square[W], result[W];
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis].store(origin[axis]);
    sphere[axis].store(centre[axis]);
  }
  sphere[3].store(square);
  power.store(result);
  for (int i = 0; i < W; ++i) {
    if ((cancelled >> i & 1u) == 0) continue;
    double sum = -static_cast<double>(square[i]);
    for (int axis = 2; axis >= 0; --axis) {
      const double f = static_cast<double>(centre[axis][i]) - static_cast<double>(origin[axis][i]);
      sum += f * f;
    }
    result[i] = static_cast<float>(sum);
  }
  power = Floats<W>::load(result);
}

// The roots as the larger one, q, by addition of equal signs, and the other as their product over q.
template <Grade grade>
inline BallDistances ball_distances(const ScaledRay& ray, const Floats<W> (&sphere)[4]) {
  const Floats<W> zero(0.0f), infinity(std::numeric_limits<float>::infinity());
  const BallDecision d = meets_ball<grade>(ray, sphere);
  const Floats<W> free = sphere[3] - square_of_offset<grade>(ray, d.from_centre, d.middle);
  const Floats<W> half_chord = sqrt(max(free, zero) * ray.inverse_square);
  const Floats<W> q = d.middle + flip<W>(half_chord, sign_of<W>(d.middle));
  Floats<W> power = dot<grade, W>(d.from_centre, d.from_centre) - sphere[3];
  const FloatMask<W> cancelled = d.hit & (abs(power) < Floats<W>(0.25f) * sphere[3]) & (sphere[3] < infinity);
  if (any(cancelled)) [[unlikely]]
    power_in_double(ray, sphere, power, bits(cancelled));
  // q = 0: the line touches the sphere at the origin.
  const Floats<W> other = select(q == zero, zero, power * ray.inverse_square / q);
  // The second operand stands for a NaN: radius² = inf, all of space.
  const Floats<W> near = max(min(q, other) * ray.unit, -infinity);
  const Floats<W> far = min(max(q, other) * ray.unit, infinity);
  return {d.hit, near + zero, far + zero};
}

// b² − 4ac with the whole ray in it.
template <Grade grade>
inline BallDistances textbook_distances(const ScaledRay& ray, const Floats<W> (&sphere)[4]) {
  const Floats<W> zero(0.0f), two(2.0f), four(4.0f);
  Floats<W> f[3];
  for (int axis = 0; axis < 3; ++axis) f[axis] = ray.origin[axis] - sphere[axis];
  const Floats<W> a = ray.square, b = two * dot<grade, W>(f, ray.direction);
  const Floats<W> c = dot<grade, W>(f, f) - sphere[3];
  const Floats<W> discriminant = multiply_add<grade>(b, b, -(four * a * c));
  const Floats<W> root = sqrt(max(discriminant, zero)), half = Floats<W>(0.5f) * ray.inverse_square;
  const Floats<W> near = (-b - root) * half, far = (root - b) * half;
  const FloatMask<W> hit = (discriminant >= zero) & (near <= ray.tmax) & (far >= ray.tmin);
  return {hit, near * ray.unit + zero, far * ray.unit + zero};
}

// Two unit vectors across a direction, so that their products with the way to a centre are the two
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

// to_centre in the order of the frame's axes.
template <Grade grade>
inline FloatMask<W> line_meets(const Floats<W> (&first)[3], const Floats<W> (&second)[3],
                               const Floats<W> (&to_centre)[3], Floats<W> radius_square) {
  const Floats<W> x = dot<grade, W>(first, to_centre);
  const Floats<W> y = multiply_add<grade>(second[2], to_centre[2], second[1] * to_centre[1]);
  return multiply_add<grade>(x, x, y * y) <= radius_square;
}

}  // namespace
}  // namespace raylanes
