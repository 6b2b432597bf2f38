// One ray, or one point, through a tree's nodes, depth first: a node's children by one comparison, sorted in a register
// where they are three or more.
#pragma once

#include "../one_by_one.hpp"
#include "fused_ray.hpp"

namespace raylanes {
namespace {

// The children that a ray meets.
struct HitChildren {
  FloatMask<tree_width> mask;
  std::uint32_t lanes;

  HitChildren(NodeFloats in, NodeFloats out) : mask(in <= out), lanes(bits(mask)) {}
  bool is_one() const { return (lanes & (lanes - 1)) == 0; }
  std::uint32_t but_first() const { return lanes & (lanes - 1); }
  NodeWords select(NodeWords hit, NodeWords other) const { return select_bits(mask, hit, other); }
};

// The key of a child: the bits of its entry that the key keeps, and the child's number. `none`: the key of a child that
// is not hit, behind all others. Few nodes need these constants, so they stay in memory.
struct alignas(32) KeyParts {
  std::uint32_t child[tree_width] = {0, 1, 2, 3, 4, 5, 6, 7};
  std::uint32_t entry[tree_width] = {~7u, ~7u, ~7u, ~7u, ~7u, ~7u, ~7u, ~7u};
  std::uint32_t none[tree_width] = {~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u};
};
inline constexpr KeyParts key_parts;

// The stack of the nearest hit: references, and where the ray enters their boxes, with room for a vector more. The
// caller keeps their number in a register.
template <std::size_t room>
class WaitingNearest {
 public:
  // Goes on with the nearest of two children or more. Entries are not negative, so keys compare as entries do.
  TreeReference push(const WideNode& node, const HitChildren& hit, NodeFloats entry, std::size_t& size) {
    if (const std::uint32_t others = hit.but_first(); (others & (others - 1)) == 0) {
      alignas(32) float at[tree_width];
      entry.store(at);
      const int a = std::countr_zero(hit.lanes), b = std::countr_zero(others);
      const TreeReference of_a = node.child[a], of_b = node.child[b];  // beside the entries, not behind them
      const float t_a = at[a], t_b = at[b];
      const bool a_is_nearer = t_a < t_b;
      reference_[size] = a_is_nearer ? of_b : of_a, t_[size] = a_is_nearer ? t_b : t_a;
      ++size;
      return a_is_nearer ? of_a : of_b;
    }
    const KeyParts& parts = in_memory(key_parts);
    NodeWords key = hit.select(key_of(entry, parts), NodeWords::load(parts.none));
    const std::uint32_t nearest = min_unsigned(key) & 7u;
    store_sorted(node, key, size, parts);
    // The nearest, which goes on, is behind those that stay; so are lanes that are not hit.
    size += static_cast<std::size_t>(std::popcount(hit.but_first()));
    return node.child[nearest];
  }
  // Asks for the next N that wait ahead of time. Inlined, as g++ 12 drops calls of functions that do no more than that.
  template <std::size_t N, class Leaves>
  [[gnu::always_inline]] void prefetch_next(const TreeView& tree, const Leaves& leaves,
                                            std::size_t size) const {
    for (std::size_t i = 1; i <= N && i <= size; ++i) {
      const TreeReference next = reference_[size - i];
      const auto* const lines = refers_to_leaf(next) ? static_cast<const std::byte*>(leaves.begin_of(next))
                                                     : reinterpret_cast<const std::byte*>(tree.nodes + next);
      for (std::size_t at = 0; at < sizeof(LeafBlock<9>); at += 64) __builtin_prefetch(lines + at);
    }
  }
  // All children that are hit, without a branch.
  void push_all(const WideNode& node, const HitChildren& hit, NodeFloats entry, std::size_t& size) {
    store_sorted(node, hit.select(key_of(entry, key_parts), NodeWords(~0u)), size, key_parts);
    size += static_cast<std::size_t>(std::popcount(hit.lanes));
  }
  bool pop(TreeReference& next, float tmax, std::size_t& size) const {
    do {
      if (size == 0) return false;
      --size;
    } while (t_[size] > tmax);
    next = reference_[size];
    return true;
  }

 private:
  static NodeWords key_of(NodeFloats entry, const KeyParts& parts) {
    return (as<std::uint32_t>(entry) & NodeWords::load(parts.entry)) | NodeWords::load(parts.child);
  }
  // The farthest first.
  void store_sorted(const WideNode& node, NodeWords key, std::size_t size, const KeyParts& parts) {
    NodeWords sorted = sort_descending_signed(key);
    permute(NodeWords::load(node.child), sorted).store(reference_ + size);
    as<float>(sorted & NodeWords::load(parts.entry)).store(t_ + size);
  }

  alignas(64) TreeReference reference_[room + tree_width];
  alignas(64) float t_[room + tree_width];
};

// The same for any hit: children come as they are stored.
template <std::size_t room>
class WaitingAsStored {
 public:
  TreeReference push(const WideNode& node, const HitChildren& hit, NodeFloats, std::size_t& size) {
    std::uint32_t others = hit.but_first();
    if ((others & (others - 1)) == 0) {
      reference_[size++] = node.child[std::countr_zero(others)];
    } else {
      push_lanes(node, others, size);
    }
    return node.child[std::countr_zero(hit.lanes)];
  }
  void push_all(const WideNode& node, const HitChildren& hit, NodeFloats, std::size_t& size) {
    push_lanes(node, hit.lanes, size);
  }
  bool pop(TreeReference& next, float, std::size_t& size) const {
    if (size == 0) return false;
    next = reference_[--size];
    return true;
  }

 private:
  void push_lanes(const WideNode& node, std::uint32_t lanes, std::size_t& size) {
    while (lanes != 0) {
      const int last = std::bit_width(lanes) - 1;
      lanes ^= 1u << last;
      reference_[size++] = node.child[last];
    }
  }

  alignas(64) TreeReference reference_[room + tree_width];
};

template <bool only_decides, std::size_t room>
using WaitingOf = std::conditional_t<only_decides, WaitingAsStored<room>, WaitingNearest<room>>;

// From a node or leaf to the leaves that the query wants to see. leaves.visit(leaf, query) is true where the search
// ends. `boxes` says for each child where it is entered, not before +0, and where it is left. Leaves may say how many
// of those that wait are asked for ahead of time, and where a leaf begins. Returns whether a leaf has ended the search.
template <class Boxes, class Leaves, class Query>
inline bool walk_fused_from(const TreeView& tree, TreeReference next, const Boxes& boxes,
                            const Leaves& leaves, Query& query) {
  WaitingOf<Query::only_decides, max_stack> waiting;
  std::size_t size = 0;
  float end = query.box_tmax();
  do {
    const NodeFloats tmax(end);
    while (!refers_to_leaf(next)) {
      const WideNode& node = tree.nodes[next];
      NodeFloats entry = boxes.entries(node);
      const HitChildren hit(entry, boxes.exits(node, tmax));
      if (hit.lanes == 0) {
        if (!waiting.pop(next, end, size)) return false;
      } else {
        next = hit.is_one() ? node.child[std::countr_zero(hit.lanes)] : waiting.push(node, hit, entry, size);
      }
    }
    if constexpr (requires { Leaves::prefetched; })
      waiting.template prefetch_next<Leaves::prefetched>(tree, leaves, size);
    if (leaves.visit(next, query)) return true;
    if constexpr (!Query::only_decides) end = query.box_tmax();
  } while (waiting.pop(next, end, size));
  return false;
}
template <class Boxes, class Leaves, class Query>
inline bool walk_fused(const TreeView& tree, const Boxes& boxes, const Leaves& leaves, Query& query) {
  return walk_fused_from(tree, tree.root, boxes, leaves, query);
}

}  // namespace
}  // namespace raylanes
