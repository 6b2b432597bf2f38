// The queries of trees over triangles: nearest hits, occlusion, all hits, crossings, inside and outside, closest
// points.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include <raylanes/mesh.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/points.hpp>
#include <raylanes/progress.hpp>
#include <raylanes/queries.hpp>
#include <raylanes/ray_calls.hpp>
#include <raylanes/rays.hpp>
#include <raylanes/traversal.hpp>
#include <raylanes/triangles.hpp>

namespace raylanes {

/// The caller's knowledge about the rays of a batch. A wrong hint costs time, not hits. Modes other than automatic need
/// none.
enum class BatchHint : std::uint8_t {
  none,           ///< Nothing is known: the call samples some rays.
  shared_origin,  ///< Rays come in runs that share their origin.
  shared_end,     ///< Rays come in runs that share their end, as at a light.
  coherent,       ///< Neighbours in the batch are neighbours in space, but share no point.
  incoherent      ///< Neighbours in the batch have nothing in common.
};

/// The names of the hints, by enumerator.
inline constexpr std::array<std::string_view, 5> batch_hint_names{"none", "shared_origin", "shared_end",
                                                                  "coherent", "incoherent"};

/// How rays are traced.
struct TraceOptions {
  TriangleTest test = TriangleTest::exact;        ///< how a ray is tested against a triangle
  Grade grade = Grade::reproducible;              ///< the promise of the test about its bits
  TraversalMode mode = TraversalMode::automatic;  ///< how the rays of a batch share vectors
  BatchHint hint = BatchHint::none;               ///< the caller's knowledge about the batch
  const Path* path = nullptr;  ///< an ISA path that this machine supports; null: the active one
  int threads = 1;  ///< 1: the calling thread; n: up to n, at most one a core; 0: the caller's oneTBB arena
  /// The sides of triangles that count, by TriangleTest::exact: a ray passes through the other side as if the triangle
  /// were not there.
  /// Throws std::invalid_argument if this is not Facing::any and the test is another one.
  Facing facing = Facing::any;
  LaneBits active = nullptr;  ///< the active rays of a batch; null: all
  /// For TriangleTest::exact: triangle skip[i] is not there for ray i; no_primitive leaves out none. So a ray that
  /// begins on a triangle need not begin behind it. Usually these are the hits of an earlier call: {.skip = hits}; they
  /// may be those that results go to. An empty view leaves out nothing.
  /// Throws std::invalid_argument for another test, or another number of indices than rays.
  PrimitiveView skip = {};
  /// If not null, what the call costs is added here, summed over its threads. No other call may add to it at the same
  /// time. Results keep their bytes; the call takes longer.
  /// Counts need the grade reproducible, a build with -Dcounters=true (the default), and the test exact or the mode
  /// single; otherwise std::invalid_argument is thrown. Counts of single rays depend on the tree, the rays and, if a
  /// leaf's triangles exceed a vector, the lanes of the ISA path. Counts of other modes also depend on which rays are
  /// traced together, and so on the number of threads.
  TraceCounters* counters = nullptr;
  /// For closest() with TriangleTest::exact: returns for ray i the first hit behind after[i], in the order of t, then
  /// of primitives; in scenes of t, then instance, then primitive. Usually these are the hits of an earlier call:
  /// {.after = hits}; they may be those that results go to.
  /// If after[i] is a miss, ray i returns a miss. If its t is -infinity, ray i returns its first hit. An empty view
  /// asks for nearest hits. Rays are traced individually, whatever the mode.
  /// Throws std::invalid_argument for another test, or another number of hits than rays. Other calls ignore it.
  AfterView after = {};
  /// If not null, batches call it between parts of their rays, as Progress says; if it throws, the results of any rays
  /// may be written. Results keep their bytes for the test exact and the mode single; for others the parts are as large
  /// as without it, up to 65,536 rays. With a filter, shares are of the first search. Calls with one ray
  /// ignore it.
  const Progress* progress = nullptr;
};

/// Options of closest_point() and closest_points().
struct ClosestPointOptions {
  /// Triangles farther away are ignored: distance_squared > max_distance², compared exactly. If it is NaN or negative,
  /// all are.
  float max_distance = std::numeric_limits<float>::infinity();
  const Path* path = nullptr;  ///< an ISA path that this machine supports; null: the active one
  int threads = 1;  ///< 1: the calling thread; n: up to n, at most one a core; 0: the caller's oneTBB arena
  LaneBits active = nullptr;  ///< the active points of a batch; null: all
  /// If not null, nodes, leaves, box_tests and triangle_tests are added here. They depend on the tree, the points,
  /// their order, the number of threads and the ISA path.
  TraceCounters* counters = nullptr;
  /// If not null, batches call it between parts, as Progress says; if it throws, any results may be written.
  const Progress* progress = nullptr;
};

struct TracedTree;
struct TreeView;

/// The queries that Bvh and KdTree share: results do not depend on the kind of tree.
/// Many threads may query one object at the same time. No call traps floating-point exceptions, even if the caller lets
/// them trap; calls may leave status flags raised: docs/guide/arrays.md.
class TriangleTree {
 public:
  virtual ~TriangleTree() = default;

  /// Returns the nearest hit of the ray, or a miss. Ties in t go to the lowest primitive index.
  /// With TriangleTest::exact the result is that of exact arithmetic on the given floats: it does not depend on tree,
  /// ISA path, grade, mode or thread count. If the exact t overflows a float, the ray misses.
  /// With TriangleTest::watertight in the grade reproducible that holds too, with two exceptions: rays nearly in the
  /// plane of a triangle, and hits whose t times twice the triangle's area, seen along the major axis of the direction,
  /// is neither zero nor in [2^-100, 2^120].
  /// Throws std::invalid_argument if an option is no enumerator of its type, the thread count is negative, the path is
  /// not supported here, or trees do not take the test.
  Hit closest(const Ray& ray, const TraceOptions& options) const;
  /// Returns the nearest hit of the ray by TriangleTest::exact on the active path. Throws as active_path() does.
  Hit closest(const Ray& ray) const;
  /// Returns whether the ray's segment hits any triangle. Throws as closest() does.
  bool occluded(const Ray& ray, const TraceOptions& options) const;
  /// Returns whether the ray's segment hits any triangle, by TriangleTest::exact on the active path.
  bool occluded(const Ray& ray) const;
  /// Returns calls with one ray by these options, which take less time than closest() and occluded(): see RayCalls.
  /// Throws as closest(ray, options) does.
  RayCalls<TriangleTree> calls(const TraceOptions& options = {}) const&;
  /// Does not compile: the calls would outlive a temporary tree.
  RayCalls<TriangleTree> calls(const TraceOptions& options = {}) const&& = delete;

  /// Finds the nearest hit of each ray: hits[i] belongs to rays[i].
  /// Inactive rays (options.active) leave their hit unchanged. Skips, hits behind which rays look and the mask of
  /// active rays may lie where hits go: the call copies them.
  /// Each thread keeps up to 20 MB of scratch memory, 30 MB if rays or hits are not contiguous.
  /// Throws what closest(ray) throws, and std::invalid_argument if hits.count is not rays.count, hits overlap rays
  /// or each other, or a view of some elements is null. A call that throws has written nothing; but on several threads
  /// std::bad_alloc may leave some hits written.
  void closest(RayView rays, HitView hits, const TraceOptions& options = {}) const;
  /// Finds the nearest hit of each ray, given as one array per number.
  void closest(const RayArrays& rays, HitView hits, const TraceOptions& options = {}) const;
  /// Sets occluded[i] to 1 if the segment of ray i hits any triangle, else to 0.
  /// Memory, inactive rays and exceptions are as in closest() of many rays.
  void occluded(RayView rays, std::span<std::uint8_t> occluded, const TraceOptions& options = {}) const;
  /// Sets occluded[i] for each ray, given as one array per number.
  void occluded(const RayArrays& rays, std::span<std::uint8_t> occluded,
                const TraceOptions& options = {}) const;

  /// Returns the nearest hit at which the ray passes through the surface, or a miss: the next exit of a solid by
  /// {.facing = Facing::back, .skip = here}, its entry by Facing::front. With normals that point out they alternate.
  /// It is the first hit of closest() that is an item of crossings() and no glance. The sides of the crossings at one
  /// edge or corner, by position, are summed: as many of them count as the sum is large, of its sign, with the lowest
  /// primitives. So an edge between two triangles counts once, or not at all if the ray only touches it. Sides sum over
  /// all triangles but the skipped one, whatever options.facing is. If all of them have the same corners, all count.
  /// A ray in the plane of a triangle, or from a point on an edge of it, does not pass it. A cell that is only touched
  /// at a corner has no passage: particles go through cells that share faces by crossings(), as docs/crossings.md says.
  /// Takes all options of closest(), `after` too. Throws as closest() does, and std::invalid_argument for another test
  /// than TriangleTest::exact.
  Hit closest_crossing(const Ray& ray, const TraceOptions& options = {}) const;
  /// Finds the nearest hit at which each ray passes through the surface: hits[i] belongs to rays[i].
  /// Views, inactive rays, memory and exceptions are as in closest() of many rays. The hits have the bytes of
  /// closest_crossing() of one ray in every mode. Rays whose hit is less than 2^-22 from an edge, as a share of the
  /// triangle, are looked at individually by the calling thread.
  void closest_crossing(RayView rays, HitView hits, const TraceOptions& options = {}) const;
  /// Finds the nearest hit at which each ray passes through the surface, given as one array per number.
  void closest_crossing(const RayArrays& rays, HitView hits, const TraceOptions& options = {}) const;

  /// Sets occluded[i] to 1 if a triangle lies between `from` and points[i], else to 0: shadows of one light.
  /// The ray that begins at points[i] decides. Its direction is the difference of the points, rounded, tmin is
  /// 1 - ends.end and tmax 1 - ends.start, less than 1 if ends.start is positive. So a segment begins at its point
  /// exactly, however far the light is. Along each axis it ends within 2^-24 of that difference from `from`. If a
  /// difference overflows, the direction is half of the differences, rounded, with twice tmin and tmax. If both points
  /// are equal, the result is 0. options.facing is meant as `from` sees it. `active` is a mask of points. Such
  /// rays are traced fastest. Throws as closest() of many rays does.
  void occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                     const SegmentEnds& ends = {}, const TraceOptions& options = {}) const;
  /// Sets occluded[i] to 1 if the ray from points[i] in that direction hits any triangle, else to 0: shadows of a sun.
  /// The direction needs no unit length. tmin is 0 and tmax infinity; options.facing is as for rays. `active` is a mask
  /// of points. Throws as closest() of many rays does.
  void occluded_towards(const Float3& direction, VertexView points, std::span<std::uint8_t> occluded,
                        const TraceOptions& options = {}) const;

  /// Returns the closest point of the triangles; ties in distance go to the lowest primitive index. ClosestPoint has
  /// the error bound. The bytes do not depend on ISA path, tree, builder or threads.
  /// Triangles with two equal corners are ignored. If the point is not finite, there is no closest point.
  /// Throws std::invalid_argument if the thread count is negative, the path is not supported here, or counters are
  /// asked for in a build without them.
  ClosestPoint closest_point(const Float3& point, const ClosestPointOptions& options) const;
  /// Returns the closest point, however far, on the active path. Throws as active_path() does.
  ClosestPoint closest_point(const Float3& point) const;
  /// Finds the closest point of each of many points: closest[i] belongs to points[i].
  /// Inactive points leave their result unchanged. Fastest if neighbours in the batch are neighbours in space. Throws
  /// what closest_point() throws, and std::invalid_argument, before writing anything, if closest.size() is not
  /// points.count, points and closest overlap, or a view of some points is null.
  void closest_points(VertexView points, std::span<ClosestPoint> closest,
                      const ClosestPointOptions& options = {}) const;

  // The queries below use TriangleTest::exact. docs/crossings.md has the definitions. Views, active elements, threads,
  // paths and exceptions are as in closest() of many rays; after std::bad_alloc the tree is unchanged.

  /// Returns every hit of each ray once, in the order of t, then of primitives. The first one has the bytes of
  /// closest().
  /// One traversal a ray; as many hits as memory holds, or options.max_count for each ray.
  RayLists<Hit> all_hits(RayView rays, const ListOptions& options = {}) const;
  /// Returns every hit of each ray, given as one array per number.
  RayLists<Hit> all_hits(const RayArrays& rays, const ListOptions& options = {}) const;
  /// Writes every hit of each ray into the caller's arrays, and returns how many there are.
  /// offsets.size() must be rays.count + 1. If there are more hits than hits.size(), none is written. Needs memory for
  /// as many hits besides.
  std::size_t all_hits(RayView rays, std::span<std::size_t> offsets, std::span<Hit> hits,
                       const ListOptions& options = {}) const;
  /// Returns each crossing of a ray and the surface once, in the order of t, then of primitives.
  /// At edges and vertices, and along planes, simulation of simplicity decides (Edelsbrunner, Mücke 1990): a ray
  /// leaves a closed mesh as often as it enters it.
  RayLists<Crossing> crossings(RayView rays, const ListOptions& options = {}) const;
  /// Returns each crossing of the rays, given as one array per number.
  RayLists<Crossing> crossings(const RayArrays& rays, const ListOptions& options = {}) const;
  /// Counts the crossings of each ray, and sums up their sides; options.max_count is ignored.
  /// Inactive rays leave their count unchanged. Takes less than 1 MB a thread beside what streams of rays take, but for
  /// trees that hold triangles in several leaves (k-d trees, spatial splits), where it makes lists.
  /// Throws std::invalid_argument if counts.size() is not the number of rays or an option is invalid.
  void count_crossings(RayView rays, std::span<CrossingCount> counts, const ListOptions& options = {}) const;
  /// Counts the crossings of each ray, given as one array per number.
  void count_crossings(const RayArrays& rays, std::span<CrossingCount> counts,
                       const ListOptions& options = {}) const;
  /// Finds out whether each point is inside, outside or on the surface, exactly: locations[i] belongs to points[i].
  /// The mesh should be closed: each edge with as many triangles in one direction as in the other. For other meshes
  /// InsideRule::winding is meant. By `parity` and `nonzero` a location depends there on the direction of the point's
  /// ray, which goes to the nearest side of bounds(). If a point differs from the active point before or after
  /// it along one axis only, as in a grid, its ray goes up this axis. Rows of four such points or more share one ray,
  /// and are several times as fast. Points that are not finite are outside. Inactive points are not read, and leave
  /// their location unchanged.
  void locate(VertexView points, std::span<Location> locations, const LocateOptions& options = {}) const;
  /// Computes the generalised winding number of each point: numbers[i] belongs to points[i]. It is the sum of the solid
  /// angles of all triangles, seen from the point, over 4π; 1 inside a closed mesh whose normals point out (Jacobson et
  /// al. 2013). Any mesh has it: with holes, faces turned over, in several copies, with triangles that share nothing.
  /// It is computed as the signed crossings of a ray, exactly, and an integral over the boundary: the edges that have
  /// more triangles in one direction than in the other, by positions. Closed meshes have whole numbers.
  /// The error is at most options.accuracy + 2^-24·|w| + 2^-40·n, with n edges of the boundary: docs/winding.md.
  /// Numbers below 2^-100 in size become 0.
  /// Crossings at the point itself count half: on a triangle the number is the mean of both sides. On an edge it is one
  /// of the values around. Points that are not finite have 0. Inactive points leave their number unchanged.
  /// The first call finds the boundary, in time and memory like a build's; the tree keeps it until refit().
  /// The bytes do not depend on ISA path, tree, builder or threads. Rows of a grid share rays: there the last bits
  /// depend on the row's direction. Throws as locate() does, and std::invalid_argument if the accuracy is negative or
  /// NaN, or the tree has 2^30 triangles or more. std::bad_alloc may leave some numbers written.
  void winding_numbers(VertexView points, std::span<float> numbers, const WindingOptions& options = {}) const;
  /// Computes how far each point is from the surface, negative inside: distances[i] belongs to points[i].
  /// The sign is exact, as locate() finds it by the same rule: the distance is 0 if and only if the point is on a
  /// triangle, and at least 2^-126 in size otherwise. The size is the square root of closest_points()'
  /// distance_squared, rounded to float, at most FLT_MAX. It is infinite if nothing is within max_distance, the mesh
  /// is empty, or the point is not finite. Throws as locate() and closest_points() do; std::bad_alloc may leave some
  /// distances written.
  void signed_distances(VertexView points, std::span<float> distances,
                        const SignedDistanceOptions& options = {}) const;

  // Templates, because clang 14 takes the braces of {.mode = …} for a HitFilter and refuses them.

  /// Finds the nearest hit of each ray that the filter does not reject, by TriangleTest::exact. `rays` are records or
  /// arrays, as in closest() of many rays.
  /// The filter is called with batches of hits; rejected rays are traced on behind their hit, individually. All modes
  /// return the same hits. An empty filter rejects nothing.
  template <class Rays, std::convertible_to<HitFilter> Filter>
  void closest(const Rays& rays, HitView hits, const Filter& filter, const TraceOptions& options = {}) const {
    filtered_closest(rays, hits, filter, options);
  }
  /// Sets occluded[i] to 1 if the segment of ray i has a hit that the filter does not reject, else to 0.
  template <class Rays, std::convertible_to<HitFilter> Filter>
  void occluded(const Rays& rays, std::span<std::uint8_t> occluded, const Filter& filter,
                const TraceOptions& options = {}) const {
    filtered_occluded(rays, occluded, filter, options);
  }
  /// Sets occluded[i] to 1 if the segment from `from` to points[i] has a hit that the filter keeps, else to 0.
  /// The filter sees hits of the ray that begins at points[i], nearest to the point first.
  template <std::convertible_to<HitFilter> Filter>
  void occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                     const Filter& filter, const SegmentEnds& ends = {},
                     const TraceOptions& options = {}) const {
    filtered_occluded_from(from, points, occluded, filter, ends, options);
  }
  /// Sets occluded[i] to 1 if the ray from points[i] in that direction has a hit that the filter keeps, else to 0.
  template <std::convertible_to<HitFilter> Filter>
  void occluded_towards(const Float3& direction, VertexView points, std::span<std::uint8_t> occluded,
                        const Filter& filter, const TraceOptions& options = {}) const {
    filtered_occluded_towards(direction, points, occluded, filter, options);
  }
  /// Returns the nearest hit of the ray for which rejects(hit) is false.
  /// rejects() is asked during the search about each hit that would be the best so far: in no order of t, perhaps about
  /// hits behind the result, and again about a triangle that the tree has in several leaves. If its result depends on
  /// the hit alone, so does that of this call. It may query trees; its exceptions pass through. To see hits in order,
  /// call all_hits() or closest() with options.after.
  template <std::predicate<const Hit&> Rejects>
  Hit closest(const Ray& ray, Rejects&& rejects, const TraceOptions& options) const {
    return detail::with_rejection<Hit>(rejects, [&](const detail::Rejection<Hit>& rejection) {
      return closest_kept(ray, rejection, &options);
    });
  }
  /// Returns the nearest hit of the ray for which rejects(hit) is false, on the active path.
  template <std::predicate<const Hit&> Rejects>
  Hit closest(const Ray& ray, Rejects&& rejects) const {
    return detail::with_rejection<Hit>(rejects, [&](const detail::Rejection<Hit>& rejection) {
      return closest_kept(ray, rejection, nullptr);
    });
  }
  /// Returns whether the ray's segment has a hit for which rejects(hit) is false. rejects() is asked as in closest(),
  /// until it keeps a hit.
  template <std::predicate<const Hit&> Rejects>
  bool occluded(const Ray& ray, Rejects&& rejects, const TraceOptions& options) const {
    return detail::with_rejection<Hit>(
        rejects, [&](const detail::Rejection<Hit>& rejection) { return any_kept(ray, rejection, &options); });
  }
  /// Returns whether the ray's segment has a hit for which rejects(hit) is false, on the active path.
  template <std::predicate<const Hit&> Rejects>
  bool occluded(const Ray& ray, Rejects&& rejects) const {
    return detail::with_rejection<Hit>(
        rejects, [&](const detail::Rejection<Hit>& rejection) { return any_kept(ray, rejection, nullptr); });
  }

  /// Writes the corners of triangles: triangles[k] belongs to primitives[k], as the mesh had them at the last build or
  /// refit. The primitives may be hits, crossings or closest points. unit_normal() of <raylanes/surface.hpp> makes
  /// their normals. A primitive that is no triangle of the tree, such as that of a miss, has corners of NaN. A triangle
  /// that was left out has them, too.
  /// Each call visits all leaves. Throws std::invalid_argument, before writing anything, if there are not as many
  /// triangles as primitives or a view points to nothing. std::bad_alloc passes through.
  void corners(PrimitiveView primitives, std::span<Triangle> triangles) const;
  /// Returns the box around all triangles but those with two equal corners, which the last build or refit left out;
  /// lo = +infinity and hi = −infinity if there are none.
  Box bounds() const noexcept;

 protected:
  TriangleTree() noexcept = default;
  TriangleTree(TriangleTree&& other) noexcept : ready_(std::exchange(other.ready_, nullptr)) {}
  TriangleTree& operator=(TriangleTree&& other) noexcept {
    ready_ = std::exchange(other.ready_, nullptr);
    return *this;
  }
  /// Sets the tree that calls with one ray or one point traverse, with blocks of corners. It must live until the next
  /// call of set_ready(), or as long as this object. If it is null, these calls take the path of batches.
  void set_ready(const TreeView* tree) noexcept { ready_ = tree; }

 private:
  // The tree that kernels traverse.
  virtual TracedTree traced() const noexcept = 0;
  Hit closest_kept(const Ray& ray, const detail::Rejection<Hit>& rejection,
                   const TraceOptions* options) const;
  bool any_kept(const Ray& ray, const detail::Rejection<Hit>& rejection, const TraceOptions* options) const;
  void filtered_closest(RayView rays, HitView hits, const HitFilter& filter,
                        const TraceOptions& options) const;
  void filtered_closest(const RayArrays& rays, HitView hits, const HitFilter& filter,
                        const TraceOptions& options) const;
  void filtered_occluded(RayView rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
                         const TraceOptions& options) const;
  void filtered_occluded(const RayArrays& rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
                         const TraceOptions& options) const;
  void filtered_occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                              const HitFilter& filter, const SegmentEnds& ends,
                              const TraceOptions& options) const;
  void filtered_occluded_towards(const Float3& direction, VertexView points, std::span<std::uint8_t> occluded,
                                 const HitFilter& filter, const TraceOptions& options) const;
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
