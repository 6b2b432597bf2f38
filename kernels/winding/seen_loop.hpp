// A loop of a boundary as a point sees it, of floats or of doubles: directions and normals to full precision.
#pragma once

#include "../../dispatch/bits.hpp"
#include "../../dispatch/table/frame.hpp"
#include "../exact/cross_product.hpp"
#include "solid_angle.hpp"

namespace raylanes {
namespace {

using Number = Lanes<double, 1>;
using Vector = Vec3<Number>;

using Reproducible = Arithmetic<Grade::reproducible>;

double dot_product(const Vector& a, const Vector& b) {
  return Reproducible::dot(a, b).raw;
}
Vector times(const Vector& a, Number factor) {
  return {a.x * factor, a.y * factor, a.z * factor};
}
bool is_zero(const Vector& a) {
  return a.x.raw == 0.0 && a.y.raw == 0.0 && a.z.raw == 0.0;
}
Vector vector_of(const double (&xyz)[3]) {
  return {xyz[0], xyz[1], xyz[2]};
}
int sign_of(double x) {
  return (x > 0.0 ? 1 : 0) - (x < 0.0 ? 1 : 0);
}
double length_of(const Vector& a) {
  return sqrt(Number(dot_product(a, a))).raw;
}

// The sum of numbers whose differences are exact, with its sign and within two ULPs: kept as parts that do not overlap
// (Shewchuk 1997).
double sum_of(const double (&terms)[6]) {
  double parts[6];
  int count = 0;
  for (double term : terms) {
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      const double part = parts[i], sum = term + part, of_part = sum - term;
      const double rest = (term - (sum - of_part)) + (part - of_part);
      if (rest != 0.0) parts[kept++] = rest;
      term = sum;
    }
    if (term != 0.0) parts[kept++] = term;
    count = kept;
  }
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += parts[i];
  return sum;
}

// The vector from a point to a corner, times 2^-exponent.
struct Sight {
  Vector vector;
  int exponent = 0;
};

// The part that differs with numbers T: floats have exact products in doubles, and no vector that overflows or is
// flushed.
template <class T>
struct Exactly;
template <>
struct Exactly<float> {
  static Sight sight(const double (&from)[3], const double (&to)[3]) {
    return {{to[0] - from[0], to[1] - from[1], to[2] - from[2]}};
  }
  // Each component within two ULPs.
  static Sight normal(const double (&point)[3], const double (&a)[3], const double (&b)[3]) {
    const auto component = [&](int y, int z) {
      return sum_of({a[y] * b[z], -(a[z] * b[y]), a[z] * point[y], -(a[y] * point[z]), b[y] * point[z],
                     -(b[z] * point[y])});
    };
    return {{component(1, 2), component(2, 0), component(0, 1)}};
  }
  static Vector over_sizes(const Sight& normal, const Sight& a, const Sight& b) {
    return times(normal.vector, 1.0 / (length_of(a.vector) * length_of(b.vector)));
  }
  static float number(double x) { return float_of(x); }
};
template <>
struct Exactly<double> {
  // Halves, if a difference overflows: the largest component is 1 to 2 in size.
  static Sight sight(const double (&from)[3], const double (&to)[3]) {
    Double3 d;
    bool overflows = false;
    for (std::size_t k = 0; k < 3; ++k) d[k] = to[k] - from[k], overflows = overflows || d[k] - d[k] != 0.0;
    if (overflows)
      for (std::size_t k = 0; k < 3; ++k) d[k] = 0.5 * to[k] - 0.5 * from[k];
    const int exponent = exponent_of_largest(d);
    return {{times_power(d[0], -exponent), times_power(d[1], -exponent), times_power(d[2], -exponent)},
            exponent + (overflows ? 1 : 0)};
  }
  static Sight normal(const double (&point)[3], const double (&a)[3], const double (&b)[3]) {
    const detail::CrossProduct product = detail::cross_product_exactly(point, a, b);
    return {vector_of(product.vector), product.exponent};
  }
  // The normal of unit vectors, 2^-500 in size at least: it would be flushed where directions differ by little, or are
  // opposite but for little.
  static Vector over_sizes(const Sight& normal, const Sight& a, const Sight& b) {
    constexpr int least = -500;
    const int power = normal.exponent - a.exponent - b.exponent;
    const double factor =
        times_power(1.0 / (length_of(a.vector) * length_of(b.vector)), power < least ? least : power);
    return times(normal.vector, factor);
  }
  static double number(double x) { return x; }
};

template <class T>
struct Loop {
  const double (&point)[3];
  const double (*corners)[3];
  std::size_t count;
  int axis;     // of the ray
  double sign;  // along it

  const double (&corner(std::size_t i) const)[3] { return corners[i % count]; }
  Sight to_corner(std::size_t i) const { return Exactly<T>::sight(point, corner(i)); }
  // The direction to a corner, without what is along the ray; zero if the corner is on the ray's line.
  Vector across_ray(std::size_t i) const {
    double to[3] = {corner(i)[0], corner(i)[1], corner(i)[2]};
    to[axis] = point[axis];
    return unit(Exactly<T>::sight(point, to).vector);
  }
  // The cross product of the vectors to two corners: zero only if the point is in a line with them.
  Sight normal(std::size_t i, std::size_t j) const { return Exactly<T>::normal(point, corner(i), corner(j)); }
  Vector ray() const { return along(axis, sign); }
  static Vector along(int k, double size) {
    return {k == 0 ? size : 0.0, k == 1 ? size : 0.0, k == 2 ? size : 0.0};
  }
};

}  // namespace
}  // namespace raylanes
