// From a mesh of doubles to its tree: boxes in the frame for the builders of trees of floats, then leaves of doubles.

#include "../../dispatch/bits.hpp"
#include "../builders/mesh_build.hpp"
#include "../doubles/bvh_d_arrays.hpp"
#include "../layout/refit.hpp"
#include "../mesh/valid_mesh.hpp"

namespace raylanes {
namespace {

// Around the triangles that a build takes. Parts are joined in their order, so that zeros keep their signs.
BoxD bounds_of(const VertexViewD& vertices, const IndexView& triangles, int threads) {
  constexpr std::size_t grain = 1 << 14;
  std::vector<BoxD> parts((triangles.count + grain - 1) / grain, empty_double_box);
  in_parallel(parts.size(), 1, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t part = first; part < last; ++part)
      for (std::size_t i = part * grain; i < std::min((part + 1) * grain, triangles.count); ++i) {
        const Index3 t = triangles[i];
        const Double3 a = vertices[t[0]], b = vertices[t[1]], c = vertices[t[2]];
        if (has_equal_corners(a, b, c)) continue;
        extend(parts[part], a), extend(parts[part], b), extend(parts[part], c);
      }
  });
  BoxD bounds = empty_double_box;
  for (const BoxD& part : parts) extend(bounds, part);
  return bounds;
}

// Half the largest extent becomes 1/2 to 1, or less where the largest coordinate would become more than 2^901. First
// that coordinate becomes 1 to 2, so that no extent is flushed.
TreeFrame frame_of(const BoxD& bounds) {
  TreeFrame frame;
  if (!(bounds.lo[0] <= bounds.hi[0])) return frame;
  const int power = -std::max(exponent_of_largest(bounds.lo), exponent_of_largest(bounds.hi));
  Double3 half;
  for (std::size_t k = 0; k < 3; ++k)
    half[k] = 0.5 * times_power(bounds.hi[k], power) - 0.5 * times_power(bounds.lo[k], power);
  frame.power = power + std::min(-1 - exponent_of_largest(half), 900);
  for (std::size_t k = 0; k < 3; ++k)
    frame.centre[k] =
        0.5 * times_power(bounds.lo[k], frame.power) + 0.5 * times_power(bounds.hi[k], frame.power);
  return frame;
}

Box box_in(const TreeFrame& frame, const Double3& a, const Double3& b, const Double3& c) {
  Box box = empty_box;
  for (const Double3* corner : {&a, &b, &c}) {
    const Double3 p = frame.of(*corner);
    extend(box, Float3{rounded_down(p[0]), rounded_down(p[1]), rounded_down(p[2])});
    extend(box, Float3{rounded_up(p[0]), rounded_up(p[1]), rounded_up(p[2])});
  }
  return box;
}

// As TrianglesOfHalves reads them.
LeafLanes<double> lanes_of(BvhDArrays& tree, LeafReference leaf) {
  return {reinterpret_cast<double*>(tree.halves[leaf.block].bytes), lanes_of_leaf(leaf.size)};
}

void fill_leaf(BvhDArrays& tree, LeafReference leaf, std::span<const std::uint32_t> primitives,
               const VertexViewD& vertices, const IndexView& triangles) {
  const LeafLanes<double> lanes = lanes_of(tree, leaf);
  std::memset(static_cast<void*>(lanes.numbers), 0xff, halves_of_leaf(leaf.size) * sizeof(LeafHalf));
  for (std::uint32_t lane = 0; lane < leaf.size; ++lane) {
    const Index3 t = triangles[primitives[lane]];
    lanes.set(lane, vertices[t[0]], vertices[t[1]], vertices[t[2]]);
    lanes.primitives()[lane] = primitives[lane];
  }
}

// References number halves in place of leaves.
void make_leaves(BvhDArrays& tree, const Array<LeafRange>& ranges, std::span<const std::uint32_t> order,
                 const VertexViewD& vertices, const IndexView& triangles, const BuildRun& run) {
  std::vector<std::uint32_t> first_half(ranges.size());
  std::size_t halves = 0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (halves > leaf_block_mask) throw std::length_error("bvh: more than 2^28 halves of leaves");
    first_half[i] = static_cast<std::uint32_t>(halves);
    halves += halves_of_leaf(ranges[i].count);
  }
  tree.halves = Array<LeafHalf>(halves);
  tree.leaves = ranges.size();
  run.memory.hold(tree.halves.bytes());
  const HeldMemory held(run.memory, ranges.bytes() + first_half.size() * sizeof(std::uint32_t));
  constexpr std::size_t grain = 1024;
  in_parallel(ranges.size(), grain, run.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      fill_leaf(tree, {first_half[i], ranges[i].count}, order.subspan(ranges[i].begin, ranges[i].count),
                vertices, triangles);
  });
  each_leaf_reference(tree, [&](TreeReference& reference) {
    const LeafReference leaf = leaf_of(reference);
    reference = tree_reference({first_half[leaf.block], leaf.size});
  });
}

BvhDArrays build_on(const VertexViewD& vertices, const IndexView& triangles, const BuildOptions& options,
                    int threads) {
  BvhBuild build(options, triangles.count, threads);
  require_valid_mesh(vertices, triangles, threads);
  BvhDArrays tree;
  tree.mesh_bounds = bounds_of(vertices, triangles, threads);
  tree.frame = frame_of(tree.mesh_bounds);
  Array<Reference> references = references_of(
      vertices, triangles, build.run, end_of_bvh_boxes,
      [&](const Double3& a, const Double3& b, const Double3& c) { return box_in(tree.frame, a, b, c); });
  constexpr double no_waste = 1.0;  // waste speaks for splits alone, which trees of doubles do not have
  BinaryTree binary = build.binary_tree(std::move(references), no_waste, nullptr);
  NodesOverRanges nodes = collapse_nodes(binary, build.run);
  tree.nodes = std::move(nodes.nodes), tree.root = nodes.root, tree.bounds = nodes.bounds;
  make_leaves(tree, nodes.leaves, binary.order, vertices, triangles, build.run);
  build.finish(tree);
  return tree;
}

}  // namespace

BvhDArrays build_bvh_d(VertexViewD vertices, IndexView triangles, const BuildOptions& options) {
  checked_index("bvh", "builder", options.builder, std::size(builders));
  if (options.builder == TreeBuilder::spatial_splits && !options.choose)
    throw std::invalid_argument(
        "bvh: trees of doubles do not split triangles; the builder is spatial_splits");
  return build_checked("bvh", triangles, options,
                       [&](int threads) { return build_on(vertices, triangles, options, threads); });
}

std::vector<CornersOf<double>> triangles_of(const BvhDArrays& tree) {
  std::vector<CornersOf<double>> triangles(tree.mesh_triangles);
  each_triangle(tree, [&](std::uint32_t primitive, const std::array<Double3, 3>& corners) {
    for (std::size_t k = 0; k < 3; ++k) triangles[primitive].vertex[k] = corners[k];
  });
  return triangles;
}

void refit_bvh_d(BvhDArrays& tree, const VertexViewD& vertices, const IndexView& triangles, int threads) {
  const BoxD bounds = bounds_of(vertices, triangles, threads);
  const TreeFrame frame = frame_of(bounds);
  const auto refill = [&](TreeReference reference) {
    const LeafReference leaf = leaf_of(reference);
    Box box = empty_box;
    lanes_of(tree, leaf)
        .refill(leaf.size, vertices, triangles, [&](const Double3& a, const Double3& b, const Double3& c) {
          extend(box, box_in(frame, a, b, c));
        });
    return box;
  };
  NodeRefitter(tree, refill).refit(threads);
  tree.mesh_bounds = bounds, tree.frame = frame;
  tree.boundary.reset();
}

}  // namespace raylanes
