#include "tree_counts.hpp"

#include "../../dispatch/table/kernel_table.hpp"
#include "../report/exits.hpp"
#include "../support/rulers/measure.hpp"

namespace raylanes::bench {

double CountedRays::per_ray(std::uint64_t TraceCounters::*what) const {
  return static_cast<double>(counters.*what) / static_cast<double>(std::max<std::size_t>(1, rays));
}
double CountedRays::triangle_tests_per_hit() const {
  return hits == 0 ? 0.0 : static_cast<double>(counters.triangle_tests) / static_cast<double>(hits);
}

CountedRays count(const TriangleTree& tree, const RaySet& set, RayKind kind, TraceOptions options,
                  Answers& answers, std::size_t batch) {
  CountedRays counted;
  counted.kind = kind, counted.rays = set.rays.size();
  options.counters = &counted.counters;
  if (options.test != TriangleTest::exact) options.mode = TraversalMode::single;
  const Contender contender = our_contender(tree, options, batch);
  counted.seconds = seconds_of([&] { contender.trace(set, answers); });
  counted.hits = answers.hit_count();
  return counted;
}

PixelTests count_pixels(const TriangleTree& tree, std::span<const Ray> rays, TraceOptions options) {
  PixelTests tests;
  for (const Ray& ray : rays) {
    TraceCounters counters;
    options.counters = &counters, options.mode = TraversalMode::single;
    tree.closest(ray, options);
    tests.triangles.push_back(counters.triangle_tests), tests.boxes.push_back(counters.box_tests);
  }
  return tests;
}

std::vector<TreeCounts> count_trees(const std::list<BuiltTree>& trees, const Workload& workload,
                                    const std::vector<RayKind>& kinds, TraceOptions options) {
  if (!kernels_of(paths().front()).has_counters()) return {};
  options.mode = TraversalMode::single;
  std::vector<TreeCounts> rows;
  for (const BuiltTree& tree : trees) rows.push_back({tree.kind, tree.bvh.report(), {}});
  for (const RayKind kind : kinds) {
    const RaySet set = workload.rays(kind);
    std::optional<Answers> first;
    std::size_t i = 0;
    for (const BuiltTree& tree : trees) {
      Answers answers(set);
      rows[i++].rays.push_back(count(tree.bvh, set, kind, options, answers));
      if (first && !answers.same_bytes(*first))
        throw WrongAnswers("trees: counted " + name_of(kind) + " rays have other answers in row " +
                           std::to_string(i));
      first = std::move(answers);
    }
  }
  return rows;
}

}  // namespace raylanes::bench
