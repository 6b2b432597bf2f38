// Meshes of doubles and rays that meet them where it matters: at vertices, at edges, along planes.
#pragma once

#include "../../bench/support/oracles/exact_rays.hpp"
#include "../support/random_input.hpp"

namespace raylanes::testing {
using namespace oracle;

struct DoubleCase {
  std::string name;
  DoubleMesh mesh;
  std::vector<RayD> rays;
};

// A mesh of floats, moved and then scaled: corner · 2^power + offset, rounded to doubles.
DoubleMesh moved(const Mesh& mesh, double factor, const Double3& offset);

// `count` rays: half aimed at a corner, an edge or a plane, some with ends at a hit.
// Most begin within `reach` times half the mesh's box around its middle.
std::vector<RayD> aimed_rays(const DoubleMesh& mesh, std::size_t count, std::uint64_t seed, double reach = 3);

// The same in runs of `run` rays that share an origin, of the first one or a corner, but for a few.
std::vector<RayD> aimed_rays_from_points(const DoubleMesh& mesh, std::size_t count, std::size_t run,
                                         std::uint64_t seed);

// Meshes of all sizes that doubles have, near to zero and far away from it.
std::vector<DoubleCase> double_cases(std::size_t rays);

}  // namespace raylanes::testing
