// How k-d trees grow from their root, in the order of builders/level_order.hpp and without recursion. Who splits is a
// type.
#pragma once

#include <tuple>

#include "../level_order.hpp"
#include "kd_builders.hpp"

namespace raylanes {

// A cell that may be divided.
struct KdCell {
  Box4 cell, box;        // its own, and that around the parts of references in it
  std::uint32_t blocks;  // what its leaves may take
  int depth;             // planes above it
};

struct KdPlane {
  std::size_t axis;
  float at;
  bool flat_below;  // where references go that lie in the plane
};

// A Splitter has
//   bool choose(std::span<const Reference> references, const KdCell& cell, int threads, KdPlane& plane) const: whether
//     to divide; the plane is in the cell. `threads` as in BuildInput where nobody else is given work.
//   void place(const Reference& reference, const KdPlane& plane, To& to) const: calls to.below, to.above or to.keep
//     with parts of it, which stay in the cell; each once at most.
template <class Splitter>
class KdGrowth {
 public:
  KdGrowth(const Splitter& splitter, const BuildRun& run) : splitter_(splitter), run_(run) {}

  KdCells build(Array<Reference> references) {
    const LevelOrder<Open> order(references.size(), run_);
    Open root{{}, {empty_four_box, empty_four_box, blocks_allowed(references.size()), 0}, 0};
    root.references.assign(references.data(), references.data() + references.size());
    run_.memory.hold(bytes_of(root.references));
    references = {};
    for (const Reference& reference : root.references) extend(root.cell.box, reference.box);
    root.cell.cell = root.cell.box;
    cells_.nodes.resize(1);
    grow_top(std::move(root), order);
    grow_subtrees(order);
    collect();
    return std::move(cells_);
  }

 private:
  using References = std::vector<Reference>;

  // With references of its own.
  struct Open {
    References references;
    KdCell cell;
    std::size_t node;
    std::size_t count() const { return references.size(); }
  };
  // With references in a pool.
  struct Waiting {
    std::size_t begin, count;
    KdCell cell;
    std::size_t node;
  };
  // The root is apart, numbers are its own.
  struct Subtree {
    KdNode root;
    KdCells below;
  };

  static std::size_t bytes_of(const References& references) {
    return references.capacity() * sizeof(Reference);
  }

  // Two cells of one, less what references are in them.
  static std::pair<KdCell, KdCell> halves_of(const KdCell& cell, const KdPlane& plane) {
    KdCell below{cell.cell, empty_four_box, 0, cell.depth + 1}, above = below;
    below.cell.hi[plane.axis] = plane.at;
    above.cell.lo[plane.axis] = plane.at;
    return {below, above};
  }
  // The blocks of a cell, shared out in proportion to what has to go into them.
  static void share_blocks(std::uint32_t blocks, std::size_t kept, std::size_t in_below, std::size_t in_above,
                           KdCell& below, KdCell& above) {
    const std::uint32_t needed = blocks_of(kept) + blocks_of(in_below) + blocks_of(in_above);
    const std::uint64_t spare = blocks > needed ? blocks - needed : 0;
    const auto for_below =
        static_cast<std::uint32_t>(spare * in_below / std::max<std::size_t>(1, in_below + in_above));
    below.blocks = blocks_of(in_below) + for_below;
    above.blocks = blocks_of(in_above) + static_cast<std::uint32_t>(spare) - for_below;
  }
  bool choose(std::span<const Reference> references, const KdCell& cell, int threads, KdPlane& plane) const {
    return cell.depth < max_kd_depth && references.size() > 1 &&
           splitter_.choose(references, cell, threads, plane);
  }

  // Appends a leaf's primitives.
  template <class List>
  static KdNode leaf_of(const List& references, KdCells& cells) {
    const auto begin = static_cast<std::uint32_t>(cells.order.size());
    for (const Reference& reference : references) cells.order.push_back(reference.primitive());
    return KdNode::leaf(begin, static_cast<std::uint32_t>(references.size()));
  }
  static KdNode inner(const KdPlane& plane, bool keeps, std::size_t first) {
    return KdNode::inner(static_cast<std::uint32_t>(plane.axis), plane.at, keeps,
                         static_cast<std::uint32_t>(first));
  }

  // --- What is large.

  struct Division {
    Open below, above;
    References kept;
    KdPlane plane;
    bool is_divided = false;
  };
  struct ToLists {
    Division& to;
    void below(const Reference& r) { to.below.references.push_back(r), extend(to.below.cell.box, r.box); }
    void above(const Reference& r) { to.above.references.push_back(r), extend(to.above.cell.box, r.box); }
    void keep(const Reference& r) { to.kept.push_back(r); }
  };

  Division divide(const Open& open) const {
    Division d;
    d.is_divided = choose(open.references, open.cell, run_.threads, d.plane);
    if (!d.is_divided) return d;
    std::tie(d.below.cell, d.above.cell) = halves_of(open.cell, d.plane);
    ToLists to{d};
    for (const Reference& reference : open.references) splitter_.place(reference, d.plane, to);
    share_blocks(open.cell.blocks, d.kept.size(), d.below.references.size(), d.above.references.size(),
                 d.below.cell, d.above.cell);
    run_.memory.hold(bytes_of(d.below.references) + bytes_of(d.above.references) + bytes_of(d.kept));
    return d;
  }

  void grow_top(Open root, const LevelOrder<Open>& order) {
    open_ = order.divide_large(
        std::move(root), [&](const Open& open) { return divide(open); },
        [&](Open& open, Division& division, std::vector<Open>& next) { take(open, division, next); });
  }
  void take(Open& open, Division& division, std::vector<Open>& next) {
    if (division.is_divided) {
      const std::size_t first = cells_.nodes.size();
      const bool keeps = !division.kept.empty();
      cells_.nodes.resize(first + (keeps ? 3 : 2));
      cells_.nodes[open.node] = inner(division.plane, keeps, first);
      division.below.node = first, division.above.node = first + 1;
      if (keeps) cells_.nodes[first + 2] = leaf_of(division.kept, cells_);
      run_.memory.release(bytes_of(division.kept));
      next.push_back(std::move(division.below));
      next.push_back(std::move(division.above));
    } else {
      cells_.nodes[open.node] = leaf_of(open.references, cells_);
    }
    run_.memory.release(bytes_of(open.references));
    open.references = {};
  }

  // --- Subtrees.

  // References of the part below go behind all others in the pool; references of the part above take the place of the
  // cell's own. So the part in work is always the last.
  struct ToPool {
    References &pool, &kept;
    std::size_t at;
    Box4 below_box = empty_four_box, above_box = empty_four_box;

    void below(const Reference& r) { pool.push_back(r), extend(below_box, r.box); }
    void above(const Reference& r) { pool[at++] = r, extend(above_box, r.box); }
    void keep(const Reference& r) { kept.push_back(r); }
  };

  Subtree grow(References pool, const KdCell& root) const {
    Subtree tree;
    constexpr std::size_t of_root = ~std::size_t{0};
    std::vector<Waiting> waiting{{0, pool.size(), root, of_root}};
    References kept;
    while (!waiting.empty()) {
      const Waiting at = waiting.back();
      waiting.pop_back();
      pool.resize(at.begin + at.count);
      const std::span<const Reference> references = std::span(pool).subspan(at.begin);
      KdPlane plane;
      KdNode node;
      if (choose(references, at.cell, 1, plane)) {
        auto [below, above] = halves_of(at.cell, plane);
        kept.clear();
        ToPool to{pool, kept, at.begin};
        for (std::size_t i = at.begin; i < at.begin + at.count; ++i) {
          const Reference reference = pool[i];
          splitter_.place(reference, plane, to);
        }
        const std::size_t end = at.begin + at.count, in_below = pool.size() - end,
                          in_above = to.at - at.begin;
        below.box = to.below_box, above.box = to.above_box;
        share_blocks(at.cell.blocks, kept.size(), in_below, in_above, below, above);
        const std::size_t first = tree.below.nodes.size();
        node = inner(plane, !kept.empty(), first);
        tree.below.nodes.resize(first + (kept.empty() ? 2 : 3));
        if (!kept.empty()) tree.below.nodes[first + 2] = leaf_of(kept, tree.below);
        waiting.push_back({at.begin, in_above, above, first + 1});
        waiting.push_back({end, in_below, below, first});
      } else {
        node = leaf_of(references, tree.below);
      }
      (at.node == of_root ? tree.root : tree.below.nodes[at.node]) = node;
    }
    return tree;
  }

  void grow_subtrees(const LevelOrder<Open>& order) {
    subtrees_.resize(open_.size());
    order.grow_subtrees(open_, [&](std::size_t i) {
      const std::size_t bytes = bytes_of(open_[i].references);
      subtrees_[i] = grow(std::exchange(open_[i].references, {}), open_[i].cell);
      run_.memory.hold(subtrees_[i].below.bytes());
      run_.memory.release(bytes);
    });
  }

  // --- One tree of all.

  static KdNode moved(KdNode node, std::size_t nodes, std::size_t order) {
    node.link += static_cast<std::uint32_t>(node.is_leaf() ? order : nodes) << 3;
    return node;
  }
  void collect() {
    std::vector<std::size_t> nodes_at, order_at;
    std::size_t nodes = cells_.nodes.size(), order = cells_.order.size();
    for (const Subtree& subtree : subtrees_) {
      nodes_at.push_back(std::exchange(nodes, nodes + subtree.below.nodes.size()));
      order_at.push_back(std::exchange(order, order + subtree.below.order.size()));
    }
    if (nodes > max_kd_nodes || order > max_kd_nodes)
      throw std::length_error("kdtree: more nodes or triangles in leaves than can be numbered");
    cells_.nodes.resize(nodes), cells_.order.resize(order);
    run_.memory.hold(cells_.bytes());
    in_parallel(subtrees_.size(), 1, run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const KdCells below = std::exchange(subtrees_[i].below, {});
        cells_.nodes[open_[i].node] = moved(subtrees_[i].root, nodes_at[i], order_at[i]);
        for (std::size_t k = 0; k < below.nodes.size(); ++k)
          cells_.nodes[nodes_at[i] + k] = moved(below.nodes[k], nodes_at[i], order_at[i]);
        std::copy(below.order.begin(), below.order.end(),
                  cells_.order.begin() + static_cast<std::ptrdiff_t>(order_at[i]));
        run_.memory.release(below.bytes());
      }
    });
  }

  const Splitter& splitter_;
  const BuildRun& run_;
  KdCells cells_;
  std::vector<Open> open_;  // roots of subtrees
  std::vector<Subtree> subtrees_;
};

}  // namespace raylanes
