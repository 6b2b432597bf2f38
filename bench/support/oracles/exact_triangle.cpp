#include "exact_triangle.hpp"

#include "rational_vectors.hpp"

namespace raylanes::oracle {
namespace {

bool finite(const Float3& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

bool valid_input(const Ray& ray, const Triangle& triangle) {
  const bool zero = ray.direction[0] == 0 && ray.direction[1] == 0 && ray.direction[2] == 0;
  return finite(ray.origin) && finite(ray.direction) && !zero && ray.tmin <= ray.tmax &&
         std::all_of(triangle.corner, triangle.corner + 3, finite);
}

bool at_least(const mpq_class& t, float bound) {
  return std::isinf(bound) ? bound < 0 : t >= mpq_class(bound);
}
bool at_most(const mpq_class& t, float bound) {
  return std::isinf(bound) ? bound > 0 : t <= mpq_class(bound);
}

bool equal(const Float3& a, const Float3& b) {
  return a == b;
}

// The bound of a determinant a·(b×c) after `roundings` roundings on the way of each of its six products:
// gamma(roundings) times the permanent P (7u(1+8u)·P for seven), plus what underflow may add: each
// component of b×c is off by two products, each product of the dot again by one.
struct Determinant {
  mpq_class bound, peak;  // peak: no intermediate value is larger
};
Determinant determinant(int roundings, const Vector& a, const Vector& b, const Vector& c) {
  const Vector inner = cross_permanent(b, c);
  const mpq_class permanent = dot(a, inner);
  return {gamma(roundings) * permanent + underflow * (2 * (a[0] + a[1] + a[2]) + 3),
          2 * std::max({permanent, inner[0], inner[1], inner[2], a[0], a[1], a[2]})};
}

struct Geometry {
  Vector d, corner[3];  // the direction and A, B, C
  Geometry(const Ray& ray, const Triangle& triangle) : d(to_vector(ray.direction)) {
    for (std::size_t i = 0; i < 3; ++i) corner[i] = to_vector(triangle.corner[i]) - to_vector(ray.origin);
  }
};

// Each determinant has rounded differences in two of its rows (one rounding each), a cross product (two) and
// a dot product (three): seven. T has them in all three rows: eight. W = det-U-V adds two more.
void moller_trumbore_bounds(const Geometry& g, const ExactTriangleTest& exact, ErrorBounds& bounds) {
  const Vector d = absolute(g.d), a = absolute(g.corner[0]);
  const Vector e1 = absolute(g.corner[1] - g.corner[0]), e2 = absolute(g.corner[2] - g.corner[0]);
  // Embree dots other rows of the same determinants: take each row once as the dotted one.
  const auto any_order = [](int roundings, const Vector& x, const Vector& y, const Vector& z) {
    const Determinant p = determinant(roundings, x, y, z), q = determinant(roundings, y, z, x),
                      r = determinant(roundings, z, x, y);
    return Determinant{std::max({p.bound, q.bound, r.bound}), std::max({p.peak, q.peak, r.peak})};
  };
  const Determinant det = any_order(7, e1, d, e2), v = any_order(7, a, d, e2), w = any_order(7, d, a, e1),
                    depth = any_order(8, e2, a, e1);
  bounds.det = det.bound;
  bounds.weight[1] = v.bound;
  bounds.weight[2] = w.bound;
  bounds.weight[0] = det.bound + v.bound + w.bound +
                     gamma(2) * (abs(exact.det) + det.bound + abs(exact.weight[1]) + v.bound +
                                 abs(exact.weight[2]) + w.bound);
  bounds.depth = depth.bound;
  bounds.in_range = std::max({det.peak, v.peak, w.peak, depth.peak}) < overflow;
}

// A vector as magnitudes of its exact components and of their errors.
struct Uncertain {
  Vector size, error;
};

// a·(b×c) where the rows are off already: the product of the enlarged magnitudes after the five roundings of
// cross and dot, less the exact product.
Determinant moved_determinant(const Uncertain& a, const Uncertain& b, const Uncertain& c) {
  const Vector x = a.size + a.error, y = b.size + b.error, z = c.size + c.error;
  Determinant result = determinant(5, x, y, z);
  result.bound += dot(x, cross_permanent(y, z)) - dot(a.size, cross_permanent(b.size, c.size));
  return result;
}

Vector scaled(const mpq_class& factor, const Vector& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

// Embree's robust form computes 2U = d·((v2-v1)×(v2+v1)) and so on, where v are the rounded A, B, C: each sum
// and difference is off by two roundings of |v2|+|v1|. The normal in det is built from two such differences,
// T from it and the rounded A. It accepts weights down to -eps·|U+V+W|, eps = 2^-23; its det must also agree
// in sign with that sum.
void plucker_bounds(const Geometry& g, const ExactTriangleTest& exact, ErrorBounds& bounds) {
  const Vector &a = g.corner[0], &b = g.corner[1], &c = g.corner[2];
  const Uncertain d = {absolute(g.d), {0, 0, 0}};
  const auto edge = [&d](const Vector& p, const Vector& q) {
    const Vector error = scaled(gamma(2), absolute(p) + absolute(q));
    Determinant twice = moved_determinant(d, {absolute(p - q), error}, {absolute(p + q), error});
    twice.bound /= 2;
    return twice;
  };
  const Determinant u = edge(c, b), v = edge(a, c), w = edge(b, a);
  const mpq_class sum = (u.bound + v.bound + w.bound) * (1 + gamma(2)) +
                        gamma(2) * (abs(exact.weight[0]) + abs(exact.weight[1]) + abs(exact.weight[2]));
  const mpq_class epsilon = power_of_two(-23) * (1 + gamma(4)) * (abs(exact.det) + sum);
  bounds.weight = {u.bound + epsilon, v.bound + epsilon, w.bound + epsilon};
  // Which two edges Embree crosses depends on their sizes: take the largest components of all three.
  const Vector ab = absolute(b - a), bc = absolute(c - b), ca = absolute(a - c);
  Uncertain largest = {{}, scaled(gamma(2), absolute(a) + absolute(b) + absolute(c))};
  for (std::size_t i = 0; i < 3; ++i) largest.size[i] = std::max({ab[i], bc[i], ca[i]});
  const Uncertain corner = {absolute(a), scaled(gamma(1), absolute(a))};
  const Determinant det = moved_determinant(d, largest, largest),
                    depth = moved_determinant(corner, largest, largest);
  bounds.det = std::max(det.bound, sum);
  bounds.depth = depth.bound;
  bounds.in_range = std::max({u.peak, v.peak, w.peak, det.peak, depth.peak}) < overflow;
}

// The sheared form. Let P = v-o exactly, X = P[kx] - Sx·P[kz] with Sx = d[kx]/d[kz], |Sx| <= 1 because kz is
// the largest axis of d; Y has the same form, and Z = P[kz]/d[kz]. Computed is
//   x = fl(p_kx - fl(fl(Sx)·p_kz)),  p = fl(P).
// P[kx] passes two roundings (p, the difference), Sx·P[kz] four (p, Sx, product, difference):
//   |x - X| <= gamma(2)|P[kx]| + gamma(4)|Sx·P[kz]| <= gamma(6)·D.
// D is the largest |component of v-o|. Underflow of Sx (times |P[kz]|) and of the product adds to the error.
// z passes three (1/d, p, product):
//   |z - Z| <= gamma(3)|Z|, plus the same underflow.
// An edge function U = fl(fl(Cx·By) - fl(Cy·Bx)) of the computed vertices rounds twice; moving the factors by
// their errors e adds e_Cx|By| + e_By|Cx| + e_Cx·e_By for the first product, and such terms for the second. With
// |v-o| <= D this is at most about 2·(2·6+2)·u·D·(largest sheared |x|, |y|): the error of an edge function
// grows with the distance of the triangle, that of Möller-Trumbore with its size. If the edge function
// falls back to binary64, its one rounding to float is within the same bound.
struct Approximate {
  mpq_class value, error;
};

Approximate product(const Approximate& a, const Approximate& b) {
  return {a.value * b.value, abs(a.value) * b.error + abs(b.value) * a.error + a.error * b.error};
}
mpq_class magnitude(const Approximate& a) {
  return abs(a.value) + a.error;
}

// One more rounding sequence of n steps on an approximate value.
void round_by(int n, Approximate& a) {
  a.error += gamma(n) * magnitude(a) + underflow;
}

struct Sheared {
  Approximate x, y, z;
};

Approximate shear(const mpq_class& p, const mpq_class& slope, const mpq_class& p_major) {
  const mpq_class shift = slope * p_major;
  return {p - shift, gamma(2) * abs(p) + gamma(4) * abs(shift) + underflow * (1 + abs(p_major))};
}

Approximate edge_function(const Sheared& p, const Sheared& q) {
  Approximate first = product(p.x, q.y), second = product(p.y, q.x);
  round_by(2, first);
  round_by(2, second);
  return {first.value - second.value, first.error + second.error};
}

std::size_t major_axis(const Vector& d) {
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (abs(d[i]) > abs(d[axis])) axis = i;
  return axis;
}

void sheared_bounds(const Geometry& g, ErrorBounds& bounds) {
  const std::size_t kz = major_axis(g.d);
  std::size_t kx = (kz + 1) % 3, ky = (kx + 1) % 3;
  if (g.d[kz] < 0) std::swap(kx, ky);
  const mpq_class scale = abs(g.d[kz]);
  mpq_class peak = 1 / scale;
  Sheared s[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector& p = g.corner[i];
    s[i] = {shear(p[kx], g.d[kx] / g.d[kz], p[kz]),
            shear(p[ky], g.d[ky] / g.d[kz], p[kz]),
            {p[kz] / g.d[kz], gamma(3) * abs(p[kz] / g.d[kz]) + underflow * (1 + abs(p[kz]))}};
    const Vector m = absolute(p);
    peak = std::max({peak, mpq_class(m[0] + m[1] + m[2]), mpq_class(2 * m[kz]), magnitude(s[i].z)});
  }
  const Approximate weight[3] = {edge_function(s[2], s[1]), edge_function(s[0], s[2]),
                                 edge_function(s[1], s[0])};
  // det = (U+V)+W; T = (U·z0+V·z1)+W·z2: each term passes up to three roundings.
  mpq_class det = 0, depth = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const mpq_class m = magnitude(weight[i]);
    det += weight[i].error + gamma(2) * m;
    Approximate term = product(weight[i], s[i].z);
    round_by(3, term);
    depth += term.error;
    bounds.weight[i] = weight[i].error * scale;
    peak = std::max({peak, mpq_class(3 * m), mpq_class(3 * magnitude(term)),
                     mpq_class(magnitude(s[i].x) * magnitude(s[i].x)),
                     mpq_class(magnitude(s[i].y) * magnitude(s[i].y))});
  }
  bounds.det = det * scale;
  bounds.depth = depth * scale;
  bounds.in_range = 2 * peak < overflow && scale >= min_normal;
}

int quotient_roundings(Form form) {
  if (form == Form::sheared) return 1;
  if (form == Form::moller_trumbore) return 2;
  return 8;  // an estimate of the reciprocal with one Newton step is within 6u, and the product
}

// |fl(N/det) - q| for q = N/det exactly, the errors of N and det known.
mpq_class quotient_bound(const mpq_class& q, const mpq_class& error, const mpq_class& det,
                         const mpq_class& det_error, int roundings) {
  const mpq_class moved = (error + abs(q) * det_error) / (abs(det) - det_error);
  return moved + gamma(roundings) * (abs(q) + moved) + underflow;
}

bool equal_vertices_cancel(const Triangle& triangle, Form form) {
  const auto& v = triangle.corner;
  if (form == Form::moller_trumbore) return equal(v[0], v[1]) || equal(v[0], v[2]);
  if (form == Form::sheared) return equal(v[0], v[1]) || equal(v[0], v[2]) || equal(v[1], v[2]);
  return false;
}

// Half an ULP of what x rounds to, at most.
mpq_class rounding_of(const mpq_class& x) {
  int exponent = -126;
  if (x != 0) std::frexp(x.get_d(), &exponent);  // x < 2^exponent
  return power_of_two(std::max(exponent - 1, -126) - 24);
}
ErrorBounds exact_bounds(const ExactTriangleTest& exact) {
  ErrorBounds bounds;
  bounds.decides_exactly = true;
  if (exact.det == 0) return bounds;
  bounds.t = rounding_of(exact.t), bounds.u = rounding_of(exact.u), bounds.v = rounding_of(exact.v);
  return bounds;
}

}  // namespace

ExactTriangleTest exact_triangle(const Ray& ray, const Triangle& triangle) {
  ExactTriangleTest test;
  test.valid = valid_input(ray, triangle);
  if (!test.valid) return test;
  const Geometry g(ray, triangle);
  const Vector &a = g.corner[0], &b = g.corner[1], &c = g.corner[2];
  test.weight = {dot(g.d, cross(c, b)), dot(g.d, cross(a, c)), dot(g.d, cross(b, a))};
  test.det = test.weight[0] + test.weight[1] + test.weight[2];
  test.depth = dot(c, cross(b, a));
  if (test.det == 0) return test;
  test.t = test.depth / test.det;
  test.u = test.weight[1] / test.det;
  test.v = test.weight[2] / test.det;
  const bool inside = std::all_of(test.weight.begin(), test.weight.end(),
                                  [&](const mpq_class& w) { return sgn(w) * sgn(test.det) >= 0; });
  test.hit = inside && at_least(test.t, ray.tmin) && at_most(test.t, ray.tmax);
  return test;
}

ErrorBounds error_bounds(const Ray& ray, const Triangle& triangle, const ExactTriangleTest& exact,
                         Form form) {
  ErrorBounds bounds;
  const Geometry g(ray, triangle);
  if (form == Form::exact) return exact_bounds(exact);
  if (form == Form::sheared)
    sheared_bounds(g, bounds);
  else if (form == Form::embree_robust)
    plucker_bounds(g, exact, bounds);
  else
    moller_trumbore_bounds(g, exact, bounds);
  bounds.always_misses = equal_vertices_cancel(triangle, form);
  if (abs(exact.det) <= bounds.det) return bounds;
  const int n = quotient_roundings(form);
  bounds.t = quotient_bound(exact.t, bounds.depth, exact.det, bounds.det, n);
  bounds.u = quotient_bound(exact.u, bounds.weight[1], exact.det, bounds.det, n);
  bounds.v = quotient_bound(exact.v, bounds.weight[2], exact.det, bounds.det, n);
  bounds.in_range = bounds.in_range && abs(exact.t) + *bounds.t < overflow;
  return bounds;
}

namespace {

// The three-valued sign of a number known within a bound: 0 means unknown.
int sure_sign(const mpq_class& value, const mpq_class& bound) {
  return abs(value) > bound ? sgn(value) : 0;
}

Class classify_depth(const Ray& ray, const ExactTriangleTest& exact, const ErrorBounds& bounds) {
  if (!bounds.t) return Class::either;
  const mpq_class low = exact.t - *bounds.t, high = exact.t + *bounds.t;
  if (!at_least(high, ray.tmin) || !at_most(low, ray.tmax)) return Class::must_miss;
  // Strictly inside, because some tracers exclude an end of the segment.
  const bool clear = (std::isinf(ray.tmin) || low > mpq_class(ray.tmin)) &&
                     (std::isinf(ray.tmax) || high < mpq_class(ray.tmax));
  return clear ? Class::must_hit : Class::either;
}

}  // namespace

Class classify(const Ray& ray, const ExactTriangleTest& exact, const ErrorBounds& bounds) {
  if (!exact.valid || bounds.always_misses) return Class::must_miss;
  if (bounds.decides_exactly) return exact.hit ? Class::must_hit : Class::must_miss;
  if (!bounds.in_range) return Class::either;
  const int side = sure_sign(exact.det, bounds.det);
  int positive = side > 0, negative = side < 0, known = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const int sign = sure_sign(exact.weight[i], bounds.weight[i]);
    positive += sign > 0;
    negative += sign < 0;
    known += sign != 0;
  }
  if (positive > 0 && negative > 0) return Class::must_miss;
  const Class depth = classify_depth(ray, exact, bounds);
  if (depth == Class::must_miss) return Class::must_miss;
  return side != 0 && known == 3 ? depth : Class::either;
}

Class classify(const Ray& ray, const Triangle& triangle, Form form) {
  const ExactTriangleTest exact = exact_triangle(ray, triangle);
  if (!exact.valid) return Class::must_miss;
  return classify(ray, exact, error_bounds(ray, triangle, exact, form));
}

}  // namespace raylanes::oracle
