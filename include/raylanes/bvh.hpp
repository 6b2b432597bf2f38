// A bounding volume hierarchy: build it over a mesh, then query it.
#pragma once

#include <concepts>
#include <cstddef>
#include <iosfwd>
#include <memory>

#include <raylanes/builders.hpp>
#include <raylanes/mesh.hpp>
#include <raylanes/progress.hpp>
#include <raylanes/tree.hpp>
#include <raylanes/triangle_tree.hpp>

namespace raylanes {

/// How a Bvh is built.
struct BuildOptions {
  Progress progress = {};                         ///< called with the share of work done
  TreeBuilder builder = TreeBuilder::binned_sah;  ///< how the tree is divided
  int threads = 1;  ///< as in TraceOptions; the tree has the same bytes for any number
  /// Whether to move subtrees to where they cost less (Bittner, Hapala, Havran 2013; Meister, Bittner 2018): for trees
  /// that trace many rays. Takes up to as long as binned_sah, often half of that.
  bool optimize = false;
  /// Whether to choose `builder` by the mesh and by `rays`. The choice is the same on every machine and for any number
  /// of threads. TreeReport::choice says what was chosen and why.
  bool choose = false;
  double rays = 0;  ///< with `choose`: about how many rays the tree will trace; 0 or NaN: many
};

/// A bounding volume hierarchy over triangles; TriangleTree has its queries.
/// Many threads may query one object at the same time, but not during refit().
/// A default-constructed or moved-from object is the tree of an empty mesh, which nothing hits.
class Bvh : public TriangleTree {
 public:
  Bvh() noexcept;
  /// Builds the tree: a binary tree by options.builder, collapsed to eight children a node at the least expected cost
  /// (Ylitie, Karras, Laine 2017).
  /// The tree copies the triangles, and keeps nothing of the views. Triangles with two equal corners are left out:
  /// nothing hits them.
  /// Throws std::invalid_argument if validate_mesh() refuses the mesh, it has more than 2^28 triangles, the builder
  /// does not exist, or the thread count is negative. Throws std::length_error if split triangles make more nodes or
  /// leaves than can be numbered.
  Bvh(VertexView vertices, IndexView triangles, const BuildOptions& options = {});
  /// Does not compile: BvhD is the tree over vertices of doubles.
  template <detail::VerticesOfDoubles Doubles>
  Bvh(const Doubles&, IndexView, const BuildOptions& = {}) = delete;  // vertices of doubles: use BvhD
  /// Builds the tree of a mesh. Throws as the constructor from views does.
  explicit Bvh(const Mesh& mesh, const BuildOptions& options = {});
  ~Bvh() override;
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;

  /// Makes this the tree of another mesh with as many triangles, such as the same mesh in motion, far faster than a
  /// build: nodes keep their triangles, and get new boxes.
  /// All queries, also bounds(), then return what a tree built over the new mesh returns. Triangles that have two equal
  /// corners now are left out; a later refit brings them back. If a triangle comes back that the last build left out,
  /// refit() builds the tree again. Boxes hold whole triangles, so the gain of spatial splits is lost. The indices may
  /// differ from the build's.
  /// `threads` is as in TraceOptions. Throws std::invalid_argument if validate_mesh() refuses the mesh, the number of
  /// triangles differs, or the thread count is negative. Strong exception guarantee: if this throws, the tree is
  /// unchanged.
  void refit(VertexView vertices, IndexView triangles, int threads = 1);
  /// Returns the tree that refit() would make of this one, which stays as it is: for threads that query it meanwhile.
  /// Takes the time of refit() and of a copy of bytes(). Throws as refit() does.
  Bvh refitted(VertexView vertices, IndexView triangles, int threads = 1) const;

  /// Returns the cost of the tree by the surface area heuristic: the node visits, with a leaf as 0.9 of one, expected
  /// for a line that meets bounds(), all such lines being equally likely. 0 for an empty tree.
  /// Takes about a tenth of the time of refit().
  double sah_cost() const noexcept;
  /// Returns sah_cost() divided by that after the last build: 1.5 if tracing is expected to take 1.5× as long now.
  /// 1 after a build and for an empty tree; may be less than 1. docs/motion.md says when to build again.
  double decay() const noexcept;

  /// Writes the tree as bytes, from which load() makes a tree that gives the same bytes for any ray, on any machine.
  /// docs/tree_file.md has the format. A stream may hold other data before and behind the tree.
  /// Throws std::runtime_error if the stream does not take it.
  void save(std::ostream& file) const;
  /// Returns the tree that save() wrote; reads no byte behind it.
  /// Throws std::runtime_error, with one line, if the bytes are no such tree, cut or damaged, and std::bad_alloc if
  /// memory runs out.
  /// No bytes make a tree that faults. Bytes from a hostile source may, with a right checksum, make a tree that misses
  /// triangles.
  static Bvh load(std::istream& file);

  /// Returns the nodes and leaves. The view is valid until the tree is destroyed, assigned to, or built again by
  /// refit(). It shows what a refit changes, and survives a move.
  BvhView view() const& noexcept;
  /// Does not compile: the view would outlive a temporary tree.
  BvhView view() const&& = delete;

  std::size_t bytes() const noexcept;       ///< the bytes of nodes and leaves
  std::size_t node_count() const noexcept;  ///< the number of inner nodes
  std::size_t leaf_count() const noexcept;  ///< the number of leaves
  TreeReport report() const;                ///< what the tree is, and what its build took; visits all nodes

 private:
  friend struct TreeAccess;
  [[gnu::visibility("hidden")]] explicit Bvh(std::unique_ptr<struct BvhArrays> tree) noexcept;
  [[gnu::visibility("hidden")]] void make_ready() noexcept;
  [[gnu::visibility("hidden")]] bool must_build(VertexView vertices, IndexView triangles, int threads) const;
  [[gnu::visibility("hidden")]] Bvh built_again(VertexView vertices, IndexView triangles, int threads) const;
  [[gnu::visibility("hidden")]] TracedTree traced() const noexcept override;

  std::unique_ptr<struct BvhArrays> tree_;  // null: the empty tree
};

class BvhD;
namespace detail {
template <class Tree>
concept TreeOfDoubles = std::same_as<Tree, BvhD> || std::same_as<Tree, std::shared_ptr<BvhD>> ||
    std::same_as<Tree, std::shared_ptr<const BvhD>>;
}  // namespace detail

}  // namespace raylanes
