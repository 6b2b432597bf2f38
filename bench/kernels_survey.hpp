// Accuracy of the intersection tests: wrong decisions against exact arithmetic, errors of distances and
// weights, and leaks of a closed mesh.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "../dispatch/intersect.hpp"

namespace raylanes::bench {

// How rays are aimed.
//   uniform   anywhere near the primitive
//   edges     at a point of an edge (sphere: tangent to it)
//   vertices  at a corner (sphere: not measured)
//   far       uniform, in a scene far from the origin of space (sphere: from 10,000 radii away)
enum class Aim : std::uint8_t { uniform, edges, vertices, far };
inline constexpr std::array<std::string_view, 4> aim_names{"uniform", "edges", "vertices", "far"};

struct KernelAccuracy {
  std::array<std::optional<double>, aim_names.size()> wrong_per_million;
  // Of hits in the uniform set, in ULP of the exact value (weights: in ULP of 1); t is the near distance of
  // boxes and spheres.
  std::optional<double> max_t_ulp, max_u_ulp, max_v_ulp;
};

using Done = std::function<void(double)>;  // share, 0 … 1

// `pairs` rays and primitives of each set for every path; result [path][form or test][grade]. The last of the
// sphere tests is the line's.
using Accuracies = std::vector<std::vector<std::array<KernelAccuracy, 2>>>;
Accuracies survey_triangles(const std::vector<const Path*>& paths, std::size_t pairs, const Done& done);
Accuracies survey_boxes(const std::vector<const Path*>& paths, std::size_t pairs, const Done& done);
Accuracies survey_spheres(const std::vector<const Path*>& paths, std::size_t pairs, const Done& done);

// Rays from inside a closed ellipsoid of 1,280 triangles, half of them aimed at corners and half at edges,
// that no triangle around the target stops: leaks per million [path][form][grade]. Only what `chosen` says is
// measured. `rays` is rounded up to a multiple of the targets.
using Leaks = std::vector<std::vector<std::array<std::optional<double>, 2>>>;
Leaks count_leaks(const std::vector<const Path*>& paths, std::size_t rays,
                  const std::function<bool(TriangleForm)>& chosen, const Done& done);

}  // namespace raylanes::bench
