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

struct BoxTable {
  BoxLoops test[box_test_names.size()][grade_names.size()];
};
struct SphereTable {
  SphereLoops test[sphere_test_names.size()][grade_names.size()];
  void (*line_of_spheres[grade_names.size()])(const Ray& ray, Columns spheres, std::size_t n,
                                              std::uint8_t* bits);
};

}  // namespace raylanes
