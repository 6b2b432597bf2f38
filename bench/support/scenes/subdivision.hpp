// Meshes cut into finer ones.
#pragma once

#include <raylanes/mesh.hpp>

#include "../std.hpp"

namespace raylanes::bench {

// Cuts each triangle into four at the midpoints of its edges. Triangles that share an edge share its midpoint, which is
// midpoint(a, b), the same in either order. New points follow the old ones in the order in which triangles need them.
template <class Point, class Midpoint>
void cut_in_four(std::vector<Point>& points, std::vector<Index3>& triangles, const Midpoint& midpoint) {
  struct Edge {
    std::uint64_t ends;  // the lower index above the higher one
    std::uint32_t number;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const Index3& triangle : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      edges.push_back({std::uint64_t{low} << 32 | high, static_cast<std::uint32_t>(edges.size())});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::pair(a.ends, a.number) < std::pair(b.ends, b.number);
  });
  // For each edge the number of the first one with the same ends, later the index of its midpoint.
  std::vector<std::uint32_t> middle(edges.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool is_first = i == 0 || edges[i].ends != edges[i - 1].ends;
    middle[edges[i].number] = is_first ? edges[i].number : middle[edges[i - 1].number];
    different += is_first;
  }
  edges = {};
  points.reserve(points.size() + different);
  for (std::uint32_t i = 0; i < middle.size(); ++i) {
    if (middle[i] != i) {
      middle[i] = middle[middle[i]];
      continue;
    }
    const Index3& triangle = triangles[i / 3];
    middle[i] = static_cast<std::uint32_t>(points.size());
    points.push_back(midpoint(points[triangle[i % 3]], points[triangle[(i + 1) % 3]]));
  }
  std::vector<Index3> fine;
  fine.reserve(4 * triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    const std::uint32_t ab = middle[3 * i], bc = middle[3 * i + 1], ca = middle[3 * i + 2];
    fine.insert(fine.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  triangles = std::move(fine);
}

// Cuts each triangle of a mesh into four `times` times; vertices keep their indices. The surface stays as it is but for
// the rounding of new vertices. Throws std::invalid_argument if there were more than 2^28 triangles.
void subdivide(Mesh& mesh, int times);

}  // namespace raylanes::bench
