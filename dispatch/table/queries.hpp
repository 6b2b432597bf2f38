// Kernels for what is beyond the nearest hit: lists, the next hit, visits of leaves.
#pragma once

#include <raylanes/numbers.hpp>

#include "traversal.hpp"

namespace raylanes {

// The items of lists.
//   hits       as TriangleTree::all_hits() returns them, but in any order, with triangles that the tree has in parts
//              several times, and cut at `max_count` only if that is cheap
//   crossings  entries with t; in any order and several times as well
//   sides      the same without t
enum class ListKind : std::uint8_t { hits, crossings, sides };
// The triangle that ends a list of crossings or sides, as an entry whose side is 0: none; one that holds the ray's
// origin; one that floats do not decide.
enum class ListStop : std::uint8_t { never, at_origin, undecided };

// A triangle that a ray meets. Lists of hits have them while they are made: then the numbers are computed.
template <class T>
struct ListEntryOf {
  T t;                                     // of a crossing; 0 if the triangle holds the origin
  std::uint32_t leaf_triangle, primitive;  // no_leaf_triangle: holds the origin, also where t rounds to 0
  std::int16_t side;                       // of a crossing: 1 along the normal, -1 against it
  // Which weights of a crossing are zero, if rays go alone: 1, 2 and 4 for the corners, added up.
  std::uint16_t zero_weights;

  bool operator==(const ListEntryOf&) const = default;
};
// Lists of some rays, one behind the other in `list`: that of ray i ends before end[i].
template <class T>
struct ListBatchOf {
  const RayOf<T>* rays = nullptr;
  std::size_t size = 0;
  ListKind kind = ListKind::hits;
  ListStop stop = ListStop::never;
  std::uint32_t max_count = ~0u;
  Facing facing = Facing::any;
  const std::uint32_t* skip = nullptr;  // for each ray the primitive that is not there for it; null: none
  TriangleMasks masks = {};
  ListEntryOf<T>* list = nullptr;
  HitOf<T>* hits = nullptr;  // the hit of each entry, in lists of hits
  std::size_t room = 0;      // for so many; overlaps nothing
  std::size_t* end = nullptr;
  // If not null, for ListKind::sides: counts[i] becomes the sum of ray i's list, and no list is returned. Each triangle
  // must be in one leaf only. Then `room` is at least 16, however long the lists would be, and all rays are done.
  CrossingCount* counts = nullptr;
  TraceCounters* counters = nullptr;
  void* scratch = nullptr;  // for list_together, as in TraceBatch
};
using ListBatch = ListBatchOf<float>;

// Rays to the leaves of a tree over boxes, which say `first` and how many of their owner's list. The kernel calls
// visit() with each leaf whose padded box a ray may meet within [ray.tmin, tmax], usually nearer leaves first. Each ray
// comes at most once to a leaf. The call may lower the tmax of these rays, to -infinity if one is done.
struct VisitedLeaf {
  std::uint32_t first, size;
  const std::uint32_t* rays;  // their numbers in the batch
  float* tmax;                // of each of these, where what is of use ends; finite
  std::size_t count;
};
struct VisitBatch {
  const Ray* rays = nullptr;
  std::size_t size = 0;
  const float* tmax = nullptr;  // for each ray, where what is of use ends at first; not NaN; null: its own
  // Whether all have the first one's origin, bit for bit, as a rule, and are at most rays_of_an_origin: traced as
  // packets, with scratch for these.
  bool share_origin = false;
  void* scratch = nullptr;
  void (*visit)(void* context, const VisitedLeaf& leaf) = nullptr;
  void* context = nullptr;
  TraceCounters* counters = nullptr;
};

// Spheres in the leaves of a tree over their boxes. A leaf that begins at `first` has rows of its size from number
// 4 · first on: the coordinates of centres, and signed squares of radii. Behind the last leaf sphere_room more numbers
// may be read.
inline constexpr std::size_t sphere_room = 16;
struct SphereLeaves {
  const float* numbers;
  const std::uint32_t* primitives;
};
// How one ray is asked for. No box that begins behind `end`, not NaN, is looked at. The skipped sphere has only the hit
// that is farther from the begin of the segment; and if `after` is not null, only hits after it count.
struct SphereQuery {
  float end;
  bool any = false;  // whether any hit will do
  std::uint32_t skipped = no_primitive;
  const Hit* after = nullptr;
  bool (*rejects)(void* function, const Hit& hit) = nullptr;  // as in AskedOf
  void* function = nullptr;
  TraceCounters* counters = nullptr;  // of the counted row
};

// Some rays at a leaf of spheres, by their numbers in arrays: of rays, and of their hits so far or whether they are
// occluded; the other one is null.
struct SphereVisit {
  std::uint32_t first, size;  // spheres, at most a leaf's
  const std::uint32_t* numbers;
  std::size_t count;
  const Ray* rays;
  Hit* hits;
  std::uint8_t* occluded;
  const std::uint32_t* skip;  // for each ray what it skips, as in SphereQuery; null: nothing
};

// A search of one ray whose caller keeps some hits, of the sides that `facing` names, but of the skipped primitive, by
// t and then by primitives. The function is asked about each of these that would be the best so far. If the tree has a
// triangle in several leaves, it may be asked again.
template <class T>
struct AskedOf {
  bool (*rejects)(void* function, const HitOf<T>& hit) = nullptr;  // null: none is rejected
  void* function = nullptr;
  Facing facing = Facing::any;
  std::uint32_t skipped = no_primitive;
  const HitOf<T>* after = nullptr;  // only hits after this one count; null: all
  bool any = false;                 // whether the first hit that is kept ends the search
};
// The nearest hit that is kept, or whether there is one.
template <class Tree, class T>
struct KeptRow {
  HitOf<T> (*closest)(const Tree& tree, const RayOf<T>& ray, const AskedOf<T>& asked);
  bool (*any)(const Tree& tree, const RayOf<T>& ray, const AskedOf<T>& asked);
};

// Rays whose caller keeps some hits: nearest ones, or any. `facing` and `skip` say which triangles count. ask() is
// called with up to hits_of_list hits that would be the best so far, of rays by their numbers in the batch. It sets to
// 1 what is 0 where it rejects a hit. It may be asked again about a hit.
struct KeptBatch : TraceBatch {
  void (*ask)(void* function, const std::uint32_t* rays, const Hit* hits, std::uint8_t* rejected,
              std::size_t count) = nullptr;
  void* function = nullptr;
};
inline constexpr std::size_t hits_of_list = 512;

// Questions of the exact test beyond the nearest hit, of trees of either kind by their nodes; single rays. Lists return
// how many rays have theirs: fewer than all if there is no room for that of the next one. Rays of list_along_axes are
// directed along an axis, by ±1 or ±4, from 0 to infinity, and their lists are crossings or sides.
struct QueryKernels {
  std::size_t (*list)(const TreeView& tree, const ListBatch& batch);
  std::size_t (*list_along_axes)(const TreeView& tree, const ListBatch& batch);
  // The same as list by streams of up to max_rays_of_a_call rays, without stops or `max_count`: all rays have their
  // lists, or none has. Needs scratch_bytes(rays, room) bytes of scratch. Null in the counted row: counted rays go
  // alone.
  std::size_t (*list_together)(const TreeView& tree, const ListBatch& batch);
  std::size_t (*scratch_bytes)(std::size_t rays, std::size_t room);
  // Nearest hits and any hits of the triangles that batch.facing and batch.skip leave: single rays, and streams. The
  // latter are null in the counted row. `closest_after` and lists look at these, too.
  TraversalRow ruled_single, ruled_stream;
  RuledCallRow ruled_call;        // null in the counted row
  KeptRow<TreeView, float> kept;  // null in the counted row
  // The same by streams, with their scratch. Null in the counted row.
  void (*kept_together)(const TreeView& tree, const KeptBatch& batch);
  // The nearest hits after the hits in batch.after, in the order of t and then of primitives; null: nearest hits.
  void (*closest_after)(const TreeView& tree, const TraceBatch& batch);
  // Trees without blocks; scratch as streams of so many rays need it.
  void (*visit)(const TreeView& tree, const VisitBatch& batch);
  // One ray to the leaves of such a tree, nearer ones first, up to `end`, not NaN. visit(context, first, size) returns
  // the t of the nearest hit so far; -infinity ends the walk. Null in the counted row.
  void (*visit_ray)(const TreeView& tree, const Ray& ray, float end,
                    float (*visit)(void* context, std::uint32_t first, std::uint32_t size), void* context);
  // One ray among spheres; tree.origin_share is the slack of their test.
  Hit (*closest_sphere)(const TreeView& tree, const SphereLeaves& spheres, const Ray& ray,
                        const SphereQuery& asked);
  // Valid rays among the spheres of a leaf: what they hit replaces hits behind it. Null in the counted row.
  void (*visit_spheres)(const SphereLeaves& spheres, const SphereVisit& leaf);
};
struct AllQueryKernels {
  QueryKernels plain, counted;  // counted: null where the build was asked for no counters
  // Some rays, all or those numbered, in another space: out[i] has the origin map·(x, y, z, 1) and the direction
  // map·(x, y, z, 0), columns of three, in doubles from left to right, each rounded once to float; a direction below
  // 2^-126 becomes zero, so that the ray hits nothing. tmin and tmax stay.
  void (*map_rays)(const Ray* rays, const std::uint32_t* numbers, std::size_t size, const double* map,
                   Ray* out);
};

}  // namespace raylanes
