#include "triangle_judge.hpp"

#include "../../../bench/support/scenes/vector3.hpp"

namespace raylanes::testing {
namespace {

using bench::Double3, bench::cross, bench::dot, bench::length;
using oracle::Class;
constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double u = 0x1p-24;  // unit roundoff
constexpr double underflow =
    0x1p-146;  // of a cross or dot product: three times the half of 2^-149, and slack

Double3 minus(const Float3& a, const Float3& b) {
  return bench::subtract(bench::to_double(a), bench::to_double(b));
}
double length_of(const Float3& a) {
  return length(bench::to_double(a));
}

// The terms of the bounds of the tests on planes, in double: exact but for a factor of 1 + 2^-50.
struct Sizes {
  double origin, direction;  // lengths
  double corner[3];          // of the corners
  double edge[3];            // of the edges 0–1, 1–2, 2–0
  double area;               // |e1 × e2|
  double slope;              // |(e1 × e2) · d|
  double permanent;          // |e1| · |e2|
  double away;               // |v0 − o|
  double t, weight[3];       // exact
  double from_corner[3];     // |o + t·d − corner|

  Sizes(const Ray& ray, const Triangle& triangle, const oracle::ExactTriangleTest& exact) {
    const auto& v = triangle.corner;
    const Double3 e1 = minus(v[1], v[0]), e2 = minus(v[2], v[0]);
    const Double3 n = cross(e1, e2);
    const Double3 d = bench::to_double(ray.direction);
    origin = length_of(ray.origin), direction = length(d);
    for (int k = 0; k < 3; ++k) corner[k] = length_of(v[k]), edge[k] = length(minus(v[(k + 1) % 3], v[k]));
    area = length(n), slope = std::fabs(dot(n, d)), permanent = length(e1) * length(e2);
    away = length(minus(v[0], ray.origin));
    t = exact.t.get_d();
    weight[1] = exact.u.get_d(), weight[2] = exact.v.get_d();
    weight[0] = mpq_class(1 - exact.u - exact.v).get_d();
    for (int k = 0; k < 3; ++k) {
      const Double3 to1 = minus(v[1], v[k]), to2 = minus(v[2], v[k]), to0 = minus(v[0], v[k]);
      Double3 p;
      for (std::size_t i = 0; i < 3; ++i) p[i] = weight[0] * to0[i] + weight[1] * to1[i] + weight[2] * to2[i];
      from_corner[k] = length(p);
    }
  }
};

// |fl(N/D) − N/D| for N and D off by these.
double quotient_error(double quotient, double numerator_error, double divisor, double divisor_error) {
  if (divisor <= 2 * divisor_error) return unbounded;
  const double moved = (numerator_error + quotient * divisor_error) / (divisor - divisor_error);
  return moved + 2 * u * (quotient + moved) + underflow;
}

struct PlaneBounds {
  double t, u, v;
  std::array<double, 3> weight;
};
constexpr PlaneBounds nothing_known{unbounded, unbounded, unbounded, {unbounded, unbounded, unbounded}};

// The plane, then the edges (both plane_edges). Lengths stand for vectors; a sum of three products
// rounds each thrice, by Cauchy at most 3u of the product of the lengths; a cross product rounds each of its
// products twice, and the vector of the sums |a_j b_k| + |a_k b_j| is at most √2·|a||b| long.
//   n:  edges rounded (1 each), cross: (1 + 1 + 2)·√2·u < 6u of |e1||e2|
//   slope n·d: the error of n, and 4u·|n||d|;  depth n·v0 − n·o: the error of n times |v0 − o|, and 4u of
//   |n|(|v0| + |o|), the subtraction included
//   point o + t·d: the error of t times |d|, product and sum 2u·|t||d| + u·|o|
//   c = edge × (point − corner): |edge| times the error of the point, and (1 + 1 + 2√2)u < 6u of the lengths
//   c·n: exactly the opposite corner's weight times |n|²; |c| is weight·|n|, off by the error of c
//   u, v = √(c·c / n·n): half of 3u for each square, and quotient and roots: below 8u. A weight that is
//   negative comes out positive.
PlaneBounds bounds_by_edges(const Sizes& s) {
  const double normal_error = 6 * u * s.permanent + underflow, normal = s.area + normal_error;
  const double slope_error = (normal_error + 4 * u * normal) * s.direction + underflow;
  const double depth_error = normal_error * s.away + 4 * u * normal * (s.corner[0] + s.origin) + underflow;
  PlaneBounds bounds = nothing_known;
  bounds.t = quotient_error(std::fabs(s.t), depth_error, s.slope, slope_error);
  if (bounds.t == unbounded || s.area <= 2 * normal_error) return nothing_known;
  const double reach = (std::fabs(s.t) + bounds.t) * s.direction;
  const double point_error = bounds.t * s.direction + 2.1 * u * reach + 1.1 * u * s.origin + underflow;
  double value[3];
  for (int k = 0; k < 3; ++k) {
    const int opposite = (k + 2) % 3;
    const double weight = std::fabs(s.weight[opposite]);
    const double c_error = s.edge[k] * (point_error + 6 * u * (s.from_corner[k] + point_error)) + underflow;
    const double decision_error =
        c_error * normal + (weight * s.area + c_error) * (normal_error + 4 * u * normal) + underflow;
    bounds.weight[static_cast<std::size_t>(opposite)] = decision_error / (s.area * s.area);
    value[opposite] = (c_error + weight * normal_error + std::sqrt(underflow)) / (s.area - normal_error) +
                      8 * u * (weight + c_error / s.area) + 2 * std::max(0.0, -s.weight[opposite]);
  }
  // Squares that underflow.
  const bool squares = s.area * s.area > 0x1p20 * underflow;
  bounds.u = squares ? value[1] : unbounded, bounds.v = squares ? value[2] : unbounded;
  return bounds;
}

// The prepared map: n, a, b rounded once each (their errors in double add less than u/8, aspects to 1e-8).
//   t = n·s / n·d, s = v0 − o rounded: (1 + 1 + 3)u of |n||s|, (1 + 3)u of |n||d|
//   point t·d − s: the error of t times |d|, s's rounding, product and difference
//   u = a·point: |a| = |e2|/|n| times the error of the point, and (1 + 3)u of |a||point|
PlaneBounds bounds_by_rows(const Sizes& s) {
  if (!(s.area > 0)) return nothing_known;
  PlaneBounds bounds = nothing_known;
  bounds.t = quotient_error(std::fabs(s.t), 5.2 * u * s.area * s.away + underflow, s.slope,
                            4.2 * u * s.area * s.direction + underflow);
  if (bounds.t == unbounded) return nothing_known;
  const double reach = (std::fabs(s.t) + bounds.t) * s.direction;
  const double point_error =
      bounds.t * s.direction + 1.1 * u * (s.away + reach + s.from_corner[0]) + underflow;
  const auto along = [&](double row) {
    return row * (point_error + 4.2 * u * (s.from_corner[0] + point_error)) + underflow;
  };
  bounds.u = along(s.edge[2] / s.area), bounds.v = along(s.edge[0] / s.area);
  bounds.weight = {bounds.u + bounds.v + 1.1 * u * (1 + bounds.u + bounds.v), bounds.u, bounds.v};
  return bounds;
}

Class classify(const Ray& ray, const Sizes& s, const PlaneBounds& bounds) {
  bool inside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    if (s.weight[k] < -bounds.weight[k]) return Class::must_miss;
    inside = inside && s.weight[k] > bounds.weight[k];
  }
  if (s.t + bounds.t < double(ray.tmin) || s.t - bounds.t > double(ray.tmax)) return Class::must_miss;
  const bool clear = s.t - bounds.t > double(ray.tmin) && s.t + bounds.t < double(ray.tmax);
  return inside && clear ? Class::must_hit : Class::either;
}

std::optional<double> if_bounded(double bound) {
  if (bound == unbounded) return std::nullopt;
  return bound;
}

void judge_plane(TriangleTest test, const Ray& ray, const Triangle& triangle, TriangleJudgement& judgement) {
  judgement.weight = {unbounded, unbounded, unbounded};
  judgement.decision = Class::either;
  if (judgement.exact.det == 0) return;
  const Sizes sizes(ray, triangle, judgement.exact);
  const PlaneBounds bounds =
      test == TriangleTest::precomputed ? bounds_by_rows(sizes) : bounds_by_edges(sizes);
  judgement.weight = bounds.weight;
  judgement.t = if_bounded(bounds.t), judgement.u = if_bounded(bounds.u), judgement.v = if_bounded(bounds.v);
  judgement.decision = classify(ray, sizes, bounds);
}

void judge_determinants(oracle::Form form, const Ray& ray, const Triangle& triangle,
                        TriangleJudgement& judgement) {
  const auto& exact = judgement.exact;
  const oracle::ErrorBounds bounds = oracle::error_bounds(ray, triangle, exact, form);
  judgement.decision = oracle::classify(ray, exact, bounds);
  const auto to_double = [](const std::optional<mpq_class>& bound) -> std::optional<double> {
    if (!bound) return std::nullopt;
    return bound->get_d();
  };
  judgement.t = to_double(bounds.t), judgement.u = to_double(bounds.u), judgement.v = to_double(bounds.v);
  for (std::size_t k = 0; k < 3; ++k)
    judgement.weight[k] = exact.det == 0 ? unbounded : mpq_class(bounds.weight[k] / abs(exact.det)).get_d();
}

// Numbers from exact ones by get_d, off by 2^-52 of themselves: far below any bound.
bool is_within(float computed, const mpq_class& exact, const std::optional<double>& bound) {
  return !bound || abs(mpq_class(computed) - exact) <= mpq_class(*bound * (1 + 0x1p-40));
}

}  // namespace

TriangleJudgement judge(TriangleTest test, const Ray& whole, const Triangle& triangle) {
  // The t of a hit is finite: the segment ends at the largest numbers.
  constexpr float largest = std::numeric_limits<float>::max();
  Ray ray = whole;
  if (ray.tmin < -largest && ray.tmax >= -largest) ray.tmin = -largest;
  if (ray.tmax > largest && ray.tmin <= largest) ray.tmax = largest;
  TriangleJudgement judgement{oracle::exact_triangle(ray, triangle), Class::must_miss, {}, {}, {}, {}};
  if (!judgement.exact.valid) return judgement;
  switch (test) {
    case TriangleTest::plane_edges_plain:
    case TriangleTest::plane_edges:
    case TriangleTest::precomputed:
      judge_plane(test, ray, triangle, judgement);
      break;
    case TriangleTest::exact:
      judge_determinants(oracle::Form::exact, ray, triangle, judgement);
      break;
    case TriangleTest::watertight:
      judge_determinants(oracle::Form::sheared, ray, triangle, judgement);
      break;
    default:
      judge_determinants(oracle::Form::moller_trumbore, ray, triangle, judgement);
  }
  return judgement;
}

std::string fault(const TriangleResult& result, const Ray& ray, const TriangleJudgement& judgement) {
  if (result.hit == 0) {
    if (judgement.decision == Class::must_hit) return "missed";
    return result == triangle_missed ? "" : "a miss with other values than those of a miss";
  }
  if (result.hit != hit_flag) return "a hit flag that is neither 0 nor all ones";
  if (judgement.decision == Class::must_miss) return "hit";
  if (!(result.t >= ray.tmin && result.t <= ray.tmax)) return "t outside the segment";
  if (!std::isfinite(result.t) || !std::isfinite(result.u) || !std::isfinite(result.v)) return "not finite";
  if (!is_within(result.t, judgement.exact.t, judgement.t)) return "t beyond its bound";
  if (!is_within(result.u, judgement.exact.u, judgement.u)) return "u beyond its bound";
  return is_within(result.v, judgement.exact.v, judgement.v) ? "" : "v beyond its bound";
}

}  // namespace raylanes::testing
