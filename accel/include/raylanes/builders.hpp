// Which trees there are, and what is known of one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace raylanes {

// How a tree is built. The hits are the same; the time to build and to trace are not.
//   median           primitives sorted by the centres of their boxes along the longest axis, halved at the middle of
//                    the list
//   equal_partition  the volume halved at the middle of the longest axis; where that separates nothing, the list
//   binned_sah       the split with the least Σ count·area of 16 bins along each axis (Wald 2007)
//   sweep_sah        the same of all planes between neighbouring centres (MacDonald, Booth 1990)
//   spatial_splits   binned_sah, and triangles that lie across a split in both parts where that is cheaper (Stich,
//                    Friedrich, Dietrich 2009): up to a quarter more references than there are triangles. For scenes
//                    of long triangles and for many rays
//   morton           sorted along a space-filling curve, split where its bits change (Lauterbach, Garland, Sengupta,
//                    Luebke, Manocha 2009): built fastest, traced slower than those by SAH
enum class TreeBuilder : std::uint8_t {
  median,
  equal_partition,
  binned_sah,
  sweep_sah,
  spatial_splits,
  morton
};

inline constexpr std::array<std::string_view, 6> tree_builder_names{
    "median", "equal_partition", "binned_sah", "sweep_sah", "spatial_splits", "morton"};

// What a tree is, and what its build took.
struct TreeReport {
  TreeBuilder builder = TreeBuilder::binned_sah;
  bool optimized = false;
  std::size_t nodes = 0;       // of eight children
  std::size_t leaves = 0;      // blocks of up to eight triangles
  std::size_t triangles = 0;   // of the mesh, but those with two equal corners
  std::size_t references = 0;  // triangles in leaves: more where the builder splits
  std::size_t bytes = 0;       // of nodes and leaves
  int depth = 0;               // nodes on the longest path from the root to a leaf

  double sah_cost = 0.0;  // as of Bvh::sah_cost()
  // Areas of the intersections of each two children's boxes, by that of their node's: the mean over the nodes, weighted
  // with their areas. 0 if no boxes overlap.
  double overlap = 0.0;

  // Wall-clock time: to check the mesh and make boxes, to build the binary tree, to optimize it where that is asked
  // for, and to lay it out in nodes and leaves. 0, as the bytes below, of a tree from a file.
  double boxes_seconds = 0.0, tree_seconds = 0.0, optimize_seconds = 0.0, layout_seconds = 0.0;
  // The most bytes that the build had in its arrays at a time, the tree included; not what oneTBB and the allocator
  // take.
  std::size_t peak_bytes = 0;

  std::string choice;  // of BuildOptions::choose: what was taken and why, a line; else empty
};

}  // namespace raylanes
