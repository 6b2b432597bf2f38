// The door for most users: build a tree over a mesh, trace batches of rays through it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include <raylanes/mesh.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/triangles.hpp>

namespace raylanes {

// Called now and then with the share of work done, 0 … 1. May throw to give up.
using Progress = std::function<void(double)>;

// How the rays of a batch share the lanes: one ray against eight boxes or triangles at a time, or a
// register's worth of consecutive rays against one (better if neighbours in the batch are neighbours in
// space). The hits are the same.
enum class TraversalMode : std::uint8_t { single, packet };
inline constexpr std::array<std::string_view, 2> traversal_mode_names{"single", "packet"};

struct TraceOptions {
  TriangleTest test = TriangleTest::watertight;
  Grade grade = Grade::reproducible;
  TraversalMode mode = TraversalMode::single;
  const Path* path = nullptr;  // null: the active path
  int threads = 1;             // 1: the caller's alone; 0, or more than there are cores: one per core
};

// A bounding volume hierarchy over triangles. Immutable once built; one object may be traced from many
// threads. Moved from, it is the tree of an empty mesh.
class Bvh {
 public:
  // Binned SAH (Wald 2007), collapsed to eight children a node. The tree copies what it needs of the mesh.
  // Throws std::invalid_argument for an index out of range or a coordinate that is not finite (see
  // validate_mesh), or more than 2^28 triangles. An empty mesh gives a tree that nothing hits.
  Bvh(std::span<const Float3> vertices, std::span<const Index3> triangles, const Progress& progress = {});
  ~Bvh();
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;

  // hits[i] = the nearest hit of rays[i]; see Ray and Hit. The t of a hit is finite. Throws
  // std::invalid_argument if the spans differ in length, a thread count is negative, an option is no enumerator
  // of its type, or the path is not supported here.
  void closest(std::span<const Ray> rays, std::span<Hit> hits, const TraceOptions& options = {}) const;

  // occluded[i] = 1 if anything lies within rays[i], else 0. Throws as `closest`.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded,
                const TraceOptions& options = {}) const;

  std::size_t bytes() const noexcept;  // of nodes and leaves
  std::size_t node_count() const noexcept;
  std::size_t leaf_count() const noexcept;

 private:
  std::unique_ptr<struct WideTree> tree_;
};

}  // namespace raylanes
