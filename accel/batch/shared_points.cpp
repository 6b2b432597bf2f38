#include "shared_points.hpp"

namespace raylanes {
namespace {

// Lines may miss an end by that share of the way to it: half of what kernels bear.
constexpr double largest_miss = 0x1p-20, missed_by_rounding = 0x1p-22;  // a direction is rounded
constexpr std::size_t looked_at = 16;

template <class AnyRay>
bool share_origin(const AnyRay& a, const AnyRay& b) {
  return a.origin == b.origin;
}

struct Point {
  double x, y, z;
  Point() = default;
  template <class T>
  explicit Point(const std::array<T, 3>& p)
      : x(static_cast<double>(p[0])), y(static_cast<double>(p[1])), z(static_cast<double>(p[2])) {}
  Point(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
  friend Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Point operator*(double k, const Point& a) { return {k * a.x, k * a.y, k * a.z}; }
  friend double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  template <class T = float>
  std::array<T, 3> rounded() const {
    return {static_cast<T>(x), static_cast<T>(y), static_cast<T>(z)};
  }
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

std::size_t place_in_sample(std::size_t i, std::size_t size) {
  const double turns = 0.6180339887498949 * static_cast<double>(i);
  return static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(size));
}

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
bool are_coherent(std::span<const AnyRay> rays, const AnyBox& box, double near) {
  constexpr std::size_t max_strangers = looked_at / 8;
  if (rays.size() < 2 * looked_at) return false;
  const Point diagonal = Point(box.hi) - Point(box.lo);
  std::size_t strangers = 0;
  for (std::size_t i = 1; i < rays.size(); i += rays.size() / looked_at) {
    const Point d(rays[i - 1].direction), e(rays[i].direction),
        apart = e - d, way = Point(rays[i].origin) - Point(rays[i - 1].origin);
    const bool together = dot(apart, apart) <= near * near * std::min(dot(d, d), dot(e, e)) &&
                          dot(way, way) <= near * near * dot(diagonal, diagonal);
    if (!together && ++strangers > max_strangers) return false;
  }
  return true;
}

template <class AnyRay, class AnyBox>
bool pass_by(std::span<const AnyRay> rays, const AnyBox& box) {
  const std::size_t looks = std::clamp<std::size_t>(rays.size() / 32, 3, looked_at);
  for (std::size_t i = 0; i < looks; ++i) {
    const AnyRay& ray = rays[place_in_sample(i, rays.size())];
    double near = ray.tmin, far = ray.tmax;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double origin = ray.origin[axis], direction = ray.direction[axis],
                   a = (box.lo[axis] - origin) / direction, b = (box.hi[axis] - origin) / direction;
      near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
    }
    if (near <= far && near < HUGE_VAL) return false;
  }
  return true;
}
template bool pass_by(std::span<const Ray>, const Box&);
template bool pass_by(std::span<const RayD>, const BoxD&);
template std::size_t count_of_origin(std::span<const Ray>);
template std::size_t count_of_origin(std::span<const RayD>);
template std::size_t count_before_shared_origin(std::span<const Ray>);
template std::size_t count_before_shared_origin(std::span<const RayD>);
template bool are_coherent(std::span<const Ray>, const Box&, double);
template bool are_coherent(std::span<const RayD>, const BoxD&, double);

template <class AnyPoint, class AnyBox>
bool is_near(const AnyPoint& point, const AnyBox& box, double most_sizes) {
  double farthest = 0, size = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = point[axis], lo = box.lo[axis], hi = box.hi[axis];
    farthest = std::max({farthest, x - lo, hi - x}), size = std::max(size, hi - lo);
  }
  return farthest <= most_sizes * size;
}
template bool is_near(const Float3&, const Box&, double);
template bool is_near(const Double3&, const BoxD&, double);

template <class AnyRay, class AnyBox>
bool begin_outside(std::span<const AnyRay> rays, const AnyBox& box) {
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
template bool begin_outside(std::span<const Ray>, const Box&);
template bool begin_outside(std::span<const RayD>, const BoxD&);

std::optional<Float3> shared_end_of(std::span<const Ray> rays) {
  if (rays.size() < min_shared_point) return {};
  const std::size_t step = rays.size() / looked_at;
  const Ray& first = rays[0];
  const Point o(first.origin), d(first.direction);
  std::optional<Float3> best;
  double least = largest_miss;
  const auto try_point = [&](const Float3& candidate) {
    if (const double missed = max_missed(rays, step, candidate); missed <= least)
      best = candidate, least = missed;
    return least <= missed_by_rounding;
  };
  if (!try_point((o + d).rounded()) && !try_point((o + static_cast<double>(first.tmax) * d).rounded()))
    try_point(meeting_point(first, max_different(rays, step)));
  return best;
}

// --- How finely rays look at a tree.

namespace {

// So many directions are looked at, and so many rays traced, fewer in a batch of few rays. These see triangles of one
// size, so the first ray that sees far fewer or far more than any limit decides for all. Counts above max_of_a_ray are
// max_of_a_ray.
constexpr std::size_t max_directions = 64, max_traced = 32, few_rays = 1024;
constexpr double max_of_a_ray = 4, surely_few = 0.05, surely_many = 16;
// Fewer rays a steradian have too little in common for a packet, however large triangles are: measured. Below so many
// rays nobody asks for more.
constexpr double min_density_of_packets = 2048;
constexpr std::size_t min_wide_stream = 320;
constexpr std::uint32_t none = ~std::uint32_t{0};

double length_of(const Point& a) {
  return std::sqrt(dot(a, a));
}
Point unit(const Point& a) {
  const double length = length_of(a);
  return {a.x / length, a.y / length, a.z / length};
}
Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The solid angle that directions fill, were they spread evenly over a rectangle: 12 times the root of their two
// greatest variances multiplied, by the sum of the principal minors of their covariance.
double solid_angle_of(std::span<const Point> directions) {
  const auto n = static_cast<double>(directions.size());
  double mean[3] = {}, square[3][3] = {};
  for (const Point& point : directions) {
    const double d[] = {point.x, point.y, point.z};
    for (std::size_t i = 0; i < 3; ++i) {
      mean[i] += d[i] / n;
      for (std::size_t k = 0; k < 3; ++k) square[i][k] += d[i] * d[k] / n;
    }
  }
  const auto covariance = [&](std::size_t i, std::size_t k) { return square[i][k] - mean[i] * mean[k]; };
  double minors = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3;
    minors += covariance(i, i) * covariance(k, k) - covariance(i, k) * covariance(i, k);
  }
  return 12 * std::sqrt(std::max(minors, 0.0));
}

double number_of(const TreeView& tree, std::uint32_t leaf_triangle, int k) {
  const auto* const blocks = static_cast<const LeafBlock<9>*>(tree.blocks);
  return blocks[leaf_triangle / tree_width].number[k][leaf_triangle % tree_width];
}
double number_of(const DoubleTreeView& tree, std::uint32_t leaf_triangle, int k) {
  return TrianglesOfHalves{tree.halves}.number(k, leaf_triangle);
}

// A small triangle seen from a point.
struct SeenTriangle {
  double solid_angle, distance, area;

  template <class Tree>
  SeenTriangle(const Tree& tree, std::uint32_t leaf_triangle, const Point& point) {
    const auto corner = [&](int k) {
      const auto number = [&](int axis) { return number_of(tree, leaf_triangle, 3 * k + axis); };
      return Point(number(0), number(1), number(2)) - point;
    };
    const Point a = corner(0), e = corner(1) - a, f = corner(2) - a, middle = a + 1.0 / 3 * (e + f);
    const Point normal = cross(e, f);
    distance = length_of(middle), area = length_of(normal) / 2;
    solid_angle = std::abs(dot(normal, middle)) / (2 * distance * distance * distance);
  }
};

// Between two rays, at a distance; or between their origins alone.
template <class AnyRay>
double solid_angle_between(const AnyRay& ray, const AnyRay& next, double distance, bool by_origins) {
  const Point turn = unit(Point(next.direction)) - unit(Point(ray.direction));
  const Point origins = 1 / distance * (Point(next.origin) - Point(ray.origin)),
              way = by_origins ? origins : turn + origins;
  return dot(way, way);
}

template <class AnyBox>
double area_of(const AnyBox& box) {
  const Point d = Point(box.hi) - Point(box.lo);
  return 2 * (d.x * d.y + d.x * d.z + d.y * d.z);
}

// The mean, of values that count as max_of_a_ray at most, and the middle one.
TrianglesOfRays summary_of(std::span<double> triangles) {
  if (triangles.empty()) return {};
  double sum = 0;
  for (const double x : triangles) sum += std::min(x, max_of_a_ray);
  const auto middle = triangles.begin() + static_cast<std::ptrdiff_t>(triangles.size() / 2);
  std::nth_element(triangles.begin(), middle, triangles.end());
  return {sum / static_cast<double>(triangles.size()), *middle};
}

}  // namespace

template <class T>
TrianglesOfRays triangles_of_a_ray(const TreeViewOf<T>& tree, NearestTriangle<T> nearest,
                                   std::span<const RayOf<T>> rays, SharedApex shared, const PointOf<T>& point,
                                   bool by_origins) {
  const bool has_point = shared != SharedApex::none;
  std::array<Point, max_directions> directions;
  const auto seen_from_point = [&](std::size_t i) {
    const RayOf<T>& ray = rays[place_in_sample(i, rays.size())];
    return unit(shared == SharedApex::end ? Point(ray.origin) - Point(point) : Point(ray.direction));
  };
  double of_a_ray = 0;
  bool are_sparse = false;
  if (has_point) {
    const std::span<Point> some(directions.data(),
                                std::clamp(rays.size() / 32, max_directions / 8, max_directions));
    for (std::size_t i = 0; i < some.size(); ++i) some[i] = seen_from_point(i);
    const double view = solid_angle_of(some);
    of_a_ray = view / static_cast<double>(rays.size());
    are_sparse = of_a_ray * min_density_of_packets > 1;
    if (are_sparse && rays.size() < min_wide_stream) return {max_of_a_ray, max_of_a_ray};
  }
  const std::size_t min_traced = rays.size() < 2 * min_shared_point ? 1 : 3;
  const std::size_t traced = by_origins ? std::clamp<std::size_t>(rays.size() / 64, 4, max_traced)
                                        : std::clamp<std::size_t>(rays.size() / 128, min_traced, max_traced);
  const bool one_may_decide = !by_origins && rays.size() <= few_rays;
  // The share of a ray, if all together went anywhere through the tree.
  const double all = area_of(tree.bounds) / static_cast<double>(std::min(rays.size(), rays_of_streams));
  std::array<double, max_traced> triangles;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < traced; ++i) {
    const std::size_t k = std::clamp(place_in_sample(i, rays.size()), std::size_t{1}, rays.size() - 2);
    RayOf<T> ray{has_point ? point : rays[k].origin, 0, rays[k].direction,
                 std::numeric_limits<T>::infinity()};
    if (shared == SharedApex::end) ray.direction = directions[i].template rounded<T>();
    const std::uint32_t leaf_triangle = nearest(tree, ray);
    if (leaf_triangle == none) continue;
    const SeenTriangle triangle(tree, leaf_triangle, Point(ray.origin));
    const auto between = [&](std::size_t other) {
      return solid_angle_between(rays[k], rays[other], triangle.distance, by_origins);
    };
    // At the end of a row of a picture the next ray is far away.
    const double of_neighbours = std::min(between(k - 1), between(k + 1));
    double share = has_point ? of_a_ray : of_neighbours;
    // A row of a picture is bent, so the rectangle around it is much larger.
    if (one_may_decide && shared == SharedApex::origin) share = std::min(of_a_ray, of_neighbours);
    double number = share / triangle.solid_angle;
    if (by_origins) number = std::min(number, all / triangle.area);
    if (number >= 0) triangles[seen++] = number;
    if (one_may_decide && (number < surely_few || number > surely_many)) break;
  }
  if (seen == 0)
    return traced < max_traced && !by_origins ? TrianglesOfRays{max_of_a_ray, max_of_a_ray}
                                              : TrianglesOfRays{};
  TrianglesOfRays all_seen = summary_of({triangles.data(), seen});
  if (are_sparse) all_seen.mean = max_of_a_ray;
  return all_seen;
}

// Measured: from so many triangles a ray on streams take less time, and single rays where they are few.
bool packets_pay(const TrianglesOfRays& triangles, PacketsOf kind) {
  constexpr double of_closest = 0.35, of_any = 0.25, of_doubles = 1.5;
  const double most = kind == PacketsOf::doubles    ? of_doubles
                      : kind == PacketsOf::any_hits ? of_any
                                                    : of_closest;
  return triangles.mean < most;
}

template TrianglesOfRays triangles_of_a_ray<float>(const TreeView&, NearestTriangle<float>,
                                                   std::span<const Ray>, SharedApex, const Float3&, bool);
template TrianglesOfRays triangles_of_a_ray<double>(const DoubleTreeView&, NearestTriangle<double>,
                                                    std::span<const RayD>, SharedApex, const Double3&, bool);

}  // namespace raylanes
