// Accuracy of the intersection tests: wrong decisions against exact arithmetic, errors of distances and weights, and
// leaks of a closed mesh.
#pragma once

#include <raylanes/boxes.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

#include "../../support/std.hpp"

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
  using ByAim = std::array<std::optional<double>, aim_names.size()>;
  // A box is wrong if it is missed. One too many costs time and is no error, so it is counted apart.
  ByAim wrong_per_million, extra_per_million;
  // For the exact test: pairs that its floats leave undecided.
  ByAim undecided_per_million;
  // Errors of hits in the uniform set, in ULP of the exact value (weights: in ULP of 1). For boxes and spheres t is the
  // near distance.
  std::optional<double> max_t_ulp, max_u_ulp, max_v_ulp;
};

using Done = std::function<void(double)>;  // share, 0 … 1

// [path][form or test][grade].
using Accuracies = std::vector<std::vector<std::array<KernelAccuracy, 2>>>;

// The judgement of each test; the last of the spheres' elements is the line's. Integers have [0][0][0] only: all paths
// and both grades share their decisions.
struct KernelJudgement {
  // Nothing is judged yet; elements stay where they are when it is.
  explicit KernelJudgement(std::size_t paths);
  // By `pairs` rays and primitives of each set for every path, as many as it was made for.
  void judge(const std::vector<const Path*>& paths, std::size_t pairs, const Done& done);

  Accuracies triangles, integers, boxes, spheres;
};

// Rays from inside a closed ellipsoid of 1,280 triangles, half of them aimed at corners and half at edges,
// that no triangle around the target stops: leaks per million [path][form][grade]. Only what `chosen` says is
// measured. `rays` is rounded up to a multiple of the targets.
using Leaks = std::vector<std::vector<std::array<std::optional<double>, 2>>>;
Leaks count_leaks(const std::vector<const Path*>& paths, std::size_t rays,
                  const std::function<bool(TriangleTest)>& chosen, const std::function<void(double)>& done);

}  // namespace raylanes::bench
