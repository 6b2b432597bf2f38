// Questions beyond the nearest hit: all hits along a ray, passages through surfaces, which points are inside. All by
// the exact test, so that none needs an epsilon. docs/crossings.md has the definitions and the reasons.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <raylanes/mesh.hpp>
#include <raylanes/rays.hpp>
#include <raylanes/traversal.hpp>

namespace raylanes {

struct Path;

struct ListOptions {
  // Of each ray only the first ones in the order of its list. Up to 64 shorten the search.
  std::uint32_t max_count = 0xffffffffu;
  const Path* path = nullptr;  // these as of TraceOptions
  int threads = 1;
  LaneBits active = nullptr;          // rays that take no part have empty lists
  TraceCounters* counters = nullptr;  // those of rays alone, which go so then; sorting is not counted
};

// What belongs to some rays, ray by ray.
template <class Item>
struct RayLists {
  std::vector<std::size_t> offsets{
      0};  // where each ray's items begin, and the end of the last: one more than rays
  std::vector<Item> items;

  std::size_t size() const { return offsets.size() - 1; }
  std::span<const Item> operator[](std::size_t ray) const {
    return std::span<const Item>(items).subspan(offsets[ray], offsets[ray + 1] - offsets[ray]);
  }
};

// A passage through a surface.
struct Crossing {
  float t;                  // the exact quotient, rounded once
  std::uint32_t primitive;  // the triangle
  std::int32_t
      side;  // 1: along its normal (v1 − v0) × (v2 − v0), out of a solid whose normals point out; −1: against it

  bool operator==(const Crossing&) const = default;
};

// Says which hits do not count, a batch of them at a time: hits[k] is that of ray rays[k] of the call, rejected[k], 0
// before, becomes 1 if the ray is to go on behind it. Called by the thread that asked, with all hits first, then with
// those that came up behind rejected ones, nearer ones of a ray first, each once. What it throws passes through.
using HitFilter = std::function<void(std::span<const std::size_t> rays, std::span<const Hit> hits,
                                     std::span<std::uint8_t> rejected)>;

// A hit counts if ray and triangle have a bit in common. As many masks as rays of the call, and as triangles of the
// mesh; both outlive the filter.
inline HitFilter mask_filter(std::span<const std::uint32_t> of_rays,
                             std::span<const std::uint32_t> of_triangles) {
  return [=](std::span<const std::size_t> rays, std::span<const Hit> hits, std::span<std::uint8_t> rejected) {
    for (std::size_t k = 0; k < rays.size(); ++k)
      rejected[k] = (of_rays[rays[k]] & of_triangles[hits[k].primitive]) == 0 ? 1 : 0;
  };
}

// Where a point is. `on`: on a triangle, exactly; triangles without an area hold no point.
enum class Location : std::uint8_t { outside, inside, on };
inline constexpr std::array<std::string_view, 3> location_names{"outside", "inside", "on"};

// When a point is inside: if a ray from it has crossings odd in number, or the sum of their sides is not zero.
// The second is for solids that overlap, or are nested with normals that all point out; a shell that bounds a hole
// points into it. Of one closed surface that does not intersect itself both say the same.
//   vote  for meshes with holes, of which the others depend on the direction: the six rays along the axes, both ways,
//         have a vote each by parity, and a point is inside if four or more say so; three against three is outside. Of
//         a closed mesh all six say the same, at up to six times the cost.
enum class InsideRule : std::uint8_t { parity, nonzero, vote };
inline constexpr std::array<std::string_view, 3> inside_rule_names{"parity", "nonzero", "vote"};

struct LocateOptions {
  InsideRule rule = InsideRule::parity;
  const Path* path = nullptr;  // these as of TraceOptions
  int threads = 1;
  LaneBits active = nullptr;  // locations of points that take no part are left alone
  TraceCounters* counters = nullptr;
};

// Of signed_distances(). Points farther away than max_distance get an infinity, of their side's sign: the narrower the
// band the faster. NaN and negative numbers leave but the sides.
struct SignedDistanceOptions {
  InsideRule rule = InsideRule::parity;
  float max_distance = std::numeric_limits<float>::infinity();  // as of PointOptions
  const Path* path = nullptr;                                   // these as of TraceOptions
  int threads = 1;
  LaneBits active = nullptr;          // distances of points that take no part are left alone
  TraceCounters* counters = nullptr;  // of both searches
};

}  // namespace raylanes
