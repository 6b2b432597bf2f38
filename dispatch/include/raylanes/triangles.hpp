// Ray–triangle tests.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <raylanes/types.hpp>

namespace raylanes {

// Ray–triangle tests. A hit is tmin <= t <= tmax with u, v >= 0, u + v <= 1, all closed. A degenerate
// triangle, a ray in the triangle's plane, and any NaN or infinity among the inputs other than tmin and
// tmax is a miss.
//   watertight       canonical shear (Woop, Benthin, Wald 2013) with exact edge signs: no ray slips between
//                    two triangles that share an edge or a vertex, in either grade. Reproducible: a zero edge
//                    function is decided again in double. Fast: Kahan determinants where the path has FMA.
//                    Usable scene scale 1e-12 … 1e12 with unit directions.
//   moller_trumbore  Möller, Trumbore 1997, decided on scaled values, divided afterwards; no epsilon.
//                    Decisions outside 7u(1+8u)·permanent of each determinant are exact (u = 2^-24); leaks up to a
//                    fifth of rays aimed exactly at edges.
enum class TriangleTest : std::uint8_t { watertight, moller_trumbore };
inline constexpr std::array<std::string_view, 2> triangle_test_names{"watertight", "moller_trumbore"};

}  // namespace raylanes
