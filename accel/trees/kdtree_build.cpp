
#include "../builders/builder_table.hpp"
#include "../builders/kd/kd_builders.hpp"
#include "../builders/mesh_build.hpp"
#include "../layout/kdtree_arrays.hpp"
#include "../mesh/valid_mesh.hpp"

namespace raylanes {
namespace {

// The shares of a build's time at whose ends the boxes and the cells are there, about.
constexpr double end_of_boxes = 0.05, end_of_cells = 0.85, end_of_layout = 0.999;

// Makes leaves refer to blocks, which are given in ranges of the order.
std::vector<LeafRange> ranges_of(KdCells& cells) {
  std::vector<LeafRange> ranges;
  ranges.reserve(cells.nodes.size() / 2);
  for (KdNode& node : cells.nodes) {
    if (!node.is_leaf()) continue;
    const std::uint32_t begin = node.first(), end = begin + node.count();
    node = KdNode::leaf(static_cast<std::uint32_t>(ranges.size()), node.count());
    for (std::uint32_t i = begin; i < end; i += tree_width)
      ranges.push_back({i, std::min<std::uint32_t>(tree_width, end - i)});
  }
  if (ranges.size() > leaf_block_mask) throw std::length_error("kdtree: more than 2^28 blocks of triangles");
  return ranges;
}

KdTreeArrays build_on(VertexView vertices, IndexView triangles, const KdBuildOptions& options,
                      KdBuild build_nodes, int threads) {
  BuildMeters build(options.progress, threads, end_of_boxes);
  require_valid_mesh(vertices, triangles, threads);
  const TriangleClipper clipper(vertices, triangles);
  Array<Reference> references = references_of(vertices, triangles, build.run, end_of_boxes);
  KdTreeArrays tree;
  tree.build_report.triangles = references.size();
  tree.build_report.boxes_seconds = build.watch.lap();
  build.progress.begin_phase(end_of_cells);
  KdCells cells;
  if (references.size() > 0) {
    for (std::size_t i = 0; i < references.size(); ++i) extend(tree.bounds, plain_box(references[i].box));
    cells = build_nodes({std::move(references), &clipper, build.run});
  }
  tree.build_report.tree_seconds = build.watch.lap();
  build.progress.finish_phase();
  build.progress.begin_phase(end_of_layout);
  const std::vector<LeafRange> ranges = ranges_of(cells);
  build.memory.hold(ranges.size() * sizeof(LeafRange));
  tree.fill({vertices, triangles}, ranges, cells.order, build.run, end_of_layout - end_of_cells);
  tree.nodes = std::move(cells.nodes);
  collapse_cells(tree);
  build.memory.hold(tree.wide_nodes.size() * sizeof(WideNode));
  tree.build_report.layout_seconds = build.watch.lap();
  tree.build_report.peak_bytes = build.memory.peak();
  tree.mesh_triangles = triangles.count;
  tree.built_with = options;
  tree.built_with.progress = {};
  build.finish();
  return tree;
}

}  // namespace

KdTreeArrays build_kdtree(VertexView vertices, IndexView triangles, const KdBuildOptions& options) {
  const KdBuilderInfo& builder = checked_row("kdtree", "builder", kd_builders, options.builder);
  return build_checked("kdtree", triangles, options, [&](int threads) {
    return build_on(vertices, triangles, options, builder.build, threads);
  });
}

}  // namespace raylanes
