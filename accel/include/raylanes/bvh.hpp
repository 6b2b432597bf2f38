// What most users want: build a tree over a mesh, trace rays through it.
#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <memory>

#include <raylanes/builders.hpp>
#include <raylanes/mesh.hpp>
#include <raylanes/tree.hpp>
#include <raylanes/triangle_tree.hpp>

namespace raylanes {

// Called now and then with the share of work done: 0 at first, 1 at last, never less than before. What it throws gives
// up the work and passes through. Of several threads one calls at a time, any of them.
using Progress = std::function<void(double)>;

struct BuildOptions {
  // A test that the tree is to serve besides those that read corners, which any tree serves. One that reads other
  // numbers gets leaves of its own, beside those with corners. `directional` serves arrays alone.
  TriangleTest test = TriangleTest::exact;
  Progress progress = {};
  TreeBuilder builder = TreeBuilder::binned_sah;
  int threads = 1;  // as of TraceOptions; the tree is the same, byte for byte
  // Whether parts of what the builder made are moved to where they cost less (Bittner, Hapala, Havran 2013; Meister,
  // Bittner 2018): for trees that many rays are traced through. Takes up to as long as binned_sah, often half of that.
  bool optimize = false;
  // Instead of `builder` and `optimize` as given: those that suit the mesh and the number of rays to come, the same on
  // every machine and for any number of threads. TreeReport::choice says what was taken and why.
  bool choose = false;
  double rays = 0;  // with `choose`: how many the tree will be traced with, about; 0 or NaN: many
};

// A bounding volume hierarchy over triangles; TriangleTree says what it is asked. One object may be traced from many
// threads at a time, but not while it is refitted.
// Default-constructed or moved from, it is the tree of an empty mesh, which nothing hits.
class Bvh : public TriangleTree {
 public:
  Bvh() noexcept;
  // A binary tree by the builder, collapsed to eight children a node at the least expected cost (Ylitie, Karras, Laine
  // 2017). The tree keeps nothing of the views: it has its own copy of each triangle but those with two equal corners,
  // which nothing hits. Throws std::invalid_argument for a mesh that validate_mesh refuses, more than 2^28 triangles, a
  // test that does not serve trees, a builder that does not exist, or a negative thread count; std::length_error where
  // parts of split triangles make more nodes or leaves than can be numbered.
  Bvh(VertexView vertices, IndexView triangles, const BuildOptions& options = {});
  explicit Bvh(const Mesh& mesh, const BuildOptions& options = {});
  ~Bvh() override;
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;

  // Makes this the tree of another mesh with as many triangles, as of the same one in motion, far faster than a build:
  // nodes keep their triangles, numbers and boxes are written anew in place. All queries then answer as those of a tree
  // built over that mesh would, with what BuildOptions said. Boxes hold whole triangles then: what spatial splits
  // gained is lost. The tree remembers no indices, and different ones will do. Where a triangle that the build left out
  // for equal corners has three different ones, a build is what it becomes; one with a leaf keeps that, whatever
  // happens to it. `threads` as in TraceOptions. Throws std::invalid_argument for a mesh that validate_mesh refuses,
  // another number of triangles, or a negative number of threads. Whoever catches an exception has the tree of before.
  void refit(VertexView vertices, IndexView triangles, int threads = 1);

  // What a tree costs by the surface area heuristic: node visits, and leaves in that unit (0.9 each), that a line is
  // expected to need which meets bounds(), all such being equally likely. 0 for an empty tree. Takes about a
  // tenth of a refit's time.
  double sah_cost() const noexcept;
  // sah_cost() by that of the last build: 1 after a build, 1.5 if tracing is expected to take one and a half times as
  // long by now. May be less than 1, as where the mesh now fills its box less. See docs/motion.md for when to build
  // anew. 1 for an empty tree.
  double decay() const noexcept;

  // The tree as bytes, which load() makes into a tree that gives the same bytes for any ray, on any machine; the mesh
  // is not needed again. docs/tree_file.md has the format. A stream may hold other things before and behind a tree.
  // Throws std::runtime_error if the stream does not take it.
  void save(std::ostream& file) const;
  // Throws std::runtime_error with one line for what is no such tree, was cut or damaged; std::bad_alloc if memory runs
  // out; std::invalid_argument, as active_path() does, if the tree needs numbers of its own for a test and the variable
  // RAYLANES_PATH names no path of this machine. No bytes whatsoever make a
  // tree that faults; from a hostile origin they may, with a right checksum, make one that misses what is there to hit.
  static Bvh load(std::istream& file);

  // The nodes and leaves themselves. Valid until the tree dies, is assigned to, or becomes a build by refit(); another
  // refit is seen through it, a move leaves it valid.
  BvhView view() const noexcept;

  std::size_t bytes() const noexcept;  // of nodes and leaves
  std::size_t node_count() const noexcept;
  std::size_t leaf_count() const noexcept;
  TreeReport report() const;  // visits all nodes

 private:
  friend struct TreeOf;
  [[gnu::visibility("hidden")]] explicit Bvh(std::unique_ptr<struct WideTree> tree) noexcept;
  [[gnu::visibility("hidden")]] void make_ready() noexcept;
  [[gnu::visibility("hidden")]] TracedTree traced() const noexcept override;

  std::unique_ptr<struct WideTree> tree_;  // null: the empty tree
};

}  // namespace raylanes
