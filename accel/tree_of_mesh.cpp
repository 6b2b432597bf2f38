#include "tree_of_mesh.hpp"

#include "builders/builder_table.hpp"
#include "builders/choice.hpp"
#include "builders/mesh_build.hpp"
#include "builders/reinsertion.hpp"
#include "layout/cost.hpp"

namespace raylanes {
namespace {

// The shares of a build's time at whose ends the boxes and the binary tree are there, about.
constexpr double end_of_boxes = 0.1, end_of_first_tree = 0.5, end_of_tree = 0.7, end_of_layout = 0.999;

// The builder and `optimize` that are chosen, into the options, by which a refit that has to build goes, too.
std::string take_choice(const Array<Reference>& references, const VertexView& vertices,
                        const IndexView& triangles, BuildOptions& options) {
  const double waste = box_waste(references, vertices, triangles);
  const TreeChoice choice = choose_tree(references.size(), waste, options.rays);
  options.builder = choice.builder, options.optimize = choice.optimize, options.choose = false;
  return choice.why;
}

WideTree build_on(VertexView vertices, IndexView triangles, BuildOptions options, int threads) {
  MeshBuild build(vertices, triangles, options.progress, threads, end_of_boxes);
  TreeReport report;
  std::vector<std::uint32_t> left_out = left_out_of(triangles.count, build.references);
  build.memory.hold(left_out.size() * sizeof(std::uint32_t));
  if (options.choose) report.choice = take_choice(build.references, vertices, triangles, options);
  report.boxes_seconds = build.watch.lap();
  build.progress.begin_phase(options.optimize ? end_of_first_tree : end_of_tree);
  const BuilderInfo& builder = builders[static_cast<std::size_t>(options.builder)];
  BinaryTree binary = builder.build({std::move(build.references), &build.clipper, build.run});
  report.tree_seconds = build.watch.lap();
  if (options.optimize) {
    build.progress.finish_phase();
    build.progress.begin_phase(end_of_tree);
    binary = reinserted(std::move(binary), build.run);
    report.optimize_seconds = build.watch.lap();
  }
  build.progress.finish_phase();
  build.progress.begin_phase(end_of_layout);
  WideTree tree = collapse_to_wide(binary, {vertices, triangles, options.test}, build.run);
  report.layout_seconds = build.watch.lap();
  report.peak_bytes = build.memory.peak();
  tree.mesh_triangles = triangles.count;
  tree.left_out = std::move(left_out);
  tree.built_cost = sah_cost(tree);
  tree.built_with = options;
  tree.built_with.progress = {};
  tree.build_report = report;
  build.finish();
  return tree;
}

}  // namespace

WideTree build_tree(VertexView vertices, IndexView triangles, const BuildOptions& options) {
  checked_index("bvh", "builder", options.builder, std::size(builders));
  return build_checked("bvh", triangles, options,
                       [&](int threads) { return build_on(vertices, triangles, options, threads); });
}

}  // namespace raylanes
