// Whether the triangles of a tree have an edge that an odd number of them shares, and whether they bound a solid from
// its outside.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
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

// The exclusive or of all edges is 0 if each comes an even number of times; the sum of directed edges is 0 if each
// comes as often in both directions. Otherwise they are 0 for one mesh in 2^64.
class MeshSums {
 public:
  // Rows of `lanes` numbers, corners v0 v1 v2, x y z of each; and the triangle of each lane.
  template <class T>
  void add(const T* numbers, const std::uint32_t* primitives, std::size_t lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane)
      if (primitives[lane] != no_primitive && is_new(primitives[lane])) add(numbers + lane, lanes);
  }
  bool has_odd_edge() const { return edges_ != 0; }
  // Whether the mesh is closed and its volume negative, by more than rounding explains.
  bool is_inside_out() const { return directed_ == 0 && volume_ < -0x1p-20 * size_; }

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
    add_edge(a, b), add_edge(b, c), add_edge(c, a);
    double v[3][3];
    for (std::size_t k = 0; k < 9; ++k) v[k / 3][k % 3] = static_cast<double>(n[k * lanes]);
    if (!has_origin_) std::copy_n(v[0], 3, origin_), has_origin_ = true;
    for (auto& vertex : v)
      for (std::size_t k = 0; k < 3; ++k) vertex[k] -= origin_[k];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      const double p = v[0][k] * v[1][l] * v[2][m], q = v[0][k] * v[1][m] * v[2][l];
      volume_ += p - q, size_ += std::abs(p) + std::abs(q);
    }
  }
  void add_edge(PositionHash from, PositionHash to) {
    const std::uint64_t edge = mixed(from + to);
    edges_ ^= edge, directed_ += from < to ? edge : 0 - edge;
  }

  std::vector<bool> seen_;
  std::uint64_t edges_ = 0, directed_ = 0;
  double origin_[3]{}, volume_ = 0, size_ = 0;  // six times the volume, seen from a corner of the mesh
  bool has_origin_ = false;
};

// Calls listens(i) for each leaf or triangle; of many the calls that do something are few.
template <class Tree, class Listens>
void add_leaves(MeshSums& sums, const Tree& tree, const Listens& listens) {
  std::size_t i = 0;
  for (const LeafBlock<9>& block : tree.view().leaves) {
    sums.add(&block.number[0][0], block.primitive, tree_width);
    listens(i++);
  }
}
template <class Listens>
void add_leaves(MeshSums& sums, const BvhD& tree, const Listens& listens) {
  std::size_t i = 0;
  tree.each_triangle([&](std::uint32_t primitive, const std::array<Double3, 3>& corners) {
    sums.add(corners[0].data(), &primitive, 1);
    listens(i++);
  });
}

// Looks at the first call of a tree only, for a warning that comes once: `looked` says whether it did.
template <class Tree>
bool found(SharedTreeOf<Tree>& shared, bool SharedTree<NumberOf<Tree>>::*looked,
           bool (MeshSums::*fault)() const) {
  if (shared.*looked) return false;
  Listener listener(py::none(), Listener::many);
  const bool found = query(shared, listener, [&](const Tree& tree) {
    MeshSums sums;
    add_leaves(sums, tree, [&](std::size_t i) {
      if (i % 4096 == 4095 && listener.progress() != nullptr) (*listener.progress())(0.5);
    });
    return (sums.*fault)();
  });
  return !std::exchange(shared.*looked, true) && found;
}
template <class Tree>
bool found_holes(SharedTreeOf<Tree>& shared) {
  return found(shared, &SharedTree<NumberOf<Tree>>::looked_for_holes, &MeshSums::has_odd_edge);
}
template <class Tree>
bool found_inside_out(SharedTreeOf<Tree>& shared) {
  return found(shared, &SharedTree<NumberOf<Tree>>::looked_for_sides, &MeshSums::is_inside_out);
}

}  // namespace raylanes::python
