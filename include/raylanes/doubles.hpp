// Trees over triangles of doubles: exact on the doubles given. docs/doubles.md says when floats are enough.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <functional>
#include <iosfwd>
#include <limits>
#include <memory>
#include <span>

#include <raylanes/bvh.hpp>
#include <raylanes/queries.hpp>
#include <raylanes/ray_calls.hpp>
#include <raylanes/types.hpp>

namespace raylanes {

/// A view of vertices of doubles; otherwise as VertexView.
using VertexViewD = VertexRecords<double>;
/// A view of rays of doubles; otherwise as RayView.
using RayViewD = RayRecords<RayD>;
/// A view of hits of doubles; otherwise as HitView.
using HitViewD = HitRecords<HitD>;
/// A view of the hits of doubles behind which rays look for the next; otherwise as AfterView.
using AfterViewD = AfterRecords<HitD>;
/// The ends of segments of doubles.
using SegmentEndsD = SegmentEndsOf<double>;

/// Checks a mesh of doubles, as validate_mesh() checks one of floats. Throws std::invalid_argument in the same cases.
void validate_mesh(VertexViewD vertices, IndexView triangles);

/// A crossing of a ray of doubles and a surface.
struct CrossingD {
  double t;                 ///< the exact quotient, rounded once
  std::uint32_t primitive;  ///< the triangle
  std::int32_t side;        ///< 1: along the normal, out of a solid; −1: against it, into a solid

  bool operator==(const CrossingD&) const = default;
};

/// A function that rejects hits of doubles, a batch at a time; otherwise as HitFilter.
using HitFilterD = std::function<void(std::span<const std::size_t> rays, std::span<const HitD> hits,
                                      std::span<std::uint8_t> rejected)>;

/// A function that takes a triangle of a tree: its index in the mesh, and its corners.
using TriangleVisitorD = std::function<void(std::uint32_t primitive, const std::array<Double3, 3>& corners)>;

/// How rays of doubles are traced: always by exact arithmetic.
struct TraceOptionsD {
  const Path* path = nullptr;  ///< an ISA path that this machine supports; null: the active one
  int threads = 1;  ///< 1: the calling thread; n: up to n, at most one a core; 0: the caller's oneTBB arena
  Facing facing = Facing::any;  ///< the sides of triangles that count; a ray passes through the other side
  LaneBits active = nullptr;    ///< the active rays of a batch; null: all
  PrimitiveView skip =
      {};  ///< for each ray a triangle that is not there for it; empty: none; as in TraceOptions
  /// For closest(): returns for ray i the first hit behind after[i], in the order of t, then of primitives; otherwise
  /// as TraceOptions::after. Other calls ignore it.
  AfterViewD after = {};
  const Progress* progress = nullptr;  ///< as in TraceOptions
};

/// Options of BvhD::closest_point() and closest_points().
struct ClosestPointOptionsD {
  /// Triangles farther away are ignored: distance_squared > max_distance², compared exactly. If it is NaN or negative,
  /// all are.
  double max_distance = std::numeric_limits<double>::infinity();
  const Path* path = nullptr;  ///< an ISA path that this machine supports; null: the active one
  int threads = 1;  ///< 1: the calling thread; n: up to n, at most one a core; 0: the caller's oneTBB arena
  LaneBits active = nullptr;           ///< the active points of a batch; null: all
  const Progress* progress = nullptr;  ///< as in ClosestPointOptions
};

/// Options of BvhD::signed_distances(); otherwise as SignedDistanceOptions.
struct SignedDistanceOptionsD {
  InsideRule rule = InsideRule::parity;                           ///< when a point counts as inside
  double max_distance = std::numeric_limits<double>::infinity();  ///< points farther away get an infinity
  const Path* path = nullptr;  ///< an ISA path that this machine supports; null: the active one
  int threads = 1;  ///< 1: the calling thread; n: up to n, at most one a core; 0: the caller's oneTBB arena
  LaneBits active = nullptr;           ///< the active points; null: all
  const Progress* progress = nullptr;  ///< as in SignedDistanceOptions
};

/// A bounding volume hierarchy over triangles whose corners are doubles. Rays, hits and points are doubles, too.
/// Each result is that of exact arithmetic on the doubles given: t, u and v are exact quotients, rounded once to
/// double; segments and triangles are closed; ties in t go to the lowest primitive index. Any finite double is allowed,
/// as are subnormal numbers. Results do not depend on ISA path, builder, batch or thread count.
/// Rounding must be to nearest: in another mode last bits differ, and hits may be lost or wrong.
/// A ray whose exact t overflows a double misses. Numbers beyond 2^200 in size, and meshes smaller than about 2^-200,
/// take many times as long.
/// Many threads may query one object at the same time, but not during refit().
/// A default-constructed or moved-from object is the tree of an empty mesh, which nothing hits.
/// There is no view() of nodes and leaves, whose layout may change.
class BvhD {
 public:
  BvhD() noexcept;
  /// Builds the tree: options are as for Bvh.
  /// The tree copies the triangles. Triangles with two equal corners are left out: nothing hits them.
  /// Throws std::invalid_argument if validate_mesh() refuses the mesh, it has more than 2^28 triangles, the builder is
  /// spatial_splits or does not exist, or the thread count is negative.
  /// Throws std::length_error if there are more nodes or leaves than can be numbered.
  BvhD(VertexViewD vertices, IndexView triangles, const BuildOptions& options = {});
  ~BvhD();
  BvhD(BvhD&&) noexcept;
  BvhD& operator=(BvhD&&) noexcept;

  /// Makes this the tree of another mesh with as many triangles; otherwise as Bvh::refit(). The tree has the same bytes
  /// for any number of threads.
  /// Throws std::invalid_argument if validate_mesh() refuses the mesh, the number of triangles differs, or the thread
  /// count is negative. Strong exception guarantee: if this throws, the tree is unchanged.
  void refit(VertexViewD vertices, IndexView triangles, int threads = 1);
  /// Returns the tree that refit() would make of this one, which stays as it is; otherwise as Bvh::refitted().
  BvhD refitted(VertexViewD vertices, IndexView triangles, int threads = 1) const;

  double sah_cost() const noexcept;  ///< the cost of the tree, as Bvh::sah_cost()
  double decay() const noexcept;     ///< sah_cost() divided by that after the last build, as Bvh::decay()

  /// Returns the nearest hit of the ray, or a miss.
  HitD closest(const RayD& ray) const;
  /// Returns whether the ray's segment hits any triangle.
  bool occluded(const RayD& ray) const;
  /// Returns the nearest hit of the ray by these options.
  /// Throws std::invalid_argument if an option is no enumerator of its type, the thread count is negative, or the path
  /// is not supported here.
  HitD closest(const RayD& ray, const TraceOptionsD& options) const;
  /// Returns whether the ray's segment hits any triangle, by these options. Throws as closest() does.
  bool occluded(const RayD& ray, const TraceOptionsD& options) const;
  /// Returns calls with one ray by these options, which take less time than closest() and occluded(): see RayCalls.
  /// Throws as closest(ray, options) does.
  RayCalls<BvhD> calls(const TraceOptionsD& options = {}) const&;
  /// Does not compile: the calls would outlive a temporary tree.
  RayCalls<BvhD> calls(const TraceOptionsD& options = {}) const&& = delete;

  /// Finds the nearest hit of each ray: hits[i] belongs to rays[i].
  /// Inactive rays leave their hit unchanged. Options may be views of hits that results go to.
  /// Throws what closest(ray) throws, and std::invalid_argument if hits.count is not rays.count, hits overlap rays or
  /// each other, or a view of some elements is null. A call that throws has written nothing; but on several threads
  /// std::bad_alloc may leave some hits written.
  void closest(RayViewD rays, HitViewD hits, const TraceOptionsD& options = {}) const;
  /// Finds the nearest hit of each ray, given as one array per number.
  void closest(const RayArraysD& rays, HitViewD hits, const TraceOptionsD& options = {}) const;
  /// Sets occluded[i] to 1 if the segment of ray i hits any triangle, else to 0. Throws as closest() of many rays does.
  void occluded(RayViewD rays, std::span<std::uint8_t> occluded, const TraceOptionsD& options = {}) const;
  /// Sets occluded[i] for each ray, given as one array per number.
  void occluded(const RayArraysD& rays, std::span<std::uint8_t> occluded,
                const TraceOptionsD& options = {}) const;
  /// Returns the nearest hit at which the ray passes through the surface, or a miss, as
  /// TriangleTree::closest_crossing() does: each passage once, and no edge that the ray only touches.
  HitD closest_crossing(const RayD& ray, const TraceOptionsD& options = {}) const;
  /// Finds the nearest hit at which each ray passes through the surface: hits[i] belongs to rays[i].
  /// Throws as closest() of many rays does.
  void closest_crossing(RayViewD rays, HitViewD hits, const TraceOptionsD& options = {}) const;
  /// Finds the nearest hit at which each ray passes through the surface, given as one array per number.
  void closest_crossing(const RayArraysD& rays, HitViewD hits, const TraceOptionsD& options = {}) const;

  /// Sets occluded[i] to 1 if a triangle lies between `from` and points[i], else to 0.
  /// The ray that begins at points[i] decides. Its direction is the difference of the points, rounded, tmin is
  /// 1 - ends.end and tmax 1 - ends.start: as in TriangleTree::occluded_from(), with 2^-53 in place of 2^-24.
  /// Differences of two floats of similar size are exact in doubles: then a triangle that holds one of the points
  /// occludes, unless options.skip names it. Throws as closest() of many rays does.
  void occluded_from(const Double3& from, VertexViewD points, std::span<std::uint8_t> occluded,
                     const SegmentEndsD& ends = {}, const TraceOptionsD& options = {}) const;
  /// Sets occluded[i] to 1 if the ray from points[i] in that direction hits any triangle, else to 0: shadows of a
  /// sun, as TriangleTree::occluded_towards(). Throws as closest() of many rays does.
  void occluded_towards(const Double3& direction, VertexViewD points, std::span<std::uint8_t> occluded,
                        const TraceOptionsD& options = {}) const;

  /// Finds the nearest hit of each ray that the filter does not reject; otherwise as TriangleTree::closest() with a
  /// filter.
  template <class Rays, std::convertible_to<HitFilterD> Filter>
  void closest(const Rays& rays, HitViewD hits, const Filter& filter,
               const TraceOptionsD& options = {}) const {
    filtered_closest(rays, hits, filter, options);
  }
  /// Sets occluded[i] to 1 if the segment of ray i has a hit that the filter does not reject, else to 0.
  template <class Rays, std::convertible_to<HitFilterD> Filter>
  void occluded(const Rays& rays, std::span<std::uint8_t> occluded, const Filter& filter,
                const TraceOptionsD& options = {}) const {
    filtered_occluded(rays, occluded, filter, options);
  }
  /// Sets occluded[i] to 1 if the segment from `from` to points[i] has a hit that the filter keeps, else to 0.
  template <std::convertible_to<HitFilterD> Filter>
  void occluded_from(const Double3& from, VertexViewD points, std::span<std::uint8_t> occluded,
                     const Filter& filter, const SegmentEndsD& ends = {},
                     const TraceOptionsD& options = {}) const {
    filtered_occluded_from(from, points, occluded, filter, ends, options);
  }
  /// Sets occluded[i] to 1 if the ray from points[i] in that direction has a hit that the filter keeps, else to 0.
  template <std::convertible_to<HitFilterD> Filter>
  void occluded_towards(const Double3& direction, VertexViewD points, std::span<std::uint8_t> occluded,
                        const Filter& filter, const TraceOptionsD& options = {}) const {
    filtered_occluded_towards(direction, points, occluded, filter, options);
  }
  /// Returns the nearest hit of the ray for which rejects(hit) is false.
  /// rejects() is asked during the search about each hit that would be the best so far: in no order of t, perhaps about
  /// hits behind the result, and again about a triangle that the tree has in several leaves. If its result depends on
  /// the hit alone, so does that of this call. It may query trees; its exceptions pass through. To see hits in order,
  /// call all_hits() or closest() with options.after.
  template <std::predicate<const HitD&> Rejects>
  HitD closest(const RayD& ray, Rejects&& rejects, const TraceOptionsD& options) const {
    return detail::with_rejection<HitD>(rejects, [&](const detail::Rejection<HitD>& rejection) {
      return closest_kept(ray, rejection, &options);
    });
  }
  /// Returns the nearest hit of the ray for which rejects(hit) is false, on the active path.
  template <std::predicate<const HitD&> Rejects>
  HitD closest(const RayD& ray, Rejects&& rejects) const {
    return detail::with_rejection<HitD>(rejects, [&](const detail::Rejection<HitD>& rejection) {
      return closest_kept(ray, rejection, nullptr);
    });
  }
  /// Returns whether the ray's segment has a hit for which rejects(hit) is false. rejects() is asked as in closest(),
  /// until it keeps a hit.
  template <std::predicate<const HitD&> Rejects>
  bool occluded(const RayD& ray, Rejects&& rejects, const TraceOptionsD& options) const {
    return detail::with_rejection<HitD>(rejects, [&](const detail::Rejection<HitD>& rejection) {
      return any_kept(ray, rejection, &options);
    });
  }
  /// Returns whether the ray's segment has a hit for which rejects(hit) is false, on the active path.
  template <std::predicate<const HitD&> Rejects>
  bool occluded(const RayD& ray, Rejects&& rejects) const {
    return detail::with_rejection<HitD>(
        rejects, [&](const detail::Rejection<HitD>& rejection) { return any_kept(ray, rejection, nullptr); });
  }

  /// Returns every hit of each ray once, in the order of t, then of primitives.
  /// Throws std::invalid_argument if options.counters is not null: rays of doubles are not counted; otherwise as
  /// closest() of many rays does.
  RayLists<HitD> all_hits(RayViewD rays, const ListOptions& options = {}) const;
  /// Returns every hit of each ray, given as one array per number.
  RayLists<HitD> all_hits(const RayArraysD& rays, const ListOptions& options = {}) const;
  /// Returns each crossing of a ray and the surface once, in the order of t, then of primitives; otherwise as
  /// TriangleTree::crossings(). Throws as all_hits() does.
  RayLists<CrossingD> crossings(RayViewD rays, const ListOptions& options = {}) const;
  /// Returns each crossing of the rays, given as one array per number.
  RayLists<CrossingD> crossings(const RayArraysD& rays, const ListOptions& options = {}) const;
  /// Counts the crossings of each ray, and sums up their sides; options.max_count is ignored.
  /// Inactive rays leave their count unchanged. Throws as all_hits() does.
  void count_crossings(RayViewD rays, std::span<CrossingCount> counts, const ListOptions& options = {}) const;
  /// Counts the crossings of each ray, given as one array per number.
  void count_crossings(const RayArraysD& rays, std::span<CrossingCount> counts,
                       const ListOptions& options = {}) const;
  /// Finds out whether each point is inside, outside or on the surface, exactly: locations[i] belongs to points[i].
  /// The rules are as in TriangleTree::locate(). Points that are not finite are outside. Inactive points are not read,
  /// and leave their location unchanged.
  /// Rows of four points or more that differ along one axis only, as in a grid, share one ray, which makes them faster.
  /// In a closed mesh a row has the locations of its single points. In a mesh with holes, `parity` and `nonzero` count
  /// the crossings along the row.
  /// Throws as all_hits() does.
  void locate(VertexViewD points, std::span<Location> locations, const LocateOptions& options = {}) const;
  /// Computes the generalised winding number of each point: numbers[i] belongs to points[i]. The number is as in
  /// TriangleTree::winding_numbers(): closed meshes have whole numbers, numbers below 2^-100 in size become 0, and
  /// points that are not finite have 0. The error is at most options.accuracy + 2^-53·|w| + 2^-40·n, with n edges of
  /// the boundary. Rows of points share rays: there the last bits depend on the row's direction. Inactive points leave
  /// their number unchanged. The first call finds the boundary; the tree keeps it until refit().
  /// Throws as all_hits() does, and std::invalid_argument if numbers.size() is not points.count, or the accuracy is
  /// negative or NaN. std::bad_alloc may leave some numbers written.
  void winding_numbers(VertexViewD points, std::span<double> numbers,
                       const WindingOptions& options = {}) const;

  /// Returns the closest point of the triangles; ties in distance_squared go to the lowest primitive index.
  /// ClosestPointD has the error bound. The bytes do not depend on ISA path, tree, builder or threads.
  /// If the point is not finite, there is no closest point.
  /// Throws std::invalid_argument if the thread count is negative or the path is not supported here.
  ClosestPointD closest_point(const Double3& point, const ClosestPointOptionsD& options = {}) const;
  /// Finds the closest point of each of many points; otherwise as TriangleTree::closest_points().
  void closest_points(VertexViewD points, std::span<ClosestPointD> closest,
                      const ClosestPointOptionsD& options = {}) const;
  /// Computes how far each point is from the surface, negative inside: distances[i] belongs to points[i].
  /// The sign is exact, as locate() finds it by the same rule: the distance is 0 if and only if the point is on a
  /// triangle, and at least 2^-1022 in size otherwise. The size is ClosestPointD::distance, at most the largest double.
  /// It is infinite if nothing is within max_distance, the mesh is empty, or the point is not finite. Throws as
  /// locate() and closest_points() do; std::bad_alloc may leave some distances written.
  void signed_distances(VertexViewD points, std::span<double> distances,
                        const SignedDistanceOptionsD& options = {}) const;

  /// Writes the corners of triangles: triangles[k] belongs to primitives[k]; otherwise as TriangleTree::corners().
  void corners(PrimitiveView primitives, std::span<TriangleD> triangles) const;

  /// Writes the tree as bytes, from which load() makes a tree that gives the same bytes for any ray; otherwise as
  /// Bvh::save().
  void save(std::ostream& file) const;
  /// Returns the tree that save() wrote; otherwise as Bvh::load().
  /// Throws std::runtime_error, with one line, if the bytes are no such tree, cut or damaged, or the file of a Bvh,
  /// KdTree or Scene; and std::bad_alloc if memory runs out. No bytes make a tree that faults.
  static BvhD load(std::istream& file);

  /// Calls visit() with each triangle that the last build or refit did not leave out, by order of leaves. Corners are
  /// the doubles given, in the mesh's order. The function must not change the tree. An exception of it ends the call.
  /// Throws std::bad_function_call if the function is empty and the tree is not.
  void each_triangle(const TriangleVisitorD& visit) const;

  /// Returns the box around all triangles that no build or refit left out; otherwise as TriangleTree::bounds().
  BoxD bounds() const noexcept;
  std::size_t bytes() const noexcept;       ///< the bytes of nodes and leaves
  std::size_t node_count() const noexcept;  ///< the number of inner nodes
  std::size_t leaf_count() const noexcept;  ///< the number of leaves
  /// Returns what the tree is, and what its build took, as Bvh::report() does: `choice` says what BuildOptions::choose
  /// chose. Visits all nodes.
  TreeReport report() const;

 private:
  friend struct TreeOf;
  explicit BvhD(std::unique_ptr<struct BvhDArrays> tree) noexcept;
  HitD closest_kept(const RayD& ray, const detail::Rejection<HitD>& rejection,
                    const TraceOptionsD* options) const;
  bool any_kept(const RayD& ray, const detail::Rejection<HitD>& rejection,
                const TraceOptionsD* options) const;
  void filtered_closest(RayViewD rays, HitViewD hits, const HitFilterD& filter,
                        const TraceOptionsD& options) const;
  void filtered_closest(const RayArraysD& rays, HitViewD hits, const HitFilterD& filter,
                        const TraceOptionsD& options) const;
  void filtered_occluded(RayViewD rays, std::span<std::uint8_t> occluded, const HitFilterD& filter,
                         const TraceOptionsD& options) const;
  void filtered_occluded(const RayArraysD& rays, std::span<std::uint8_t> occluded, const HitFilterD& filter,
                         const TraceOptionsD& options) const;
  void filtered_occluded_from(const Double3& from, VertexViewD points, std::span<std::uint8_t> occluded,
                              const HitFilterD& filter, const SegmentEndsD& ends,
                              const TraceOptionsD& options) const;
  void filtered_occluded_towards(const Double3& direction, VertexViewD points,
                                 std::span<std::uint8_t> occluded, const HitFilterD& filter,
                                 const TraceOptionsD& options) const;

  std::unique_ptr<struct BvhDArrays> tree_;  // null: the empty tree
};

}  // namespace raylanes
