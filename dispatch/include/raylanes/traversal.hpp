// How rays walk a tree.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace raylanes {

// How the rays of a batch share the lanes. Of several hits the nearest wins, of equal t the smallest primitive. The
// hits are the same in all modes for the test exact in both grades; for watertight in the grade reproducible, too,
// but for the rays that TriangleTree::closest() names. Any other test or grade promises each triangle's bounds alone:
// within rounding of an edge modes may decide otherwise, and any hit otherwise than the closest, some rays in a
// million. Seen from the side, or towards slivers, moller_trumbore and its kind also report hits of triangles that a
// ray passes at a distance. Trees do not visit most of these triangles: they report fewer of such hits than arrays do.
//   single  one ray against eight boxes or triangles at a time
//   packet  up to 512 rays, in any order, against frusta around them: rays that share the point where they begin, as
//           at a camera, or, asked only whether they hit, where they end, as at a light; or, asked for the nearest hit,
//           no point, but are neighbours, as behind a lens or all parallel. Rays that fit into no packet go as single
//           ones or, asked whether they hit, as streams; with tests but exact, watertight and moller_trumbore all rays
//           go as single ones, in this mode and those below.
//   stream  thousands of rays whose directions have the same signs, a list at each node: better where neighbours in the
//           batch have little in common, and from some thousands of rays on
//   automatic  packets from 64 rays that share a point on; else streams from 64 to 512 rays on, as the tree says.
//           Neighbours go as streams from 64 rays on, and as packets from 512 on if asked for the nearest hit
enum class TraversalMode : std::uint8_t { single, packet, stream, automatic };

inline constexpr std::array<std::string_view, 4> traversal_mode_names{"single", "packet", "stream",
                                                                      "automatic"};
inline constexpr std::size_t traversal_kernel_modes = 3;  // the first of them have kernels

// What walks have cost, added up. Rays are counted one by one, however many of them a register holds: a list of k
// rays that still take part makes k tests of a box. What that took is `registers`.
struct TraceCounters {
  std::uint64_t nodes = 0;           // visits of nodes with children, one of however many rays
  std::uint64_t leaves = 0;          // and of leaves
  std::uint64_t box_tests = 0;       // of a ray that comes to a node, and a child's box
  std::uint64_t triangle_tests = 0;  // of a ray that comes to a leaf, and a triangle
  std::uint64_t frustum_tests = 0;   // of a frustum around the rays of a packet, and a box or a triangle
  std::uint64_t registers = 0;  // of tests of these three kinds, full or not; other paths need more or less
  std::uint64_t hits =
      0;  // triangle tests that hit within what was left of the segment then, with certainty, by floats alone
  std::uint64_t undecided = 0;  // triangle tests that floats left undecided, of the exact test

  TraceCounters& operator+=(const TraceCounters& other) {
    nodes += other.nodes, leaves += other.leaves;
    box_tests += other.box_tests, triangle_tests += other.triangle_tests,
        frustum_tests += other.frustum_tests;
    registers += other.registers, hits += other.hits, undecided += other.undecided;
    return *this;
  }
  bool operator==(const TraceCounters&) const = default;
};

}  // namespace raylanes
