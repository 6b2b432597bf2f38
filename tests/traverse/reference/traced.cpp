#include "traced.hpp"

#include "../../../bench/support/oracles/exact_rays.hpp"
#include "../../support/float_modes.hpp"
#include "../../support/same_bytes.hpp"
#include "../../support/supported_paths.hpp"
#include "reference_tracer.hpp"

namespace raylanes::testing {

std::vector<TraceOptions> ways_to_trace(const TraceOptions& base) {
  std::vector<TraceOptions> ways;
  for (const Path* path : supported_paths())
    for (std::size_t mode = 0; mode < traversal_kernel_modes; ++mode) {
      ways.push_back(base);
      ways.back().path = path;
      ways.back().mode = static_cast<TraversalMode>(mode);
    }
  return ways;
}

std::vector<TraceOptions> ways_by_every_test() {
  std::vector<TraceOptions> ways;
  for (const TriangleTestInfo& info : triangle_tests)
    for (const Grade grade : {Grade::reproducible, Grade::fast})
      for (const TraceOptions& way : ways_to_trace({.test = info.test, .grade = grade}))
        if (info.serves_trees) ways.push_back(way);
  return ways;
}

std::string name_of(const TraceOptions& options) {
  const auto pick = [](const auto& names, auto value) {
    return " " + std::string(names[static_cast<std::size_t>(value)]);
  };
  return options.path->name + pick(traversal_mode_names, options.mode) +
         pick(triangle_test_names, options.test) + pick(grade_names, options.grade) + ' ' +
         std::to_string(options.threads) + " threads";
}

std::vector<Hit> trace(const TriangleTree& tree, std::span<const Ray> rays, const TraceOptions& options) {
  std::vector<Hit> hits(rays.size());
  tree.closest(rays, hits, options);
  return hits;
}

std::vector<std::uint8_t> trace_occluded(const TriangleTree& tree, std::span<const Ray> rays,
                                         const TraceOptions& options) {
  std::vector<std::uint8_t> occluded(rays.size(), 0xa5);
  tree.occluded(rays, occluded, options);
  return occluded;
}

namespace {

void expect_hits_in_one_way(const TriangleTree& tree, std::span<const Ray> rays,
                            std::span<const Hit> expected, const TraceOptions& options) {
  const std::vector<Hit> hits = trace(tree, rays, options);
  const auto wrong = std::mismatch(hits.begin(), hits.end(), expected.begin(),
                                   [](const Hit& a, const Hit& b) { return same_bytes(a, b); });
  if (wrong.first != hits.end())
    ADD_FAILURE() << name_of(options) << " ray " << wrong.first - hits.begin() << ": primitive "
                  << wrong.first->primitive << " at " << wrong.first->t << " instead of "
                  << wrong.second->primitive << " at " << wrong.second->t;
  const std::vector<std::uint8_t> occluded = trace_occluded(tree, rays, options);
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (occluded[i] != (expected[i].primitive == no_primitive ? 0 : 1)) {
      ADD_FAILURE() << name_of(options) << " ray " << i << ": occluded = " << int{occluded[i]}
                    << ", the nearest hit is " << expected[i].primitive;
      return;
    }
}

}  // namespace

void expect_hits(const TriangleTree& tree, std::span<const Ray> rays, std::span<const Hit> expected,
                 const TraceOptions& base) {
  for (const TraceOptions& options : ways_to_trace(base))
    expect_hits_in_one_way(tree, rays, expected, options);
  TraceOptions threaded = ways_to_trace(base).back();
  threaded.threads = 2;
  expect_hits_in_one_way(tree, rays, expected, threaded);
}

std::size_t expect_brute_force(const Mesh& mesh, std::span<const Ray> rays, bool are_needles) {
  const Bvh bvh(mesh.vertices, mesh.triangles);
  const std::vector<Hit> exact = oracle::nearest_hits(mesh, rays);
  const KdTree cells(mesh), midpoint(mesh, {.builder = KdBuilder::midpoint});
  for (const TriangleTree* tree : std::initializer_list<const TriangleTree*>{&bvh, &cells, &midpoint})
    expect_hits(*tree, rays, exact);
  if (!quick()) expect_hits(bvh, rays, exact, {.grade = Grade::fast});
  const std::vector<Hit> watertight = brute_force(mesh.vertices, mesh.triangles, rays);
  expect_hits(bvh, rays, watertight, {.test = TriangleTest::watertight});
  if (!are_needles) expect_hits(cells, rays, watertight, {.test = TriangleTest::watertight});
  return static_cast<std::size_t>(
      std::count_if(exact.begin(), exact.end(), [](const Hit& hit) { return !!hit; }));
}

std::size_t expect_exact_hits(const TriangleTree& tree, const Mesh& mesh, std::span<const Ray> rays) {
  const std::vector<Hit> hits = oracle::nearest_hits(mesh, rays);
  expect_hits(tree, rays, hits);
  const FloatModeScope scope(FloatMode::flush);
  expect_hits(tree, rays, hits);
  return static_cast<std::size_t>(std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return !!h; }));
}

void expect_exact(const Mesh& mesh, std::span<const Ray> rays, std::size_t min_hits) {
  const Bvh bvh(mesh);
  EXPECT_GE(expect_exact_hits(bvh, mesh, rays), min_hits);
  expect_exact_hits(KdTree(mesh), mesh, rays);
  TraceOptions scalar{.mode = TraversalMode::single, .path = &paths().front()};
  std::vector<std::uint32_t> skip;
  for (const Hit& hit : trace(bvh, rays, scalar))
    skip.push_back(skip.size() % 4 == 3 ? no_primitive : hit.primitive);
  for (const TraceOptions& base :
       {TraceOptions{.facing = Facing::front}, TraceOptions{.facing = Facing::back, .skip = skip},
        TraceOptions{.skip = skip}}) {
    scalar.facing = base.facing, scalar.skip = base.skip;
    expect_hits(bvh, rays, trace(bvh, rays, scalar), base);
  }
}

}  // namespace raylanes::testing
