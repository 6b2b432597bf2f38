// Leaks of a closed mesh under the forms of the triangle test.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include <raylanes/boxes.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

namespace raylanes::bench {

// Rays from inside a closed ellipsoid of 1,280 triangles, half of them aimed at corners and half at edges,
// that no triangle around the target stops: leaks per million [path][form][grade]. Only what `chosen` says is
// measured. `rays` is rounded up to a multiple of the targets.
using Leaks = std::vector<std::vector<std::array<std::optional<double>, 2>>>;
Leaks count_leaks(const std::vector<const Path*>& paths, std::size_t rays,
                  const std::function<bool(TriangleTest)>& chosen, const std::function<void(double)>& done);

}  // namespace raylanes::bench
