// Triangles as a user would trace them through a tree over boxes: Möller–Trumbore in floats, in the user's own code.
#pragma once

#include <span>
#include <vector>

#include <raylanes/bounded_tree.hpp>
#include <raylanes/mesh.hpp>

namespace raylanes::bench {

class UserTriangles {
 public:
  // The mesh must outlive it.
  explicit UserTriangles(const Mesh& mesh);

  // One primitive in a leaf and a ray at a time.
  void closest_by_rays(std::span<const Ray> rays, std::span<Hit> hits, const VisitOptions& options) const;
  // Eight primitives in a leaf, a leaf at a time: in registers of AVX2 where the machine has them.
  void closest_by_leaves(std::span<const Ray> rays, std::span<Hit> hits, const VisitOptions& options) const;
  // Visits the same leaves without hits: the cost of visits that end nowhere.
  void visit_leaves(std::span<const Ray> rays, std::span<Hit> hits, const VisitOptions& options) const;

 private:
  const Mesh& mesh_;
  BoundedTree ones_, eights_;
  // Corners and the edges from there, each number in a row of its own: in the order of the tree of eights.
  std::vector<float> rows_[9];
};

}  // namespace raylanes::bench
