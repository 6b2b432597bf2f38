// Ray–sphere tests: one ray and many spheres, or many rays and one sphere. Baseline code, thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <raylanes/types.hpp>

namespace raylanes {

// Balls against segments, closed: a hit means that some point with tmin <= t <= tmax is in the ball. A negative
// radius is never hit, zero is a point, one whose square overflows is all of space. The largest |direction| must be
// in [FLT_MIN, 2^126]. A NaN in a sphere is a miss; a ray is missed by all spheres if its origin or direction is
// not finite, its direction is zero, an end of its segment is NaN, or tmin > tmax. u = 2^-24.
//   perpendicular  by the distance from the centre to the nearest point of the segment (Haines, Günther,
//                  Akenine-Möller 2019): wrong decisions only where |r² − l²| <= 64u·r·D, l the distance of
//                  the segment and D that of the origin from the centre; t within 16 ULP of (D + r)/|d| where
//                  r² − l² > r²/100: by the stable quotient, with D² − r² in double where it cancels, so that
//                  huge balls close by keep their t
//   textbook       b² − 4ac, for comparison: loses the decision from D/r of about 1000
enum class SphereTest : std::uint8_t { perpendicular, textbook };

struct SphereTestInfo {
  SphereTest test;
  const char* name;
  int floats;  // the numbers it reads of a sphere: centre and radius²
};
// A row per enumerator, in their order.
inline constexpr SphereTestInfo sphere_tests[] = {
    {SphereTest::perpendicular, "perpendicular", 4},
    {SphereTest::textbook, "textbook", 4},
};

using SphereOptions = CallOptions<SphereTest, SphereTest::perpendicular>;

// Common to all calls: sizes may be zero; arrays need the alignment of a float; nothing is read or written but the
// active elements, and outputs overlap nothing. `bits` has (size + 7) / 8 bytes, spans of floats one number an element.
// Reproducible: the same bits on every path. Throws std::invalid_argument, before anything is written, for spans of
// other sizes, an enumerator that does not exist and a path that this machine lacks. Bits and bounds hold for rounding
// to nearest without FTZ and DAZ.

// Bit i % 8 of bits[i / 8]: whether sphere i, or the sphere by ray i, is hit.
void hit_mask(const Ray& ray, const SphereArrays& spheres, std::span<std::uint8_t> bits,
              const SphereOptions& options = {});
void hit_mask(const RayArrays& rays, const Sphere& sphere, std::span<std::uint8_t> bits,
              const SphereOptions& options = {});

// The nearest of the surfaces that the ray meets: t is the least distance in [tmin, tmax], of those that `distances`
// gives, and finite; of equal ones the sphere of least index is the hit. So a ray from inside hits where it leaves, and
// one that ends inside hits nothing, though hit_mask says yes. u = v = 0. More than 2^32 − 1 spheres are refused: Hit
// cannot name them.
Hit closest_hit(const Ray& ray, const SphereArrays& spheres, const SphereOptions& options = {});

// For each hit the two distances at which the ray's line meets the sphere, near <= far, wherever tmin and tmax are: an
// origin inside has near < 0 < far; all of space has −infinity and +infinity. A miss has near = +infinity,
// far = −infinity.
void distances(const Ray& ray, const SphereArrays& spheres, std::span<std::uint8_t> bits,
               std::span<float> near, std::span<float> far, const SphereOptions& options = {});
void distances(const RayArrays& rays, const Sphere& sphere, std::span<std::uint8_t> bits,
               std::span<float> near, std::span<float> far, const SphereOptions& options = {});

// Whether the whole line of a ray, of which hit_mask asks too, meets each sphere: the least arithmetic a sphere can be
// decided by. Wrong only where |r² − l²| <= 15u·l·D + 42u²·D². options.test is not looked at.
void line_hits(const Ray& ray, const SphereArrays& spheres, std::span<std::uint8_t> bits,
               const SphereOptions& options = {});

}  // namespace raylanes
