// The time of scenes and of a user's own tests compared with the tree of the same triangles.
#pragma once

#include <memory>
#include <vector>

#include <raylanes/scene.hpp>

#include "contenders.hpp"
#include "user_triangles.hpp"

namespace raylanes::bench {

// A contender by name. Exact ones have the tree's hits to the byte; others test in floats, and decide nearly all rays
// as the tree does.
struct NamedContender {
  std::string name;
  Contender way;
  bool is_exact;
};

// Whether another primitive for so many rays of a million is within the rounding of a test in floats.
constexpr double max_others_per_million = 1e4;

// The tree as the only instance of a scene: untransformed, and turned by a quarter with rays turned by the same, so
// that they are exactly the same in the tree's space. Also triangles in a tree of boxes, tested by the user's own code.
class SceneContenders {
 public:
  // The tree and the mesh must outlive it.
  SceneContenders(const Mesh& mesh, const Bvh& bvh);

  // Contenders for nearest hits: whole batches, or a call for each ray.
  std::vector<NamedContender> scenes(const Path& path, bool calls) const;
  // Batches: a leaf at a time, a ray at a time; and visits that test nothing, whose answers are the tree's.
  std::vector<NamedContender> user(const Path& path) const;

 private:
  const Bvh& bvh_;
  const UserTriangles user_;
  raylanes::Scene scene_, turned_;
};

}  // namespace raylanes::bench
