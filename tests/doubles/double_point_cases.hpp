// Points beside meshes of doubles, and what holds for their closest points.
#pragma once

#include "../../bench/support/oracles/exact_point.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {

inline constexpr double infinite = std::numeric_limits<double>::infinity(),
                        not_a_number = std::numeric_limits<double>::quiet_NaN(),
                        largest = std::numeric_limits<double>::max();

// At corners, on edges and faces, a step of a double beside them, anywhere, and far away.
inline std::vector<Double3> points_for(const DoubleMesh& mesh, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Double3> points;
  for (const RayD& ray : aimed_rays(mesh, count / 3, seed)) {
    Double3 target = ray.origin;
    for (std::size_t k = 0; k < 3; ++k) target[k] += ray.direction[k];
    points.push_back(ray.origin), points.push_back(target);
    for (double& x : target) x = std::nextafter(x, random.chance(0.5) ? infinite : -infinite);
    points.push_back(target);
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 5 + mesh.vertices.size() / 20)
    points.push_back(mesh.vertices[i]);
  for (Double3& point : points)
    for (double& x : point) x = std::isnan(x) ? 0 : std::clamp(x, -largest, largest);
  return points;
}
// Points so near to each other that they go together.
inline std::vector<Double3> clusters(const std::vector<Double3>& points, double size, std::uint64_t seed) {
  Random random(seed);
  std::vector<Double3> result;
  for (const Double3& point : points) {
    const double off = random.chance(0.2) ? 0.0 : size * std::ldexp(1.0, random.integer(-20, -4));
    for (int i = 0; i < 40; ++i) {
      result.push_back(point);
      for (double& x : result.back()) x += off * random.real(-1, 1);
    }
  }
  return result;
}
inline double size_of(const DoubleMesh& mesh) {
  double size = 0;
  for (const Double3& v : mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k)
      size = std::max(size, std::abs(0.5 * v[k] - 0.5 * mesh.vertices[0][k]));
  return size;
}

inline std::vector<ClosestPointD> closest_of(const BvhD& tree, std::span<const Double3> points,
                                             const ClosestPointOptionsD& options = {}) {
  std::vector<ClosestPointD> closest(points.size());
  tree.closest_points(points, closest, options);
  return closest;
}
inline void expect_same(const std::vector<ClosestPointD>& found, const std::vector<ClosestPointD>& expected,
                        const std::string& name) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_TRUE(same_bytes(found[i], expected[i]))
        << name << ", point " << i << ": " << found[i].primitive << " at " << found[i].distance << ", not "
        << expected[i].primitive << " at " << expected[i].distance;
}

// The least of all triangles, each in a tree of its own; compared where no square leaves the range of doubles.
inline std::vector<ClosestPointD> one_by_one(const DoubleMesh& mesh, std::span<const Double3> points,
                                             double most = infinite) {
  const double size = size_of(mesh);
  const int exponent = size > 0x1p400 ? -900 : size < 0x1p-400 && size > 0 ? 900 : 0;
  const auto scaled = [&](std::span<const Double3> some) {
    std::vector<Double3> result(some.begin(), some.end());
    for (Double3& p : result)
      for (double& x : p) x = std::ldexp(x, exponent);
    return result;
  };
  const std::vector<Double3> vertices = scaled(mesh.vertices), to = scaled(points);
  std::vector<ClosestPointD> closest(points.size());
  std::vector<double> least(points.size(), infinite);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::vector<Index3> triangle{mesh.triangles[t]};
    const BvhD tree(mesh.vertices, triangle), of_scaled(vertices, triangle);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ClosestPointD here = tree.closest_point(points[i], {.max_distance = most, .path = &paths().front()});
      if (!here) continue;
      const double square = exponent == 0
                                ? here.distance_squared
                                : of_scaled.closest_point(to[i], {.path = &paths().front()}).distance_squared;
      if (!(square < least[i])) continue;
      here.primitive = static_cast<std::uint32_t>(t);
      closest[i] = here, least[i] = square;
    }
  }
  return closest;
}

inline void expect_near(const DoubleMesh& mesh, std::span<const Double3> points,
                        const std::vector<ClosestPointD>& found, const std::string& name) {
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_EQ(fault_of_closest_point(mesh, points[i], found[i]), "") << name << ", point " << i;
}

}  // namespace raylanes::testing
