// A tree over triangles of doubles: nodes of floats in a frame of the tree, leaves of doubles.
#pragma once

#include <raylanes/doubles.hpp>

#include "../../dispatch/table/double_rays.hpp"
#include "../batch/ray_source.hpp"
#include "../batch/triangle_masks.hpp"
#include "../layout/bvh_arrays.hpp"
#include "../mesh/boundary.hpp"

namespace raylanes {

// References of leaves number halves; boxes of nodes are in the frame.
struct BvhDArrays : NodesOfMesh {
  Array<LeafHalf> halves;
  std::size_t leaves = 0;
  TreeFrame frame;
  BoxD mesh_bounds = empty_double_box;
  LastingView<DoubleTreeView> ready;                     // of calls with one ray; as view()
  mutable std::shared_ptr<const BoundaryTree> boundary;  // as TreeLeaves::boundary

  BvhDArrays() = default;
  BvhDArrays(BvhDArrays&&) = default;
  BvhDArrays& operator=(BvhDArrays&&) = default;
  // Without what TreeLeaves leaves out.
  BvhDArrays(const BvhDArrays& other)
      : NodesOfMesh(other),
        halves(other.halves),
        leaves(other.leaves),
        frame(other.frame),
        mesh_bounds(other.mesh_bounds) {}

  DoubleTreeView view() const {
    DoubleTreeView view{{nodes.data(), nullptr, live_root(), bounds}, halves.data(), frame, mesh_bounds};
    view.tree.streams_from = streams_from;
    view.tree.rays_wait = rays_wait && view.tree.root != empty_reference;
    return view;
  }
  std::size_t bytes() const { return nodes.size() * sizeof(WideNode) + halves.bytes(); }
};

// The corners of a leaf triangle.
inline CornersOf<double> corners_of(const DoubleTreeView& tree, std::uint32_t leaf_triangle) {
  const TrianglesOfHalves triangles{tree.halves};
  CornersOf<double> corners;
  for (std::size_t k = 0; k < 9; ++k)
    corners.vertex[k / 3][k % 3] = triangles.number(static_cast<int>(k), leaf_triangle);
  return corners;
}

// The view of a tree; a null pointer is the empty tree.
inline DoubleTreeView view_of(const BvhDArrays* tree) {
  return tree != nullptr
             ? tree->view()
             : DoubleTreeView{{nullptr, nullptr, empty_reference, empty_box}, nullptr, {}, empty_double_box};
}

// A tree with what kernels know of the options' masks.
inline DoubleTreeView masked(DoubleTreeView tree, const TraceOptionsD& options) {
  tree.tree.masks = masks_of(options);
  return tree;
}

// As BvhD::each_triangle(): without those that collapsed at a refit.
template <class Visit>
void each_triangle(const BvhDArrays& tree, const Visit& visit) {
  const TrianglesOfHalves triangles{tree.halves.data()};
  each_leaf_reference(tree, [&](TreeReference reference) {
    const LeafReference leaf = leaf_of(reference);
    const std::uint32_t first = TrianglesOfHalves::first_of(leaf);
    for (std::uint32_t triangle = first; triangle < first + leaf.size; ++triangle) {
      std::array<Double3, 3> corners;
      for (int k = 0; k < 9; ++k)
        corners[static_cast<std::size_t>(k / 3)][static_cast<std::size_t>(k % 3)] =
            triangles.number(k, triangle);
      if (!has_equal_corners(corners[0], corners[1], corners[2]))
        visit(triangles.primitive(triangle), corners);
    }
  });
}

// Builds as the constructor of BvhD says.
BvhDArrays build_bvh_d(VertexViewD vertices, IndexView triangles, const BuildOptions& options);
// The corners of each triangle of the mesh, three equal ones of a triangle without a leaf.
std::vector<CornersOf<double>> triangles_of(const BvhDArrays& tree);
// As refit_tree().
void refit_bvh_d(BvhDArrays& tree, const VertexViewD& vertices, const IndexView& triangles, int threads);

// The kernels of the path that the options name, which are checked.
const DoubleRayKernels& checked_kernels(const TraceOptionsD& options);

// As BvhD::closest() and BvhD::occluded().
void trace_hits(const DoubleTreeView& tree, const RaySourceOf<double>& rays, const HitViewD& hits,
                const TraceOptionsD& options);
void trace_occluded(const DoubleTreeView& tree, const RaySourceOf<double>& rays,
                    std::span<std::uint8_t> occluded, const TraceOptionsD& options);

}  // namespace raylanes
