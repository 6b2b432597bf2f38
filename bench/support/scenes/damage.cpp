#include "damage.hpp"

#include "mesh_and_camera.hpp"
#include "splitmix.hpp"

namespace raylanes::bench {

Mesh with_holes(const Mesh& mesh, std::size_t holes) {
  if (mesh.triangles.empty()) return mesh;
  SplitMix random(5);
  std::vector<Float3> centres;
  for (std::size_t i = 0; i < holes; ++i)
    centres.push_back(mesh.vertices[mesh.triangles[random.next() % mesh.triangles.size()][0]]);
  const double radius = 0.02 * diagonal_of(mesh);
  Mesh open{mesh.vertices, {}};
  for (const Index3& triangle : mesh.triangles) {
    const bool is_cut = std::any_of(centres.begin(), centres.end(), [&](const Float3& centre) {
      double square = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        double middle = 0;
        for (const std::uint32_t corner : triangle)
          middle += static_cast<double>(mesh.vertices[corner][k]) / 3;
        square += (middle - static_cast<double>(centre[k])) * (middle - static_cast<double>(centre[k]));
      }
      return square < radius * radius;
    });
    if (!is_cut) open.triangles.push_back(triangle);
  }
  return open;
}

}  // namespace raylanes::bench
