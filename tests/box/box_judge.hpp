// The result that each box test must return, by exact rational slabs and the derived bound of that test's rounding.
//
// conservative and plain. A computed distance (b - o)·(1/d) rounds three times, so it is t(1 + e), |e| <= γ3
// = 3u + O(u²), u = 2^-24. The far one of `conservative` has one rounding more in the widened reciprocal and
// the factor 1 + 6u: it is t(1 + 6u)(1 + e'), |e'| <= γ4. Minimum and maximum do not round. So with exact
// entry <= exit, both >= 0:
//   computed entry <= entry(1 + γ3) <= exit(1 + 6u)(1 - γ4) + O(u²)·exit … <= computed exit up to O(u²);
// the O(u²) lies in favour of the far side because u·t is the least step between floats, and the rational
// oracle sees to it. A box is reported wrongly only if
//   entry(1 - γ3) <= exit(1 + 6u)(1 + γ4), that is if entry - exit <= (3 + 6 + 4)u·exit + O(u²) < 14u·exit.
// The values: |entry - exact| <= 4u·|exact|, and exact <= exit <= exact·(1 + 12u) where exact >= 0; for
// `plain` both within 4u. This holds where nothing under- or overflows: for 2^-126 <= |d| <= 2^126 or d = 0,
// and normal or zero t.
//
// directional. b·(1/d), o·(1/d) and its sum with the pad round once each, 1/d moves t by u·|t|, the
// difference rounds once more: below 3u·|o/d| + 4u·|t|. The pad of 8u·|o/d| goes outwards. So entry is at
// most 4u·|t| late and 12u·|o/d| + 4u·|t| early, exit as much late besides its widening, and never early.
#pragma once

#include <raylanes/boxes.hpp>

#include "../../bench/support/oracles/exact_box.hpp"
#include "../support/soa.hpp"

namespace raylanes::testing {

struct BoxJudgement {
  oracle::ExactInterval exact;
  // Whether the ray meets the box when that is moved outwards, and inwards, by 32u·(|o| + |bound|) on each
  // axis: more than rounding, padding and widening reach together.
  bool meets_enlarged, meets_shrunk;
};

// Rays with 0 <= tmin.
BoxJudgement judge(const Ray& ray, const Box& box);

// Whether both answers are right.
bool is_open(BoxTest test, const BoxJudgement& judgement);

// Why the answer of a test is wrong, or "". Along an axis where 0 < |d| < 2^-96 nothing is said of values.
std::string fault(BoxTest test, const IntervalResult& result, const Ray& ray, const Box& box,
                  const BoxJudgement& judgement);

// Whether the interval is empty by no more than 14u·exit, so that the conservative test may say hit.
bool is_open(const oracle::ExactInterval& exact);

// Why the result of the conservative test is wrong, or "": sharper than the above, by
// 14u·exit instead of a box moved outwards.
std::string fault(const IntervalResult& result, const oracle::ExactInterval& exact);

// Larger by what BoxJudgement says, with a little more for a plane through 0.
Box enlarged(const Box& box, const Ray& ray);

}  // namespace raylanes::testing
