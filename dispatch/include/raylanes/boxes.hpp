// Ray–box tests: one ray and many boxes, or many rays and one box. Baseline code, thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <raylanes/types.hpp>

namespace raylanes {

// By closed slabs; 0 <= tmin. A box with lo > hi on an axis or a NaN bound is missed; flat and infinite boxes are
// boxes. A ray is missed by all boxes if its origin or direction is not finite, its direction is zero, an end of
// its segment is NaN, or tmin > tmax. u = 2^-24.
//   conservative  (lo − o)·(1/d) (Williams et al. 2005), the far distance widened by 1 + 2γ3 = 1 + 6u (Ize 2013,
//                 Pharr et al. 2016): no box that the exact ray meets is missed; one that it passes within 14u of
//                 the exit may be reported. Entries are within 4u, exits beyond theirs by at most 12u. This holds
//                 where each component of the direction is zero, of either sign, or at least 2^-126 in size, so
//                 that its reciprocal is finite, and where no difference of bound and origin overflows
//   plain         the same without widening: boxes grazed within rounding may be missed (2–8 % of rays aimed
//                 at edges)
//   directional   lo·(1/d) − o·(1/d) as one multiply-add with prepared products. Padded by 8u·|o/d| and
//                 widened as conservative, so no false miss either, but false hits within 8u·|o| of a box.
//                 |d| < 2^-96 is taken for 2^-96 of its sign, with a slack of 2^40 in t: in a box that the
//                 ray is parallel to, t must stay below 2^40 (beyond, it may be missed), and |lo|, |hi|, |o|
//                 beyond 2^31 along that axis may cost false hits
enum class BoxTest : std::uint8_t { conservative, plain, directional };

struct BoxTestInfo {
  BoxTest test;
  const char* name;
  int floats;  // the numbers it reads of a box: lo and hi
};
// A row per enumerator, in their order.
inline constexpr BoxTestInfo box_tests[] = {
    {BoxTest::conservative, "conservative", 6},
    {BoxTest::plain, "plain", 6},
    {BoxTest::directional, "directional", 6},
};

using BoxOptions = CallOptions<BoxTest, BoxTest::conservative>;

// Common to all calls: sizes may be zero; arrays need the alignment of a float; nothing is read or written but the
// active elements, and outputs overlap nothing. `bits` has (size + 7) / 8 bytes, spans of floats one number an element.
// Reproducible: the same bits on every path. Throws std::invalid_argument, before anything is written, for spans of
// other sizes, an enumerator that does not exist and a path that this machine lacks. Bits and bounds hold for rounding
// to nearest without FTZ and DAZ.

// Bit i % 8 of bits[i / 8]: whether box i, or the box by ray i, is hit. Of one ray and many boxes a box that is
// inverted by no more than rounding on the ray's major axis may count as a flat one, and the largest |direction|
// must be at least FLT_MIN.
void hit_mask(const Ray& ray, const BoxArrays& boxes, std::span<std::uint8_t> bits,
              const BoxOptions& options = {});
void hit_mask(const RayArrays& rays, const Box& box, std::span<std::uint8_t> bits,
              const BoxOptions& options = {});

// And the part of [tmin, tmax] inside the box, from entry to exit: entry = +infinity, exit = −infinity for a miss. They
// are infinite for a hit only where tmin or tmax is.
void intervals(const Ray& ray, const BoxArrays& boxes, std::span<std::uint8_t> bits, std::span<float> entry,
               std::span<float> exit, const BoxOptions& options = {});
void intervals(const RayArrays& rays, const Box& box, std::span<std::uint8_t> bits, std::span<float> entry,
               std::span<float> exit, const BoxOptions& options = {});

}  // namespace raylanes
