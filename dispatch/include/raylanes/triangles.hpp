// Ray–triangle tests.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>
#include <vector>

#include <raylanes/types.hpp>

namespace raylanes {

// A hit is tmin <= t <= tmax with a finite t, u, v >= 0 and u + v <= 1, all closed: where t overflows it is a miss,
// also if tmax = +infinity. A degenerate triangle, a ray in the triangle's plane, and any NaN or infinity among the
// inputs other than tmin and tmax is a miss. u = 2^-24. Each test names the numbers it reads of a triangle: v0, v1,
// v2 are corners, e1 = v1 − v0, e2 = v2 − v0; three numbers each unless a single one is named. Tests that read
// corners work on meshes as they are, the others on numbers that were prepared from them.
//   exact            [v0 v1 v2]  hit or miss is what exact arithmetic on the floats says, for every finite input: no
//                    ray slips through a mesh, and no answer depends on path, grade, tree, mode or order. t, u and v
//                    are the exact values, rounded once to nearest (within 0.5 ULP). Floats decide behind a proved
//                    bound, doubles and then integers the rest (after Shewchuk 1997; the shear is that
//                    of Woop, Benthin, Wald 2013): docs/exact.md. Holds with FTZ and DAZ too, where subnormal t, u
//                    and v become zeros, as do ends of the segment, and a direction of subnormals is none.
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
  exact,
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
  int floats;                 // the numbers it reads of a triangle
  bool reads_corners = true;  // so that any tree and any array serves it; else they are prepared from corners
  bool serves_trees = true;   // else it is a test of arrays: trees serve rays of any direction
};
// A row per enumerator, in their order.
inline constexpr TriangleTestInfo triangle_tests[] = {
    {TriangleTest::exact, "exact", 9},
    {TriangleTest::watertight, "watertight", 9},
    {TriangleTest::moller_trumbore, "moller_trumbore", 9},
    {TriangleTest::moller_trumbore_edges, "moller_trumbore_edges", 9, false},
    {TriangleTest::precomputed, "precomputed", 12, false},
    {TriangleTest::directional, "directional", 13, false, false},
    {TriangleTest::plane_edges, "plane_edges", 9},
    {TriangleTest::plane_edges_plain, "plane_edges_plain", 9},
};
inline constexpr std::size_t max_triangle_floats = 13;
constexpr bool reads_corners(TriangleTest test) {
  return triangle_tests[static_cast<std::size_t>(test)].reads_corners;
}
constexpr bool serves_trees(TriangleTest test) {
  return triangle_tests[static_cast<std::size_t>(test)].serves_trees;
}
inline constexpr auto triangle_test_names = [] {
  std::array<std::string_view, std::size(triangle_tests)> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = triangle_tests[i].name;
  return names;
}();

using TriangleOptions = CallOptions<TriangleTest, TriangleTest::exact>;

// Where the hits of rays go. A ray that misses gets t = +infinity, u = v = 0 and a zero bit.
struct TriangleHits {
  std::span<std::uint8_t> bits;
  std::span<float> t;
  std::span<float> u, v;  // may be empty: not computed
};

// Common to all calls: sizes may be zero; arrays need the alignment of a float; nothing is read or written but the
// active elements, and outputs overlap nothing. `bits` has (size + 7) / 8 bytes, spans of floats one per element.
// Reproducible: the same bits on every path. Throws std::invalid_argument, before anything is written, for spans of
// other sizes, an enumerator that does not exist and a path that this machine lacks. Thread-safe. Bits and bounds hold
// for rounding to nearest without FTZ and DAZ.
//
// Tests that read other numbers than corners prepare them here for the one call, with an allocation: keep
// PreparedTriangles where the same triangles are tested again.

// The hit of least t, of equal ones the one of least index. More than 2^32 − 1 triangles are refused: Hit cannot name
// them.
Hit closest_hit(const Ray& ray, const TriangleArrays& triangles, const TriangleOptions& options = {});

// Bit i % 8 of bits[i / 8]: whether triangle i is hit.
void hit_mask(const Ray& ray, const TriangleArrays& triangles, std::span<std::uint8_t> bits,
              const TriangleOptions& options = {});

// The same for each of many rays and one triangle. directional: all active rays have the direction of the first of
// them.
void closest_hits(const RayArrays& rays, const Triangle& triangle, const TriangleHits& hits,
                  const TriangleOptions& options = {});
void hit_mask(const RayArrays& rays, const Triangle& triangle, std::span<std::uint8_t> bits,
              const TriangleOptions& options = {});

// (v1 − v0) × (v2 − v0), not normalised; each operation rounded once, the same on every path.
Float3 normal_of(const Triangle& triangle);

// The numbers that options.test reads of some triangles, kept; options.path and options.grade are those of the calls
// too. options.active is not looked at: each call has its own. Moved from, they are none.
class PreparedTriangles {
 public:
  // `direction` is that of all rays to come; only the test directional looks at it.
  explicit PreparedTriangles(const TriangleArrays& triangles, const TriangleOptions& options = {},
                             const Float3& direction = {});
  PreparedTriangles(const PreparedTriangles&) = default;
  PreparedTriangles(PreparedTriangles&& other) noexcept;
  PreparedTriangles& operator=(PreparedTriangles other) noexcept;
  // The same triangles for rays of another direction; does nothing for other tests than directional.
  void prepare(const Float3& direction);

  std::size_t size() const noexcept { return size_; }
  const TriangleOptions& options() const noexcept { return options_; }
  // Number k of triangle i, as the test reads it: k < triangle_tests[test].floats.
  float number(std::size_t k, std::size_t i) const noexcept { return numbers_[k * size_ + i]; }

 private:
  friend Hit closest_hit(const Ray&, const PreparedTriangles&, LaneBits);
  friend void hit_mask(const Ray&, const PreparedTriangles&, std::span<std::uint8_t>, LaneBits);

  TriangleOptions options_;
  std::size_t size_;
  std::vector<float> numbers_;  // array after array
  std::vector<float> corners_;  // so too, for another direction
};

// As above, with the test, grade and path of the prepared triangles.
Hit closest_hit(const Ray& ray, const PreparedTriangles& triangles, LaneBits active = nullptr);
void hit_mask(const Ray& ray, const PreparedTriangles& triangles, std::span<std::uint8_t> bits,
              LaneBits active = nullptr);

}  // namespace raylanes
