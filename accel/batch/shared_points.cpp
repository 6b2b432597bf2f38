#include "shared_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace raylanes {
namespace {

// Lines may miss an end by that share of the way to it: half of what kernels bear.
constexpr double largest_miss = 0x1p-20;
constexpr std::size_t looked_at = 16;

template <class AnyRay>
bool share_origin(const AnyRay& a, const AnyRay& b) {
  return a.origin == b.origin;
}

struct Point {
  double x, y, z;
  template <class T>
  explicit Point(const std::array<T, 3>& p)
      : x(static_cast<double>(p[0])), y(static_cast<double>(p[1])), z(static_cast<double>(p[2])) {}
  Point(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
  friend Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Point operator*(double k, const Point& a) { return {k * a.x, k * a.y, k * a.z}; }
  friend double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  Float3 rounded() const { return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}; }
};

// How far the line of a ray passes a point, as a share of the way; infinite for a ray that does not end before it, and
// for what has no number.
double share_missed(const Ray& ray, const Float3& point) {
  const Point o(ray.origin), d(ray.direction), way = Point(point) - o;
  const double t = dot(way, d) / dot(d, d);
  const Point miss = way - t * d;
  const double share = std::sqrt(dot(miss, miss) / dot(way, way));
  const bool ends = t >= static_cast<double>(ray.tmax) * (1 - largest_miss) && ray.tmin <= ray.tmax;
  return ends && share >= 0 ? share : HUGE_VAL;
}
// The largest share, of all if it is small enough.
double max_missed(std::span<const Ray> rays, std::size_t step, const Float3& point) {
  double most = 0;
  for (std::size_t i = 0; i < rays.size() && most <= largest_miss; i += step)
    most = std::max(most, share_missed(rays[i], point));
  return most;
}

// The point of the first of two lines that is nearest to the other line.
Float3 meeting_point(const Ray& a, const Ray& b) {
  const Point p(a.origin), d(a.direction), e(b.direction), way = Point(b.origin) - p;
  const double de = dot(d, e), dd = dot(d, d), ee = dot(e, e);
  return (p + (dot(way, d) * ee - dot(way, e) * de) / (dd * ee - de * de) * d).rounded();
}
// The ray whose direction differs most from the first one's.
const Ray& max_different(std::span<const Ray> rays, std::size_t step) {
  const Point d(rays[0].direction);
  const auto likeness = [&](const Ray& ray) {
    const Point e(ray.direction);
    const double de = dot(d, e);
    return de * std::abs(de) / dot(e, e);
  };
  const Ray* best = &rays[0];
  double least = likeness(rays[0]);
  for (std::size_t i = step; i < rays.size(); i += step)
    if (const double like = likeness(rays[i]); like < least) best = &rays[i], least = like;
  return *best;
}

}  // namespace

template <class AnyRay>
std::size_t count_of_origin(std::span<const AnyRay> rays) {
  constexpr std::size_t step = 61;  // prime: what takes turns is seen
  std::size_t shared = 0;
  while (shared + step < rays.size() && share_origin(rays[shared + step], rays[0])) shared += step;
  const auto rest = rays.subspan(shared, std::min(step, rays.size() - shared));
  const auto other = std::find_if_not(rest.begin(), rest.end(),
                                      [&](const AnyRay& ray) { return share_origin(ray, rays[0]); });
  return shared + static_cast<std::size_t>(other - rest.begin());
}

template <class AnyRay>
std::size_t count_before_shared_origin(std::span<const AnyRay> rays) {
  for (std::size_t i = 0; i + min_shared_point < rays.size(); i += min_shared_point)
    if (share_origin(rays[i], rays[i + min_shared_point]) &&
        count_of_origin(rays.subspan(i)) > min_shared_point)
      return i;
  return rays.size();
}

template <class AnyRay, class AnyBox>
bool are_coherent(std::span<const AnyRay> rays, const AnyBox& box) {
  constexpr double near = 0.02;
  constexpr std::size_t max_strangers = looked_at / 8;
  if (rays.size() < 2 * looked_at) return false;
  const Point diagonal = Point(box.hi) - Point(box.lo);
  std::size_t strangers = 0;
  for (std::size_t i = 1; i < rays.size(); i += rays.size() / looked_at) {
    const Point d(rays[i - 1].direction), e(rays[i].direction),
        apart = e - d, way = Point(rays[i].origin) - Point(rays[i - 1].origin);
    const bool together = dot(apart, apart) <= near * near * std::min(dot(d, d), dot(e, e)) &&
                          dot(way, way) <= near * near * dot(diagonal, diagonal);
    strangers += together ? 0 : 1;
  }
  return strangers <= max_strangers;
}
template std::size_t count_of_origin(std::span<const Ray>);
template std::size_t count_of_origin(std::span<const RayD>);
template std::size_t count_before_shared_origin(std::span<const Ray>);
template std::size_t count_before_shared_origin(std::span<const RayD>);
template bool are_coherent(std::span<const Ray>, const Box&);
template bool are_coherent(std::span<const RayD>, const BoxD&);

bool begin_outside(std::span<const RayD> rays, const BoxD& box) {
  const std::size_t step = std::max<std::size_t>(1, rays.size() / looked_at);
  std::size_t outside = 0, looked = 0;
  for (std::size_t i = 0; i < rays.size(); i += step, ++looked)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (const double x = rays[i].origin[axis]; !(x >= box.lo[axis] && x <= box.hi[axis])) {
        ++outside;
        break;
      }
  return 2 * outside > looked;
}

std::optional<Float3> shared_end_of(std::span<const Ray> rays) {
  if (rays.size() < min_shared_point) return {};
  const std::size_t step = rays.size() / looked_at;
  const Ray& first = rays[0];
  const Point o(first.origin), d(first.direction);
  const Float3 candidates[] = {(o + d).rounded(), (o + static_cast<double>(first.tmax) * d).rounded(),
                               meeting_point(first, max_different(rays, step))};
  std::optional<Float3> best;
  double least = largest_miss;
  for (const Float3& candidate : candidates)
    if (const double missed = max_missed(rays, step, candidate); missed <= least)
      best = candidate, least = missed;
  return best;
}

}  // namespace raylanes
