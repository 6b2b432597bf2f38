// Whether the triangles of a tree have an edge that an odd number of them shares.
#pragma once

#include <bit>
#include <cstdint>
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
inline PositionHash hash_of(float x, float y, float z) {
  const auto bits = [](float coordinate) -> std::uint64_t {
    const auto of = std::bit_cast<std::uint32_t>(coordinate);
    return of == 0x80000000u ? 0u : of;
  };
  return mixed(mixed(bits(x) << 32 | bits(y)) + bits(z) + 1);
}

// The exclusive or of all edges: 0 if each comes an even number of times. Else it is 0 for one mesh in 2^64.
class EdgeParity {
 public:
  void add(const LeafBlock<9>& block) {
    for (std::size_t lane = 0; lane < tree_width; ++lane)
      if (block.primitive[lane] != no_primitive && is_new(block.primitive[lane])) add(block, lane);
  }
  bool is_odd() const { return sum_ != 0; }

 private:
  // Builders that split triangles put some into several leaves.
  bool is_new(std::uint32_t primitive) {
    if (primitive >= seen_.size()) seen_.resize(std::size_t{primitive} * 2 + 1);
    if (seen_[primitive]) return false;
    return seen_[primitive] = true;
  }

  void add(const LeafBlock<9>& block, std::size_t lane) {
    const auto& n = block.number;
    const PositionHash a = hash_of(n[0][lane], n[1][lane], n[2][lane]),
                       b = hash_of(n[3][lane], n[4][lane], n[5][lane]),
                       c = hash_of(n[6][lane], n[7][lane], n[8][lane]);
    if (a == b || b == c || c == a) return;  // after a refit; nothing crosses it
    sum_ ^= mixed(a + b) ^ mixed(b + c) ^ mixed(c + a);
  }

  std::vector<bool> seen_;
  std::uint64_t sum_ = 0;
};

// Looks at the first call of a tree only, for a warning that comes once.
template <class Tree>
bool found_holes(SharedTreeOf<Tree>& shared) {
  if (shared.looked_for_holes) return false;
  const bool found = query(shared, [](const Tree& tree) {
    EdgeParity edges;
    for (const LeafBlock<9>& block : tree.view().leaves) edges.add(block);
    return edges.is_odd();
  });
  return !std::exchange(shared.looked_for_holes, true) && found;
}

}  // namespace raylanes::python
