// Ray–sphere tests: one ray and many spheres, or many rays and one sphere.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <raylanes/types.hpp>

namespace raylanes {

/// How a ray segment is tested against a closed ball. A hit means that a point with tmin <= t <= tmax is in the ball.
/// A sphere of negative radius is never hit; radius 0 is a point; a radius whose square overflows is all of space.
/// A sphere with a NaN is missed. The largest |direction| must be in [FLT_MIN, 2^126]. u = 2^-24.
/// A ray misses every sphere if its origin or direction is not finite, its direction is zero, tmin or tmax is NaN, or
/// tmin > tmax.
enum class SphereTest : std::uint8_t {
  /// By the distance from the centre to the nearest point of the segment (Haines, Günther, Akenine-Möller 2019).
  /// With l that distance and D the distance of origin and centre, decisions are wrong only if |r² − l²| <= 64u·r·D.
  /// If r² − l² > r²/100, t is within 16 ULP of (D + r)/|d|: the stable quotient, with D² − r² in double where it
  /// cancels, so that huge spheres close by keep their t.
  perpendicular,
  /// b² − 4ac, for comparison: decisions are lost from D/r of about 1000.
  textbook
};

/// Facts about a test.
struct SphereTestInfo {
  SphereTest test;
  const char* name;
  int floats;  ///< how many floats of a sphere it reads: centre and radius²
};
/// One row for each enumerator, in their order.
inline constexpr SphereTestInfo sphere_tests[] = {
    {SphereTest::perpendicular, "perpendicular", 4},
    {SphereTest::textbook, "textbook", 4},
};

/// Options of the calls below.
using SphereOptions = CallOptions<SphereTest, SphereTest::perpendicular>;

// All calls here:
// - Sizes may be 0. Arrays need the alignment of a float. Outputs overlap no other array.
// - `bits` has (size + 7) / 8 bytes; spans of floats have one float for each element. Inactive elements are neither
//   read nor written.
// - In the grade reproducible the bits are the same on every ISA path.
// - Throws std::invalid_argument, before writing anything, if a span has another size, an enumerator does not exist,
//   or this machine lacks the path. Thread-safe.
// - Bits and bounds hold for rounding to nearest without FTZ and DAZ.

/// Sets bit i % 8 of bits[i / 8] to whether the ray hits sphere i.
void hit_mask(const Ray& ray, const SphereArrays& spheres, std::span<std::uint8_t> bits,
              const SphereOptions& options = {});
/// Sets bit i % 8 of bits[i / 8] to whether ray i hits the sphere.
void hit_mask(const RayArrays& rays, const Sphere& sphere, std::span<std::uint8_t> bits,
              const SphereOptions& options = {});

/// Returns the nearest surface that the ray meets: the least finite t of distances() in [tmin, tmax].
/// Ties in t go to the lowest index; u = v = 0. A ray that begins inside a sphere hits it where it leaves. A ray that
/// begins and ends inside a sphere does not hit its surface, although hit_mask() reports the ball.
/// Throws std::invalid_argument also for more than 2^32 − 1 spheres.
Hit closest_hit(const Ray& ray, const SphereArrays& spheres, const SphereOptions& options = {});

/// Writes the bits of hit_mask(), and for each hit where the ray's line enters and leaves sphere i: near[i] <= far[i].
/// The distances do not depend on tmin and tmax: an origin inside has near < 0 < far. A sphere that is all of space has
/// −infinity and +infinity. A miss has near = +infinity and far = −infinity.
void distances(const Ray& ray, const SphereArrays& spheres, std::span<std::uint8_t> bits,
               std::span<float> near, std::span<float> far, const SphereOptions& options = {});
/// Writes the bits of hit_mask(), and for each hit where the line of ray i enters and leaves the sphere.
void distances(const RayArrays& rays, const Sphere& sphere, std::span<std::uint8_t> bits,
               std::span<float> near, std::span<float> far, const SphereOptions& options = {});

/// Sets bit i % 8 of bits[i / 8] to whether the infinite line of the ray meets sphere i; options.test is ignored.
/// This is the least arithmetic that decides a sphere. It is wrong only if |r² − l²| <= 15u·l·D + 42u²·D².
void line_hits(const Ray& ray, const SphereArrays& spheres, std::span<std::uint8_t> bits,
               const SphereOptions& options = {});

}  // namespace raylanes
