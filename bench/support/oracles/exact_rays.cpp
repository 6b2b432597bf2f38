#include "exact_rays.hpp"

#include <gmpxx.h>

#include "rational_vectors.hpp"

namespace raylanes::oracle {
namespace {

// Numbers with more digits, and with exponents that no product of three differences leaves.
template <class T>
using Wide = std::conditional_t<std::is_same_v<T, float>, double, long double>;
template <class T>
constexpr Wide<T> roundoff = std::is_same_v<T, float> ? 0x1p-53 : 0x1p-64;  // at most

template <class Number>
using VectorOf = std::array<Number, 3>;
template <class Number, class T>
VectorOf<Number> difference(const PointOf<T>& a, const PointOf<T>& b) {
  return {Number(Number(a[0]) - Number(b[0])), Number(Number(a[1]) - Number(b[1])),
          Number(Number(a[2]) - Number(b[2]))};
}

// Whether d·(p×q) certainly has a sign, by a bound of seven roundings of each of six products.
struct Sign {
  bool positive, negative;
};
template <class T, class W = Wide<T>>
Sign certain_sign(const VectorOf<W>& d, const VectorOf<W>& p, const VectorOf<W>& q) {
  W value = 0, permanent = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const W a = p[(i + 1) % 3] * q[(i + 2) % 3], b = p[(i + 2) % 3] * q[(i + 1) % 3];
    value += d[i] * (a - b);
    permanent += std::fabs(d[i]) * (std::fabs(a) + std::fabs(b));
  }
  const W error = 16 * roundoff<T> * permanent;
  return {value > error, value < -error};
}
// Whether two weights are of opposite sign.
template <class AnyRay, class T = NumberOf<AnyRay>, class W = Wide<T>>
bool certainly_misses(const AnyRay& ray, const TriangleCorners<T>& corners) {
  const VectorOf<W> d{ray.direction[0], ray.direction[1], ray.direction[2]},
      a = difference<W, T>(corners[0], ray.origin), b = difference<W, T>(corners[1], ray.origin),
      c = difference<W, T>(corners[2], ray.origin);
  const Sign u = certain_sign<T>(d, c, b), v = certain_sign<T>(d, a, c), w = certain_sign<T>(d, b, a);
  return (u.positive || v.positive || w.positive) && (u.negative || v.negative || w.negative);
}

template <class T>
constexpr T largest = std::numeric_limits<T>::max();

// x rounded to nearest, of two to the even one; zero is positive.
template <class T>
T nearest(const mpq_class& x) {
  using Bits = std::conditional_t<std::is_same_v<T, float>, std::uint32_t, std::uint64_t>;
  const auto guess =
      static_cast<T>(std::clamp<double>(x.get_d(), -largest<T>, largest<T>));  // off by one at most
  T best = guess;
  mpq_class error = abs(mpq_class(best) - x);
  for (const T towards : {-largest<T>, largest<T>}) {
    const T other = std::nextafter(guess, towards);
    const mpq_class other_error = abs(mpq_class(other) - x);
    const bool is_even = (std::bit_cast<Bits>(other) & 1u) == 0;
    if (other_error < error || (other_error == error && is_even)) best = other, error = other_error;
  }
  return best + T(0);
}

template <class T>
bool is_finite(const std::array<T, 3>& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}
bool is_valid(const auto& ray) {
  return is_finite(ray.origin) && is_finite(ray.direction) && ray.direction != decltype(ray.direction){} &&
         ray.tmin <= ray.tmax;
}
// An infinite end is the largest number.
template <class AnyRay, class T = NumberOf<AnyRay>>
bool is_within(const mpq_class& t, const AnyRay& ray) {
  return ray.tmin <= largest<T> && ray.tmax >= -largest<T> &&
         t >= mpq_class(std::max(ray.tmin, -largest<T>)) && t <= mpq_class(std::min(ray.tmax, largest<T>));
}

// A triangle seen from a point, with the normals whose products with a direction are the weights of the corners.
struct SeenTriangle {
  Vector normal[3];
  mpq_class volume;

  template <class T>
  SeenTriangle(const PointOf<T>& from, const TriangleCorners<T>& corners) {
    Vector at[3];
    for (std::size_t k = 0; k < 3; ++k) at[k] = difference<mpq_class, T>(corners[k], from);
    for (std::size_t k = 0; k < 3; ++k) normal[k] = cross(at[(k + 1) % 3], at[(k + 2) % 3]);
    volume = dot(at[0], normal[0]);
  }
  Vector sum() const { return normal[0] + normal[1] + normal[2]; }
};

bool is_zero(const Vector& v) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}
// The sign of the product with a direction that is moved by a number below all others along x, by less along y and z.
int perturbed_sign(const mpq_class& product, const Vector& normal) {
  if (product != 0) return sgn(product);
  for (const mpq_class& x : normal)
    if (x != 0) return sgn(x);
  return 0;
}

template <class Item>
void sort_by_t(std::vector<Item>& items) {
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.t < b.t; });
}

template <class T>
bool is_in_box(const TriangleCorners<T>& corners, const PointOf<T>& point) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [lo, hi] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
    if (!(point[axis] >= lo && point[axis] <= hi)) return false;
  }
  return true;
}
// Whether all corners have a coordinate of the point: then it is in their plane.
template <class T>
bool is_in_plane_of_axes(const TriangleCorners<T>& corners, const PointOf<T>& point) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::ranges::all_of(corners, [&](const PointOf<T>& c) { return c[axis] == point[axis]; }))
      return true;
  return false;
}
template <class T>
bool has_equal_corners(const TriangleCorners<T>& corners) {
  return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
}

// Takes a point in the plane and in the box of the triangle.
Touch touch_of(const SeenTriangle& seen) {
  const Vector n = seen.sum();
  if (is_zero(n))
    return is_zero(seen.normal[0]) && is_zero(seen.normal[1]) && is_zero(seen.normal[2]) ? Touch::edge
                                                                                         : Touch::none;
  int least = 1;
  for (const Vector& normal : seen.normal) least = std::min(least, sgn(dot(n, normal)));
  return least < 0 ? Touch::none : least == 0 ? Touch::edge : Touch::face;
}

}  // namespace

template <class AnyRay, class T>
SidedHit<T> exact_hit(const AnyRay& ray, const TriangleCorners<T>& corners) {
  if (!is_valid(ray) || certainly_misses(ray, corners)) return {};
  const SeenTriangle seen(ray.origin, corners);
  const Vector d = to_vector(ray.direction);
  mpq_class weight[3], det = 0;
  for (std::size_t k = 0; k < 3; ++k) weight[k] = dot(d, seen.normal[k]), det += weight[k];
  if (det == 0) return {};
  for (const mpq_class& w : weight)
    if (sgn(w) * sgn(det) < 0) return {};
  const mpq_class t = seen.volume / det;
  if (!is_within(t, ray)) return {};
  SidedHit<T> found{{}, sgn(det)};
  found.hit.t = nearest<T>(t), found.hit.primitive = 0;
  found.hit.u = nearest<T>(weight[1] / det), found.hit.v = nearest<T>(weight[2] / det);
  return found;
}

template <class AnyRay, class T>
std::vector<HitOf<T>> exact_hits(const MeshOf<T>& mesh, const AnyRay& ray, Facing facing) {
  std::vector<HitOf<T>> hits;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    auto [hit, side] = exact_hit(ray, corners_of(mesh, i));
    if (!hit || (facing == Facing::front && side > 0) || (facing == Facing::back && side < 0)) continue;
    hit.primitive = static_cast<std::uint32_t>(i);
    hits.push_back(hit);
  }
  sort_by_t(hits);
  return hits;
}

namespace {

template <class AnyRay, class T = NumberOf<AnyRay>>
std::vector<HitOf<T>> nearest_of_all(const MeshOf<T>& mesh, std::span<const AnyRay> rays) {
  std::vector<HitOf<T>> nearest;
  for (const AnyRay& ray : rays) {
    const std::vector<HitOf<T>> all = exact_hits(mesh, ray);
    nearest.push_back(all.empty() ? HitOf<T>() : all[0]);
  }
  return nearest;
}

}  // namespace

std::vector<Hit> nearest_hits(const Mesh& mesh, std::span<const Ray> rays) {
  return nearest_of_all(mesh, rays);
}
std::vector<HitD> nearest_hits(const DoubleMesh& mesh, std::span<const RayD> rays) {
  return nearest_of_all(mesh, rays);
}

template <class AnyRay, class T>
std::vector<CrossingOf<T>> exact_crossings(const MeshOf<T>& mesh, const AnyRay& ray) {
  std::vector<CrossingOf<T>> crossings;
  const Vector d = is_valid(ray) ? to_vector(ray.direction) : Vector();
  for (std::size_t i = 0; is_valid(ray) && i < mesh.triangles.size(); ++i) {
    const auto corners = corners_of(mesh, i);
    if (certainly_misses(ray, corners)) continue;
    const SeenTriangle seen(ray.origin, corners);
    const auto sign_of = [&](const Vector& normal) { return perturbed_sign(dot(d, normal), normal); };
    const int side = sign_of(seen.normal[0]);
    if (side == 0 || side != sign_of(seen.normal[1]) || side != sign_of(seen.normal[2])) continue;
    const mpq_class t = seen.volume == 0 ? mpq_class(0) : mpq_class(seen.volume / dot(d, seen.sum()));
    if (is_within(t, ray)) crossings.push_back({nearest<T>(t), static_cast<std::uint32_t>(i), side});
  }
  sort_by_t(crossings);
  return crossings;
}

template <class T>
Placed placed(const TriangleCorners<T>& corners, const PointOf<T>& point) {
  if (has_equal_corners(corners)) return {0, Touch::none};
  const bool in_box = is_in_box(corners, point);
  if (!in_box && is_in_plane_of_axes(corners, point)) return {0, Touch::none};
  const SeenTriangle seen(point, corners);
  const int side = sgn(seen.volume);
  return {side, side == 0 && in_box ? touch_of(seen) : Touch::none};
}

namespace {

template <class T, class Is>
bool any_in_box(const MeshOf<T>& mesh, const PointOf<T>& point, const Is& is) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (const auto corners = corners_of(mesh, i); is_in_box(corners, point) && is(corners)) return true;
  return false;
}

template <class T>
bool is_inside(const MeshOf<T>& mesh, const PointOf<T>& point, const PointOf<T>& direction, InsideRule rule) {
  RayOf<T> ray;
  ray.origin = point, ray.direction = direction;
  int winding = 0, parity = 0;
  for (const auto& crossing : exact_crossings(mesh, ray)) winding += crossing.side, parity ^= 1;
  return rule == InsideRule::winding ? winding > 0 : (rule == InsideRule::nonzero ? winding : parity) != 0;
}

template <class T>
int votes_for_inside(const MeshOf<T>& mesh, const PointOf<T>& point) {
  int votes = 0;
  for (const T step : {T(-1), T(1)})
    for (std::size_t axis = 0; axis < 3; ++axis) {
      PointOf<T> direction{};
      direction[axis] = step;
      votes += is_inside<T>(mesh, point, direction, InsideRule::parity) ? 1 : 0;
    }
  return votes;
}

}  // namespace

template <class T>
bool is_on(const MeshOf<T>& mesh, const PointOf<T>& point) {
  return any_in_box<T>(mesh, point, [&](const TriangleCorners<T>& corners) {
    const Touch touch = placed<T>(corners, point).touch;
    return touch == Touch::face || (touch == Touch::edge && !is_zero(SeenTriangle(point, corners).sum()));
  });
}
template <class T>
bool is_on_edge(const MeshOf<T>& mesh, const PointOf<T>& point) {
  return any_in_box<T>(mesh, point, [&](const TriangleCorners<T>& corners) {
    return placed<T>(corners, point).touch == Touch::edge;
  });
}

template <class T>
Location exact_location(const MeshOf<T>& mesh, const PointOf<T>& point,
                        const std::type_identity_t<PointOf<T>>& direction, InsideRule rule) {
  if (is_on<T>(mesh, point)) return Location::on;
  const bool inside = rule == InsideRule::vote ? votes_for_inside<T>(mesh, point) > 3
                                               : is_inside<T>(mesh, point, direction, rule);
  return inside ? Location::inside : Location::outside;
}

// Both kinds of numbers.
#define RAYLANES_EXACT(T)                                                                 \
  template SidedHit<T> exact_hit(const RayOf<T>&, const TriangleCorners<T>&);             \
  template std::vector<HitOf<T>> exact_hits(const MeshOf<T>&, const RayOf<T>&, Facing);   \
  template std::vector<CrossingOf<T>> exact_crossings(const MeshOf<T>&, const RayOf<T>&); \
  template Placed placed<T>(const TriangleCorners<T>&, const PointOf<T>&);                \
  template bool is_on<T>(const MeshOf<T>&, const PointOf<T>&);                            \
  template bool is_on_edge<T>(const MeshOf<T>&, const PointOf<T>&);                       \
  template Location exact_location<T>(const MeshOf<T>&, const PointOf<T>&, const PointOf<T>&, InsideRule)
RAYLANES_EXACT(float);
RAYLANES_EXACT(double);
#undef RAYLANES_EXACT

}  // namespace raylanes::oracle
