#include "kdtree_arrays.hpp"
#include "occlusion_order.hpp"

namespace raylanes {
namespace {

// A candidate for a child: a node with its cell, or some blocks of a leaf.
struct Item {
  KdNode node;
  Box4 cell;

  bool is_empty() const { return node.is_leaf() && node.count() == 0; }
  bool is_block() const { return node.is_leaf() && node.count() <= tree_width; }
};

class Eights {
 public:
  explicit Eights(KdTreeArrays& tree) : tree_(tree) {}

  void make() {
    if (tree_.nodes.empty()) return;
    const Item root{tree_.nodes[0], four_box(tree_.bounds)};
    if (root.is_empty()) return;
    // No deeper than planes are, and halves of a leaf's blocks: less than max_tree_depth.
    tree_.root = reference_to(root);
    while (!pending_.empty()) {
      const Pending next = pending_.back();
      pending_.pop_back();
      fill_node(next);
    }
    for (std::size_t i = tree_.wide_nodes.size(); i-- > 0;) measure(tree_.wide_nodes[i]);
    Array<float> areas(tree_.corners.count());
    for (std::size_t i = 0; i < areas.size(); ++i) areas[i] = tree_.corners.area(i);
    OcclusionOrder(tree_.wide_nodes, areas.part(0, areas.size())).sort(0, tree_.wide_nodes.size());
  }

 private:
  struct Pending {
    Item item;
    std::size_t node;
  };

  TreeReference reference_to(const Item& item) {
    if (item.is_block()) return tree_reference({item.node.first(), item.node.count()});
    tree_.wide_nodes.emplace_back();
    pending_.push_back({item, tree_.wide_nodes.size() - 1});
    return static_cast<TreeReference>(tree_.wide_nodes.size() - 1);
  }

  void fill_node(const Pending& at) {
    Item items[tree_width];
    std::size_t count = 0;
    divide(at.item, items, count);
    // The largest first, each in three parts at most.
    for (std::size_t widest; count + 2 <= tree_width && (widest = widest_of(items, count)) < count;) {
      const Item item = items[widest];
      items[widest] = items[--count];
      divide(item, items, count);
    }
    WideNode node = empty_node();
    for (std::size_t slot = 0; slot < count; ++slot) {
      set_box(node, slot, items[slot].is_block() ? box_of(items[slot]) : items[slot].cell);
      node.occupied |= 1u << slot;
      node.child[slot] = reference_to(items[slot]);
    }
    tree_.wide_nodes[at.node] = node;
  }

  // The widest item that can be divided; `count` if there is none.
  static std::size_t widest_of(const Item (&items)[tree_width], std::size_t count) {
    std::size_t widest = count;
    double area = -1.0;
    for (std::size_t i = 0; i < count; ++i)
      if (!items[i].is_block() && area_of(items[i].cell) > area) widest = i, area = area_of(items[i].cell);
    return widest;
  }

  void divide(const Item& item, Item (&items)[tree_width], std::size_t& count) const {
    const KdNode& node = item.node;
    const auto add = [&](const KdNode& part, const Box4& cell) {
      if (const Item added{part, cell}; !added.is_empty()) items[count++] = added;
    };
    if (node.is_leaf()) {
      const std::uint32_t half = blocks_of(node.count()) / 2;
      add(KdNode::leaf(node.first(), std::min(node.count(), half * tree_width)), item.cell);
      add(KdNode::leaf(node.first() + half, node.count() - std::min(node.count(), half * tree_width)),
          item.cell);
      return;
    }
    Box4 below = item.cell, above = item.cell;
    below.hi[node.axis()] = above.lo[node.axis()] = node.plane();
    add(tree_.nodes[node.first()], below);
    add(tree_.nodes[node.first() + 1], above);
    if (node.keeps_triangles()) add(tree_.nodes[node.first() + 2], item.cell);
  }

  // The box of the part of a cell that the triangles of a block take.
  Box4 box_of(const Item& item) const {
    const LeafBlock<9>& block = static_cast<const LeafBlock<9>*>(tree_.corners.blocks())[item.node.first()];
    Box4 box = empty_four_box;
    for (std::uint32_t lane = 0; lane < item.node.count(); ++lane)
      for (std::size_t k = 0; k < 9; k += 3)
        extend(box, Vec4{block.number[k][lane], block.number[k + 1][lane], block.number[k + 2][lane], 0.0f});
    const Box4 common{greatest(box.lo, item.cell.lo), least(box.hi, item.cell.hi)};
    // If a triangle only touches its cell, they may have nothing in common, by rounding.
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!(common.lo[axis] <= common.hi[axis])) return item.cell;
    return common;
  }

  static void set_box(WideNode& node, std::size_t slot, const Box4& box) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      node.lo[axis][slot] = box.lo[axis], node.hi[axis][slot] = box.hi[axis];
  }

  // Nodes below get the box around their children, which come after them.
  void measure(WideNode& node) const {
    for (std::size_t slot = 0; slot < tree_width; ++slot) {
      if ((node.occupied >> slot & 1u) == 0 || refers_to_leaf(node.child[slot])) continue;
      const WideNode& below = tree_.wide_nodes[node.child[slot]];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        node.lo[axis][slot] = *std::min_element(below.lo[axis], below.lo[axis] + tree_width);
        node.hi[axis][slot] = *std::max_element(below.hi[axis], below.hi[axis] + tree_width);
      }
    }
  }

  KdTreeArrays& tree_;
  std::vector<Pending> pending_;
};

}  // namespace

void collapse_cells(KdTreeArrays& tree) {
  Eights(tree).make();
}

}  // namespace raylanes
