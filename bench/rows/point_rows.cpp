#include "point_rows.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include <raylanes/bvh.hpp>
#include <raylanes/kdtree.hpp>

#include "../contenders/rivals.hpp"
#include "../support/scenes/splitmix.hpp"

namespace raylanes::bench {
namespace {

using Work = std::function<void(std::span<const Float3>, std::span<double>)>;

struct Finder {
  std::string name, path;
  Work work;
};

Finder finder_of(const char* name, const TriangleTree& tree, const Path& path, int threads) {
  return {name, path.name,
          [&tree, &path, threads](std::span<const Float3> points, std::span<double> squared) {
            std::vector<ClosestPoint> closest(points.size());
            tree.closest_points(points, closest, {.path = &path, .threads = threads});
            for (std::size_t i = 0; i < closest.size(); ++i) squared[i] = closest[i].distance_squared;
          }};
}

}  // namespace

double largest_difference(std::span<const double> a, std::span<const double> b, double diagonal) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;  // infinite ones as well
    const double difference = std::abs(std::sqrt(a[i]) - std::sqrt(b[i])) / diagonal;
    most = std::isnan(difference) ? std::numeric_limits<double>::infinity() : std::max(most, difference);
  }
  return most;
}

std::vector<Float3> points_of(const Scene& scene, PointKind kind, std::size_t count) {
  SplitMix random(27);
  const Box box = bounds_of(scene.mesh);
  const double off = 0.01 * diagonal_of(scene.mesh);
  std::vector<Float3> points(count);
  for (Float3& point : points) {
    const std::size_t triangles = scene.mesh.triangles.size();
    const auto triangle = static_cast<std::size_t>(random.uniform() * static_cast<double>(triangles));
    const double v = 1 - std::sqrt(random.uniform()), u = random.uniform() * (1 - v);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto corner = [&](std::size_t k) {
        return static_cast<double>(scene.mesh.vertices[scene.mesh.triangles[triangle][k]][axis]);
      };
      const double lo = static_cast<double>(box.lo[axis]), extent = static_cast<double>(box.hi[axis]) - lo;
      const double x = kind == PointKind::box ? lo + (1.2 * random.uniform() - 0.1) * extent
                                              : (1 - u - v) * corner(0) + u * corner(1) + v * corner(2) +
                                                    (2 * random.uniform() - 1) * off / std::sqrt(3.0);
      point[axis] = static_cast<float>(x);
    }
  }
  return points;
}

std::vector<PointRow> measure_points(const Scene& scene, const PointRowsOptions& options) {
  const Bvh bvh(scene.mesh);
  const KdTree kd(scene.mesh);
  std::unique_ptr<EmbreePoints> embree;
  std::unique_ptr<CgalPoints> cgal;
  std::vector<Finder> finders;
  for (const Path* path : options.paths) finders.push_back(finder_of("bvh", bvh, *path, options.threads));
  const std::size_t ours = finders.size() - 1;
  for (const Path* path : options.paths) finders.push_back(finder_of("kdtree", kd, *path, options.threads));
  if (options.against_embree) {
    embree = std::make_unique<EmbreePoints>(scene.mesh);
    finders.push_back({"embree", "", [&](auto points, auto squared) { embree->closest(points, squared); }});
  }
  if (options.against_cgal) {
    cgal = std::make_unique<CgalPoints>(scene.mesh);
    finders.push_back({"cgal", "", [&](auto points, auto squared) { cgal->closest(points, squared); }});
  }
  std::vector<PointRow> rows;
  for (const PointKind kind : options.kinds) {
    const std::vector<Float3> points = points_of(scene, kind, options.count);
    std::vector<std::vector<double>> squared(finders.size(), std::vector<double>(points.size()));
    std::vector<std::function<void()>> contenders;
    for (std::size_t i = 0; i < finders.size(); ++i)
      contenders.push_back([&, i] { finders[i].work(points, squared[i]); });
    const std::vector<Timing> timings = take_turns(contenders, {options.seconds, 5});
    for (std::size_t i = 0; i < finders.size(); ++i) {
      PointRow row{kind, finders[i].name, finders[i].path, 0, 0, {}, 0};
      row.mpoints_per_second = static_cast<double>(points.size()) / timings[i].median_seconds * 1e-6;
      row.spread = timings[i].spread;
      if (i != ours) row.behind = speed_ratio(timings[ours], timings[i]);
      row.largest_difference = largest_difference(squared[ours], squared[i], diagonal_of(scene.mesh));
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace raylanes::bench
