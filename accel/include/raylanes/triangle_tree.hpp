// What trees over triangles are asked: nearest hits, whether there is one, all of them, crossings, what is inside,
// closest points.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include <raylanes/closest_points.hpp>
#include <raylanes/mesh.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/queries.hpp>
#include <raylanes/rays.hpp>
#include <raylanes/traversal.hpp>
#include <raylanes/triangles.hpp>

namespace raylanes {

// What the caller knows of the rays of a batch. Without a hint some of them are looked at. A wrong one costs time, not
// hits; forced modes need none.
//   shared_origin, shared_end  they come in runs that begin, or end, at a point
//   coherent    neighbours in the batch are neighbours in space, but share no point
//   incoherent  they are not
enum class BatchHint : std::uint8_t { none, shared_origin, shared_end, coherent, incoherent };

inline constexpr std::array<std::string_view, 5> batch_hint_names{"none", "shared_origin", "shared_end",
                                                                  "coherent", "incoherent"};

struct TraceOptions {
  TriangleTest test = TriangleTest::exact;
  Grade grade = Grade::reproducible;
  TraversalMode mode = TraversalMode::automatic;
  BatchHint hint = BatchHint::none;
  const Path* path = nullptr;  // null: the active path
  int threads = 1;  // 1: the caller's alone; n: n, at most one per core; 0: those of the caller's arena
  LaneBits active = nullptr;  // of a batch: bit i: ray i takes part; null: all
  // Where what a call costs is added, summed over its threads; no other call adds to it at a time. Null: nothing is
  // counted, at no cost. The answers have the same bytes, and take longer. Of the reproducible grade, of the exact test
  // in every mode and others in the mode single, and of builds with -Dcounters=true, as is the default; else
  // std::invalid_argument is thrown. Sums of single
  // rays depend on the tree, the rays and, where a leaf's triangles do not fit into a register, the lanes of the path;
  // those of other modes also on which rays are traced together, as on threads.
  TraceCounters* counters = nullptr;
  // Of closest() with the test exact: for each ray the hit behind which the next is asked for, in the order of t and
  // then of primitives; that of an earlier answer, as a rule. Behind a miss there is nothing, behind t = -infinity all.
  // It may be the view that the answers go to. Such rays go one by one, whatever the mode. Null: the nearest hit.
  // Other tests, another number of hits: std::invalid_argument; other calls do not look at it.
  HitView after = {};
};

struct TracedTree;
struct TreeView;

// The queries of every kind of tree over triangles, Bvh and KdTree: hits do not depend on which it is. One object may
// be asked from many threads at a time.
class TriangleTree {
 public:
  virtual ~TriangleTree() = default;

  // The nearest hit of a ray, of equal t the smallest primitive; see Ray and Hit. A hit's t is finite: where t
  // overflows it is a miss. With the exact test the result is that of exact arithmetic over all triangles: tree, path,
  // grade, mode and threads cannot change it. With the watertight one in the reproducible grade they do not either, but
  // for rays nearly in the plane of a triangle, whose decisions are rounding errors, and where the test's own numbers
  // overflow or underflow: the product of t and twice the area of a triangle that is hit, seen along the major axis of
  // the direction, must be in [2^-100, 2^120] or zero. Throws std::invalid_argument if an option is no enumerator of
  // its type, the thread count is negative, the path is not supported here, or the tree was not built for the test.
  Hit closest(const Ray& ray, const TraceOptions& options) const;
  // The nearest hit by the exact test, on the active path. Throws as active_path() does.
  Hit closest(const Ray& ray) const;
  // Whether anything lies within the ray's segment.
  bool occluded(const Ray& ray, const TraceOptions& options) const;
  // The same by the exact test, on the active path. Throws as active_path() does.
  bool occluded(const Ray& ray) const;

  // The same for many rays, as records or as arrays; mode and threads are for these. hits[i] belongs to rays[i],
  // occluded[i] is 1 or 0; answers of rays that do not take part are left alone. Rays and answers do not overlap. Each
  // thread keeps up to 20 MB for it, 30 MB where rays or hits do not lie as spans of them do. Throws also if there are
  // not as many answers as rays, hits overlap, or a view of something points to nothing. A batch with an exception has
  // written nothing; but on several threads memory may run out, std::bad_alloc, when some answers are there.
  void closest(RayView rays, HitView hits, const TraceOptions& options = {}) const;
  void closest(const RayArrays& rays, HitView hits, const TraceOptions& options = {}) const;
  void occluded(RayView rays, std::span<std::uint8_t> occluded, const TraceOptions& options = {}) const;
  void occluded(const RayArrays& rays, std::span<std::uint8_t> occluded,
                const TraceOptions& options = {}) const;

  // Whether anything lies between a shared point and each of some others, as between a light and what it may shine on:
  // on the rays from `from`, with tmin and tmax the ends, whose directions are the differences of the points, rounded;
  // such rays are traced fastest. All else is as for the other batches; `active` tells which points take part.
  void occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                     const SegmentEnds& ends = {}, const TraceOptions& options = {}) const;

  // The closest point of the triangles to a point, of equal distances that of the least primitive; see ClosestPoint for
  // what is computed and how exactly. Triangles with two equal corners do not count. Path, tree, builder and threads
  // cannot change a bit of it. Nothing is close to a point that is not finite. Throws std::invalid_argument if the
  // thread count is negative, the path is not supported here, or counters are asked for that the build lacks.
  ClosestPoint closest_point(const Float3& point, const ClosestPointOptions& options) const;
  // The same however far it is, on the active path. Throws as active_path() does.
  ClosestPoint closest_point(const Float3& point) const;
  // The same for many points; closest[i] belongs to points[i], answers of those that do not take part are left alone.
  // Points and answers do not overlap. Fastest where neighbours in the batch are neighbours in space. Throws also, with
  // nothing written, if there are not as many answers as points, or the view points to nothing.
  void closest_points(VertexView points, std::span<ClosestPoint> closest,
                      const ClosestPointOptions& options = {}) const;

  // What is beyond the nearest hit, by the exact test alone: <raylanes/queries.hpp> has the options and answers,
  // docs/crossings.md the definitions. Views, active rays, threads, paths and exceptions as of closest(). Whoever
  // catches std::bad_alloc has lost nothing but the answers.
  //
  // Every hit of each ray once, in the order of t and then of primitives: the first one has the bytes of closest().
  // There are as many as memory holds; one traversal a ray.
  RayLists<Hit> all_hits(RayView rays, const ListOptions& options = {}) const;
  RayLists<Hit> all_hits(const RayArrays& rays, const ListOptions& options = {}) const;
  // The same into the caller's arrays: offsets, one more than rays, and hits, if there is room for all of them; returns
  // how many there are. Needs memory for as many besides.
  std::size_t all_hits(RayView rays, std::span<std::size_t> offsets, std::span<Hit> hits,
                       const ListOptions& options = {}) const;
  // Each passage of a ray through the surface once, in that order: at an edge or a vertex, and along a plane, by
  // simulation of simplicity (Edelsbrunner, Mücke 1990), so that a closed mesh is entered as often as it is left.
  RayLists<Crossing> crossings(RayView rays, const ListOptions& options = {}) const;
  RayLists<Crossing> crossings(const RayArrays& rays, const ListOptions& options = {}) const;
  /// Counts the crossings of each ray, and sums up their sides; options.max_count is ignored.
  /// Inactive rays leave their count unchanged. Takes less than 1 MB a thread beside what streams of rays take, but for
  /// trees that hold triangles in several leaves (k-d trees, spatial splits), where it makes lists.
  /// Throws std::invalid_argument if counts.size() is not the number of rays or an option is invalid.
  void count_crossings(RayView rays, std::span<CrossingCount> counts, const ListOptions& options = {}) const;
  void count_crossings(const RayArrays& rays, std::span<CrossingCount> counts,
                       const ListOptions& options = {}) const;
  // Whether each point is inside, outside or on the surface, exactly. A closed mesh: each edge has as many triangles
  // in one direction as in the other; of others the answers depend on the direction in which a point's ray goes, here
  // to the nearest side of bounds(), or are those of a vote: InsideRule. Of a point that differs from the one before or
  // behind it along one axis only, as in a grid, the ray goes up this axis; rows of four such points and more share
  // one, and are several times as fast. Points that are not finite are outside.
  void locate(VertexView points, std::span<Location> locations, const LocateOptions& options = {}) const;
  // How far each point is from the surface, negative inside. The sign is locate()'s, exactly: 0 for a point on a
  // triangle and for no other, whatever is rounded, so at least 2^-126 beside it. Of meshes that are not closed it says
  // as much as locate() does by the same rule. The size is the root of what closest_points() finds, rounded to a
  // float, at most the largest; infinite if nothing is within max_distance, as of an empty mesh, and of points that
  // are not finite. Exceptions as of both; where memory runs out some distances may be there.
  void signed_distances(VertexView points, std::span<float> distances,
                        const SignedDistanceOptions& options = {}) const;

  // The nearest hit that counts, of the test exact: a filter turns hits down in batches, and rays go on behind those.
  // Like others in that all modes have the same hits; a ray goes on alone. An empty filter turns nothing down.
  // Templates, because clang 14 takes the braces of {.mode = …} for a HitFilter and refuses them.
  template <std::convertible_to<HitFilter> Filter>
  void closest(RayView rays, HitView hits, const Filter& filter, const TraceOptions& options = {}) const {
    filtered_closest(rays, hits, filter, options);
  }
  template <std::convertible_to<HitFilter> Filter>
  void occluded(RayView rays, std::span<std::uint8_t> occluded, const Filter& filter,
                const TraceOptions& options = {}) const {
    filtered_occluded(rays, occluded, filter, options);
  }

  Box bounds() const noexcept;  // of the triangles it has; lo = +infinity, hi = −infinity if there are none

 protected:
  TriangleTree() noexcept = default;
  TriangleTree(TriangleTree&& other) noexcept : ready_(std::exchange(other.ready_, nullptr)) {}
  TriangleTree& operator=(TriangleTree&& other) noexcept {
    ready_ = std::exchange(other.ready_, nullptr);
    return *this;
  }
  // The tree that calls with one ray or one point walk, with blocks of corners: it lives as long as this object, or
  // until the next one is set. Null, as at first: these calls go the way of all others.
  void set_ready(const TreeView* tree) noexcept { ready_ = tree; }

 private:
  // What kernels walk.
  virtual TracedTree traced() const noexcept = 0;
  void filtered_closest(RayView rays, HitView hits, const HitFilter& filter,
                        const TraceOptions& options) const;
  void filtered_occluded(RayView rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
                         const TraceOptions& options) const;
  // A ray, or a point, with any options.
  [[gnu::cold, gnu::visibility("hidden")]] Hit closest_by_options(const Ray& ray,
                                                                  const TraceOptions& options) const;
  [[gnu::cold, gnu::visibility("hidden")]] bool occluded_by_options(const Ray& ray,
                                                                    const TraceOptions& options) const;
  [[gnu::cold, gnu::visibility("hidden")]] ClosestPoint closest_by_options(
      const Float3& point, const ClosestPointOptions& options) const;

  const TreeView* ready_ = nullptr;
};

}  // namespace raylanes
