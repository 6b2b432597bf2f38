// From cells to a tree that is traced.
#pragma once

#include <raylanes/kdtree.hpp>

#include "../mesh/bounding_boxes.hpp"
#include "kd_cells.hpp"
#include "leaves.hpp"

namespace raylanes {

// The arrays behind a TreeView of a mesh in cells.
struct KdTreeArrays : TreeLeaves {
  std::vector<KdNode> nodes;
  std::vector<WideNode> wide_nodes;  // of the same cells, see collapse_cells
  TreeReference root = empty_reference;
  Box bounds = empty_box;

  std::size_t mesh_triangles = 0;
  KdBuildOptions built_with;  // but for what reports progress
  KdReport build_report;  // what the build took, and its triangles; the rest is counted where it is asked for

  std::size_t bytes() const {
    return nodes.size() * sizeof(KdNode) + wide_nodes.size() * sizeof(WideNode) + corners.bytes();
  }
  TreeView view() const {
    TreeView view{wide_nodes.data(), corners.blocks(), root, bounds, nodes.data()};
    view.max_fused_size = ready.max_fused_size;
    return view;
  }
};

// Makes nodes of up to eight children of a tree's planes, leaves one block each; their boxes are cells, cut down to
// what the triangles of their blocks take. The tree is valid.
void collapse_cells(KdTreeArrays& tree);

// Builds as the constructor of KdTree says.
KdTreeArrays build_kdtree(VertexView vertices, IndexView triangles, const KdBuildOptions& options);

// The tree's report with all that can be counted of it.
KdReport report_of(const KdTreeArrays& tree);

}  // namespace raylanes
