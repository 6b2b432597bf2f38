#include <algorithm>
#include <bit>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <raylanes/closed_mesh.hpp>

namespace raylanes {
namespace {

struct Key {
  std::uint64_t lo, hi;
};

bool same_high(const Key& a, const Key& b) {
  return a.hi == b.hi;
}
// Highway's sort of 128 bits gives up on processors without SSSE3.
void sort(std::vector<Key>& keys) {
  std::sort(keys.begin(), keys.end(),
            [](const Key& a, const Key& b) { return a.hi != b.hi ? a.hi < b.hi : a.lo < b.lo; });
}

// Adding zero makes +0 of −0; by bits, because a mode may flush subnormal sums.
std::uint32_t bits_of(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return bits == 0x80000000u ? 0u : bits;
}

// A number for each vertex, the same for those at the same position: by x and y, then those by z.
std::vector<std::uint32_t> numbers_of_positions(const VertexView& vertices) {
  std::vector<Key> keys(vertices.count);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Float3 v = vertices[i];
    keys[i] = {std::uint64_t{bits_of(v[2])} << 32 | i, std::uint64_t{bits_of(v[0])} << 32 | bits_of(v[1])};
  }
  sort(keys);
  std::vector<std::uint32_t> numbers(keys.size());
  for (std::size_t i = 0, first = 0; i < keys.size(); ++i) {
    if (!same_high(keys[i], keys[first]) || keys[i].lo >> 32 != keys[first].lo >> 32) first = i;
    numbers[static_cast<std::uint32_t>(keys[i].lo)] = static_cast<std::uint32_t>(keys[first].lo);
  }
  return numbers;
}

// Side k of a triangle goes from its corner k to the next one. Sides of the same edge come one behind the other, in the
// order of triangles; the lowest bit says in which direction.
Key key_of(std::uint32_t from, std::uint32_t to, std::size_t triangle, std::uint32_t side) {
  return {std::uint64_t{triangle} << 3 | side << 1 | (from < to ? 1u : 0u),
          std::uint64_t{std::min(from, to)} << 32 | std::max(from, to)};
}

class Edges {
 public:
  Edges(const VertexView& vertices, const IndexView& triangles) : triangles_(triangles) {
    const std::vector<std::uint32_t> number = numbers_of_positions(vertices);
    sides_.reserve(3 * triangles.count);
    for (std::size_t i = 0; i < triangles.count; ++i) {
      const Index3 t = triangles[i];
      const std::uint32_t corner[3] = {number[t[0]], number[t[1]], number[t[2]]};
      if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) {
        ++report_.degenerate;
        continue;
      }
      for (std::uint32_t side = 0; side < 3; ++side)
        sides_.push_back(key_of(corner[side], corner[(side + 1) % 3], i, side));
    }
    sort(sides_);
  }

  ClosedReport report(std::size_t max_listed) {
    for (std::size_t begin = 0, end; begin < sides_.size(); begin = end) {
      std::size_t forward = 0;
      for (end = begin; end < sides_.size() && same_high(sides_[begin], sides_[end]); ++end)
        forward += sides_[end].lo & 1u;
      look_at(sides_[begin], end - begin, forward);
    }
    const auto listed = static_cast<std::ptrdiff_t>(std::min(max_listed, faulty_.size()));
    std::partial_sort(faulty_.begin(), faulty_.begin() + listed, faulty_.end(),
                      [](const Fault& a, const Fault& b) { return a.side < b.side; });
    for (auto fault = faulty_.begin(); fault != faulty_.begin() + listed; ++fault) list(*fault);
    return std::move(report_);
  }

 private:
  struct Fault {
    std::uint64_t side;  // the lower half of its key
    EdgeFault fault;
  };

  void look_at(const Key& first, std::size_t count, std::size_t forward) {
    ++report_.edges;
    if (count == 2 && forward == 1) return;
    const EdgeFault fault = count % 2 != 0         ? EdgeFault::open
                            : 2 * forward != count ? EdgeFault::inconsistent
                                                   : EdgeFault::shared;
    ++(fault == EdgeFault::open           ? report_.open
       : fault == EdgeFault::inconsistent ? report_.inconsistent
                                          : report_.shared);
    faulty_.push_back({first.lo, fault});
  }

  void list(const Fault& fault) {
    const auto triangle = static_cast<std::uint32_t>(fault.side >> 3);
    const std::size_t side = fault.side >> 1 & 3u;
    const Index3 t = triangles_[triangle];
    report_.first.push_back({fault.fault, triangle, t[side], t[(side + 1) % 3]});
  }

  const IndexView& triangles_;
  std::vector<Key> sides_;
  std::vector<Fault> faulty_;
  ClosedReport report_;
};

}  // namespace

ClosedReport closed_report(VertexView vertices, IndexView triangles, std::size_t max_listed) {
  validate_mesh(vertices, triangles);
  if (vertices.count > 0xffffffffu || triangles.count >= std::size_t{1} << 30)
    throw std::invalid_argument("closed_report: " + std::to_string(vertices.count) + " vertices and " +
                                std::to_string(triangles.count) +
                                " triangles, allowed are less than 2^32 and 2^30");
  return Edges(vertices, triangles).report(max_listed);
}

}  // namespace raylanes
