// The door for most users: build a tree over a mesh, trace rays through it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include <raylanes/mesh.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/rays.hpp>
#include <raylanes/traversal.hpp>
#include <raylanes/trees.hpp>
#include <raylanes/triangles.hpp>

namespace raylanes {

// Called now and then with the share of work done: 0 at first, 1 at last, never less than before. What it throws gives
// up the work and passes through. Of several threads one calls at a time, any of them.
using Progress = std::function<void(double)>;

struct BuildOptions {
  // A test that the tree is to serve besides those that read corners, which any tree serves. One that reads other
  // numbers gets leaves of its own, beside those with corners.
  TriangleTest test = TriangleTest::exact;
  Progress progress = {};
  Float3 direction{};  // of all rays to come; only the test directional looks at it
  TreeBuilder builder = TreeBuilder::binned_sah;
  int threads = 1;  // as of TraceOptions; the tree is the same, byte for byte
};

struct TraceOptions {
  TriangleTest test = TriangleTest::exact;
  Grade grade = Grade::reproducible;
  TraversalMode mode = TraversalMode::automatic;
  const Path* path = nullptr;  // null: the active path
  int threads = 1;  // 1: the caller's alone; n: n, at most one per core; 0: those of the caller's arena
  LaneBits active = nullptr;  // of a batch: bit i: ray i takes part; null: all
};

// A bounding volume hierarchy over triangles. Immutable once built; one object may be traced from many threads.
// Default-constructed or moved from, it is the tree of an empty mesh, which nothing hits.
class Bvh {
 public:
  Bvh() noexcept;
  // A binary tree by the builder, collapsed to eight children a node at the least expected cost (Ylitie, Karras, Laine
  // 2017). The tree keeps nothing of the views: it has its own copy of each triangle but those with two equal corners,
  // which nothing hits. Throws std::invalid_argument for a mesh that validate_mesh refuses, more than 2^28 triangles, a
  // test or builder that does not exist, or a negative thread count.
  Bvh(VertexView vertices, IndexView triangles, const BuildOptions& options = {});
  explicit Bvh(const Mesh& mesh, const BuildOptions& options = {});
  ~Bvh();
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;

  // The nearest hit of a ray, of equal t the smallest primitive; see Ray and Hit. A hit's t is finite: where t
  // overflows it is a miss. With the exact test the result is that of exact arithmetic over all triangles: tree, path,
  // grade, mode and threads cannot change it. With the watertight one in the reproducible grade they do not either, but
  // for rays nearly in the plane of a triangle, whose decisions are rounding errors, and where the test's own numbers
  // overflow or underflow: the product of t and twice the area of a triangle that is hit, seen along the major axis of
  // the direction, must be in [2^-100, 2^120] or zero. Throws std::invalid_argument if an option is no enumerator of
  // its type, the thread count is negative, the path is not supported here, or the tree was not built for the test.
  Hit closest(const Ray& ray, const TraceOptions& options = {}) const;
  // Whether anything lies within the ray's segment.
  bool occluded(const Ray& ray, const TraceOptions& options = {}) const;

  // The same for many rays, as records or as arrays; mode and threads are for these. hits[i] belongs to rays[i],
  // occluded[i] is 1 or 0; answers of rays that do not take part are left alone. Rays and answers do not overlap. Each
  // thread keeps up to 20 MB for it, 30 MB where rays or hits do not lie as spans of them do. Throws also if there are
  // not as many answers as rays, hits overlap, or a view of something points to nothing. A batch with an exception has
  // written nothing.
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

  Box bounds() const noexcept;  // of the triangles it has; lo = +infinity, hi = −infinity if there are none
  std::size_t bytes() const noexcept;  // of nodes and leaves
  std::size_t node_count() const noexcept;
  std::size_t leaf_count() const noexcept;
  TreeReport report() const;  // visits all nodes

 private:
  std::unique_ptr<struct WideTree> tree_;  // null: the empty tree
};

}  // namespace raylanes
