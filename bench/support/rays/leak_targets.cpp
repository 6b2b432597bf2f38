#include "leak_targets.hpp"

#include <set>

#include "../../../dispatch/table/traversal.hpp"

namespace raylanes::bench {

std::vector<SharedApex> shared_points(const Mesh& mesh) {
  const auto triangle_of = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return Triangle{{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}};
  };
  std::vector<std::vector<std::size_t>> of_vertex(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t vertex : mesh.triangles[i]) of_vertex[vertex].push_back(i);
  std::vector<SharedApex> targets;
  for (const Index3& corners : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
      std::set<std::size_t> around(of_vertex[a].begin(), of_vertex[a].end());
      around.insert(of_vertex[b].begin(), of_vertex[b].end());
      SharedApex target{triangle_of(a, b, c), a < b, {}};
      for (const std::size_t i : around) {
        const auto& [x, y, z] = mesh.triangles[i];
        target.around.push_back(triangle_of(x, y, z));
      }
      targets.push_back(target);
    }
  return targets;
}

}  // namespace raylanes::bench
