// Trees over triangles of doubles: exact on the doubles given. docs/doubles.md says when floats are enough.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <iosfwd>
#include <limits>
#include <memory>
#include <span>

#include <raylanes/bvh.hpp>

namespace raylanes {

/// A view of vertices of doubles; otherwise as VertexView.
using VertexViewD = VertexRecords<double>;
/// A view of rays of doubles; otherwise as RayView.
using RayViewD = RayRecords<RayD>;
/// A view of hits of doubles; otherwise as HitView.
using HitViewD = HitRecords<HitD>;
/// A view of the hits of doubles after which rays look for the next; otherwise as AfterView.
using AfterViewD = AfterRecords<HitD>;
/// The ends of segments of doubles.
using SegmentEndsD = SegmentEndsOf<double>;

/// Checks a mesh of doubles, as validate_mesh() checks one of floats. Throws std::invalid_argument in the same cases.
void validate_mesh(VertexViewD vertices, IndexView triangles);

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
  std::uint32_t mask = ~0u;                   ///< of instances of a scene, or for `masks`, as in TraceOptions
  std::uint32_t filter_mask = ~0u;            ///< for `masks`: as in TraceOptions
  std::span<const std::uint32_t> masks = {};  ///< of triangles, as in TraceOptions
  /// For closest(): returns for ray i the first hit after `after[i]`, in the order of t, then of primitives; otherwise
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
  std::uint32_t mask = ~0u;            ///< of instances of a scene, as in TraceOptions
  const Progress* progress = nullptr;  ///< as in ClosestPointOptions
};

/// Options of BvhD::signed_distances(); otherwise as SignedDistanceOptions.
struct SignedDistanceOptionsD {
  InsideRule rule = InsideRule::parity;                           ///< when a point counts as inside
  double max_distance = std::numeric_limits<double>::infinity();  ///< points farther away get an infinity
  const Path* path = nullptr;  ///< an ISA path that this machine supports; null: the active one
  int threads = 1;  ///< 1: the calling thread; n: up to n, at most one a core; 0: the caller's oneTBB arena
  LaneBits active = nullptr;           ///< the active points; null: all
  std::uint32_t mask = ~0u;            ///< of instances of a scene, as in TraceOptions
  const Progress* progress = nullptr;  ///< as in SignedDistanceOptions
};

class BvhD;
struct DoubleTreeView;
namespace detail {
template <>
struct QueryTypes<BvhD> {
  using Number = double;
  using Hit = HitD;
  using Options = TraceOptionsD;
  using Crossing = CrossingD;
  using ClosestPoint = ClosestPointD;
  using ClosestOptions = ClosestPointOptionsD;
  using DistanceOptions = SignedDistanceOptionsD;
  using View = DoubleTreeView;
};
}  // namespace detail

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
/// Rows of points that share a ray have the locations of single points in a closed mesh. In a mesh with holes, `parity`
/// and `nonzero` count the crossings along the row.
class BvhD : public SurfaceQueries<BvhD>, public PointQueries<BvhD> {
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

  /// Returns calls with one ray by these options, which take less time than closest() and occluded(): see RayCalls.
  /// Throws as closest(ray, options) does.
  RayCalls<BvhD> calls(const TraceOptionsD& options = {}) const&;
  /// Does not compile: the calls would outlive a temporary tree.
  RayCalls<BvhD> calls(const TraceOptionsD& options = {}) const&& = delete;

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
  friend struct TreeAccess;
  explicit BvhD(std::unique_ptr<struct BvhDArrays> tree) noexcept;

  std::unique_ptr<struct BvhDArrays> tree_;  // null: the empty tree
};

}  // namespace raylanes
