#include "../builders/builder_table.hpp"
#include "../builders/choice.hpp"
#include "../builders/mesh_build.hpp"
#include "../layout/bvh_arrays.hpp"
#include "../layout/cost.hpp"

namespace raylanes {
namespace {

BvhArrays build_on(VertexView vertices, IndexView triangles, BuildOptions options, int threads) {
  MeshBuild build(vertices, triangles, options.progress, threads, end_of_bvh_boxes);
  TreeReport report;
  std::vector<std::uint32_t> left_out = left_out_of(triangles.count, build.references);
  build.memory.hold(left_out.size() * sizeof(std::uint32_t));
  if (options.choose)
    report.choice = take_choice(build.references, box_waste(build.references, vertices, triangles), options);
  BinaryTree binary = binary_tree_of(std::move(build.references), &build.clipper, options, build, report);
  BvhArrays tree = collapse_to_bvh(std::move(binary), {vertices, triangles}, build.run);
  report.layout_seconds = build.watch.lap();
  report.peak_bytes = build.memory.peak();
  tree.left_out = std::move(left_out);
  tree.built_cost = sah_cost(tree);
  tree.set_build(options, triangles.count, std::move(report));
  build.finish();
  return tree;
}

}  // namespace

BvhArrays build_bvh(VertexView vertices, IndexView triangles, const BuildOptions& options) {
  checked_index("bvh", "builder", options.builder, std::size(builders));
  return build_checked("bvh", triangles, options,
                       [&](int threads) { return build_on(vertices, triangles, options, threads); });
}

}  // namespace raylanes
