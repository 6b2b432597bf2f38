// Ray–triangle tests.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <raylanes/types.hpp>

namespace raylanes {

// A hit is tmin <= t <= tmax with a finite t, u, v >= 0 and u + v <= 1, all closed: where t overflows it is a miss,
// also if tmax = +infinity. A degenerate triangle, a ray in the triangle's plane, and any NaN or infinity among the
// inputs other than tmin and tmax is a miss. u = 2^-24. Each test names the numbers it reads of a triangle: v0, v1,
// v2 are corners, e1 = v1 − v0, e2 = v2 − v0; three numbers each unless a single one is named. Tests that read
// corners work on meshes as they are, the others on numbers that were prepared from them.
//   watertight       [v0 v1 v2]  canonical shear (Woop, Benthin, Wald 2013) with exact edge signs: no ray slips
//                    between two triangles that share an edge or a vertex, in either grade. Reproducible: a zero
//                    edge function is decided again in double. Fast: Kahan determinants where the path has FMA.
//                    Usable scene scale 1e-12 … 1e12 with unit directions.
//   moller_trumbore  [v0 v1 v2]  Möller, Trumbore 1997, decided on scaled values, divided afterwards; no epsilon.
//                    Decisions outside 7u(1+8u)·permanent of each determinant are exact; leaks up to a fifth of
//                    rays aimed exactly at edges.
//   moller_trumbore_edges  [v0 e1 e2]  the same from stored edges, the same bits
//   precomputed      [v0 n a b]  the map to barycentric coordinates, prepared (Baldwin, Weber 2016; Havel, Herout
//                    2010), relative to the corner v0, so that distance from the scene's origin costs no
//                    accuracy: t = −n·s / n·d with s = o − v0, u and v = a and b · (s + t·d). Exact edge hits may
//                    go either way; leaks like moller_trumbore
//   directional      [v0 e1 e2 p det]  for rays that share one direction: p = d × e2 and det = e1 · p prepared
//                    for it, e1 and p with the sign of det; the same bits as moller_trumbore for rays of exactly
//                    that direction, no meaning for others. det is NaN where it was 0.
//   plane_edges      [v0 v1 v2]  plane, then three edge tests on the hit point: t is rejected first, against the
//                    nearest hit so far; roots come after the last rejection, and there are two of them. Decisions
//                    wrong within about u·|o|·(distance / size): see `raylanes kernels`. Its edge tests multiply
//                    four lengths: for sizes and distances of 1e-8 … 1e8; with smaller ones products vanish and
//                    misses become hits, with larger ones u and v become NaN
//   plane_edges_plain  [v0 v1 v2]  the same as a first program writes it: everything is computed for every
//                    triangle, with three square roots for u and v
enum class TriangleTest : std::uint8_t {
  watertight,
  moller_trumbore,
  moller_trumbore_edges,
  precomputed,
  directional,
  plane_edges,
  plane_edges_plain
};

struct TriangleTestInfo {
  TriangleTest test;
  const char* name;
  int floats;  // the numbers it reads of a triangle
};
// A row per enumerator, in their order.
inline constexpr TriangleTestInfo triangle_tests[] = {
    {TriangleTest::watertight, "watertight", 9},
    {TriangleTest::moller_trumbore, "moller_trumbore", 9},
    {TriangleTest::moller_trumbore_edges, "moller_trumbore_edges", 9},
    {TriangleTest::precomputed, "precomputed", 12},
    {TriangleTest::directional, "directional", 13},
    {TriangleTest::plane_edges, "plane_edges", 9},
    {TriangleTest::plane_edges_plain, "plane_edges_plain", 9},
};
inline constexpr std::size_t most_triangle_floats = 13;

// Those that trees offer.
inline constexpr std::array<std::string_view, 2> triangle_test_names{"watertight", "moller_trumbore"};

}  // namespace raylanes
