// Which sides of triangles share an edge: by the positions of its ends, bit for bit but for the sign of zero.
#pragma once

#include <raylanes/mesh.hpp>
#include <raylanes/numbers.hpp>
#include <raylanes/types.hpp>

#include "../../dispatch/bits.hpp"
#include "pulse.hpp"

namespace raylanes {

struct SideKey {
  std::uint64_t lo, hi;
};

inline bool same_high(const SideKey& a, const SideKey& b) {
  return a.hi == b.hi;
}
// Highway's sort of 128 bits gives up on processors without SSSE3.
inline void sort(std::vector<SideKey>& keys, Pulse& pulse) {
  std::sort(keys.begin(), keys.end(), [&](const SideKey& a, const SideKey& b) {
    pulse.step();
    return a.hi != b.hi ? a.hi < b.hi : a.lo < b.lo;
  });
}

// The steps of a pulse while numbers_of_positions() and sorted_sides() work, about.
inline double steps_of_edges(std::size_t vertices, std::size_t triangles) {
  const auto of_sort = [](double n) { return 1.1 * n * std::log2(n + 2); };
  return static_cast<double>(vertices) + of_sort(3.0 * static_cast<double>(triangles));
}

// Adding zero makes +0 of −0; by bits, because a mode may flush subnormal sums.
template <class T>
std::uint64_t bits_without_minus_zero(T x) {
  constexpr BitsOfNumber<T> minus_zero = ~(~BitsOfNumber<T>{0} >> 1);
  const auto bits = std::bit_cast<BitsOfNumber<T>>(x);
  return bits == minus_zero ? 0 : bits;
}

// The number of each distinct key, in the order in which keys come: a table of twice as many places at least, a power
// of two, looked through from a place that all bits of the key choose.
template <class Key>
class NumberTable {
 public:
  explicit NumberTable(std::size_t keys)
      : places_(std::bit_ceil(2 * keys + 1), none), mask_(places_.size() - 1) {}

  // is_same(i): whether key i, which was numbered before, is this one. Returns the number of the first such key, or
  // takes `number` for it.
  template <class IsSame>
  std::uint32_t first_of(const Key& key, std::uint32_t number, const IsSame& is_same) {
    std::uint64_t hash = 0;
    for (const std::uint64_t word : key) {
      hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
    for (std::size_t at = hash & mask_;; at = (at + 1) & mask_) {
      if (places_[at] == none) return places_[at] = number;
      if (is_same(places_[at])) return places_[at];
    }
  }

 private:
  static constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> places_;
  std::size_t mask_;
};

// A number for each vertex, the least of those at the same position.
template <class T>
std::vector<std::uint32_t> numbers_of_positions(const VertexRecords<T>& vertices, Pulse& pulse) {
  using Position = std::array<std::uint64_t, 3>;
  const auto position = [&](std::size_t i) {
    const PointOf<T> v = vertices[i];
    return Position{bits_without_minus_zero(v[0]), bits_without_minus_zero(v[1]),
                    bits_without_minus_zero(v[2])};
  };
  NumberTable<Position> table(vertices.count);
  std::vector<std::uint32_t> numbers(vertices.count);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    pulse.step();
    const Position at = position(i);
    numbers[i] = table.first_of(at, static_cast<std::uint32_t>(i),
                                [&](std::uint32_t before) { return position(before) == at; });
  }
  return numbers;
}

// Side k of a triangle goes from its corner k to the next one. Sides of the same edge come one behind the other, in the
// order of triangles; the lowest bit says in which direction.
inline SideKey side_key(std::uint32_t from, std::uint32_t to, std::size_t triangle, std::uint32_t side) {
  return {std::uint64_t{triangle} << 3 | side << 1 | (from < to ? 1u : 0u),
          std::uint64_t{std::min(from, to)} << 32 | std::max(from, to)};
}

// The sides of triangles whose corners have so many numbers, sorted; triangles with two equal corners have none, and
// are counted.
template <class CornersOf>
std::vector<SideKey> sorted_sides(std::size_t triangles, const CornersOf& corners_of, std::size_t& degenerate,
                                  Pulse& pulse) {
  std::vector<SideKey> sides;
  sides.reserve(3 * triangles);
  for (std::size_t i = 0; i < triangles; ++i) {
    const Index3 corner = corners_of(i);
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) {
      ++degenerate;
      continue;
    }
    for (std::uint32_t side = 0; side < 3; ++side)
      sides.push_back(side_key(corner[side], corner[(side + 1) % 3], i, side));
  }
  sort(sides, pulse);
  return sides;
}

// Calls take(first key, number of sides, how many go from the lower number to the higher one) for each edge.
template <class Take>
void each_edge(const std::vector<SideKey>& sides, const Take& take) {
  for (std::size_t begin = 0, end; begin < sides.size(); begin = end) {
    std::size_t forward = 0;
    for (end = begin; end < sides.size() && same_high(sides[begin], sides[end]); ++end)
      forward += sides[end].lo & 1u;
    take(sides[begin], end - begin, forward);
  }
}

}  // namespace raylanes
