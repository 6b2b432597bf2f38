// Whether the triangles of a tree have an edge that an odd number of them shares.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
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

// Calls listens(i) for each leaf or triangle; of many the calls that do something are few.
template <class Tree, class Listens>
void add_leaves(EdgeParity& edges, const Tree& tree, const Listens& listens) {
  std::size_t i = 0;
  for (const LeafBlock<9>& block : tree.view().leaves) {
    edges.add(&block.number[0][0], block.primitive, tree_width);
    listens(i++);
  }
}
template <class Listens>
void add_leaves(EdgeParity& edges, const BvhD& tree, const Listens& listens) {
  std::size_t i = 0;
  tree.each_triangle([&](std::uint32_t primitive, const std::array<Double3, 3>& corners) {
    edges.add(corners[0].data(), &primitive, 1);
    listens(i++);
  });
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
