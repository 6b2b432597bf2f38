// Whether the triangles of a tree have an edge that an odd number of them shares.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <type_traits>
#include <utility>
#include <vector>

#include "tree_binding.hpp"

namespace raylanes::python {

using PositionHash = std::uint64_t;

// The finalizer of SplitMix64 (Vigna 2015).
inline std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

// The hash of a position. Positions are equal as closed_report() has them: by bits, −0 being +0.
template <class T>
PositionHash hash_of(T x, T y, T z) {
  const auto bits = [](T coordinate) -> std::uint64_t {
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    constexpr Bits minus_zero = Bits{1} << (8 * sizeof(T) - 1);
    const Bits of = std::bit_cast<Bits>(coordinate);
    return of == minus_zero ? 0u : of;
  };
  return mixed(mixed(mixed(bits(x)) + bits(y)) + bits(z) + 1);
}

// The exclusive or of all edges: 0 if each comes an even number of times. Else it is 0 for one mesh in 2^64.
class EdgeParity {
 public:
  // Rows of `lanes` numbers, corners v0 v1 v2, x y z of each; and the triangle of each lane.
  template <class T>
  void add(const T* numbers, const std::uint32_t* primitives, std::size_t lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane)
      if (primitives[lane] != no_primitive && is_new(primitives[lane])) add(numbers + lane, lanes);
  }
  bool is_odd() const { return sum_ != 0; }

 private:
  // Builders that split triangles put some into several leaves.
  bool is_new(std::uint32_t primitive) {
    if (primitive >= seen_.size()) seen_.resize(std::size_t{primitive} * 2 + 1);
    if (seen_[primitive]) return false;
    return seen_[primitive] = true;
  }

  template <class T>
  void add(const T* n, std::size_t lanes) {
    const auto corner = [&](std::size_t k) {
      return hash_of(n[k * lanes], n[(k + 1) * lanes], n[(k + 2) * lanes]);
    };
    const PositionHash a = corner(0), b = corner(3), c = corner(6);
    if (a == b || b == c || c == a) return;  // after a refit; nothing crosses it
    sum_ ^= mixed(a + b) ^ mixed(b + c) ^ mixed(c + a);
  }

  std::vector<bool> seen_;
  std::uint64_t sum_ = 0;
};

// Of many leaves the calls of `listens` are few.
template <class Tree, class Listens>
void add_leaves(EdgeParity& edges, const Tree& tree, const Listens& listens) {
  std::size_t i = 0;
  for (const LeafBlock<9>& block : tree.view().leaves) {
    edges.add(&block.number[0][0], block.primitive, tree_width);
    listens(i++);
  }
}
// From the bytes of its file, as docs/tree_file.md has them, since such a tree has no view.
template <class Listens>
void add_leaves(EdgeParity& edges, const BvhD& tree, const Listens& listens) {
  constexpr std::size_t nodes_at = 200, root_at = 108, half_bytes = 320;
  std::ostringstream file;
  file.exceptions(std::ios_base::badbit);
  tree.save(file);
  const char* const bytes = file.view().data();
  const auto read = [&](std::size_t at, auto& to) { std::memcpy(&to, bytes + at, sizeof to); };
  std::uint64_t nodes = 0;
  read(32, nodes);
  const std::size_t leaves_at = nodes_at + nodes * sizeof(WideNode);
  const auto add = [&](TreeReference reference) {
    if (reference == empty_reference || !refers_to_leaf(reference)) return;
    const LeafReference leaf = leaf_of(reference);
    const std::size_t lanes = leaf.size > tree_width / 2 ? tree_width : tree_width / 2;
    double numbers[9 * tree_width];
    std::uint32_t primitives[tree_width];
    const char* const at = bytes + leaves_at + half_bytes * leaf.block;
    std::memcpy(numbers, at, 9 * lanes * sizeof(double));
    std::memcpy(primitives, at + 9 * lanes * sizeof(double), lanes * sizeof(std::uint32_t));
    edges.add(numbers, primitives, lanes);
  };
  TreeReference root;
  read(root_at, root), add(root);
  for (std::size_t i = 0; i < nodes; ++i) {
    WideNode node;
    read(nodes_at + i * sizeof node, node);
    for (const TreeReference child : node.child) add(child);
    listens(i);
  }
}

// Looks at the first call of a tree only, for a warning that comes once.
template <class Tree>
bool found_holes(SharedTreeOf<Tree>& shared) {
  if (shared.looked_for_holes) return false;
  Listener listener(py::none(), Listener::many);
  const bool found = query(shared, listener, [&](const Tree& tree) {
    EdgeParity edges;
    add_leaves(edges, tree, [&](std::size_t i) {
      if (i % 4096 == 4095 && listener.progress() != nullptr) (*listener.progress())(0.5);
    });
    return edges.is_odd();
  });
  return !std::exchange(shared.looked_for_holes, true) && found;
}

}  // namespace raylanes::python
