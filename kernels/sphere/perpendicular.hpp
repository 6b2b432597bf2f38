// Balls against segments by the distance of the centre from the segment, see SphereTest::perpendicular.
#pragma once

#include "scaled_ray.hpp"

namespace raylanes {
namespace {

// D² − r² again in double, for the lanes in `cancelled`: products of floats are exact there. Out of line,
// lane by lane: only the surroundings of a sphere large against its distance need it.
template <int N>
[[gnu::noinline, maybe_unused]] void excess_in_double(const ScaledRayOf<Floats<N>>& ray,
                                                      const Floats<N> (&sphere)[4], Floats<N>& excess,
                                                      std::uint32_t cancelled) {
  float origin[3][N], centre[3][N], square[N], result[N];
  ray.origin.x.store(origin[0]), ray.origin.y.store(origin[1]), ray.origin.z.store(origin[2]);
  for (int axis = 0; axis < 3; ++axis) sphere[axis].store(centre[axis]);
  sphere[3].store(square);
  excess.store(result);
  for (int i = 0; i < N; ++i) {
    if ((cancelled >> i & 1u) == 0) continue;
    double sum = -static_cast<double>(square[i]);
    for (int axis = 2; axis >= 0; --axis) {
      const double f = static_cast<double>(centre[axis][i]) - static_cast<double>(origin[axis][i]);
      sum += f * f;
    }
    result[i] = static_cast<float>(sum);
  }
  excess = Floats<N>::load(result);
}

// A sphere is its centre and radius². In N lanes.
template <Grade grade, int N>
struct PerpendicularInLanes : Arithmetic<grade> {
  static constexpr SphereTest id = SphereTest::perpendicular;
  static constexpr int floats = 4;
  using V = Floats<N>;
  using AnyScaledRay = ScaledRayOf<V>;
  using Arithmetic<grade>::dot;

  struct Decision {
    FloatMask<N> hit;
    Vec3<V> from_centre;  // to the origin: in this order the centre comes straight from memory
    V middle;             // t of the line's point nearest to the centre
  };

  static V square_of_offset(const AnyScaledRay& ray, const Vec3<V>& from_centre, V t) {
    Vec3<V> offset{multiply_add<grade>(t, ray.direction.x, from_centre.x),
                   multiply_add<grade>(t, ray.direction.y, from_centre.y),
                   multiply_add<grade>(t, ray.direction.z, from_centre.z)};
    return dot(offset, offset);
  }
  static Decision decide(const AnyScaledRay& ray, const V (&sphere)[4]) {
    Decision d;
    d.from_centre = ray.origin - vec3(sphere);
    d.middle = dot(d.from_centre, ray.against);
    V nearest = min(max(d.middle, ray.tmin), ray.tmax);
    d.hit = square_of_offset(ray, d.from_centre, nearest) <= sphere[3];
    return d;
  }
  static FloatMask<N> hits(const AnyScaledRay& ray, const V (&sphere)[4]) { return decide(ray, sphere).hit; }

  // The roots as the larger one, q, by addition of equal signs, and the other as their product over q.
  static SphereDistancesOf<V> distances(const AnyScaledRay& ray, const V (&sphere)[4]) {
    V zero(0.0f), infinity(std::numeric_limits<float>::infinity());
    Decision d = decide(ray, sphere);
    V free = sphere[3] - square_of_offset(ray, d.from_centre, d.middle);
    V half_chord = sqrt(max(free, zero) * ray.inverse_square);
    V q = d.middle + flip(half_chord, sign_of(d.middle));
    V excess = dot(d.from_centre, d.from_centre) - sphere[3];
    FloatMask<N> cancelled = d.hit & (abs(excess) < V(0.25f) * sphere[3]) & (sphere[3] < infinity);
    if (any(cancelled)) [[unlikely]]
      excess_in_double<N>(ray, sphere, excess, bits(cancelled));
    // q = 0: the line touches the sphere at the origin.
    V other = select(q == zero, zero, excess * ray.inverse_square / q);
    // The second operand stands for a NaN: radius² = inf, all of space.
    return {d.hit, max(min(q, other) * ray.unit, -infinity) + zero,
            min(max(q, other) * ray.unit, infinity) + zero};
  }
};
template <Grade grade>
struct PerpendicularSphere : PerpendicularInLanes<grade, W> {};

}  // namespace
}  // namespace raylanes
