#include "exact_doubles.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "exact_point.hpp"

namespace raylanes::oracle {
namespace {

template <class Number>
using VectorOf = std::array<Number, 3>;

template <class Number>
VectorOf<Number> difference(const Double3& a, const Double3& b) {
  return {Number(Number(a[0]) - Number(b[0])), Number(Number(a[1]) - Number(b[1])),
          Number(Number(a[2]) - Number(b[2]))};
}
template <class Number>
VectorOf<Number> cross(const VectorOf<Number>& a, const VectorOf<Number>& b) {
  return {Number(a[1] * b[2] - a[2] * b[1]), Number(a[2] * b[0] - a[0] * b[2]),
          Number(a[0] * b[1] - a[1] * b[0])};
}
template <class Number>
Number dot(const VectorOf<Number>& a, const VectorOf<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Number>
VectorOf<Number> sizes(const VectorOf<Number>& a) {
  return {std::fabs(a[0]), std::fabs(a[1]), std::fabs(a[2])};
}

// A bound of the determinant's error, with seven roundings of each of six products: long doubles have at least 64
// digits, and exponents that no product of three doubles leaves.
struct Sign {
  bool positive, negative;
};
Sign certain_sign(const VectorOf<long double>& d, const VectorOf<long double>& p,
                  const VectorOf<long double>& q) {
  const VectorOf<long double> a = sizes(p), b = sizes(q), e = sizes(d);
  const long double value = dot(d, cross(p, q));
  const long double permanent = e[0] * (a[1] * b[2] + a[2] * b[1]) + e[1] * (a[2] * b[0] + a[0] * b[2]) +
                                e[2] * (a[0] * b[1] + a[1] * b[0]);
  const long double error = 16 * std::ldexp(permanent, -64);
  return {value > error, value < -error};
}
bool certainly_misses(const RayD& ray, const DoubleCorners& corners) {
  const VectorOf<long double> d{ray.direction[0], ray.direction[1], ray.direction[2]},
      a = difference<long double>(corners[0], ray.origin),
      b = difference<long double>(corners[1], ray.origin),
      c = difference<long double>(corners[2], ray.origin);
  const Sign u = certain_sign(d, c, b), v = certain_sign(d, a, c), w = certain_sign(d, b, a);
  return (u.positive || v.positive || w.positive) && (u.negative || v.negative || w.negative);
}

double nearest_double(const mpq_class& x) {
  constexpr double largest = std::numeric_limits<double>::max();
  const double guess = std::clamp(x.get_d(), -largest, largest);
  double best = guess;
  mpq_class error = abs(mpq_class(best) - x);
  for (const double towards : {-largest, largest}) {
    const double other = std::nextafter(guess, towards);
    const mpq_class other_error = abs(mpq_class(other) - x);
    const bool is_even = (std::bit_cast<std::uint64_t>(other) & 1u) == 0;
    if (other_error < error || (other_error == error && is_even)) best = other, error = other_error;
  }
  return best + 0.0;
}

bool is_finite(const Double3& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}
bool is_valid(const RayD& ray) {
  return is_finite(ray.origin) && is_finite(ray.direction) && ray.direction != Double3{0, 0, 0} &&
         ray.tmin <= ray.tmax;
}
// An infinite end is the largest double.
bool is_within(const mpq_class& t, const RayD& ray) {
  constexpr double largest = std::numeric_limits<double>::max();
  return ray.tmin <= largest && ray.tmax >= -largest && t >= mpq_class(std::max(ray.tmin, -largest)) &&
         t <= mpq_class(std::min(ray.tmax, largest));
}

// The ray's determinants: of corner k, weight[k] = d · normal[k].
struct Weights {
  VectorOf<mpq_class> d, normal[3];
  mpq_class weight[3], det, depth;

  Weights(const RayD& ray, const DoubleCorners& corners)
      : d{mpq_class(ray.direction[0]), mpq_class(ray.direction[1]), mpq_class(ray.direction[2])} {
    VectorOf<mpq_class> at[3];
    for (std::size_t k = 0; k < 3; ++k) at[k] = difference<mpq_class>(corners[k], ray.origin);
    for (std::size_t k = 0; k < 3; ++k) {
      normal[k] = cross(at[(k + 1) % 3], at[(k + 2) % 3]);
      weight[k] = dot(d, normal[k]);
    }
    det = weight[0] + weight[1] + weight[2];
    depth = dot(at[0], normal[0]);
  }
};

int perturbed_sign(const mpq_class& product, const VectorOf<mpq_class>& normal) {
  if (product != 0) return sgn(product);
  for (const mpq_class& x : normal)
    if (x != 0) return sgn(x);
  return 0;
}
bool has_normal(const DoubleCorners& corners) {
  const auto n =
      cross(difference<mpq_class>(corners[1], corners[0]), difference<mpq_class>(corners[2], corners[0]));
  return n[0] != 0 || n[1] != 0 || n[2] != 0;
}

}  // namespace

DoubleCorners corners_of(const DoubleMesh& mesh, std::size_t triangle) {
  const Index3& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

SidedHit exact_double_hit(const RayD& ray, const DoubleCorners& corners) {
  if (!is_valid(ray) || certainly_misses(ray, corners)) return {};
  const Weights w(ray, corners);
  if (w.det == 0) return {};
  for (const mpq_class& weight : w.weight)
    if (sgn(weight) * sgn(w.det) < 0) return {};
  const mpq_class t = w.depth / w.det;
  if (!is_within(t, ray)) return {};
  return {{nearest_double(t), nearest_double(w.weight[1] / w.det), nearest_double(w.weight[2] / w.det), 0, 0},
          sgn(w.det)};
}

std::vector<HitD> exact_double_hits(const DoubleMesh& mesh, const RayD& ray, Facing facing) {
  std::vector<HitD> hits;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    auto [hit, side] = exact_double_hit(ray, corners_of(mesh, i));
    if (!hit || (facing == Facing::front && side > 0) || (facing == Facing::back && side < 0)) continue;
    hit.primitive = static_cast<std::uint32_t>(i);
    hits.push_back(hit);
  }
  std::stable_sort(hits.begin(), hits.end(), [](const HitD& a, const HitD& b) { return a.t < b.t; });
  return hits;
}

std::vector<CrossingD> exact_double_crossings(const DoubleMesh& mesh, const RayD& ray) {
  std::vector<CrossingD> crossings;
  for (std::size_t i = 0; is_valid(ray) && i < mesh.triangles.size(); ++i) {
    const DoubleCorners corners = corners_of(mesh, i);
    if (certainly_misses(ray, corners)) continue;
    const Weights w(ray, corners);
    const int side = perturbed_sign(w.weight[0], w.normal[0]);
    if (side == 0 || side != perturbed_sign(w.weight[1], w.normal[1]) ||
        side != perturbed_sign(w.weight[2], w.normal[2]))
      continue;
    const mpq_class t = w.depth == 0 ? mpq_class(0) : mpq_class(w.depth / w.det);
    if (is_within(t, ray)) crossings.push_back({nearest_double(t), static_cast<std::uint32_t>(i), side});
  }
  std::stable_sort(crossings.begin(), crossings.end(),
                   [](const CrossingD& a, const CrossingD& b) { return a.t < b.t; });
  return crossings;
}

int side_of(const DoubleCorners& corners, const Double3& point) {
  return sgn(Weights({point, 0, {1, 0, 0}, 1}, corners).depth);
}

bool is_on(const DoubleMesh& mesh, const Double3& point) {
  if (!is_finite(point)) return false;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const DoubleCorners corners = corners_of(mesh, i);
    if (!has_normal(corners)) continue;
    const Weights w({point, 0, {1, 0, 0}, 1}, corners);
    if (w.depth != 0) continue;
    // In the plane: the normals of the three parts have one direction.
    bool is_in = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = 0; k < 3; ++k)
        is_in = is_in && sgn(w.normal[k][axis]) * sgn(w.normal[(k + 1) % 3][axis]) >= 0;
    if (is_in) return true;
  }
  return false;
}

bool is_on_edge(const DoubleMesh& mesh, const Double3& point) {
  for (std::size_t i = 0; is_finite(point) && i < mesh.triangles.size(); ++i) {
    const DoubleCorners corners = corners_of(mesh, i);
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Double3 &p = corners[k], &q = corners[(k + 1) % 3];
      bool may_be = true;
      for (std::size_t axis = 0; axis < 3; ++axis)
        may_be =
            may_be && point[axis] >= std::min(p[axis], q[axis]) && point[axis] <= std::max(p[axis], q[axis]);
      if (!may_be) continue;
      const auto n = cross(difference<mpq_class>(p, point), difference<mpq_class>(q, point));
      if (n[0] == 0 && n[1] == 0 && n[2] == 0) return true;
    }
  }
  return false;
}

Location exact_location(const DoubleMesh& mesh, const Double3& point) {
  if (is_on(mesh, point)) return Location::on;
  const RayD ray{point, 0, {0.3, -0.7, 0.61}, std::numeric_limits<double>::infinity()};
  return exact_double_crossings(mesh, ray).size() % 2 != 0 ? Location::inside : Location::outside;
}

std::string fault_of_closest_point(const DoubleMesh& mesh, const Double3& point, const ClosestPointD& found) {
  const auto power = [](int exponent) {
    mpz_class two = 1;
    two <<= static_cast<unsigned>(std::abs(exponent));
    return exponent < 0 ? mpq_class(1, two) : mpq_class(two);
  };
  double coordinate = 0;
  const auto take_largest = [&](const Double3& p) {
    for (const double x : p) coordinate = std::max(coordinate, std::abs(x));
  };
  take_largest(point);
  for (const Double3& v : mesh.vertices) take_largest(v);
  // The root has two roundings, the last one to a double that may be subnormal. An infinite one is at least 2^1024.
  const bool is_finite = std::isfinite(found.distance);
  const mpq_class distance = is_finite ? mpq_class(found.distance) : power(1024), value = distance * distance,
                  more = value * power(-50) + distance * power(-1073) + power(-2148) +
                         mpq_class(coordinate) * mpq_class(coordinate) * power(-1400);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const DoubleCorners corners = corners_of(mesh, t);
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    const std::string of_triangle = "triangle " + std::to_string(t);
    if (!found) return of_triangle + " is not found";
    const Vector p = to_vector(point), a = to_vector(corners[0]) - p, b = to_vector(corners[1]) - p,
                 c = to_vector(corners[2]) - p;
    const mpq_class exact = exact_square_of_distance(a, b, c),
                    reach = std::max({dot(a, a), dot(b, b), dot(c, c)}), bound = reach * power(-46) + more;
    if (value > exact + bound) return of_triangle + " is nearer";
    if (t != found.primitive) continue;
    if (is_finite && value < exact - bound) return of_triangle + " is farther";
    // The point that u and v say: as far, and where it is said to be.
    const mpq_class u = found.u, v = found.v, w = 1 - u - v;
    const oracle::Vector at{w * a[0] + u * b[0] + v * c[0], w * a[1] + u * b[1] + v * c[1],
                            w * a[2] + u * b[2] + v * c[2]};
    if (is_finite && abs(oracle::dot(at, at) - value) > bound) return of_triangle + ": u and v are wrong";
    for (std::size_t k = 0; k < 3; ++k)
      if (abs(at[k] + p[k] - mpq_class(found.point[k])) > mpq_class(coordinate) * power(-50) + power(-1073))
        return of_triangle + ": its point is wrong";
  }
  const bool is_normal = found.distance > 0x1p-500 && found.distance < 0x1p500;
  if (is_normal && abs(mpq_class(found.distance_squared) - value) > value * power(-51))
    return "the distance is not the root";
  return "";
}

}  // namespace raylanes::oracle
