// A k-d tree: space divided by planes, traversed front to back. docs/kdtree.md compares it with Bvh.
#pragma once

#include <raylanes/bvh.hpp>
#include <raylanes/tree.hpp>

namespace raylanes {

/// How space is divided: hits are the same, build time and trace time are not.
enum class KdBuilder : std::uint8_t {
  /// In the middle of the cell's longest axis, while a cell has more than eight triangles. Triangles across the plane
  /// stay with the node, and each ray that visits it tests them: the textbook form, for comparison.
  midpoint,
  /// At the plane where the surface area heuristic is least among 16 or 32 planes an axis and the sides of the
  /// triangles' boxes.
  /// Triangles across the plane are in both cells, each with the box of its part (Wald, Havran 2006). The default.
  sah
};

/// The names of the builders, by enumerator.
inline constexpr std::array<std::string_view, 2> kd_builder_names{"midpoint", "sah"};

/// How a KdTree is built.
struct KdBuildOptions {
  Progress progress = {};              ///< called with the share of work done
  KdBuilder builder = KdBuilder::sah;  ///< how space is divided
  int threads = 1;                     ///< as in TraceOptions; the tree has the same bytes for any number
};

/// Facts about a KdTree and its build.
struct KdReport {
  KdBuilder builder = KdBuilder::sah;  ///< the builder
  std::size_t nodes = 0;               ///< planes and leaves
  std::size_t leaves = 0;              ///< leaves with triangles
  std::size_t empty_leaves = 0;        ///< leaves without triangles
  std::size_t wide_nodes = 0;          ///< nodes of eight cells, for modes that traverse these
  std::size_t blocks = 0;              ///< blocks of up to eight triangles
  std::size_t triangles = 0;           ///< triangles of the mesh without those that have two equal corners
  std::size_t left_out = 0;            ///< triangles of the mesh that have two equal corners
  std::size_t references = 0;          ///< triangles in leaves
  std::size_t bytes = 0;               ///< the bytes of nodes, wide nodes and blocks
  int depth = 0;                       ///< planes on the longest path from the root to a leaf
  /// The cost expected for a line that meets bounds(), all such lines being equally likely: 1 for a plane,
  /// kd_block_cost for a block. 0 for an empty tree.
  double sah_cost = 0.0;
  double boxes_seconds = 0.0;   ///< wall-clock time to check the mesh and make boxes; 0 for a loaded tree
  double tree_seconds = 0.0;    ///< wall-clock time to divide space
  double layout_seconds = 0.0;  ///< wall-clock time to fill the leaves
  /// The most bytes in the arrays of the build at one time, tree included, without oneTBB's and the allocator's own.
  std::size_t peak_bytes = 0;
};

/// The measured cost of a block of up to eight triangles, in units of a plane's.
inline constexpr double kd_block_cost = 1.5;

/// A k-d tree over triangles; TriangleTree has its queries, which return what a Bvh returns.
/// TraversalMode::single traverses planes with the test exact in the grade reproducible. All other calls, single rays
/// in the mode automatic included, traverse the same cells eight at a time, like the boxes of a Bvh, which is faster.
/// Many threads may query one object at the same time.
/// A default-constructed or moved-from object is the tree of an empty mesh, which nothing hits.
class KdTree : public TriangleTree {
 public:
  KdTree() noexcept;
  /// Builds the tree, with the limits and exceptions of Bvh's constructor.
  /// KdBuilder::sah makes at most one block for three triangles of the mesh, plus one. No leaf has more than
  /// max_kd_depth planes above it.
  KdTree(VertexView vertices, IndexView triangles, const KdBuildOptions& options = {});
  /// Builds the tree of a mesh. Throws as the constructor from views does.
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
  /// memory runs out.
  /// No bytes make a tree that faults. Bytes from a hostile source may, with a right checksum, make a tree that misses
  /// triangles.
  static KdTree load(std::istream& file);

  /// Returns the nodes and leaves. The view is valid until the tree is destroyed or assigned to.
  KdTreeView view() const& noexcept;
  /// Does not compile: the view would outlive a temporary tree.
  KdTreeView view() const&& = delete;

  std::size_t bytes() const noexcept;       ///< the bytes of nodes, wide nodes and blocks
  std::size_t node_count() const noexcept;  ///< the number of planes and leaves
  std::size_t leaf_count() const noexcept;  ///< the number of blocks
  KdReport report() const;                  ///< what the tree is, and what its build took; visits all nodes

 private:
  [[gnu::visibility("hidden")]] explicit KdTree(std::unique_ptr<struct KdTreeArrays> tree) noexcept;
  [[gnu::visibility("hidden")]] TracedTree traced() const noexcept override;

  std::unique_ptr<struct KdTreeArrays> tree_;  // null: the empty tree
};

}  // namespace raylanes
