// The other tree: space divided by planes, front to back. docs/kdtree.md says when to prefer which.
#pragma once

#include <raylanes/bvh.hpp>
#include <raylanes/kd_nodes.hpp>

namespace raylanes {

// How space is divided. The hits are the same; the time to build and to trace is not.
//   midpoint  in the middle of the cell's longest axis, while a cell has more than eight triangles; those that lie
//             across stay with the node. As textbooks have it, for comparison: each ray tests what its nodes keep
//   sah       where the surface area heuristic is least among 16 or 32 planes an axis, and the sides of what is in the
//             cell; triangles across are in both cells, each with the box of its part (Wald, Havran 2006)
enum class KdBuilder : std::uint8_t { midpoint, sah };

inline constexpr std::array<std::string_view, 2> kd_builder_names{"midpoint", "sah"};

struct KdBuildOptions {
  TriangleTest test = TriangleTest::exact;  // as of BuildOptions, and so are the following
  Progress progress = {};
  KdBuilder builder = KdBuilder::sah;
  int threads = 1;  // the tree is the same, byte for byte
};

// What a tree is, and what its build took.
struct KdReport {
  KdBuilder builder = KdBuilder::sah;
  std::size_t nodes = 0;   // planes and leaves
  std::size_t leaves = 0;  // those with triangles
  std::size_t empty_leaves = 0;
  std::size_t wide_nodes = 0;  // nodes of eight cells, for modes that walk those
  std::size_t blocks = 0;      // of up to eight triangles
  std::size_t triangles = 0;   // of the mesh, but those with two equal corners
  std::size_t references = 0;  // triangles in leaves
  std::size_t bytes = 0;       // of nodes, wide_nodes and blocks
  int depth = 0;               // planes on the longest path from the root to a leaf
  // What a line that meets bounds() is expected to pay, all such being equally likely: 1 for a plane, kd_block_cost for
  // a block. 0 for an empty tree.
  double sah_cost = 0.0;
  // Wall-clock time: to check the mesh and make boxes, to divide space, to fill the leaves; bytes as of TreeReport.
  double boxes_seconds = 0.0, tree_seconds = 0.0, layout_seconds = 0.0;
  std::size_t peak_bytes = 0;
};

// What up to eight triangles cost beside a plane, as measured.
inline constexpr double kd_block_cost = 1.5;

// A k-d tree over triangles; TriangleTree says what it is asked, and the hits are those of a Bvh: with the exact
// test for any ray, with others in the reproducible grade as far as those do not depend on the tree. The mode single
// walks planes with the tests exact, watertight and moller_trumbore in the reproducible grade; all else, calls of the
// automatic mode with one ray included, walks the same cells eight at a time, as the boxes of a BVH: faster. One object
// may be traced from many threads at a time.
class KdTree : public TriangleTree {
 public:
  KdTree() noexcept;
  // As that of Bvh, with the same limits and exceptions. Leaves by sah have no more than a block for three
  // triangles of the mesh, and one; no leaf has more than max_kd_depth planes above it.
  KdTree(VertexView vertices, IndexView triangles, const KdBuildOptions& options = {});
  explicit KdTree(const Mesh& mesh, const KdBuildOptions& options = {});
  ~KdTree() override;
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;

  /// Writes the tree as bytes, from which load() makes a tree that gives the same bytes for any ray, on any machine.
  /// docs/tree_file.md has the format, which is not a Bvh's. A stream may hold other data before and behind the tree.
  /// Throws std::runtime_error if the stream does not take it.
  void save(std::ostream& file) const;
  /// Returns the tree that save() wrote; reads no byte behind it.
  /// Throws std::runtime_error, with one line, if the bytes are no such tree, cut or damaged, and std::bad_alloc if
  /// memory runs out. Throws std::invalid_argument if the tree was built for a test that reads numbers of its own and
  /// RAYLANES_PATH names no path of this machine.
  /// No bytes make a tree that faults. Bytes from a hostile source may, with a right checksum, make a tree that misses
  /// triangles.
  static KdTree load(std::istream& file);

  // Valid until the tree dies or is assigned to.
  KdTreeView view() const noexcept;

  std::size_t bytes() const noexcept;  // of nodes, wide_nodes and blocks
  std::size_t node_count() const noexcept;
  std::size_t leaf_count() const noexcept;  // blocks
  KdReport report() const;                  // visits all nodes

 private:
  [[gnu::visibility("hidden")]] explicit KdTree(std::unique_ptr<struct CellTree> tree) noexcept;
  [[gnu::visibility("hidden")]] TracedTree traced() const noexcept override;

  std::unique_ptr<struct CellTree> tree_;  // null: the empty tree
};

}  // namespace raylanes
