#include "tree_experiment.hpp"

#include <cmath>
#include <cstring>
#include <stdexcept>

#include <raylanes/intersect.hpp>

#include "../report/exits.hpp"
#include "../support/rulers/measure.hpp"

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

// Some rays, spread evenly over all, but in step with no row of a picture: by the golden ratio.
std::vector<Ray> sample_of(const std::vector<Ray>& rays) {
  constexpr std::size_t sample = 64;
  constexpr double golden = 0.6180339887498949;
  std::vector<Ray> some;
  for (std::size_t i = 0; i < std::min(sample, rays.size()); ++i) {
    const double place = golden * static_cast<double>(i);
    some.push_back(
        rays[static_cast<std::size_t>((place - std::floor(place)) * static_cast<double>(rays.size()))]);
  }
  return some;
}

// The triangles that a ray finds nearer than those before them.
std::uint64_t hits_found(const Ray& ray, const Triangles& triangles, const TriangleOptions& options) {
  std::vector<std::uint8_t> bits((triangles.size() + 7) / 8);
  hit_mask(ray, triangles.all(), bits, options);
  std::uint64_t found = 0;
  Ray left = ray;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if ((bits[i / 8] >> i % 8 & 1) != 0)
      if (const Hit hit = closest_hit(left, triangles.from(i, 1), options)) ++found, left.tmax = hit.t;
  return found;
}

ExperimentRow::Rays without_tree(const RaySet& set, RayKind kind, const Triangles& triangles,
                                 const Path* path, const TriangleTree& tree) {
  const TriangleOptions options{.path = path};
  const std::vector<Ray> rays = sample_of(set.rays);
  std::vector<Hit> hits(rays.size()), expected(rays.size());
  ExperimentRow::Rays row;
  row.counted.kind = kind, row.counted.rays = rays.size();
  row.counted.counters.triangle_tests = rays.size() * triangles.size();
  row.single_seconds = seconds_of([&] {
                         for (std::size_t i = 0; i < rays.size(); ++i)
                           hits[i] = closest_hit(rays[i], triangles.all(), options);
                       }) /
                       static_cast<double>(std::max<std::size_t>(1, rays.size()));
  tree.closest(rays, expected, {.path = path});
  row.lone_seconds = row.batch_seconds = row.single_seconds;
  if (!hits.empty() && std::memcmp(hits.data(), expected.data(), hits.size() * sizeof(Hit)) != 0)
    throw WrongAnswers("trees: " + set.name + " rays have other answers without a tree");
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
  const std::function<double()> builds[] = {
      [&] { return seconds_of([&] { midpoint = KdTree(scene.mesh, {.builder = KdBuilder::midpoint}); }); },
      [&] { return seconds_of([&] { sah = KdTree(scene.mesh); }); },
      [&] { return seconds_of([&] { bvh = Bvh(scene.mesh); }); }};
  const std::vector<Timing> of_builds = take_timed_turns(builds, {seconds, 3});
  std::vector<ExperimentRow> rows{
      {"none", "", 0.0, 0, {}},
      {"kdtree", std::string(kd_builder_names[0]), of_builds[0].median_seconds, midpoint.bytes(), {}},
      {"kdtree", std::string(kd_builder_names[1]), of_builds[1].median_seconds, sah.bytes(), {}},
      {"bvh",
       std::string(tree_builder_names[static_cast<std::size_t>(BuildOptions{}.builder)]),
       of_builds[2].median_seconds,
       bvh.bytes(),
       {}}};
  const TriangleTree* const trees[] = {&midpoint, &sah, &bvh};
  const Triangles triangles(scene.mesh);
  const Workload workload(scene, bvh, width, height);
  const TraceOptions single{.mode = TraversalMode::single, .path = path}, automatic{.path = path};
  for (const RayKind kind : kinds) {
    const RaySet set = workload.rays(kind);
    rows[0].rays.push_back(without_tree(set, kind, triangles, path, bvh));
    Answers first(set), answers(set);
    std::vector<std::function<void()>> work;
    for (std::size_t i = 0; i < std::size(trees); ++i) {
      rows[i + 1].rays.push_back({count(*trees[i], set, kind, single, i == 0 ? first : answers)});
      for (const Contender& way : {our_contender(*trees[i], single), our_contender(*trees[i], automatic, 1),
                                   our_contender(*trees[i], automatic)}) {
        way.trace(set, answers);
        if (!answers.same_bytes(first))
          throw WrongAnswers("trees: " + set.name + " rays have other answers in a " + rows[i + 1].tree);
        work.push_back([&, trace = way.trace] { trace(set, answers); });
      }
    }
    const std::vector<Timing> timings = take_turns(work, {seconds, 3});
    const double rays = static_cast<double>(std::max<std::size_t>(1, set.rays.size()));
    for (std::size_t i = 0; i < std::size(trees); ++i) {
      ExperimentRow::Rays& row = rows[i + 1].rays.back();
      row.single_seconds = timings[3 * i].median_seconds / rays;
      row.lone_seconds = timings[3 * i + 1].median_seconds / rays;
      row.batch_seconds = timings[3 * i + 2].median_seconds / rays;
    }
  }
  return rows;
}

}  // namespace raylanes::bench
