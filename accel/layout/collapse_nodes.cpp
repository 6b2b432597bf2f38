
#include "../batch/in_parallel.hpp"
#include "bvh_arrays.hpp"
#include "occlusion_order.hpp"
#include "slot_plan.hpp"

namespace raylanes {
namespace {

// Some of the wide tree; references are to its own nodes and leaves.
struct Piece {
  std::span<WideNode> nodes;
  std::span<LeafRange> leaves;
};

// A binary node that becomes the first node of another piece, and where that hangs.
struct Seam {
  std::uint32_t binary_node;
  std::size_t parent, slot;
  int depth;
};

class Emitter {
 public:
  // Nodes whose children are from `top` on go to `seams`.
  Emitter(const BinaryTree& binary, const SlotPlan& plan, std::uint32_t top, std::vector<Seam>* seams)
      : binary_(binary), plan_(plan), top_(top), seams_(seams) {}

  // The node or leaf that the subtree becomes in one slot comes first.
  Piece emit(std::uint32_t binary_node, int depth, KeptParts& kept) {
    nodes_.clear(), leaves_.clear();
    reference_to(binary_node, depth);
    while (!pending_.empty()) {
      const Pending next = pending_.back();
      pending_.pop_back();
      fill_node(next);
    }
    return {kept.keep(std::span<const WideNode>(nodes_)), kept.keep(std::span<const LeafRange>(leaves_))};
  }

 private:
  struct Pending {
    std::uint32_t binary_node;
    std::size_t wide_node;
    int depth;  // of inner nodes from the root to this one
  };
  struct Slots {
    std::uint32_t binary_node, count;
  };

  TreeReference reference_to(std::uint32_t binary_node, int depth) {
    if (plan_.as_node(binary_node) == 0) return append_leaf(binary_.nodes[binary_node]);
    const std::size_t index = nodes_.size();
    if (depth > max_tree_depth)
      throw std::length_error("tree: deeper than " + std::to_string(max_tree_depth) + " nodes");
    nodes_.emplace_back();
    pending_.push_back({binary_node, index, depth});
    return static_cast<TreeReference>(index);
  }

  TreeReference append_leaf(const BinaryNode& leaf) {
    leaves_.push_back({leaf.begin, leaf.count});
    return tree_reference({static_cast<std::uint32_t>(leaves_.size() - 1), leaf.count});
  }

  void fill_node(const Pending& at) {
    const BinaryNode& parent = binary_.nodes[at.binary_node];
    const std::uint32_t for_left = plan_.as_node(at.binary_node);
    Slots open[tree_width] = {{parent.left + 1, tree_width - for_left}, {parent.left, for_left}};
    std::size_t open_count = 2, slot = 0;
    WideNode node = empty_node();
    while (open_count > 0) {
      Slots next = open[--open_count];
      while (next.count > 1 && plan_.divided(next.binary_node, next.count) == 0) --next.count;
      const BinaryNode& child = binary_.nodes[next.binary_node];
      if (next.count == 1) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          node.lo[axis][slot] = child.box.lo[axis];
          node.hi[axis][slot] = child.box.hi[axis];
        }
        node.occupied |= 1u << slot;
        node.child[slot] = child_reference(next.binary_node, at, slot);
        ++slot;
      } else {
        const std::uint32_t left_slots = plan_.divided(next.binary_node, next.count);
        open[open_count++] = {child.left + 1, next.count - left_slots};
        open[open_count++] = {child.left, left_slots};
      }
    }
    nodes_[at.wide_node] = node;
  }

  TreeReference child_reference(std::uint32_t binary_node, const Pending& parent, std::size_t slot) {
    const bool elsewhere = seams_ != nullptr && binary_.nodes[binary_node].left >= top_;
    if (!elsewhere || plan_.as_node(binary_node) == 0) return reference_to(binary_node, parent.depth + 1);
    seams_->push_back({binary_node, parent.wide_node, slot, parent.depth + 1});
    return empty_reference;
  }

  const BinaryTree& binary_;
  const SlotPlan& plan_;
  std::uint32_t top_;
  std::vector<Seam>* seams_;
  std::vector<Pending> pending_;
  std::vector<WideNode> nodes_;
  std::vector<LeafRange> leaves_;
};

// References to nodes are already right in the first piece, which has seams to later pieces.
void move_nodes(const Piece& piece, std::size_t node_base, std::size_t leaf_base, WideNode* to) {
  for (const WideNode& from : piece.nodes) {
    WideNode node = from;
    for (TreeReference& child : node.child)
      if (child != empty_reference)
        child += static_cast<TreeReference>((child & leaf_bit) != 0 ? leaf_base : node_base);
    *to++ = node;
  }
}

// Puts pieces one behind the other; seams[i] is where pieces[i + 1] hangs.
NodesOverRanges assemble(std::vector<Piece>& pieces, const std::vector<Seam>& seams, const BuildRun& run) {
  NodesOverRanges all;
  std::vector<std::size_t>& node_base = all.piece_ends;
  std::vector<std::size_t> leaf_base{0};
  node_base.push_back(0);
  for (const Piece& piece : pieces) {
    node_base.push_back(node_base.back() + piece.nodes.size());
    leaf_base.push_back(leaf_base.back() + piece.leaves.size());
  }
  if (node_base.back() > leaf_bit) throw std::length_error("tree: more than 2^31 nodes");
  if (leaf_base.back() > leaf_block_mask) throw std::length_error("tree: more than 2^28 leaves");
  for (std::size_t i = 0; i < seams.size(); ++i)
    pieces[0].nodes[seams[i].parent].child[seams[i].slot] = static_cast<TreeReference>(node_base[i + 1]);
  all.nodes.resize(node_base.back());
  all.leaves = Array<LeafRange>(leaf_base.back());
  run.memory.hold(all.nodes.size() * sizeof(WideNode));
  in_parallel(pieces.size(), 1, run.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      move_nodes(pieces[i], i == 0 ? 0 : node_base[i], leaf_base[i], all.nodes.data() + node_base[i]);
      std::copy(pieces[i].leaves.begin(), pieces[i].leaves.end(), all.leaves.data() + leaf_base[i]);
    }
  });
  return all;
}

// The first piece, which hangs above the others, last.
void sort_children(BvhArrays& tree, std::span<const float> leaf_areas,
                   const std::vector<std::size_t>& node_base, const BuildRun& run) {
  OcclusionOrder order(tree.nodes, leaf_areas);
  const HeldMemory held(run.memory, order.bytes() + leaf_areas.size_bytes());
  in_parallel(node_base.size() - 2, 1, run.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin + 1; i < end + 1; ++i) order.sort(node_base[i], node_base[i + 1]);
  });
  order.sort(0, node_base[1]);
}

}  // namespace

NodesOverRanges collapse_nodes(BinaryTree& binary, const BuildRun& run) {
  std::vector<Seam> seams;
  std::vector<Piece> pieces(1);
  if (binary.nodes.empty()) return assemble(pieces, seams, run);
  const BinaryNode root = binary.nodes[0];
  KeptParts kept(run.memory);
  {
    const SlotPlan plan(binary, run.threads, run.progress, run.memory);
    const HeldMemory held(run.memory, plan.bytes());
    const bool shares = binary.subtrees.size() > 1;
    const std::uint32_t top = shares ? binary.subtrees[0].begin : 0;
    pieces[0] = Emitter(binary, plan, top, shares ? &seams : nullptr).emit(0, 1, kept);
    pieces.resize(1 + seams.size());
    in_parallel(seams.size(), 1, run.threads, [&](std::size_t begin, std::size_t end) {
      Emitter emitter(binary, plan, 0, nullptr);
      for (std::size_t i = begin; i < end; ++i)
        pieces[i + 1] = emitter.emit(seams[i].binary_node, seams[i].depth, kept);
    });
  }
  run.memory.release(binary.nodes.size() * sizeof(BinaryNode));
  binary.nodes = LargeVector<BinaryNode>();  // "{}" would keep the memory
  NodesOverRanges all = assemble(pieces, seams, run);
  all.bounds = root.box;
  all.root = all.nodes.empty() ? tree_reference({0, root.count}) : 0;
  return all;
}

BvhArrays collapse_to_bvh(BinaryTree binary, const LeafSource& source, const BuildRun& run) {
  NodesOverRanges all = collapse_nodes(binary, run);
  const HeldMemory held(run.memory, all.leaves.bytes());
  BvhArrays tree;
  tree.nodes = std::move(all.nodes);
  tree.root = all.root, tree.bounds = all.bounds;
  Array<float> areas = tree.fill(source, all.leaves.part(0, all.leaves.size()), binary.order, run, 0.6);
  sort_children(tree, areas.part(0, areas.size()), all.piece_ends, run);
  return tree;
}

}  // namespace raylanes
