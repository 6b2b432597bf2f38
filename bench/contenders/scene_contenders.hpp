// The time of scenes and of a user's own tests compared with the tree of the same triangles.
#pragma once

#include <raylanes/bounded_tree.hpp>
#include <raylanes/mesh.hpp>
#include <raylanes/scene.hpp>

#include "../support/scenes/parts.hpp"
#include "contenders.hpp"

namespace raylanes::bench {

// Triangles as a user would trace them through a tree over boxes: Möller–Trumbore in floats, in the user's own code.
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

// A contender by name. Exact ones have the tree's hits to the byte; others test in floats, and decide nearly all rays
// as the tree does.
struct NamedContender {
  std::string name;
  Contender way;
  bool is_exact;
};

// Whether another primitive for so many rays of a million is within the rounding of a test in floats.
constexpr double max_others_per_million = 1e4;

// A scene of parts: each part as one instance where it stands, `scene`, and the same parts as instances that will move,
// `scene_moving`. If there is one part, the second scene is turned by a quarter, with rays turned by the same, so that
// they are exactly the same in the tree's space: `scene_turned`. Parts that are nodes are instances of the meshes that
// they have in common; their transforms round, so hits may differ.
class SceneContenders {
 public:
  explicit SceneContenders(const Parts& parts);

  // Whole batches, or a call for each ray. Hits are numbered as the triangles of the whole mesh.
  std::vector<NamedContender> ways(const Path& path, bool calls) const;

 private:
  std::vector<std::uint32_t> first_;  // of each part's triangles
  bool is_exact_;
  raylanes::Scene scene_, other_;
};

// The seconds of update() after the last part was moved, and after it was moved again. The first time it leaves the
// tree that parts have in common.
std::pair<double, double> seconds_of_a_move(const Parts& parts);

// Triangles in a tree of boxes, tested by the user's own code.
class UserContenders {
 public:
  // The tree and the mesh must outlive it.
  UserContenders(const Mesh& mesh, const Bvh& bvh) : bvh_(bvh), user_(mesh) {}

  // Batches: a leaf at a time, a ray at a time; and visits that test nothing, whose answers are the tree's.
  std::vector<NamedContender> ways(const Path& path) const;

 private:
  const Bvh& bvh_;
  const UserTriangles user_;
};

}  // namespace raylanes::bench
