// A ray scaled by a power of two, so that its direction's largest component is in [1, 2): exact, and squares
// of directions of any usable length neither over- nor underflow.
#pragma once

#include <limits>

#include <raylanes/spheres.hpp>

#include "../ray/ray_columns.hpp"
#include "../simd/vec3.hpp"

namespace raylanes {
namespace {

// The numbers that the direction alone determines.
template <class V>
struct DirectionScale {
  V scale, unit;             // one of two, in which the largest component is counted; its reciprocal
  V square, inverse_square;  // of the scaled direction
};

template <class V>
inline DirectionScale<V> scale_of(const V (&direction)[3]) {
  V largest = max(max(abs(direction[0]), abs(direction[1])), abs(direction[2]));
  DirectionScale<V> s;
  // A subnormal gives 0, and with it NaN everywhere: a miss.
  s.scale = as<float>(as<std::uint32_t>(largest) & decltype(as<std::uint32_t>(largest))(0x7f800000u));
  s.unit = V(1.0f) / s.scale;
  Vec3<V> scaled{direction[0] * s.unit, direction[1] * s.unit, direction[2] * s.unit};
  s.square =
      Arithmetic<Grade::reproducible>::dot(scaled, scaled);  // once per ray: the same bits in both grades
  s.inverse_square = V(1.0f) / s.square;
  return s;
}

// t counts `unit` times as much.
template <class V>
struct ScaledRayOf {
  Vec3<V> origin, direction;
  Vec3<V> against;   // −direction / |direction|²
  V inverse_square;  // 1 / |direction|²
  V square;          // |direction|²
  V tmin, tmax, unit;

  ScaledRayOf(const V (&o)[3], const V (&d)[3], V first, V last, const DirectionScale<V>& s)
      : origin(vec3(o)),
        direction{d[0] * s.unit, d[1] * s.unit, d[2] * s.unit},
        inverse_square(s.inverse_square),
        square(s.square),
        tmin(first * s.scale),
        tmax(last * s.scale),
        unit(s.unit) {
    V back = -s.inverse_square;
    against = {direction.x * back, direction.y * back, direction.z * back};
  }
};

using ScaledRay = ScaledRayOf<Floats<W>>;

// The two distances at which a line meets a sphere, where it does.
template <class V>
struct SphereDistancesOf {
  decltype(V() < V()) hit;
  V near, far;
};
using SphereDistances = SphereDistancesOf<Floats<W>>;

}  // namespace
}  // namespace raylanes
