// The table of intersection tests: every ray–triangle, ray–box and ray–sphere test on arrays of primitives or
// of rays, one table per path. These are the bare loops: intersect.hpp adds any count, active masks and
// preparation, and is what most callers want.
//
// Common to all loops: n is a multiple of intersection_block (0 is allowed); pointers need the alignment of
// their type only; nothing outside the n elements is touched; outputs overlap nothing; MXCSR is neither read
// nor changed; no function throws or allocates. In the reproducible grade the results have the same bits on
// every path. A NaN in a ray or in a primitive is a miss and disturbs no other lane. A ray is missed by all
// if its origin or direction is not finite, its direction is zero, a bound is NaN, or tmin > tmax.
//
// Two queries:
//   any      yes or no, and nothing else: bit i % 8 of byte i / 8 is set where the test is a hit
//   closest  1 × N: the hit of least t, of equal ones the one of least index. N × 1: the hit of each ray.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <raylanes/types.hpp>

namespace raylanes {

inline constexpr std::size_t intersection_block = 16;

// Primitives as one array per number: a pointer per column, n elements each.
using Columns = const float* const*;

// Triangle tests. tmin <= t <= tmax; u, v >= 0 and u + v <= 1; all closed. Columns in brackets; v0, v1, v2
// are corners, e1 = v1 − v0, e2 = v2 − v0; three numbers each unless a single one is named.
//   plane_edges_plain  [v0 v1 v2]  plane, then three edge tests on the hit point, as a first program writes
//                      it: everything is computed for every triangle, with three square roots for u and v.
//                      Decisions wrong within about u·|o|·(distance / size): see `raylanes kernels`. Its edge
//                      tests multiply four lengths: for sizes and distances of 1e-8 … 1e8; with smaller ones
//                      products vanish and misses become hits, with larger ones u and v become NaN
//   plane_edges        [v0 v1 v2]  the same after its optimisation: t is rejected first, against the nearest
//                      hit so far; roots come after the last rejection, and there are two of them
//   moller_trumbore    [v0 v1 v2]  as TriangleTest::moller_trumbore, the same bits
//   moller_trumbore_edges  [v0 e1 e2]  the same from stored edges, the same bits
//   watertight         [v0 v1 v2]  as TriangleTest::watertight, the same bits. Where t overflows (directions
//                      near the least subnormal) a segment with tmax = +infinity holds t = +infinity
//   precomputed        [v0 n a b]  the map to barycentric coordinates, prepared (Baldwin, Weber 2016; Havel,
//                      Herout 2010), relative to the corner v0, so that distance from the scene's origin
//                      costs no accuracy: t = −n·s / n·d with s = o − v0, u and v = a and b · (s + t·d).
//                      Exact edge hits may go either way; leaks like moller_trumbore
//   directional        [v0 e1 e2 p det]  for rays that share one direction: p = d × e2 and det = e1 · p
//                      prepared for it, e1 and p with the sign of det; the same bits as moller_trumbore for
//                      rays of exactly that direction, no meaning for others. det is NaN where it was 0.
enum class TriangleForm : std::uint8_t {
  plane_edges_plain,
  plane_edges,
  moller_trumbore,
  moller_trumbore_edges,
  watertight,
  precomputed,
  directional
};
inline constexpr std::array<std::string_view, 7> triangle_form_names{
    "plane_edges_plain", "plane_edges", "moller_trumbore", "moller_trumbore_edges",
    "watertight",        "precomputed", "directional"};
inline constexpr std::array<std::size_t, 7> triangle_form_columns{9, 9, 9, 9, 9, 12, 13};
inline constexpr std::size_t max_triangle_columns = 13;

// What a closest hit consists of besides t and the primitive. What is not wanted is not computed.
//   normal  of the triangle, (v1 − v0) × (v2 − v0), not normalised
enum class Wanted : std::uint8_t { distance, weights, weights_and_normal };
inline constexpr std::array<std::string_view, 3> wanted_names{"distance", "weights", "weights_and_normal"};

// A miss is as Hit says, with a zero normal. What was not wanted is 0.
struct NearestHit {
  Hit hit;
  float normal[3];
};

// The hit of each ray; only the arrays of what is wanted are written, the others may be null. A ray that
// misses gets t = +infinity, hit = 0, zeros elsewhere; a hit has hit = 0xffffffff.
struct HitColumns {
  float* t;
  std::uint32_t* hit;
  float* u;
  float* v;
  float* normal[3];
};

// triangle: the columns of one triangle, as consecutive numbers.
struct TriangleLoops {
  void (*any_of_triangles)(const Ray& ray, Columns triangles, std::size_t n, std::uint8_t* bits);
  void (*any_of_rays)(const RayArrays& rays, std::size_t n, const float* triangle, std::uint8_t* bits);
  void (*closest_of_triangles[wanted_names.size()])(const Ray& ray, Columns triangles, std::size_t n,
                                                    NearestHit& out);
  void (*closest_of_rays[wanted_names.size()])(const RayArrays& rays, std::size_t n, const float* triangle,
                                               const HitColumns& out);
};

// Box tests by closed slabs; 0 <= tmin. Columns [lo hi]. A box with lo > hi on an axis or a NaN bound is
// missed; flat and infinite boxes are boxes. The 1 × N yes/no loop takes a box that is inverted by no more
// than rounding on the ray's major axis for a flat one; it wants the largest |direction| to be at least
// FLT_MIN.
//   conservative  (lo − o)·(1/d), the far distance widened by 1 + 6u (Ize 2013): no box that the exact ray
//                 meets is missed; the same decisions as BoxKernels
//   plain         the same without widening: boxes grazed within rounding may be missed (2–8 % of rays aimed
//                 at edges)
//   directional   lo·(1/d) − o·(1/d) as one multiply-add with prepared products. Padded by 8u·|o/d| and
//                 widened as conservative, so no false miss either, but false hits within 8u·|o| of a box.
//                 |d| < 2^-96 is taken for 2^-96 of its sign, with a slack of 2^40 in t: in a box that the
//                 ray is parallel to, t must stay below 2^40 (beyond, it may be missed), and |lo|, |hi|, |o|
//                 beyond 2^31 along that axis may cost false hits
enum class BoxTest : std::uint8_t { conservative, plain, directional };
inline constexpr std::array<std::string_view, 3> box_test_names{"conservative", "plain", "directional"};

// box: lo and hi as six consecutive numbers. Intervals are as BoxHitArrays says.
struct BoxLoops {
  void (*any_of_boxes)(const Ray& ray, Columns boxes, std::size_t n, std::uint8_t* bits);
  void (*any_of_rays)(const RayArrays& rays, std::size_t n, const float* box, std::uint8_t* bits);
  void (*interval_of_boxes)(const Ray& ray, Columns boxes, std::size_t n, const BoxHitArrays& out);
  void (*interval_of_rays)(const RayArrays& rays, std::size_t n, const float* box, const BoxHitArrays& out);
};

// Balls against segments, closed: a hit means that some point with tmin <= t <= tmax is in the ball. Columns
// [centre, radius²], the latter as signed_square of the radius: a negative radius is never hit, zero is a
// point, an overflow to infinity is all of space. The largest |direction| must be in [FLT_MIN, 2^126].
//   perpendicular  by the distance from the centre to the nearest point of the segment (Haines, Günther,
//                  Akenine-Möller 2019): wrong decisions only where |r² − l²| <= 64u·r·D, l the distance of
//                  the segment and D that of the origin from the centre; t within 16 ULP of (D + r)/|d| where
//                  r² − l² > r²/100: by the stable quotient, with D² − r² in double where it cancels, so that
//                  huge balls close by keep their t
//   textbook       b² − 4ac, for comparison: loses the decision from D/r of about 1000
enum class SphereTest : std::uint8_t { perpendicular, textbook };
inline constexpr std::array<std::string_view, 2> sphere_test_names{"perpendicular", "textbook"};

// The two distances at which the ray's line meets the sphere, near <= far, wherever tmin and tmax are: an
// origin inside has near < 0 < far. A miss has near = +infinity, far = −infinity, hit = 0.
struct SphereHitArrays {
  float* near;
  float* far;
  std::uint32_t* hit;
};

// sphere: centre and radius² as four consecutive numbers. The line loop takes the whole line for the segment
// and asks nothing else; it decides within the same bound as perpendicular, not with the same bits.
struct SphereLoops {
  void (*any_of_spheres)(const Ray& ray, Columns spheres, std::size_t n, std::uint8_t* bits);
  void (*any_of_rays)(const RayArrays& rays, std::size_t n, const float* sphere, std::uint8_t* bits);
  void (*distances_of_spheres)(const Ray& ray, Columns spheres, std::size_t n, const SphereHitArrays& out);
  void (*distances_of_rays)(const RayArrays& rays, std::size_t n, const float* sphere,
                            const SphereHitArrays& out);
};

struct TriangleTable {
  TriangleLoops form[triangle_form_names.size()][grade_names.size()];
  // From columns [v0 e1 e2] and a direction, for the form directional: out[0…2] = e1, out[3…5] = p,
  // out[6] = det; v0 and e2 are used as they are. n is any number. Fast: call it again when the light moves.
  void (*prepare_directional[grade_names.size()])(Columns edges, std::size_t n, const float* direction,
                                                  float* const* out);
};
struct BoxTable {
  BoxLoops test[box_test_names.size()][grade_names.size()];
};
struct SphereTable {
  SphereLoops test[sphere_test_names.size()][grade_names.size()];
  void (*line_of_spheres[grade_names.size()])(const Ray& ray, Columns spheres, std::size_t n,
                                              std::uint8_t* bits);
};

}  // namespace raylanes
