// From a mesh of doubles to its tree: boxes in the frame for the builders of trees of floats, then leaves of doubles.
#include <algorithm>
#include <bit>
#include <cstring>

#include "../../dispatch/bits.hpp"
#include "../../dispatch/checked.hpp"
#include "../builders/builder_table.hpp"
#include "../builders/choice.hpp"
#include "../builders/mesh_references.hpp"
#include "../builders/reinsertion.hpp"
#include "../layout/wide_tree.hpp"
#include "double_tree.hpp"

namespace raylanes {
namespace {

constexpr double end_of_boxes = 0.1, end_of_tree = 0.7, end_of_layout = 0.999;

// Around the triangles that have a leaf.
BoxD bounds_of(const VertexViewD& vertices, const IndexView& triangles) {
  BoxD bounds = empty_double_box;
  for (std::size_t i = 0; i < triangles.count; ++i) {
    const Index3 t = triangles[i];
    const Double3 a = vertices[t[0]], b = vertices[t[1]], c = vertices[t[2]];
    if (has_equal_corners(a, b, c)) continue;
    extend(bounds, a), extend(bounds, b), extend(bounds, c);
  }
  return bounds;
}

// Half the largest extent becomes 1/2 to 1. First the largest coordinate becomes 1 to 2, so that no extent is flushed.
TreeFrame frame_of(const BoxD& bounds) {
  TreeFrame frame;
  if (!(bounds.lo[0] <= bounds.hi[0])) return frame;
  const int power = -std::max(exponent_of_largest(bounds.lo), exponent_of_largest(bounds.hi));
  Double3 half;
  for (std::size_t k = 0; k < 3; ++k)
    half[k] = 0.5 * times_power(bounds.hi[k], power) - 0.5 * times_power(bounds.lo[k], power);
  frame.power = power - 1 - exponent_of_largest(half);
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

// The memory of a leaf, as DoubleTriangles reads it.
struct LeafMemory {
  double* numbers;
  std::uint32_t lanes;

  LeafMemory(DoubleTree& tree, LeafReference leaf)
      : numbers(reinterpret_cast<double*>(tree.halves[leaf.block].bytes)), lanes(lanes_of_leaf(leaf.size)) {}
  std::uint32_t* primitives() const { return reinterpret_cast<std::uint32_t*>(numbers + 9 * lanes); }
  void set(std::uint32_t lane, const VertexViewD& vertices, const Index3& t) const {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Double3 p = vertices[t[corner]];
      for (std::size_t axis = 0; axis < 3; ++axis) numbers[(3 * corner + axis) * lanes + lane] = p[axis];
    }
  }
};

void fill_leaf(DoubleTree& tree, LeafReference leaf, std::span<const std::uint32_t> primitives,
               const VertexViewD& vertices, const IndexView& triangles) {
  const LeafMemory memory(tree, leaf);
  std::memset(static_cast<void*>(memory.numbers), 0xff, halves_of_leaf(leaf.size) * sizeof(LeafHalf));
  for (std::uint32_t lane = 0; lane < leaf.size; ++lane) {
    memory.set(lane, vertices, triangles[primitives[lane]]);
    memory.primitives()[lane] = primitives[lane];
  }
}

// References number halves in place of leaves.
void make_leaves(DoubleTree& tree, const Array<LeafRange>& ranges, std::span<const std::uint32_t> order,
                 const VertexViewD& vertices, const IndexView& triangles) {
  std::vector<std::uint32_t> first_half(ranges.size());
  std::size_t halves = 0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (halves > leaf_block_mask) throw std::length_error("bvh: more than 2^28 halves of leaves");
    first_half[i] = static_cast<std::uint32_t>(halves);
    halves += halves_of_leaf(ranges[i].count);
  }
  tree.halves = Array<LeafHalf>(halves);
  tree.leaves = ranges.size();
  for (std::size_t i = 0; i < ranges.size(); ++i)
    fill_leaf(tree, {first_half[i], ranges[i].count}, order.subspan(ranges[i].begin, ranges[i].count),
              vertices, triangles);
  const auto renumber = [&](TreeReference& reference) {
    if (reference == empty_reference || !refers_to_leaf(reference)) return;
    const LeafReference leaf = leaf_of(reference);
    reference = tree_reference({first_half[leaf.block], leaf.size});
  };
  renumber(tree.root);
  for (WideNode& node : tree.nodes)
    for (TreeReference& child : node.child) renumber(child);
}

BinaryTree binary_tree(Array<Reference> references, const BuildOptions& options, const BuildRun& run) {
  const BuilderInfo& builder = builders[static_cast<std::size_t>(options.builder)];
  BinaryTree binary = builder.build({std::move(references), nullptr, run});
  return options.optimize ? reinserted(std::move(binary), run) : std::move(binary);
}

DoubleTree build_on(const VertexViewD& vertices, const IndexView& triangles, BuildOptions options,
                    int threads) {
  ProgressMeter progress(options.progress);
  MemoryMeter memory;
  const BuildRun run{threads, progress, memory};
  progress.advance(0.0);
  progress.begin_phase(end_of_boxes);
  DoubleTree tree;
  tree.bounds = bounds_of(vertices, triangles);
  tree.frame = frame_of(tree.bounds);
  Array<Reference> references = references_of(
      vertices, triangles, run, end_of_boxes,
      [&](const Double3& a, const Double3& b, const Double3& c) { return box_in(tree.frame, a, b, c); });
  tree.left_out = left_out_of(triangles.count, references);
  if (options.choose) {
    constexpr double no_waste = 1.0;  // waste speaks for splits alone, which trees of doubles do not have
    const TreeChoice choice = choose_tree(references.size(), no_waste, options.rays);
    options.builder = choice.builder, options.optimize = choice.optimize, options.choose = false;
  }
  progress.finish_phase();
  progress.begin_phase(end_of_tree);
  const BinaryTree binary = binary_tree(std::move(references), options, run);
  progress.finish_phase();
  progress.begin_phase(end_of_layout);
  NodesOverRanges nodes = collapse_nodes(binary, run);
  tree.nodes = std::move(nodes.nodes), tree.root = nodes.root, tree.frame_bounds = nodes.bounds;
  make_leaves(tree, nodes.leaves, binary.order, vertices, triangles);
  tree.mesh_triangles = triangles.count;
  tree.built_with = options;
  tree.built_with.progress = {};
  progress.begin_phase(1.0);
  progress.finish_phase();
  return tree;
}

}  // namespace

DoubleTree build_double_tree(VertexViewD vertices, IndexView triangles, const BuildOptions& options) {
  checked_index("bvh", "builder", options.builder, std::size(builders));
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument("bvh: trees of doubles serve the test exact alone");
  if (options.builder == TreeBuilder::spatial_splits && !options.choose)
    throw std::invalid_argument(
        "bvh: trees of doubles do not split triangles; the builder is spatial_splits");
  require_threads("bvh", options.threads);
  require_triangle_count("bvh", triangles.count);
  validate_mesh(vertices, triangles);
  DoubleTree tree;
  on_threads(options.threads, [&](int threads) { tree = build_on(vertices, triangles, options, threads); });
  return tree;
}

void refit_double_tree(DoubleTree& tree, const VertexViewD& vertices, const IndexView& triangles) {
  tree.bounds = bounds_of(vertices, triangles);
  tree.frame = frame_of(tree.bounds);
  const auto refill = [&](TreeReference reference) {
    const LeafReference leaf = leaf_of(reference);
    const LeafMemory memory(tree, leaf);
    Box box = empty_box;
    for (std::uint32_t lane = 0; lane < leaf.size; ++lane) {
      const Index3 t = triangles[memory.primitives()[lane]];
      memory.set(lane, vertices, t);
      extend(box, box_in(tree.frame, vertices[t[0]], vertices[t[1]], vertices[t[2]]));
    }
    return box;
  };
  const auto box_of = [&](const WideNode& node) {
    Box box = empty_box;
    for (std::uint32_t left = node.occupied; left != 0; left &= left - 1) {
      const auto slot = static_cast<std::size_t>(std::countr_zero(left));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::min(box.lo[axis], node.lo[axis][slot]);
        box.hi[axis] = std::max(box.hi[axis], node.hi[axis][slot]);
      }
    }
    return box;
  };
  if (tree.root == empty_reference) return;
  if (refers_to_leaf(tree.root)) {
    tree.frame_bounds = refill(tree.root);
    return;
  }
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    WideNode& node = tree.nodes[i];
    for (std::uint32_t left = node.occupied; left != 0; left &= left - 1) {
      const auto slot = static_cast<std::size_t>(std::countr_zero(left));
      const TreeReference child = node.child[slot];
      const Box box = refers_to_leaf(child) ? refill(child) : box_of(tree.nodes[child]);
      for (std::size_t axis = 0; axis < 3; ++axis)
        node.lo[axis][slot] = box.lo[axis], node.hi[axis][slot] = box.hi[axis];
    }
  }
  tree.frame_bounds = box_of(tree.nodes[0]);
}

}  // namespace raylanes
