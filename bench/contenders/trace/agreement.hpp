// Differences between Embree and us, and whether exact arithmetic excuses them.
#pragma once

#include "../../support/oracles/disagreement.hpp"
#include "../../support/scenes/mesh_and_camera.hpp"
#include "../contenders.hpp"

namespace raylanes::bench {

// Two hits whose t differ within the rounding bounds of the two tests agree.
struct Agreement {
  std::size_t disagreements = 0;
  std::size_t within_rounding =
      0;  // among them: of an edge, of tmin or tmax, of a degenerate triangle; or modes_apart
  std::size_t embree_wrong = 0;  // by exact arithmetic
  std::size_t ours_wrong = 0;
  std::vector<std::string> sentences;  // of the first few, and of all of ours that are wrong
};

// Whether the test promises that all modes decide alike, any hit and closest (<raylanes/traversal.hpp>).
constexpr bool modes_agree(TriangleTest test, Grade grade) {
  return test == TriangleTest::exact || (test == TriangleTest::watertight && grade == Grade::reproducible);
}

// Whether packets may decide any hit by planes through the point where their rays end, rounded as seen from there:
// Möller–Trumbore in the fast grade does (docs/intersections.md).
constexpr bool may_reverse(TriangleTest test, Grade grade, TraversalMode mode) {
  return test == TriangleTest::moller_trumbore && grade == Grade::fast &&
         (mode == TraversalMode::packet || mode == TraversalMode::automatic);
}

// Compares our answers with Embree's or another contender's, both to `set`. Each disagreement is judged exactly by the
// triangles that the two report; for an any-hit query, by the closest hits that both then find. A contender that
// contradicts its own closest hit is wrong. It is excused if its modes may decide otherwise and no bound says that it
// had to hit, from neither end of the ray where packets may reverse it.
struct Answered {
  const Answers& answers;
  const Contender& contender;
  oracle::Form form;
  bool modes_agree = true;   // see modes_agree()
  bool may_reverse = false;  // see may_reverse()
};
Agreement compare_answers(const Scene& scene, const RaySet& set, const Answered& ours,
                          const Answered& theirs);

}  // namespace raylanes::bench
