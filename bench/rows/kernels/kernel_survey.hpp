// Accuracy of the intersection tests: wrong decisions against exact arithmetic, and errors of distances and
// weights.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include <raylanes/intersect.hpp>

namespace raylanes::bench {

// How rays are aimed.
//   uniform   anywhere near the primitive
//   edges     at a point of an edge (sphere: tangent to it)
//   vertices  at a corner (sphere: not measured)
//   far       uniform, in a scene far from the origin of space (sphere: from 10,000 radii away)
//   plane     from a point of the triangle's plane at one inside it, as closely as floats can (triangles only)
enum class Aim : std::uint8_t { uniform, edges, vertices, far, plane };
inline constexpr std::array<std::string_view, 5> aim_names{"uniform", "edges", "vertices", "far", "plane"};

struct KernelAccuracy {
  std::array<std::optional<double>, aim_names.size()> wrong_per_million;
  // Of the exact test: pairs that its floats leave undecided.
  std::array<std::optional<double>, aim_names.size()> undecided_per_million;
  // Of hits in the uniform set, in ULP of the exact value (weights: in ULP of 1); t is the near distance of
  // boxes and spheres.
  std::optional<double> max_t_ulp, max_u_ulp, max_v_ulp;
};

using Done = std::function<void(double)>;  // share, 0 … 1

// `pairs` rays and primitives of each set for every path; result [path][form or test][grade]. The last of the
// sphere tests is the line's.
using Accuracies = std::vector<std::vector<std::array<KernelAccuracy, 2>>>;
Accuracies survey_triangles(const std::vector<const Path*>& paths, std::size_t pairs, const Done& done);
// Of decisions in integers, which all paths and both grades share: [0][0][0] alone.
Accuracies survey_integers(std::size_t pairs, const Done& done);
Accuracies survey_boxes(const std::vector<const Path*>& paths, std::size_t pairs, const Done& done);
Accuracies survey_spheres(const std::vector<const Path*>& paths, std::size_t pairs, const Done& done);

}  // namespace raylanes::bench
