// The kernel table: everything a path offers, with its contract. One constant table per path; every
// function in it computes the same function on every path, and in the reproducible grade the same bits.
//
// Common to all: n = 0 is allowed; pointers need the alignment of their type only; nothing is read or
// written outside the n elements; MXCSR is neither read nor changed (bits and bounds hold for round to nearest
// without FTZ and DAZ); no function throws or allocates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

#include <raylanes/boxes.hpp>
#include <raylanes/points.hpp>
#include <raylanes/root_methods.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/traversal.hpp>
#include <raylanes/triangles.hpp>
#include <raylanes/types.hpp>

#include "tree_view.hpp"

namespace raylanes {

// Primitives as one array per number that a test reads of them.
using Soa = const float* const*;

// A row per test and grade: [enumerator][Grade].
template <class Row, std::size_t tests>
struct Rows {
  Row row[tests][grade_names.size()];
};

// The tests over arrays, any n, with the elements of `active` or all; the contracts are those of the calls in
// <raylanes/triangles.hpp>, boxes.hpp and spheres.hpp. triangles: what the test reads; triangle: the numbers of one,
// one after the other.
struct TriangleRow {
  // What the test reads of the active ones of n triangles, from their corners v0 v1 v2, into arrays that overlap
  // nothing. directional needs the direction of all rays, three numbers; others do not look at it, it may be null.
  void (*prepare)(Soa corners, std::size_t n, LaneBits active, const float* direction, float* const* out);
  void (*any_of_triangles)(const Ray& ray, Soa triangles, std::size_t n, LaneBits active, std::uint8_t* bits);
  void (*any_of_rays)(const RayArrays& rays, const float* triangle, LaneBits active, std::uint8_t* bits);
  void (*closest_of_triangles)(const Ray& ray, Soa triangles, std::size_t n, LaneBits active, Hit& nearest);
  // u and v may be null.
  void (*closest_of_rays)(const RayArrays& rays, const float* triangle, LaneBits active, std::uint8_t* bits,
                          float* t, float* u, float* v);
};
using TriangleKernels = Rows<TriangleRow, std::size(triangle_tests)>;

// box: lo and hi.
struct BoxRow {
  void (*any_of_boxes)(const Ray& ray, Soa boxes, std::size_t n, LaneBits active, std::uint8_t* bits);
  void (*any_of_rays)(const RayArrays& rays, const float* box, LaneBits active, std::uint8_t* bits);
  void (*intervals_of_boxes)(const Ray& ray, Soa boxes, std::size_t n, LaneBits active, std::uint8_t* bits,
                             float* entry, float* exit);
  void (*intervals_of_rays)(const RayArrays& rays, const float* box, LaneBits active, std::uint8_t* bits,
                            float* entry, float* exit);
};
using BoxKernels = Rows<BoxRow, std::size(box_tests)>;

// sphere: centre and signed_square of the radius.
struct SphereRow {
  void (*any_of_spheres)(const Ray& ray, Soa spheres, std::size_t n, LaneBits active, std::uint8_t* bits);
  void (*any_of_rays)(const RayArrays& rays, const float* sphere, LaneBits active, std::uint8_t* bits);
  void (*closest_of_spheres)(const Ray& ray, Soa spheres, std::size_t n, LaneBits active, Hit& nearest);
  void (*distances_of_spheres)(const Ray& ray, Soa spheres, std::size_t n, LaneBits active,
                               std::uint8_t* bits, float* near, float* far);
  void (*distances_of_rays)(const RayArrays& rays, const float* sphere, LaneBits active, std::uint8_t* bits,
                            float* near, float* far);
};
struct SphereKernels : Rows<SphereRow, std::size(sphere_tests)> {
  // Of whole lines, [Grade].
  void (*line_of_spheres[grade_names.size()])(const Ray& ray, Soa spheres, std::size_t n, LaneBits active,
                                              std::uint8_t* bits);
};

// Where rays of a packet meet: where the first one begins, bit for bit; of `any` about where all end; of `closest`
// nowhere. Of what is left `any` and `closest` make single rays and rays that meet nowhere.
enum class SharedApex : std::uint8_t { origin, end, none };

// A batch of rays and where its answers go: plain data, which can grow without touching a signature. Rays and answers
// do not overlap.
struct TraceBatch {
  const Ray* rays = nullptr;
  std::size_t size = 0;
  Hit* hits = nullptr;               // of `closest`
  std::uint8_t* occluded = nullptr;  // of `any`: 1 if anything is hit within the segment, else 0
  // The caller's, one per thread, as many bytes as the row asks for, aligned to 64; what is left in it is garbage.
  void* scratch = nullptr;
  // Of packets: what their rays share. Those that do not cost more time.
  SharedApex shared_point = SharedApex::origin;
  Float3 shared_end{};
  TraceCounters* counters = nullptr;  // counted rows add to it, the others never look
  const Hit* after = nullptr;         // of `next`: for each ray the hit that it looks behind
};

// What lists are of.
//   hits       as TriangleTree::all_hits() returns them, but in any order, with triangles that the tree has in parts
//              several times, and cut at `max_count` only if that is cheap
//   crossings  t, and the side as u: 1 along the normal, -1 against it; v = 0; in any order and several times as well
//   sides      crossings without t: the side is t
//   places     sides; but of a ray that begins on a triangle this one at the end of the list, with t = 0
//   lines      crossings; but of a ray with a triangle that floats do not decide this one at the end of the list, with
//              t = 0
enum class ListKind : std::uint8_t { hits, crossings, sides, places, lines };

// Lists of some rays, one behind the other in `list`: that of ray i ends before end[i].
struct ListBatch {
  const Ray* rays = nullptr;
  std::size_t size = 0;
  ListKind kind = ListKind::hits;
  std::uint32_t max_count = ~0u;
  Hit* list = nullptr;
  std::size_t room = 0;  // for so many; overlaps nothing
  std::size_t* end = nullptr;
  // If not null, for ListKind::sides: counts[i] becomes the sum of ray i's list, and no list is returned. Each triangle
  // must be in one leaf only. Then `room` is at least 16, however long the lists would be, and all rays are done.
  CrossingCount* counts = nullptr;
  TraceCounters* counters = nullptr;
  void* scratch = nullptr;  // of list_together, as of TraceBatch
};

// No call has more rays: what bounds the scratch memory, and what streams want.
inline constexpr std::size_t max_rays_of_a_call = 131072;
// So many that share an origin are traced together: they, what they are sorted by and their hits fit into the second
// level of caches.
inline constexpr std::size_t rays_of_an_origin = 16384;

// Null where a mode does not offer a test. Single rays offer all, and ask for no scratch: scratch_bytes(n) is what a
// call with n rays needs. The tree has no node below max_tree_depth others, or max_kd_depth of a k-d tree, and blocks
// with the numbers of the test. For the contract see Bvh in <raylanes/bvh.hpp>.
struct TraversalRow {
  void (*closest)(const TreeView& tree, const TraceBatch& batch);
  void (*any)(const TreeView& tree, const TraceBatch& batch);
  std::size_t (*scratch_bytes)(std::size_t rays);
};
using TraversalRows = Rows<TraversalRow, std::size(triangle_tests)>;

// One ray in a call of its own, by tests that read corners; trees as of TraversalRow. Null for other tests, and where
// rays are counted.
struct CallRow {
  Hit (*closest)(const TreeView& tree, const Ray& ray);
  bool (*any)(const TreeView& tree, const Ray& ray);
};
using CallKernels = Rows<CallRow, std::size(triangle_tests)>;

struct TraversalKernels {
  TraversalRows mode[traversal_kernel_modes];
  CallKernels call;
};

// Of single rays through the planes of k-d trees. Other tests, grades and modes walk nodes of eight cells by the rows
// above.
struct KdKernels {
  TraversalRows plain, counted;
};

// Rays to the leaves of a tree over boxes, which say `first` and how many of their owner's list. visit() is called with
// each leaf whose box, padded, a ray may meet within [ray.tmin, tmax], nearer ones first as a rule, each ray at most
// once for a leaf; it may lower the tmax of these rays, to -infinity where one is done.
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

// Questions of the exact test beyond the nearest hit, of trees of either kind by their nodes; single rays. Lists return
// how many rays have theirs: fewer than all if there is no room for that of the next one. Rays of list_along_axes are
// directed along an axis, by +-1, from 0 to infinity, and their lists are sides or places.
struct QueryKernels {
  std::size_t (*list)(const TreeView& tree, const ListBatch& batch);
  std::size_t (*list_along_axes)(const TreeView& tree, const ListBatch& batch);
  // The same as list by streams of up to max_rays_of_a_call rays, without places or `max_count`: all rays have their
  // lists, or none has. Needs scratch_bytes(rays, room) bytes of scratch. Null in the counted row: counted rays go
  // alone.
  std::size_t (*list_together)(const TreeView& tree, const ListBatch& batch);
  std::size_t (*scratch_bytes)(std::size_t rays, std::size_t room);
  // The nearest hits behind those of batch.after, in the order of t and then of primitives.
  void (*next)(const TreeView& tree, const TraceBatch& batch);
  // Trees without blocks; scratch as of streams of so many rays.
  void (*visit)(const TreeView& tree, const VisitBatch& batch);
};
struct AllQueryKernels {
  QueryKernels plain, counted;  // counted: null where the build was asked for no counters
  // Some rays, all or those numbered, in another space: out[i] has the origin map·(x, y, z, 1) and the direction
  // map·(x, y, z, 0), rows of four, in doubles from left to right, each rounded once to float; a direction below 2^-126
  // becomes zero, so that the ray hits nothing. tmin and tmax stay.
  void (*map_rays)(const Ray* rays, const std::uint32_t* numbers, std::size_t size, const double* map,
                   Ray* out);
};

// One function of roots: its methods, numbered as in the enumeration, and the fastest one measured for each accuracy.
// Contracts and bounds: <raylanes/root_methods.hpp>.
template <class T>
using ArrayFunction = void (*)(const T* x, T* y, std::size_t n);
template <class T, class Method, std::size_t Count>
struct RootRows {
  ArrayFunction<T> by[Count];
  Method within[accuracies.size()];
};

struct RootKernels {
  RootRows<float, SqrtMethod, sqrt_methods.size()> sqrt;
  RootRows<float, RsqrtMethod, rsqrt_methods.size()> rsqrt;
  RootRows<float, ReciprocalMethod, reciprocal_methods.size()> reciprocal;
  RootRows<double, DoubleSqrtMethod, double_sqrt_methods.size()> double_sqrt;
  RootRows<double, DoubleRsqrtMethod, double_rsqrt_methods.size()> double_rsqrt;
  RootRows<double, DoubleReciprocalMethod, double_reciprocal_methods.size()> double_reciprocal;
  // The square root goldschmidt_beside_hardware, bit for bit, with more of it in the divider: the faster one where
  // operations of 512 bits take two passes. Null on paths of narrower registers.
  ArrayFunction<float> sqrt_in_two_passes;
};

// Points whose closest points are looked for in a tree, and where the answers go: those of [begin, end) that take part.
struct PointBatch {
  const std::byte* points = nullptr;  // three floats every `stride` bytes, of any alignment
  std::size_t stride = 0;
  std::size_t begin = 0, end = 0;
  const std::uint64_t* order = nullptr;  // lower halves: which from `begin` on comes next; null: in order
  LaneBits active = nullptr;
  double max_squared = 0.0;  // negative: no triangle counts
  ClosestPoint* closest = nullptr;
  TraceCounters* counters = nullptr;  // the counted row adds to it, the other never looks
};

// Contracts: <raylanes/points.hpp>; of trees, whose blocks have corners, Bvh in <raylanes/bvh.hpp>.
struct PointKernels {
  // Of the outputs all but the first may be null: distance_squared, x, y, z, u, v.
  void (*distances)(const Float3& point, Soa corners, std::size_t n, LaneBits active, float* const (&out)[6]);
  void (*closest_of_triangles)(const Float3& point, Soa corners, std::size_t n, LaneBits active,
                               double max_squared, ClosestPoint& closest);
  // A point through a tree, with nothing of a batch: the bytes of closest_in_tree.
  void (*closest_of_point)(const TreeView& tree, const Float3& point, double max_squared,
                           ClosestPoint& closest);
  void (*closest_in_tree)(const TreeView& tree, const PointBatch& batch);
  void (*counted)(const TreeView& tree, const PointBatch& batch);  // null in builds without counters
};

// The objects of one path, each from a translation unit of its own (kernels/*/).
struct KernelTable {
  const RootKernels& roots;
  const TriangleKernels& triangles;
  const BoxKernels& boxes;
  const SphereKernels& spheres;
  const TraversalKernels& traversal;
  // The same text once more, with counters: the same bytes of answers, and what they cost. Null where a test is not
  // counted, and all of them where the build was asked for no counters. Paths with the same instruction set share it.
  const TraversalKernels& counted;
  const KdKernels& kdtree;
  const PointKernels& points;
  const AllQueryKernels& queries;

  // Of streams or packets of so many rays, whatever they look for.
  std::size_t stream_scratch_bytes(std::size_t rays) const {
    return scratch_bytes(TraversalMode::stream, rays);
  }
  std::size_t packet_scratch_bytes(std::size_t rays) const {
    return scratch_bytes(TraversalMode::packet, rays);
  }
  bool has_counters() const {
    return counted.mode[0].row[static_cast<std::size_t>(TriangleTest::exact)][0].closest != nullptr;
  }

 private:
  std::size_t scratch_bytes(TraversalMode mode, std::size_t rays) const {
    const TraversalRows& rows = traversal.mode[static_cast<std::size_t>(mode)];
    return rows.row[static_cast<std::size_t>(TriangleTest::exact)][0].scratch_bytes(rays);
  }
};

}  // namespace raylanes
