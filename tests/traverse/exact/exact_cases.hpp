// Meshes and rays where the decisions of floats are hardest, by what makes them hard. Seeded by the caller.
#pragma once

#include <raylanes/mesh.hpp>
#include <raylanes/types.hpp>

#include "../../support/random_input.hpp"

namespace raylanes::testing {

struct ExactCase {
  Mesh mesh;
  std::vector<Ray> rays;
};
struct ExactSet {
  const char* name;
  ExactCase (*make)(Random&);
};
std::span<const ExactSet> exact_sets();

}  // namespace raylanes::testing
