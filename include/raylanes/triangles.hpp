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

/// How a ray is tested against a triangle. A hit has tmin <= t <= tmax with a finite t, u >= 0, v >= 0 and u + v <= 1,
/// boundaries included. If t overflows, the ray misses. A degenerate triangle is missed, and so is a triangle in whose
/// plane the ray lies. NaN or infinity in any input but tmin and tmax is a miss. u = 2^-24.
/// Trees take exact, watertight and moller_trumbore; arrays take every test. Brackets name what a test reads: corners
/// v0 v1 v2, edges e1 = v1 − v0 and e2 = v2 − v0, or prepared numbers.
enum class TriangleTest : std::uint8_t {
  /// [v0 v1 v2] Decides as exact arithmetic on the given floats does, for every finite input: no ray slips through a
  /// mesh, and no result depends on ISA path, grade, tree, mode or order. t, u and v are the exact values, rounded once
  /// (within 0.5 ULP). Floats decide behind a proved bound, doubles and then integers decide the rest (after Shewchuk
  /// 1997; the shear is that of Woop, Benthin, Wald 2013): docs/exact.md. Holds with FTZ and DAZ too: subnormal t, u,
  /// v, tmin and tmax then become zeros, and a direction of subnormals is a zero direction.
  exact,
  /// [v0 v1 v2] Canonical shear (Woop, Benthin, Wald 2013) with exact edge signs: no ray slips between two triangles
  /// that share an edge or a vertex. The grade reproducible recomputes a zero edge function in double; the grade fast
  /// uses Kahan determinants if the ISA path has FMA. For scenes of 1e-12 to 1e12 in size, and unit directions.
  watertight,
  /// [v0 v1 v2] Möller, Trumbore 1997, decided on scaled values, divided afterwards, without an epsilon. Decisions
  /// outside 7u(1+8u)·permanent of each determinant are exact. Up to a fifth of rays aimed exactly at edges leak.
  moller_trumbore,
  /// [v0 e1 e2] The arithmetic and bits of moller_trumbore, from stored edges.
  moller_trumbore_edges,
  /// [v0 n a b] A prepared map to barycentric coordinates (Baldwin, Weber 2016; Havel, Herout 2010), relative to v0, so
  /// that distance from the scene's origin costs no accuracy: t = −n·s / n·d with s = o − v0; u and v are a and b times
  /// (s + t·d). Exact edge hits go either way; leaks as moller_trumbore does.
  precomputed,
  /// [v0 e1 e2 p det] For rays that share one direction d: p = d × e2 and det = e1 · p are prepared, e1 and p with the
  /// sign of det. Rays of exactly that direction get the bits of moller_trumbore; results of other rays mean nothing. A
  /// det of 0 is stored as NaN.
  directional,
  /// [v0 v1 v2] The plane first, then three edge tests on the hit point, with two square roots for u and v. Decisions
  /// are wrong within about u·|o|·(distance / size). For sizes and distances of 1e-8 to 1e8: edge tests multiply four
  /// lengths, so smaller products vanish (misses become hits), larger ones make u and v NaN.
  plane_edges,
  /// [v0 v1 v2] The same as a first program writes it: computes everything for every triangle, with three square roots.
  plane_edges_plain
};

/// Facts about a test.
struct TriangleTestInfo {
  TriangleTest test;
  const char* name;
  int floats;                 ///< how many floats of a triangle it reads
  bool reads_corners = true;  ///< whether it reads corners: nothing has to be prepared
  bool serves_trees = true;   ///< whether trees take it; arrays take every test
};
/// One row for each enumerator, in their order.
inline constexpr TriangleTestInfo triangle_tests[] = {
    {TriangleTest::exact, "exact", 9},
    {TriangleTest::watertight, "watertight", 9},
    {TriangleTest::moller_trumbore, "moller_trumbore", 9},
    {TriangleTest::moller_trumbore_edges, "moller_trumbore_edges", 9, false, false},
    {TriangleTest::precomputed, "precomputed", 12, false, false},
    {TriangleTest::directional, "directional", 13, false, false},
    {TriangleTest::plane_edges, "plane_edges", 9, true, false},
    {TriangleTest::plane_edges_plain, "plane_edges_plain", 9, true, false},
};
/// The most floats that a test reads of a triangle.
inline constexpr std::size_t max_triangle_floats = 13;
/// Returns whether the test reads corners.
constexpr bool reads_corners(TriangleTest test) {
  return triangle_tests[static_cast<std::size_t>(test)].reads_corners;
}
/// Returns whether trees take the test.
constexpr bool serves_trees(TriangleTest test) {
  return triangle_tests[static_cast<std::size_t>(test)].serves_trees;
}
/// The names of the tests, by enumerator.
inline constexpr auto triangle_test_names = [] {
  std::array<std::string_view, std::size(triangle_tests)> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = triangle_tests[i].name;
  return names;
}();

/// The names of the tests that trees take, by enumerator: these come first.
inline constexpr std::array tree_test_names{triangle_test_names[0], triangle_test_names[1],
                                            triangle_test_names[2]};

/// Options of the calls below.
using TriangleOptions = CallOptions<TriangleTest, TriangleTest::exact>;

/// The arrays that closest_hits() writes. A miss has t = +infinity, u = v = 0 and a zero bit.
struct TriangleHits {
  std::span<std::uint8_t> bits;
  std::span<float> t;
  std::span<float> u, v;  ///< not computed if empty
};

// All calls here:
// - Sizes may be 0. Arrays need the alignment of a float. Outputs overlap no other array.
// - `bits` has (size + 7) / 8 bytes; spans of floats have one float for each element. Inactive elements are neither
//   read nor written.
// - In the grade reproducible the bits are the same on every ISA path.
// - Throws std::invalid_argument, before writing anything, if a span has another size, an enumerator does not exist,
//   or this machine lacks the path. Thread-safe.
// - Bits and bounds hold for rounding to nearest without FTZ and DAZ.
// - A test that reads other numbers than corners prepares them for this one call, with an allocation. To test the same
//   triangles again, keep a PreparedTriangles.

/// Returns the nearest hit of the ray; ties in t go to the lowest index.
/// Throws std::invalid_argument also for more than 2^32 − 1 triangles.
Hit closest_hit(const Ray& ray, const TriangleArrays& triangles, const TriangleOptions& options = {});

/// Sets bit i % 8 of bits[i / 8] to whether the ray hits triangle i.
void hit_mask(const Ray& ray, const TriangleArrays& triangles, std::span<std::uint8_t> bits,
              const TriangleOptions& options = {});

/// Tests each ray against one triangle, and writes its hit.
/// With TriangleTest::directional all active rays must have the same direction.
void closest_hits(const RayArrays& rays, const Triangle& triangle, const TriangleHits& hits,
                  const TriangleOptions& options = {});
/// Sets bit i % 8 of bits[i / 8] to whether ray i hits the triangle.
void hit_mask(const RayArrays& rays, const Triangle& triangle, std::span<std::uint8_t> bits,
              const TriangleOptions& options = {});

/// Returns (v1 − v0) × (v2 − v0), not normalised; every operation is rounded once, the same on every ISA path.
Float3 normal_of(const Triangle& triangle);

/// The numbers that a test reads of some triangles, prepared once for many calls.
/// Calls use the test, grade and path of `options`; options.active is ignored, because each call has its own. A
/// moved-from object holds no triangles.
class PreparedTriangles {
 public:
  /// Prepares the triangles. `direction` is that of all rays to come; only TriangleTest::directional reads it.
  /// Throws std::invalid_argument if the test does not exist or this machine lacks the path.
  explicit PreparedTriangles(const TriangleArrays& triangles, const TriangleOptions& options = {},
                             const Float3& direction = {});
  PreparedTriangles(const PreparedTriangles&) = default;
  PreparedTriangles(PreparedTriangles&& other) noexcept;
  /// Takes the triangles of another object.
  PreparedTriangles& operator=(PreparedTriangles other) noexcept;
  /// Prepares the same triangles for rays of another direction; does nothing unless the test is directional.
  void prepare(const Float3& direction);

  /// Returns the number of triangles.
  std::size_t size() const noexcept { return size_; }
  /// Returns the options that calls use.
  TriangleOptions options() const noexcept { return options_; }
  /// Returns float k of triangle i, as the test reads it; k < triangle_tests[test].floats.
  float number(std::size_t k, std::size_t i) const noexcept { return numbers_[k * size_ + i]; }

 private:
  friend Hit closest_hit(const Ray&, const PreparedTriangles&, LaneBits);
  friend void hit_mask(const Ray&, const PreparedTriangles&, std::span<std::uint8_t>, LaneBits);

  TriangleOptions options_;
  std::size_t size_;
  std::vector<float> numbers_;  // array after array
  std::vector<float> corners_;  // so too, for another direction
};

/// Returns the nearest hit of the ray among prepared triangles; ties in t go to the lowest index.
Hit closest_hit(const Ray& ray, const PreparedTriangles& triangles, LaneBits active = nullptr);
/// Sets bit i % 8 of bits[i / 8] to whether the ray hits prepared triangle i.
void hit_mask(const Ray& ray, const PreparedTriangles& triangles, std::span<std::uint8_t> bits,
              LaneBits active = nullptr);

}  // namespace raylanes
