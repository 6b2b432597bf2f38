#include "bounded_tree_arrays.hpp"

#include "../../dispatch/checked.hpp"
#include "../builders/builder_table.hpp"
#include "../layout/bvh_arrays.hpp"

namespace raylanes {
namespace {

Array<Reference> references_of(std::span<const Box> boxes) {
  Array<Reference> references(boxes.size());
  std::size_t size = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (is_visited(boxes[i]))
      references[size++] = Reference::make(four_box(boxes[i]), static_cast<std::uint32_t>(i));
  references.shorten(size);
  return references;
}

// Leaves of a tree over boxes, from ranges of a list: those that hold too many become nodes.
class LeafMaker {
 public:
  LeafMaker(BoundedTreeArrays& tree, std::span<const LeafRange> ranges, std::span<const Box> boxes,
            std::uint32_t most)
      : tree_(tree), ranges_(ranges), boxes_(boxes), max_(most) {}

  TreeReference remade(TreeReference reference) {
    if (reference == empty_reference || !refers_to_leaf(reference)) return reference;
    const LeafRange range = ranges_[leaf_of(reference).block];
    std::uint32_t* const first = tree_.order.data() + range.begin;
    if (range.count <= max_) {
      std::sort(first, first + range.count);
      return leaf(range.begin, range.count);
    }
    WideNode node = empty_node();
    for (std::uint32_t begin = 0, slot = 0; begin < range.count; begin += max_, ++slot) {
      const std::uint32_t count = std::min(max_, range.count - begin);
      std::sort(first + begin, first + begin + count);
      Box box = empty_box;
      for (std::uint32_t i = begin; i < begin + count; ++i) extend(box, boxes_[first[i]]);
      for (std::size_t axis = 0; axis < 3; ++axis)
        node.lo[axis][slot] = box.lo[axis], node.hi[axis][slot] = box.hi[axis];
      node.occupied |= 1u << slot;
      node.child[slot] = leaf(range.begin + begin, count);
    }
    tree_.nodes.push_back(node);
    return static_cast<TreeReference>(tree_.nodes.size() - 1);
  }

 private:
  static TreeReference leaf(std::uint32_t begin, std::uint32_t count) {
    return tree_reference({begin, count});
  }

  BoundedTreeArrays& tree_;
  std::span<const LeafRange> ranges_;
  std::span<const Box> boxes_;
  std::uint32_t max_;
};

BoundedTreeArrays tree_over(std::span<const Box> boxes, const BoundedBuildOptions& options, Builder builder,
                            int threads) {
  const Progress nobody;
  ProgressMeter progress(nobody);
  MemoryMeter memory;
  const BuildRun run{threads, progress, memory};
  BinaryTree binary = builder({references_of(boxes), nullptr, run});
  NodesOverRanges all = collapse_nodes(binary, run);
  BoundedTreeArrays tree;
  tree.nodes = std::move(all.nodes), tree.order = std::move(binary.order);
  tree.bounds = all.bounds;
  LeafMaker leaves(tree, all.leaves.part(0, all.leaves.size()), boxes, options.max_in_leaf);
  const std::size_t count = tree.nodes.size();
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t slot = 0; slot < tree_width; ++slot) {
      const TreeReference child = leaves.remade(tree.nodes[i].child[slot]);  // may move the nodes
      tree.nodes[i].child[slot] = child;
    }
  tree.root = leaves.remade(all.root);
  return tree;
}

bool overlap(std::span<const Box> boxes, const Box& bounds) {
  const auto volume_of = [](const Box& box) {
    double volume = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) volume *= double{box.hi[axis]} - double{box.lo[axis]};
    return volume;
  };
  double volume = 0.0;
  for (const Box& box : boxes)
    if (is_visited(box)) volume += volume_of(box);
  return volume > 0.125 * volume_of(bounds);  // measured
}

}  // namespace

bool is_visited(const Box& box) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!std::isfinite(box.lo[axis]) || !std::isfinite(box.hi[axis]) || !(box.lo[axis] <= box.hi[axis]))
      return false;
  return true;
}

BoundedTreeArrays build_box_tree(const char* what, std::span<const Box> boxes,
                                 const BoundedBuildOptions& options) {
  const TreeBuilder named =
      options.builder == TreeBuilder::spatial_splits ? TreeBuilder::binned_sah : options.builder;
  const BuilderInfo& builder = checked_row(what, "builder", builders, named);
  require_threads(what, options.threads);
  if (boxes.size() > max_mesh_triangles)
    throw std::invalid_argument(std::string(what) + ": " + std::to_string(boxes.size()) +
                                " boxes, at most 2^28 are allowed");
  if (options.max_in_leaf < 1 || options.max_in_leaf > tree_width)
    throw std::invalid_argument(std::string(what) + ": " + std::to_string(options.max_in_leaf) +
                                " primitives in a leaf, allowed are 1 to 8");
  if (!(options.slack >= 0.0f && options.slack <= 1.0f))
    throw std::invalid_argument(std::string(what) + ": slack " + text_of(options.slack) +
                                ", allowed are 0 to 1");
  BoundedTreeArrays tree;
  if (!boxes.empty())
    on_threads(options.threads,
               [&](int threads) { tree = tree_over(boxes, options, builder.build, threads); });
  tree.size = boxes.size(), tree.overlaps = overlap(boxes, tree.bounds);
  return tree;
}

}  // namespace raylanes
