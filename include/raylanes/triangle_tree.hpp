// The base of trees over triangles of floats, and how rays are traced through them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include <raylanes/mesh.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/point_queries.hpp>
#include <raylanes/progress.hpp>
#include <raylanes/ray_calls.hpp>
#include <raylanes/ray_queries.hpp>
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
  /// In scenes: only instances whose mask has a bit in common with this one are there. In trees this goes with `masks`.
  std::uint32_t mask = ~0u;
  /// With `masks`: a filter is asked only about triangles whose word has a bit in common with this, and about triangles
  /// without a word. Hits of the others count as they are. So two bits of a word say of a triangle that it is solid,
  /// open, or to be asked about; a filter that looks at a texture is asked about few hits.
  std::uint32_t filter_mask = ~0u;
  /// In trees, for TriangleTest::exact: triangle i is there only if masks[i] has a bit in common with `mask`. Triangles
  /// from masks.size() on are there. So an empty span, the default, asks nothing and costs nothing. Triangles that are
  /// not there have no hits and no crossings; the call is asked about none of them, and takes about the time of one
  /// with `skip`. The words must not change during the call.
  /// Throws std::invalid_argument for another test, and in scenes.
  std::span<const std::uint32_t> masks = {};
  /// If not null, what the call costs is added here, summed over its threads. No other call may add to it at the same
  /// time. Results keep their bytes; the call takes longer.
  /// Counts need the grade reproducible, a build with -Dcounters=true (the default), and the test exact or the mode
  /// single; otherwise std::invalid_argument is thrown. Counts of single rays depend on the tree, the rays and, if a
  /// leaf's triangles exceed a vector, the lanes of the ISA path. Counts of other modes also depend on which rays are
  /// traced together, and so on the number of threads.
  TraceCounters* counters = nullptr;
  /// For closest() with TriangleTest::exact: returns for ray i the first hit after `after[i]`, in the order of t, then
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
  std::uint32_t mask = ~0u;   ///< of instances of a scene, as in TraceOptions
  /// If not null, nodes, leaves, box_tests and triangle_tests are added here. They depend on the tree, the points,
  /// their order, the number of threads and the ISA path.
  TraceCounters* counters = nullptr;
  /// If not null, batches call it between parts, as Progress says; if it throws, any results may be written.
  const Progress* progress = nullptr;
};

struct TracedTree;
struct TreeView;
class TriangleTree;
namespace detail {
template <>
struct QueryTypes<TriangleTree> {
  using Number = float;
  using Hit = raylanes::Hit;
  using Options = TraceOptions;
  using Crossing = raylanes::Crossing;
  using ClosestPoint = raylanes::ClosestPoint;
  using ClosestOptions = ClosestPointOptions;
  using DistanceOptions = SignedDistanceOptions;
  using View = TreeView;
};
}  // namespace detail

/// The queries that Bvh and KdTree share: results do not depend on the kind of tree.
/// With TriangleTest::exact the nearest hit is that of exact arithmetic on the given floats. It does not depend on the
/// tree, ISA path, grade, mode or thread count. If the exact t overflows a float, the ray misses.
/// With TriangleTest::watertight in the grade reproducible that holds too, with two exceptions: rays nearly in the
/// plane of a triangle, and hits whose t times twice the triangle's area, seen along the major axis of the direction,
/// is neither zero nor in [2^-100, 2^120].
class TriangleTree : public SurfaceQueries<TriangleTree>, public PointQueries<TriangleTree> {
 public:
  virtual ~TriangleTree() = default;

  /// Returns calls with one ray by these options, which take less time than closest() and occluded(): see RayCalls.
  /// Throws as closest(ray, options) does.
  RayCalls<TriangleTree> calls(const TraceOptions& options = {}) const&;
  /// Does not compile: the calls would outlive a temporary tree.
  RayCalls<TriangleTree> calls(const TraceOptions& options = {}) const&& = delete;

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

  friend struct TreeAccess;
  const TreeView* ready_ = nullptr;
};

}  // namespace raylanes
