// How rays traverse a tree, and what that costs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace raylanes {

/// How the rays of a batch share a vector. Ties in t go to the lowest primitive index.
/// With TriangleTest::exact all modes return the same hits, in both grades. With watertight in the grade reproducible
/// they do too, but for the rays that TriangleTree::closest() names. Other tests and grades promise each triangle's
/// bounds: within rounding of an edge modes may decide otherwise, and occluded() otherwise than closest(), for some
/// rays in a million. Seen from the side, or towards slivers, moller_trumbore and its kind also report hits of
/// triangles that a ray passes at a distance. Trees do not visit most of these triangles: they report fewer such hits.
enum class TraversalMode : std::uint8_t {
  /// One ray against eight boxes or triangles at a time. In large trees some rays of a batch take turns, so that while
  /// one waits for memory the others go on.
  single,
  /// Up to 512 rays, in any order, against frusta around them. The rays share an origin, as at a camera; or an end, if
  /// only occlusion is asked for, as at a light; or are neighbours, if the nearest hit is asked for. Rays that fit into
  /// no packet are traced as single ones, or as streams if only occlusion is asked for.
  packet,
  /// Thousands of rays whose directions have the same signs, as a list at each node: faster if neighbours in the batch
  /// have little in common, from some thousands of rays on.
  stream,
  /// Packets from 64 rays on that share a point, and from 512 neighbours on if the nearest hit is asked for, where rays
  /// are dense: a few of them say how large the triangles are that rays meet, against the distance of rays there.
  /// Otherwise streams, from 64 to 512 rays on, as the tree decides, and neighbours from 64 on; but single rays where
  /// many triangles lie between one ray and the next.
  automatic
};

/// The names of the modes, by enumerator.
inline constexpr std::array<std::string_view, 4> traversal_mode_names{"single", "packet", "stream",
                                                                      "automatic"};
/// How many modes have kernels of their own: all but automatic, the last.
inline constexpr std::size_t traversal_kernel_modes = 3;

/// The sides from which a ray hits triangles.
/// With n = (v1 − v0) × (v2 − v0), a ray of direction d hits the front if d · n < 0, and the back if d · n > 0. The
/// sign is that of exact arithmetic on the given floats. If d · n = 0, the ray is parallel to the triangle and misses.
enum class Facing : std::uint32_t {
  any,  ///< Both sides.
  front,  ///< The side from which v0, v1, v2 run counter-clockwise: a ray enters a solid whose normals point outwards.
  back  ///< The other side: a ray leaves such a solid.
};

/// The names of the sides, by enumerator.
inline constexpr std::array<std::string_view, 3> facing_names{"any", "front", "back"};

/// The cost of traversals, added up. Tests are counted for each ray: k active rays against a box are k box tests, and
/// ceil(k / lanes) vectors.
struct TraceCounters {
  std::uint64_t nodes = 0;           ///< visits of inner nodes, each by any number of rays
  std::uint64_t leaves = 0;          ///< visits of leaves
  std::uint64_t box_tests = 0;       ///< tests of a ray and a child's box
  std::uint64_t triangle_tests = 0;  ///< tests of a ray and a triangle
  std::uint64_t frustum_tests = 0;   ///< tests of a packet's frustum and a box or triangle
  std::uint64_t registers = 0;       ///< vectors that these tests took, full or not; depends on the ISA path
  std::uint64_t hits = 0;       ///< triangle tests that floats decided as hits within the remaining segment
  std::uint64_t undecided = 0;  ///< triangle tests of TriangleTest::exact that floats left undecided

  /// Adds the counts of another traversal.
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
