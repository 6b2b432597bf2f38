// The parts of a scene of doubles, and the walk of a ray through them.
#pragma once

#include "../../doubles/bvh_d_arrays.hpp"
#include "../../queries/traced_tree.hpp"
#include "../lists/lists_in_trees.hpp"
#include "../nested/placed_parts.hpp"

namespace raylanes {

// A part of a scene, which scenes share.
class GeometryD {
 public:
  explicit GeometryD(std::shared_ptr<const BvhD> of);
  explicit GeometryD(NestedInstances<InstanceD> scene);  // with an empty tree
  // As in Geometry.
  double volume() const;
  const NestedInstances<InstanceD>* nested() const { return scene_ ? &*scene_ : nullptr; }
  GeometryRecord record(std::size_t, std::vector<Sphere>&) const {
    return {scene_ ? nested_scene : triangle_geometry, 0};
  }
  void save(std::ostream& file) const { scene_ ? scene_->save(file) : tree->save(file); }

  const std::shared_ptr<const BvhD> tree;  // not null

 private:
  const std::optional<NestedInstances<InstanceD>> scene_;
  mutable std::atomic<double> volume_{-1.0};  // negative: not known yet
};

// A tree over the triangles of instances of one mask whose transform is the identity.
struct CommonTreeD : MemberTable {
  std::shared_ptr<const BvhD> tree;  // that of the only member, or one of its own
  std::uint32_t mask;
  std::size_t own_bytes = 0;  // of the tree

  const BvhDArrays& arrays() const { return *TreeAccess::arrays(*tree); }
  std::size_t bytes() const {
    return members.size() * sizeof(Member) + slots.size() * sizeof(TriangleOwner) + own_bytes;
  }
};

// A tree over instances.
struct InstanceBoxes {
  BoundedTreeArrays tree;  // its slack is what they need
  std::vector<std::uint32_t>
      others;  // instances whose boxes no tree holds, which all rays and points come to

  bool is_empty() const { return tree.root == empty_reference && others.empty(); }
  std::size_t bytes() const { return tree.bytes() + others.size() * sizeof(std::uint32_t); }
};

struct SceneDParts : PlacedParts<const GeometryD, InstanceD> {
  using Number = double;
  // As the last update made them:
  std::vector<std::shared_ptr<const CommonTreeD>> commons;
  std::vector<BoxD> boxes;        // of instances, padded; empty: nothing is hit
  InstanceBoxes apart, together;  // instances in no common tree, and those in one

  // The tree of an instance; null: it is empty.
  const BvhDArrays* tree_of(const InstanceD& instance) const {
    return TreeAccess::arrays(*geometries[instance.geometry]->tree);
  }
  // The common tree that has all that the mask sees; null: there are others, or the mask sees nothing.
  const CommonTreeD* only(std::uint32_t mask) const {
    const CommonTreeD* only = nullptr;
    if (!apart.is_empty()) return nullptr;
    for (const auto& tree : commons) {
      if ((tree->mask & mask) == 0) continue;
      if (only != nullptr) return nullptr;
      only = tree.get();
    }
    return only;
  }
};

// A closest point in a tree, as one in the scene.
inline SceneClosestPointD closest_in_scene(const ClosestPointD& found, const TriangleOwners& owners) {
  if (!found) return {};
  const TriangleOwner& owner = owners.of(found.primitive);
  return {found.distance_squared,        found.distance, found.point,   found.u, found.v,
          found.primitive - owner.first, owner.geometry, owner.instance};
}

// A query that the rays of a call have in common.
struct SceneDQuery {
  const SceneDParts& scene;
  const DoubleRayKernels& kernels;
  std::uint32_t mask;
  Facing facing;
  PrimitiveView skip;  // of the caller's batch

  // The primitive of an instance that ray i skips.
  SkippedPrimitive skipped(std::size_t i) const {
    return skip.first != nullptr ? SkippedPrimitive{skip[i], skip.instance(i)}
                                 : SkippedPrimitive{no_primitive, no_part};
  }
  // The first hit of a ray, after another one if that is not null; and whether there is any. rejection: what the caller
  // rejects; null: nothing.
  SceneHitD closest(const RayD& ray, const SkippedPrimitive& skipped, const SceneHitD* after,
                    const detail::Rejection<SceneHitD>* rejection = nullptr) const;
  bool any(const RayD& ray, const SkippedPrimitive& skipped,
           const detail::Rejection<SceneHitD>* rejection = nullptr) const;
};
// Throws as SceneD::closest().
SceneDQuery checked_query(const SceneDParts& scene, const TraceOptionsD& options);

// Calls visit(instance) for the instances in no common tree that the mask sees and whose boxes the ray comes to,
// nearest first; visit() returns how far the ray goes on, NaN or before its begin to end it.
using InstanceVisitD = std::function<double(std::uint32_t instance)>;
void each_instance_along(const SceneDParts& scene, std::uint32_t mask, const RayD& ray,
                         const InstanceVisitD& visit);

}  // namespace raylanes
