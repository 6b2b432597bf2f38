// Kernels for winding numbers of meshes with boundaries. Contracts: TriangleTree::winding_numbers(), and that of BvhD.
#pragma once

#include <cstddef>
#include <cstdint>

namespace raylanes {

// Degrees of the expansions: points far from a node need the terms up to the lower one, nearer ones all terms.
inline constexpr int low_degree = 2, full_degree = 6;
// The terms of degrees 1 to `degree`: degree n has 2n + 1 of them.
constexpr int expansion_terms(int degree) {
  return degree * (degree + 2);
}

// A closed part of the boundary: corners in order; an edge goes from each to the next one, from the last to the first.
struct BoundaryLoop {
  std::uint32_t first, count;
};

// A power of two that brings the longest side of a boundary's box to 1/2 to 1, as far as doubles do: as two factors, so
// that neither large numbers overflow nor small ones are flushed before they are subtracted.
struct BoundaryScale {
  double before = 1.0, after = 1.0;  // the first is at most 1, the second at least 1; one of them is 1

  double difference(double a, double b) const { return (a * before - b * before) * after; }
};

// Loops of the boundary that lie together, their caps (fans from the first corner of each) within a ball. Distances
// are multiplied by BoundaryView::scale.
struct BoundaryNode {
  double center[3];    // of the ball, as corners are given
  double radius;       // rounded up
  double share_until;  // the area of the caps up to this node's end, in the order of nodes, over that of all
  // The error of an expansion at the distance r is at most low_error/(r²·(r − radius)²) by the terms of low degree, and
  // full_error/(r⁶·(r − radius)²) by all.
  double low_error, full_error;
  std::uint32_t next;                    // the node after all that lie below this one
  std::uint32_t first_loop, loop_count;  // of a leaf; loop_count is 0 for the others
  double moments[expansion_terms(
      full_degree)];  // of the winding number of the caps: m = 0, then real and imaginary
};

// The boundary of a mesh: a tree in the order of depth first, the root first, without nodes if the mesh is closed.
struct BoundaryView {
  const BoundaryNode* nodes = nullptr;
  std::uint32_t node_count = 0;
  const BoundaryLoop* loops = nullptr;
  const double (*corners)[3] = nullptr;
  BoundaryScale scale;
};

// Points whose rays go along one axis, and where the terms of the boundary go.
struct BoundaryBatch {
  const double* points[3] = {};  // one array a coordinate
  std::size_t size = 0;
  int axis = 0;
  double sign = 1.0;      // 1 or -1: where along the axis the rays go
  double accuracy = 0.0;  // the greatest error of all expansions together; 0: without expansions
  double* terms = nullptr;
};

struct WindingKernels {
  // terms[i] = the sum over the boundary's edges (a, b) of the solid angle of a − p, b − p and the ray's opposite
  // direction, over 4π. Corners and points are floats.
  void (*boundary_terms)(const BoundaryView& boundary, const BoundaryBatch& batch);
  // As boundary_terms; corners and points are any finite doubles.
  void (*boundary_terms_of_doubles)(const BoundaryView& boundary, const BoundaryBatch& batch);
};

}  // namespace raylanes
