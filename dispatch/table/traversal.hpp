// Kernels that trace rays through trees over triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

#include <raylanes/numbers.hpp>
#include <raylanes/scene_hit.hpp>
#include <raylanes/traversal.hpp>
#include <raylanes/triangles.hpp>

#include "rows.hpp"
#include "tree_view.hpp"

namespace raylanes {

struct InstancesView;
struct InstanceSearch;

// The instances that own the triangles of a tree over several meshes. Each of them has slots of 2^shift numbers to
// itself.
struct TriangleOwner {
  std::uint32_t first;  // of its triangles
  std::uint32_t geometry, instance;
};
struct TriangleOwners {
  const TriangleOwner* slots;
  unsigned shift;  // at most 32

  [[gnu::always_inline]] const TriangleOwner& of(std::uint64_t triangle) const {
    return slots[triangle >> shift];
  }
  // The hit of a scene.
  [[gnu::always_inline]] SceneHit spread(const Hit& hit) const {
    if (hit.primitive == no_primitive) return {};
    const TriangleOwner& owner = of(hit.primitive);
    return {hit.t, hit.u, hit.v, hit.primitive - owner.first, owner.geometry, owner.instance};
  }
};

// The point that rays of a packet share: the begin of the first one, bit for bit; for `any` about where all end; for
// `closest` none. `any` and `closest` trace the rest as single rays and as rays that share no point.
enum class SharedApex : std::uint8_t { origin, end, none };

// The nearest hit of a ray so far: its t is within two bounds; leaf_triangle as in nearest_triangle.
struct NearestSoFar {
  float t_lo, tmax;
  std::uint32_t leaf_triangle;
};
// One ray in a call of its own by the exact test, of triangles of the sides that `facing` names, without the skipped
// primitive; no_primitive: with all of them. `nearer` is for a valid ray and a part of a tree that is not empty.
struct RuledCallRow {
  Hit (*closest)(const TreeView& tree, const Ray& ray, Facing facing, std::uint32_t skipped);
  bool (*any)(const TreeView& tree, const Ray& ray, Facing facing, std::uint32_t skipped);
  void (*nearer)(const TreeView& tree, const Ray& ray, NearestSoFar& best, Facing facing,
                 std::uint32_t skipped);
};

// A batch of rays and where its answers go: plain data, which can grow without touching a signature. Rays and answers
// do not overlap.
template <class T>
struct TraceBatchOf {
  const RayOf<T>* rays = nullptr;
  std::size_t size = 0;
  HitOf<T>* hits = nullptr;          // of `closest`
  std::uint8_t* occluded = nullptr;  // of `any`: 1 if anything is hit within the segment, else 0
  // And of each ray that is occluded, if not null: the root, or a node or leaf in which it mostly hits something.
  TreeReference* found_at = nullptr;
  // The caller's, one per thread, as many bytes as the row asks for, aligned to 64; what is left in it is garbage.
  void* scratch = nullptr;
  // For packets: what their rays share. Those that do not cost more time.
  SharedApex shared_point = SharedApex::origin;
  PointOf<T> shared_end{};
  TraceCounters* counters = nullptr;  // counted rows add to it, the others never look
  Facing facing = Facing::any;        // only rows of QueryKernels look, and packets of the exact test
  // And for each ray the primitive that is not there for it; null: none is left out.
  const std::uint32_t* skip = nullptr;
  const HitOf<T>* after = nullptr;  // of `closest_after`: for each ray the hit after which it looks
  // For packets of floats: what traces rays that go alone; not null if `facing` or `skip` say something.
  const RuledCallRow* by_rule = nullptr;

  // Some of the rays, with their answers. Inlined always, so that no symbol has a path's instructions.
  [[gnu::always_inline]] TraceBatchOf part(std::size_t first, std::size_t count) const {
    TraceBatchOf some = *this;
    some.rays += first, some.size = count;
    if (hits != nullptr) some.hits += first;
    if (occluded != nullptr) some.occluded += first;
    if (found_at != nullptr) some.found_at += first;
    if (skip != nullptr) some.skip += first;
    if (after != nullptr) some.after += first;
    return some;
  }
};
using TraceBatch = TraceBatchOf<float>;

// No call has more rays: what bounds the scratch memory, and what streams want.
inline constexpr std::size_t max_rays_of_a_call = 131072;
// So many that share an origin are traced together: they, what they are sorted by and their hits fit into the second
// level of caches.
inline constexpr std::size_t rays_of_an_origin = 16384;

// Null where a mode does not offer a test. Single rays offer all, and ask for no scratch: scratch_bytes(n) is what a
// call with n rays needs. The tree has no node below max_tree_depth others, or max_kd_depth of a k-d tree, and blocks
// with the numbers of the test. Contract: TriangleTree::closest().
struct TraversalRow {
  void (*closest)(const TreeView& tree, const TraceBatch& batch);
  void (*any)(const TreeView& tree, const TraceBatch& batch);
  std::size_t (*scratch_bytes)(std::size_t rays);
};
using TraversalRows = Rows<TraversalRow, std::size(triangle_tests)>;

// One ray in a call of its own, by tests that read corners; trees as in TraversalRow. Null for other tests, and where
// rays are counted.
struct CallRow {
  Hit (*closest)(const TreeView& tree, const Ray& ray);
  bool (*any)(const TreeView& tree, const Ray& ray);
};
using CallKernels = Rows<CallRow, std::size(triangle_tests)>;

struct TraversalKernels {
  TraversalRows mode[traversal_kernel_modes];
  CallKernels call;
  // The triangle that a ray hits nearest by the exact test, as leaves number it: eight times the block, plus the lane;
  // all bits set: none. Null where rays are counted.
  std::uint32_t (*nearest_triangle)(const TreeView& tree, const Ray& ray);
  // CallRow::closest of the exact test for a tree with owners. Null where rays are counted.
  SceneHit (*closest_in_scene)(const TreeView& tree, const TriangleOwners& owners, const Ray& ray);
  // One ray by the exact test through the instances whose mask has a bit in common with `mask`. search: of their trees;
  // null: all triangles count. A hit that comes before `hit` in the order of t, instance, primitive replaces it. Null
  // where rays are counted.
  void (*closest_of_instances)(const InstancesView& scene, const Ray& ray, std::uint32_t mask,
                               const InstanceSearch* search, SceneHit& hit);
  bool (*any_of_instances)(const InstancesView& scene, const Ray& ray, std::uint32_t mask,
                           const InstanceSearch* search);

  // For streams or packets of so many rays, whatever they look for.
  std::size_t scratch_bytes(TraversalMode of, std::size_t rays) const {
    const TraversalRows& rows = mode[static_cast<std::size_t>(of)];
    return rows.row[static_cast<std::size_t>(TriangleTest::exact)][0].scratch_bytes(rays);
  }
};

// Single rays by the exact test through the planes of k-d trees. Other tests and modes walk nodes of eight cells by the
// rows above. `counted` is null where the build has no counters.
struct KdKernels {
  TraversalRow plain, counted;
};

}  // namespace raylanes
