#include "view_density.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace raylanes {
namespace {

// So many directions are looked at, some of them traced: of few rays at most some. More triangles than that count as
// that many.
constexpr std::size_t max_directions = 64, min_traced = 4, max_traced = 32, rays_of_a_traced = 64;
constexpr double max_of_a_ray = 8;
constexpr std::uint32_t none = ~std::uint32_t{0};
constexpr float infinity = std::numeric_limits<float>::infinity();

using Vector = std::array<double, 3>;

Vector to(const Float3& from, const Float3& point) {
  Vector way;
  for (std::size_t k = 0; k < 3; ++k) way[k] = static_cast<double>(point[k]) - static_cast<double>(from[k]);
  return way;
}
double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double length_of(const Vector& a) {
  return std::sqrt(dot(a, a));
}
Vector unit(Vector a) {
  const double length = length_of(a);
  for (double& x : a) x /= length;
  return a;
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// The i-th of places spread over `size` so that no rows or columns show: multiples of the golden ratio.
std::size_t spread(std::size_t i, std::size_t size) {
  const double turns = 0.6180339887498949 * static_cast<double>(i);
  return static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(size));
}

// The solid angle that directions fill, were they spread evenly over a rectangle: 12 times the root of their two
// greatest variances multiplied, by the sum of the principal minors of their covariance.
double solid_angle_of(std::span<const Vector> directions) {
  const auto n = static_cast<double>(directions.size());
  double mean[3] = {}, square[3][3] = {};
  for (const Vector& d : directions)
    for (std::size_t i = 0; i < 3; ++i) {
      mean[i] += d[i] / n;
      for (std::size_t k = 0; k < 3; ++k) square[i][k] += d[i] * d[k] / n;
    }
  const auto covariance = [&](std::size_t i, std::size_t k) { return square[i][k] - mean[i] * mean[k]; };
  double minors = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3;
    minors += covariance(i, i) * covariance(k, k) - covariance(i, k) * covariance(i, k);
  }
  return 12 * std::sqrt(std::max(minors, 0.0));
}

// A small triangle seen from a point.
struct SeenTriangle {
  double solid_angle, distance;

  SeenTriangle(const TreeView& tree, std::uint32_t leaf_triangle, const Float3& point) {
    const LeafBlock<9>& block = static_cast<const LeafBlock<9>*>(tree.blocks)[leaf_triangle / tree_width];
    const auto corner = [&](std::size_t k) {
      const std::size_t lane = leaf_triangle % tree_width;
      return to(point,
                {block.number[3 * k][lane], block.number[3 * k + 1][lane], block.number[3 * k + 2][lane]});
    };
    const Vector a = corner(0), b = corner(1), c = corner(2);
    Vector middle, e, f;
    for (std::size_t k = 0; k < 3; ++k)
      middle[k] = (a[k] + b[k] + c[k]) / 3, e[k] = b[k] - a[k], f[k] = c[k] - a[k];
    distance = length_of(middle);
    solid_angle = std::abs(dot(cross(e, f), middle)) / (2 * distance * distance * distance);
  }
};

// Between a ray and the next one, at a distance.
double solid_angle_between(const Ray& ray, const Ray& next, double distance) {
  const Vector d = unit(to({}, ray.direction)), e = unit(to({}, next.direction));
  const Vector apart = to(ray.origin, next.origin);
  Vector way;
  for (std::size_t k = 0; k < 3; ++k) way[k] = e[k] - d[k] + apart[k] / distance;
  return dot(way, way);
}

}  // namespace

double triangles_of_a_ray(const TreeView& tree, std::uint32_t (*nearest)(const TreeView&, const Ray&),
                          std::span<const Ray> rays, SharedApex shared, const Float3& point) {
  std::array<Vector, max_directions> directions;
  const auto seen_from_point = [&](std::size_t i) {
    const Ray& ray = rays[spread(i, rays.size())];
    return unit(shared == SharedApex::end ? to(point, ray.origin) : to({}, ray.direction));
  };
  double of_a_ray = 0;
  if (shared != SharedApex::none) {
    const std::span<Vector> some(directions.data(),
                                 std::clamp(rays.size() / 16, max_directions / 4, max_directions));
    for (std::size_t i = 0; i < some.size(); ++i) some[i] = seen_from_point(i);
    of_a_ray = solid_angle_of(some) / static_cast<double>(rays.size());
  }
  const std::size_t traced = std::clamp(rays.size() / rays_of_a_traced, min_traced, max_traced);
  double sum = 0;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < traced; ++i) {
    const std::size_t k = std::min(spread(i, rays.size()), rays.size() - 2);
    Ray ray{shared == SharedApex::none ? rays[k].origin : point, 0, rays[k].direction, infinity};
    if (shared == SharedApex::end)
      for (std::size_t axis = 0; axis < 3; ++axis)
        ray.direction[axis] = static_cast<float>(directions[i][axis]);
    const std::uint32_t leaf_triangle = nearest(tree, ray);
    if (leaf_triangle == none) continue;
    const SeenTriangle triangle(tree, leaf_triangle, ray.origin);
    const double share =
        shared == SharedApex::none ? solid_angle_between(rays[k], rays[k + 1], triangle.distance) : of_a_ray;
    const double triangles = share / triangle.solid_angle;
    if (!(triangles >= 0)) continue;
    sum += std::min(triangles, max_of_a_ray), ++seen;
  }
  if (seen == 0) return traced < max_traced ? max_of_a_ray : 0;
  return sum / static_cast<double>(seen);
}

}  // namespace raylanes
