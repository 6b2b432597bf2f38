#include "exact_crossings.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact_hit.hpp"
#include "rational_vectors.hpp"

namespace raylanes::oracle {
namespace {

Triangle triangle_of(std::span<const Float3> vertices, const Index3& corners) {
  return {{vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]}};
}

bool hits_nothing(const Ray& ray) {
  bool finite = true, moves = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    finite = finite && std::isfinite(ray.origin[axis]) && std::isfinite(ray.direction[axis]);
    moves = moves || ray.direction[axis] != 0;
  }
  constexpr float largest = std::numeric_limits<float>::max();
  return !finite || !moves || !(ray.tmin <= ray.tmax) || ray.tmin > largest || ray.tmax < -largest;
}

// A triangle seen from a point, with the normals whose products with a direction are the weights.
struct SeenTriangle {
  Vector a, of_bc, of_ca, of_ab;
  mpq_class volume;

  SeenTriangle(const Float3& from, const Triangle& triangle)
      : a(to_vector(triangle.corner[0]) - to_vector(from)) {
    const Vector b = to_vector(triangle.corner[1]) - to_vector(from),
                 c = to_vector(triangle.corner[2]) - to_vector(from);
    of_bc = cross(b, c), of_ca = cross(c, a), of_ab = cross(a, b);
    volume = dot(a, of_bc);
  }
  // That of all weights; 0 if they differ.
  int common_sign(const Vector& d) const {
    const int u = sgn(dot(d, of_bc));
    return u == sgn(dot(d, of_ca)) && u == sgn(dot(d, of_ab)) ? u : 0;
  }
  mpq_class det(const Vector& d) const { return dot(d, of_bc) + dot(d, of_ca) + dot(d, of_ab); }
};

Vector moved(const Float3& direction) {
  Vector d = to_vector(direction);
  mpq_class tiny = 1;
  const mpq_class step(mpz_class(1), mpz_class(1) << 1500);
  for (mpq_class& x : d) tiny *= step, x += tiny;
  return d;
}

bool is_in_box(const Triangle& triangle, const Float3& point) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [lo, hi] =
        std::minmax({triangle.corner[0][axis], triangle.corner[1][axis], triangle.corner[2][axis]});
    if (!(point[axis] >= lo && point[axis] <= hi)) return false;
  }
  return true;
}

template <class Item>
void sort_by_t(std::vector<Item>& items) {
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.t < b.t; });
}

}  // namespace

std::vector<Hit> all_exact_hits(std::span<const Float3> vertices, std::span<const Index3> triangles,
                                const Ray& ray) {
  std::vector<Hit> hits;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    Hit hit = exact_hit(ray, triangle_of(vertices, triangles[i]));
    if (!hit) continue;
    hit.primitive = i;
    hits.push_back(hit);
  }
  sort_by_t(hits);
  return hits;
}

std::vector<Crossing> exact_crossings(std::span<const Float3> vertices, std::span<const Index3> triangles,
                                      const Ray& ray) {
  std::vector<Crossing> crossings;
  if (hits_nothing(ray)) return crossings;
  constexpr float largest = std::numeric_limits<float>::max();
  const mpq_class tmin = std::max(ray.tmin, -largest), tmax = std::min(ray.tmax, largest);
  const Vector d = to_vector(ray.direction), moved_d = moved(ray.direction);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle triangle = triangle_of(vertices, triangles[i]);
    if (certainly_misses(ray, triangle)) continue;
    const SeenTriangle seen(ray.origin, triangle);
    const int side = seen.common_sign(moved_d);
    if (side == 0) continue;
    const mpq_class det = seen.det(d);
    const mpq_class t = det == 0 ? mpq_class(0) : mpq_class(seen.volume / det);
    if (t >= tmin && t <= tmax) crossings.push_back({nearest_float(t), i, side});
  }
  sort_by_t(crossings);
  return crossings;
}

// In its plane, and in the three half planes along it.
Held held_by(const Triangle& triangle, const Float3& point) {
  if (!is_in_box(triangle, point)) return Held::no;
  const SeenTriangle seen(point, triangle);
  const Vector n = seen.of_bc + seen.of_ca + seen.of_ab;
  if (seen.volume != 0 || dot(n, n) == 0) return Held::no;
  const int least = std::min({sgn(dot(n, seen.of_bc)), sgn(dot(n, seen.of_ca)), sgn(dot(n, seen.of_ab))});
  return least < 0 ? Held::no : least == 0 ? Held::at_edge : Held::inside;
}

namespace {

// Whether all corners have a coordinate of the point: then it is in their plane.
bool is_in_plane_of_axes(const Triangle& triangle, const Float3& point) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::ranges::all_of(triangle.corner, [&](const Float3& c) { return c[axis] == point[axis]; }))
      return true;
  return false;
}

// Takes a point in the plane and in the box of the triangle.
Touch touch_of(const SeenTriangle& seen) {
  const Vector n = seen.of_bc + seen.of_ca + seen.of_ab;
  if (dot(n, n) == 0)
    return dot(seen.of_bc, seen.of_bc) == 0 && dot(seen.of_ca, seen.of_ca) == 0 &&
                   dot(seen.of_ab, seen.of_ab) == 0
               ? Touch::edge
               : Touch::none;
  const int least = std::min({sgn(dot(n, seen.of_bc)), sgn(dot(n, seen.of_ca)), sgn(dot(n, seen.of_ab))});
  return least < 0 ? Touch::none : least == 0 ? Touch::edge : Touch::face;
}

}  // namespace

Placed placed(const Triangle& triangle, const Float3& point) {
  const auto& [a, b, c] = triangle.corner;
  if (a == b || b == c || c == a) return {0, Touch::none};
  const bool in_box = is_in_box(triangle, point);
  if (!in_box && is_in_plane_of_axes(triangle, point)) return {0, Touch::none};
  const SeenTriangle seen(point, triangle);
  const int side = sgn(seen.volume);
  return {side, side == 0 && in_box ? touch_of(seen) : Touch::none};
}

namespace {

bool is_inside(std::span<const Float3> vertices, std::span<const Index3> triangles, const Float3& point,
               const Float3& direction, InsideRule rule) {
  int winding = 0, parity = 0;
  for (const Crossing& crossing : exact_crossings(vertices, triangles, Ray{point, 0.0f, direction}))
    winding += crossing.side, parity ^= 1;
  return rule == InsideRule::winding ? winding > 0 : (rule == InsideRule::nonzero ? winding : parity) != 0;
}

int votes_for_inside(std::span<const Float3> vertices, std::span<const Index3> triangles,
                     const Float3& point) {
  int votes = 0;
  for (const float step : {-1.0f, 1.0f})
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Float3 direction{};
      direction[axis] = step;
      votes += is_inside(vertices, triangles, point, direction, InsideRule::parity) ? 1 : 0;
    }
  return votes;
}

}  // namespace

Location exact_location(std::span<const Float3> vertices, std::span<const Index3> triangles,
                        const Float3& point, const Float3& direction, InsideRule rule) {
  for (const Index3& triangle : triangles)
    if (held_by(triangle_of(vertices, triangle), point) != Held::no) return Location::on;
  const bool inside = rule == InsideRule::vote ? votes_for_inside(vertices, triangles, point) > 3
                                               : is_inside(vertices, triangles, point, direction, rule);
  return inside ? Location::inside : Location::outside;
}

}  // namespace raylanes::oracle
