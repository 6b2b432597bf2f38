// The operations that queries need of a tree of either kind, and the checked options of a query of the nearest hit.
#pragma once

#include <raylanes/bvh.hpp>
#include <raylanes/doubles.hpp>
#include <raylanes/scene.hpp>

#include "../../dispatch/table/tree_view.hpp"
#include "../batch/routing.hpp"
#include "../batch/triangle_masks.hpp"
#include "../layout/leaves.hpp"
#include "../mesh/bounding_boxes.hpp"

namespace raylanes {

class SceneD;

// Which kernels walk a tree.
enum class TreeKind { bvh, kdtree };

struct TracedTree {
  TreeKind kind;
  const TreeLeaves* leaves;  // null: of no triangles
  TreeView view;
  bool has_parts = false;  // whether a triangle can be in several leaves
};
struct BvhArrays;
struct BvhDArrays;
struct SceneParts;
struct SceneDParts;
struct SphereTreeArrays;

// The inside of trees.
struct TreeAccess {
  static TracedTree traced(const TriangleTree& tree) { return tree.traced(); }
  static const BvhArrays* arrays(const Bvh& bvh) { return bvh.tree_.get(); }  // null: of an empty mesh
  static const BvhDArrays* arrays(const BvhD& bvh) { return bvh.tree_.get(); }
  static const SphereTreeArrays* arrays(const SphereTree& spheres) { return spheres.tree_.get(); }
  static const SceneParts& parts(const Scene& scene) { return scene.parts(); }
  static const SceneDParts& parts(const SceneD& scene);
  // The tree that calls with one ray walk, until a refit; null: of an empty mesh. All trees set TreeLeaves::ready.
  static const LastingView<TreeView>* ready(const TriangleTree& tree) {
    return static_cast<const LastingView<TreeView>*>(tree.ready_);
  }
  static Bvh copy(const Bvh& bvh);
  // As strike_triangles() in layout/refit.hpp.
  static void strike(Bvh& bvh, const Box& box, std::uint32_t first, std::uint32_t end) noexcept;
};
inline constexpr TreeView no_tree{nullptr, nullptr, empty_reference, empty_box};

struct Traversal {
  TreeView tree;
  TraversalChoice choice;
};

// The row for a call with one ray and default options.
const CallRow& default_row();
// The row for one ray at a time, one of these or none.
struct RowsOfCalls {
  const CallRow* usual = nullptr;
  const RuledCallRow* by_rule = nullptr;

  explicit operator bool() const { return usual != nullptr || by_rule != nullptr; }
  // skipped() is the primitive that is not there for the ray.
  template <class Skipped>
  Hit closest(const TreeView& tree, const Ray& ray, Facing facing, const Skipped& skipped) const {
    return usual != nullptr ? usual->closest(tree, ray) : by_rule->closest(tree, ray, facing, skipped());
  }
  template <class Skipped>
  bool any(const TreeView& tree, const Ray& ray, Facing facing, const Skipped& skipped) const {
    return usual != nullptr ? usual->any(tree, ray) : by_rule->any(tree, ray, facing, skipped());
  }
};
// The row for so many rays if options set no more than test, grade and path, or by the exact test facing, skip and
// masks besides. With masks, the tree's view has them. False if options ask for more, or the test has no row.
RowsOfCalls rows_of_calls(const TraceOptions& options, std::size_t rays);
// Whether a call whose caller rejects hits sets no more than facing, skip, masks, after, grade and path.
bool is_usual_kept(const TraceOptions& options, std::size_t rays = 1);

// Throws std::invalid_argument where an option is wrong, or trees do not take the test.
Traversal checked_traversal(const TracedTree& tree, const TraceOptions& options);

// Throws std::invalid_argument for another test than exact.
void require_exact(const TraceOptions& options);
// Finds the hits after options.after, as TraceOptions says; there are as many hits as rays.
void trace_after(const TracedTree& tree, const RaySource& rays, const HitView& hits,
                 const TraceOptions& options);

}  // namespace raylanes
