#include "tree_experiment.hpp"

#include <cstring>
#include <stdexcept>

#include <raylanes/intersect.hpp>

#include "../rulers/measure.hpp"

namespace raylanes::bench {
namespace {

// All triangles, as arrays.
class Triangles {
 public:
  explicit Triangles(const Mesh& mesh) {
    for (auto& row : numbers_) row.reserve(mesh.triangles.size());
    for (const Index3& triangle : mesh.triangles)
      for (std::size_t k = 0; k < 9; ++k) numbers_[k].push_back(mesh.vertices[triangle[k / 3]][k % 3]);
  }
  std::size_t size() const { return numbers_[0].size(); }
  TriangleArrays from(std::size_t first, std::size_t count) const {
    TriangleArrays arrays{};
    for (std::size_t k = 0; k < 9; ++k) arrays.corner[k / 3][k % 3] = numbers_[k].data() + first;
    arrays.size = count;
    return arrays;
  }
  TriangleArrays all() const { return from(0, size()); }

 private:
  std::vector<float> numbers_[9];
};

// One of some rays, spread over all.
std::vector<Ray> sample_of(const std::vector<Ray>& rays) {
  constexpr std::size_t sample = 64;
  std::vector<Ray> some;
  for (std::size_t i = 0; i < rays.size(); i += rays.size() / sample + 1) some.push_back(rays[i]);
  return some;
}

// The triangles that a ray finds nearer than those before them.
std::uint64_t hits_found(const Ray& ray, const Triangles& triangles, const TriangleOptions& options) {
  std::vector<std::uint8_t> bits((triangles.size() + 7) / 8);
  any_hits(ray, triangles.all(), bits, options);
  std::uint64_t found = 0;
  Ray left = ray;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if ((bits[i / 8] >> i % 8 & 1) != 0)
      if (const Hit hit = closest_hit(left, triangles.from(i, 1), options)) ++found, left.tmax = hit.t;
  return found;
}

ExperimentRow::Rays without_tree(const RaySet& set, RayKind kind, const Triangles& triangles,
                                 const Path* path, AnyTree tree) {
  const TriangleOptions options{.path = path};
  const std::vector<Ray> rays = sample_of(set.rays);
  std::vector<Hit> hits(rays.size()), expected(rays.size());
  ExperimentRow::Rays row;
  row.counted.kind = kind, row.counted.rays = rays.size();
  row.counted.counters.triangle_tests = rays.size() * triangles.size();
  row.seconds_per_ray = seconds_of([&] {
                          for (std::size_t i = 0; i < rays.size(); ++i)
                            hits[i] = closest_hit(rays[i], triangles.all(), options);
                        }) /
                        static_cast<double>(std::max<std::size_t>(1, rays.size()));
  tree.visit([&](const auto& t) { t.closest(rays, expected, {.path = path}); });
  if (!hits.empty() && std::memcmp(hits.data(), expected.data(), hits.size() * sizeof(Hit)) != 0)
    throw std::runtime_error("trees: " + set.name + " rays have other answers without a tree");
  for (std::size_t i = 0; i < rays.size(); ++i) {
    row.counted.counters.hits += hits_found(rays[i], triangles, options);
    row.counted.hits += hits[i] ? 1 : 0;
  }
  return row;
}

}  // namespace

std::vector<ExperimentRow> run_experiment(const Scene& scene, const std::vector<RayKind>& kinds,
                                          const Path* path, std::uint32_t width, std::uint32_t height,
                                          double seconds) {
  KdTree midpoint, sah;
  Bvh bvh;
  std::vector<ExperimentRow> rows{{"none", "", 0.0, 0, {}}};
  const auto add = [&](const char* tree, std::string_view build, double build_seconds, std::size_t bytes) {
    rows.push_back({tree, std::string(build), build_seconds, bytes, {}});
  };
  const double of_midpoint =
      seconds_of([&] { midpoint = KdTree(scene.mesh, {.builder = KdBuilder::midpoint}); });
  add("kdtree", kd_builder_names[0], of_midpoint, midpoint.bytes());
  const double of_sah = seconds_of([&] { sah = KdTree(scene.mesh); });
  add("kdtree", kd_builder_names[1], of_sah, sah.bytes());
  const double of_bvh = seconds_of([&] { bvh = Bvh(scene.mesh); });
  add("bvh", tree_builder_names[static_cast<std::size_t>(BuildOptions{}.builder)], of_bvh, bvh.bytes());
  const AnyTree trees[] = {midpoint, sah, bvh};
  const Triangles triangles(scene.mesh);
  const Workload workload(scene, bvh, width, height);
  const TraceOptions single{.mode = TraversalMode::single, .path = path};
  for (const RayKind kind : kinds) {
    const RaySet set = workload.rays(kind);
    rows[0].rays.push_back(without_tree(set, kind, triangles, path, bvh));
    Answers first(set), answers(set);
    std::vector<std::function<void()>> work;
    for (std::size_t i = 0; i < std::size(trees); ++i) {
      rows[i + 1].rays.push_back({count(trees[i], set, kind, single, i == 0 ? first : answers), 0.0});
      if (i > 0 && !answers.same_bytes(first))
        throw std::runtime_error("trees: " + set.name + " rays have other answers in a " + rows[i + 1].tree);
      work.push_back([&, i, trace = our_contender(trees[i], single).trace] { trace(set, answers); });
    }
    const std::vector<Timing> timings = take_turns(work, {seconds, 3});
    for (std::size_t i = 0; i < std::size(trees); ++i)
      rows[i + 1].rays.back().seconds_per_ray =
          timings[i].median_seconds / static_cast<double>(std::max<std::size_t>(1, set.rays.size()));
  }
  return rows;
}

}  // namespace raylanes::bench
