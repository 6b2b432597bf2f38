// Where we and Embree differ, and whether exact arithmetic excuses it.
#pragma once

#include <string>
#include <vector>

#include "../tests/oracles/disagreement.hpp"
#include "contenders.hpp"
#include "scene.hpp"

namespace raylanes::bench {

struct Agreement {
  std::size_t disagreements = 0;
  std::size_t unexplained = 0;         // among them
  std::vector<std::string> sentences;  // of the first few
};

// Compares our answers with Embree's, both to `set`. Each disagreement is judged exactly by the triangles
// that the two report; for an any-hit query, by the closest hits that `ours` and `embree` then find.
Agreement compare_answers(const Scene& scene, const RaySet& set, const Answers& our_answers,
                          const Answers& embree_answers, const Contender& ours, oracle::Form our_form,
                          const Contender& embree);

}  // namespace raylanes::bench
