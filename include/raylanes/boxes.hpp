// Ray–box tests: one ray and many boxes, or many rays and one box.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <raylanes/types.hpp>

namespace raylanes {

/// How a ray is tested against a closed box, by slabs. tmin must be at least 0. u = 2^-24.
/// A box with lo > hi on an axis or a NaN bound is missed. Flat boxes and boxes with infinite bounds are boxes.
/// A ray misses every box if its origin or direction is not finite, its direction is zero, tmin or tmax is NaN, or
/// tmin > tmax.
enum class BoxTest : std::uint8_t {
  /// (lo − o)·(1/d) (Williams et al. 2005), the far distance widened by 1 + 2γ3 = 1 + 6u (Ize 2013, Pharr et al. 2016).
  /// No box is missed that the exact ray meets. A box that the ray passes within 14u of the exit may be reported.
  /// Entries are within 4u; exits exceed the exact ones by at most 12u. This holds if each component of the direction
  /// is zero or at least 2^-126 in size, and no difference of bound and origin overflows.
  conservative,
  /// The same without widening: boxes grazed within rounding may be missed (2–8 % of rays aimed at edges).
  plain,
  /// lo·(1/d) − o·(1/d) as one multiply-add with prepared products. It is padded by 8u·|o/d| and widened as
  /// conservative: no false miss, but false hits within 8u·|o| of a box. |d| < 2^-96 is taken for 2^-96 of its sign,
  /// with a slack of 2^40 in t. In a box that the ray is parallel to, t must stay below 2^40, or the box may be missed.
  /// |lo|, |hi| or |o| beyond 2^31 along that axis may cause false hits.
  directional
};

/// Facts about a test.
struct BoxTestInfo {
  BoxTest test;
  const char* name;
  int floats;  ///< how many floats of a box it reads: lo and hi
};
/// One row for each enumerator, in their order.
inline constexpr BoxTestInfo box_tests[] = {
    {BoxTest::conservative, "conservative", 6},
    {BoxTest::plain, "plain", 6},
    {BoxTest::directional, "directional", 6},
};

/// Options of the calls below.
using BoxOptions = CallOptions<BoxTest, BoxTest::conservative>;

// All calls here:
// - Sizes may be 0. Arrays need the alignment of a float. Outputs overlap no other array.
// - `bits` has (size + 7) / 8 bytes; spans of floats have one float for each element. Inactive elements are neither
//   read nor written.
// - In the grade reproducible the bits are the same on every ISA path.
// - Throws std::invalid_argument, before writing anything, if a span has another size, an enumerator does not exist,
//   or this machine lacks the path. Thread-safe.
// - Bits and bounds hold for rounding to nearest without FTZ and DAZ.

/// Sets bit i % 8 of bits[i / 8] to whether the ray hits box i.
/// The largest |direction| must be at least FLT_MIN. A box that is inverted by no more than rounding along the ray's
/// major axis may count as flat.
void hit_mask(const Ray& ray, const BoxArrays& boxes, std::span<std::uint8_t> bits,
              const BoxOptions& options = {});
/// Sets bit i % 8 of bits[i / 8] to whether ray i hits the box.
void hit_mask(const RayArrays& rays, const Box& box, std::span<std::uint8_t> bits,
              const BoxOptions& options = {});

/// Writes the bits of hit_mask(), and the part of [tmin, tmax] inside box i, from entry[i] to exit[i].
/// A miss has entry = +infinity and exit = −infinity. A hit has infinite ones only if tmin or tmax is infinite.
void intervals(const Ray& ray, const BoxArrays& boxes, std::span<std::uint8_t> bits, std::span<float> entry,
               std::span<float> exit, const BoxOptions& options = {});
/// Writes the bits of hit_mask(), and the part of ray i inside the box, from entry[i] to exit[i].
void intervals(const RayArrays& rays, const Box& box, std::span<std::uint8_t> bits, std::span<float> entry,
               std::span<float> exit, const BoxOptions& options = {});

}  // namespace raylanes
