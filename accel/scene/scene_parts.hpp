// The parts of a scene.
#pragma once

#include "common/common_tree.hpp"
#include "nested/placed_parts.hpp"

namespace raylanes {

// Fewer rays go through the instances of a leaf as single rays, without copies of rays and hits. Measured.
inline constexpr std::size_t min_list = 24;

// A tree over instances that need about the same padding.
struct TopLevel {
  BoundedTreeArrays tree;    // its slack is what exact tests need
  BoxPadding rounded;        // what tests whose numbers are rounded need as well
  BoundedTreeArrays opened;  // for single rays: over nodes of large instances, too; empty if none is opened
  std::vector<InstanceEntry>
      entries;                // in the leaves of `opened`, or else of `tree`; empty: none are triangles
  InstancesView walked = {};  // of the scene that has it
  // Whether instances overlap so much that streams lose, whose top level is not opened; and from how many rays on they
  // pay in the trees of all instances.
  bool overlaps = false;
  std::uint64_t closest_from = 0, occluded_from = 0;

  std::size_t bytes() const { return tree.bytes() + opened.bytes() + entries.size() * sizeof(InstanceEntry); }
};
// Top levels of triangles come first.
std::vector<TopLevel> tops_over(std::span<const Instance> instances, std::span<const InstanceBounds> bounds);

// Whether a hit comes before another one of another instance. A miss comes before nothing.
template <class AnyHit>
bool is_before(const AnyHit& hit, const AnyHit& other) {
  return hit.t < other.t || (hit.t == other.t && hit.instance < other.instance);
}

// A tree that a caller shares, which must be there.
template <class Tree>
std::shared_ptr<const Tree> not_null(std::shared_ptr<const Tree> tree) {
  if (tree == nullptr) throw std::invalid_argument("scene: a tree is needed, not a null pointer");
  return tree;
}

struct SceneParts : PlacedParts<Geometry, Instance> {
  using Number = float;
  // As the last update made them:
  std::vector<std::shared_ptr<CommonTree>> commons;
  bool traces_common = false;        // whether they are in use, and there are any
  std::uint32_t let_out = 0;         // how many members have left them since
  const CommonTree* only = nullptr;  // the common tree if nothing else is traced
  // Triangles come first, then small shares. Each instance that can be hit, and is not in a common tree in use, is
  // in one of them.
  std::vector<TopLevel> tops;

  // Whether rays with this mask are to be traced through a common tree.
  bool sees(const CommonTree& tree, std::uint32_t of_mask) const {
    return traces_common && (tree.mask & of_mask) != 0;
  }

  // Whether it has spheres, primitives of the caller's, or meshes whose trees are not built yet, which no kernel walks.
  bool has_others() const { return !tops.empty() && tops.back().walked.entries == nullptr; }
  bool has_only_others() const { return !traces_common && has_others() && tops[0].walked.entries == nullptr; }

  // Sets `only`, after changes of the rest.
  void set_only() noexcept {
    only = traces_common && commons.size() == 1 && tops.empty() ? commons[0].get() : nullptr;
  }
  // Sets the trees of instances whose geometry has one.
  void set_trees() noexcept;
  // Sets tops and their views of this scene.
  void set_tops(std::vector<TopLevel> made) noexcept;
};

// The common tree if a call with one ray may go straight to it: it has all that the mask sees, and nothing traps.
const CommonTree* quick_tree(const SceneParts& scene, std::uint32_t mask);

// Answers to rays of a scene: hits or occluded, the other is null. On this thread; all are set.
struct SceneBatch {
  const Ray* rays;
  std::size_t size;
  SceneHit* hits;
  std::uint8_t* occluded;
  detail::RayNumbers numbers = {};  // of the rays in the caller's batch
  const SceneHit* after = nullptr;  // not null: the first hits after these are looked for; without geometries
  const detail::Rejection<SceneHit>* rejection = nullptr;  // not null: of one ray whose caller rejects hits
};
struct SceneQuery : GeometryQuery {
  const SceneParts& scene;
  std::uint32_t mask;
  PrimitiveView skip;        // of the caller's batch
  TraversalChoice of_words;  // for geometries whose triangles have masks
};
// Throws as Scene::closest().
SceneQuery checked_query(const SceneParts& scene, const TraceOptions& options);
void trace_scene(const SceneQuery& query, const SceneBatch& batch);
// The same for a batch that has the answers of all instances but those that no kernel walks.
void trace_others(const SceneQuery& query, const SceneBatch& batch);
// Finds the hits after options.after, by a checked query.
void trace_after(const SceneQuery& query, const RaySource& rays, const SceneHitView& hits,
                 const TraceOptions& options);
// Throws std::invalid_argument for another test than exact.
void require_exact_in_scene(const TraceOptions& options);
// Throws std::invalid_argument if options.after is not of so many hits in scenes, or another test is asked for.
void require_after_in_scene(const TraceOptions& options, std::size_t rays);
SceneHit hit_of_after(const AfterView& after, std::size_t i);
// Throws std::invalid_argument for another test than exact, and if a geometry does not consist of triangles.
void require_triangles(const Scene& scene, const TraceOptions& options);

}  // namespace raylanes
