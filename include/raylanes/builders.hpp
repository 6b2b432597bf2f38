// Builders of bounding volume hierarchies, and reports of trees.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace raylanes {

/// How a tree is built: hits are the same, build time and trace time are not.
enum class TreeBuilder : std::uint8_t {
  /// Primitives sorted by the centres of their boxes along the longest axis; the list is halved.
  median,
  /// The box is halved along its longest axis; if that separates nothing, the list is halved.
  equal_partition,
  /// The split with the least Σ count·area among 16 bins along each axis (Wald 2007). The default.
  binned_sah,
  /// The split with the least Σ count·area among all planes between neighbouring centres (MacDonald, Booth 1990).
  sweep_sah,
  /// binned_sah, with triangles across a split in both parts if that is cheaper (Stich, Friedrich, Dietrich 2009): up
  /// to a quarter more references than triangles. For scenes with long triangles, and many rays.
  spatial_splits,
  /// Sorted along a space-filling curve, split where its bits change (Lauterbach, Garland, Sengupta, Luebke, Manocha
  /// 2009). The fastest to build; traces slower than the others by surface area.
  morton
};

/// The names of the builders, by enumerator.
inline constexpr std::array<std::string_view, 6> tree_builder_names{
    "median", "equal_partition", "binned_sah", "sweep_sah", "spatial_splits", "morton"};

/// Facts about a tree and its build.
struct TreeReport {
  TreeBuilder builder = TreeBuilder::binned_sah;  ///< the builder
  bool optimized = false;                         ///< whether subtrees were moved to where they cost less
  std::size_t nodes = 0;                          ///< inner nodes, of up to eight children
  std::size_t leaves = 0;                         ///< blocks of up to eight triangles
  std::size_t triangles = 0;  ///< triangles of the mesh without those that have two equal corners
  std::size_t left_out =
      0;  ///< triangles that have no leaf, because two corners were equal at the last build
  std::size_t references = 0;  ///< triangles in leaves: more than `triangles` if the builder splits
  std::size_t bytes = 0;       ///< the bytes of nodes and leaves
  int depth = 0;               ///< inner nodes on the longest path from the root to a leaf

  double sah_cost = 0.0;  ///< Bvh::sah_cost()
  /// The areas of the intersections of each two children's boxes divided by their node's area: the mean over the nodes,
  /// weighted by area. 0 if no boxes overlap.
  double overlap = 0.0;

  double boxes_seconds = 0.0;     ///< wall-clock time to check the mesh and make boxes; 0 for a loaded tree
  double tree_seconds = 0.0;      ///< wall-clock time to build the binary tree
  double optimize_seconds = 0.0;  ///< wall-clock time to move subtrees
  double layout_seconds = 0.0;    ///< wall-clock time to lay out nodes and leaves
  /// The most bytes in the arrays of the build at one time, tree included, without oneTBB's and the allocator's own.
  std::size_t peak_bytes = 0;

  std::string choice;  ///< of BuildOptions::choose: what was chosen and why, one line; else empty
};

}  // namespace raylanes
