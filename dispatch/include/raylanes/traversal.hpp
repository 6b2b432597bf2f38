// How rays walk a tree.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace raylanes {

// How the rays of a batch share the lanes. The hits are the same: of several the nearest wins, of equal t the smallest
// primitive.
//   single  one ray against eight boxes or triangles at a time
//   packet  a register's worth of consecutive rays against one: better where neighbours in the batch are neighbours
//           in space. For exact, watertight and moller_trumbore; with other tests, and where rays do not agree in
//           major axis and signs of the direction, they are traced as single ones.
//   large_packet  up to 512 rays that share a point, in any order, against frusta around them: where they begin, as at
//           a camera, or, asked only whether they hit, where they end, as at a light; others go as single ones.
//   bundle  as large packets, of rays that share no point but are neighbours, in some order: for an area light, a lens
//   stream  thousands of rays whose directions have the same signs, a list at each node: better where neighbours in the
//           batch have little in common, from some thousands of rays on. Both are for the tests of packets.
//   automatic  large packets from 64 rays that share a point on; else packets, and bundles or streams from 512 rays on
enum class TraversalMode : std::uint8_t { single, packet, large_packet, bundle, stream, automatic };

inline constexpr std::array<std::string_view, 6> traversal_mode_names{"single", "packet", "large_packet",
                                                                      "bundle", "stream", "automatic"};
inline constexpr std::size_t traversal_kernel_modes = 5;  // the first of them have kernels

// What walks have cost, added up: visits of nodes and of leaves, triangles of those, and how many of them were hit
// within the segment left at that time. A packet's visit counts once, a triangle's hits once for each ray.
struct TraceCounters {
  std::uint64_t nodes = 0;
  std::uint64_t leaves = 0;
  std::uint64_t triangles = 0;
  std::uint64_t hits = 0;
};

}  // namespace raylanes
