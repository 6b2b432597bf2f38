// Winding numbers of meshes of doubles beside solid angles of all triangles.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/float_modes.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "double_cases.hpp"
#include "summed_windings.hpp"

namespace raylanes::testing {

// check(tree, path), as the trees of floats have it.
template <class Check>
void each_tree(const DoubleMesh& mesh, const Check& check) {
  const BvhD tree(mesh.vertices, mesh.triangles);
  for (const Path* path : supported_paths()) {
    SCOPED_TRACE(path->name);
    check(tree, path);
  }
}
// In a ball of 1.5 around the mesh of this size.
inline std::vector<Double3> points_around(const DoubleMesh& mesh, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  const BoxD box = BvhD(mesh.vertices, mesh.triangles).bounds();
  std::vector<Double3> points;
  for (std::size_t i = 0; i < count; ++i) {
    Double3& point = points.emplace_back();
    const double share[] = {random.real(-0.25, 1.25), random.real(-0.25, 1.25), random.real(-0.25, 1.25)};
    for (std::size_t k = 0; k < 3; ++k) point[k] = (1 - share[k]) * box.lo[k] + share[k] * box.hi[k];
  }
  return points;
}

// Numbers of each accuracy, on every path: within the bound, the same bytes. Returns how many points were far from
// integers.
inline std::size_t expect_windings(const DoubleMesh& mesh, std::vector<Double3> points,
                                   bool is_ordinary = true) {
  std::erase_if(points, [&](const Double3& point) { return is_on_edge(mesh, point); });
  const double edges = boundary_edges(mesh);
  std::vector<SummedWinding> expected;
  for (const Double3& point : points) expected.push_back(summed_winding(mesh, point));
  const BvhD tree(mesh.vertices, mesh.triangles);
  for (const double accuracy : {0.0, 1e-6, 1e-3, 0.1}) {
    std::vector<double> first;
    for (const Path* path : paths_with_own_queries())
      for (const FloatMode mode : float_modes) {
        if (mode == FloatMode::flush && !is_ordinary) continue;
        const FloatModeScope scope(mode);
        std::vector<double> numbers(points.size(), -99.0);
        tree.winding_numbers(points, numbers, {.accuracy = accuracy, .path = path});
        if (first.empty()) first = numbers;
        EXPECT_TRUE(same_bytes(numbers, first)) << path->name << ' ' << name_of(mode);
      }
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const long double off = std::abs(first[i] - expected[i].number),
                        bound = bound_of_winding(expected[i], accuracy, edges);
      if (!(off <= bound) && ++wrong < 4)
        ADD_FAILURE() << "accuracy " << accuracy << ", point " << i << ": " << first[i] << ", not "
                      << static_cast<double>(expected[i].number) << ", where " << static_cast<double>(bound)
                      << " is allowed";
    }
    EXPECT_EQ(wrong, 0u);
  }
  return static_cast<std::size_t>(std::ranges::count_if(
      expected, [](const SummedWinding& w) { return std::abs(w.number - std::round(w.number)) > 0.01L; }));
}

}  // namespace raylanes::testing
