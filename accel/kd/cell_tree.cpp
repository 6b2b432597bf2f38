#include "cell_tree.hpp"

#include <stdexcept>

#include "../../dispatch/checked.hpp"
#include "../in_parallel.hpp"
#include "../mesh/mesh_references.hpp"
#include "../mesh/triangle_clipper.hpp"
#include "collapse_cells.hpp"

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

CellTree build_on(VertexView vertices, IndexView triangles, const KdBuildOptions& options, KdBuild build,
                  int threads) {
  ProgressMeter progress(options.progress);
  MemoryMeter memory;
  const BuildRun run{threads, progress, memory};
  CellTree tree;
  StopWatch watch;
  progress.advance(0.0);
  progress.begin_phase(end_of_boxes);
  validate_mesh(vertices, triangles);
  const TriangleClipper clipper(vertices, triangles);
  Array<Reference> references = references_of(vertices, triangles, run, end_of_boxes);
  tree.build_report.triangles = references.size();
  tree.build_report.boxes_seconds = watch.lap();
  progress.begin_phase(end_of_cells);
  KdCells cells;
  if (references.size() > 0) {
    for (std::size_t i = 0; i < references.size(); ++i) extend(tree.bounds, plain_box(references[i].box));
    cells = build({std::move(references), &clipper, run});
  }
  tree.build_report.tree_seconds = watch.lap();
  progress.finish_phase();
  progress.begin_phase(end_of_layout);
  const std::vector<LeafRange> ranges = ranges_of(cells);
  memory.hold(ranges.size() * sizeof(LeafRange));
  tree.fill({vertices, triangles, options.test}, ranges, cells.order, run, end_of_layout - end_of_cells);
  tree.nodes = std::move(cells.nodes);
  collapse_cells(tree);
  memory.hold(tree.wide_nodes.size() * sizeof(WideNode));
  tree.build_report.layout_seconds = watch.lap();
  tree.build_report.peak_bytes = memory.peak();
  tree.mesh_triangles = triangles.count;
  tree.built_with = options;
  tree.built_with.progress = {};
  progress.begin_phase(1.0);
  progress.finish_phase();
  return tree;
}

}  // namespace

CellTree build_cells(VertexView vertices, IndexView triangles, const KdBuildOptions& options) {
  checked_tree_test("kdtree", options.test);
  const KdBuilderInfo& builder = checked_row("kdtree", "builder", kd_builders, options.builder);
  require_threads("kdtree", options.threads);
  require_triangle_count("kdtree", triangles.count);
  CellTree tree;
  on_threads(options.threads,
             [&](int threads) { tree = build_on(vertices, triangles, options, builder.build, threads); });
  return tree;
}

}  // namespace raylanes
