// Balls against segments by the quadratic equation, b² − 4ac with the whole ray in it; see SphereTest::textbook.
#pragma once

#include "scaled_ray.hpp"

namespace raylanes {
namespace {

template <Grade grade>
struct TextbookSphere : Arithmetic<grade> {
  static constexpr SphereTest id = SphereTest::textbook;
  static constexpr int floats = 4;
  using V = Floats<W>;
  using Arithmetic<grade>::dot;

  static SphereDistances distances(const ScaledRay& ray, const V (&sphere)[4]) {
    V zero(0.0f), two(2.0f), four(4.0f);
    Vec3<V> f = ray.origin - vec3(sphere);
    V a = ray.square, b = two * dot(f, ray.direction);
    V c = dot(f, f) - sphere[3];
    V discriminant = multiply_add<grade>(b, b, -(four * a * c));
    V root = sqrt(max(discriminant, zero)), half = V(0.5f) * ray.inverse_square;
    V near = (-b - root) * half, far = (root - b) * half;
    FloatMask<W> hit = (discriminant >= zero) & (near <= ray.tmax) & (far >= ray.tmin);
    return {hit, near * ray.unit + zero, far * ray.unit + zero};
  }
  static FloatMask<W> hits(const ScaledRay& ray, const V (&sphere)[4]) { return distances(ray, sphere).hit; }
};

}  // namespace
}  // namespace raylanes
