#include "closed_meshes.hpp"

#include <set>

namespace raylanes::testing {

std::vector<SharedPoint> shared_points(const Mesh& mesh) {
  std::vector<std::vector<std::size_t>> of_vertex(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t vertex : mesh.triangles[i]) of_vertex[vertex].push_back(i);
  std::vector<SharedPoint> targets;
  for (const Index3& corners : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
      std::set<std::size_t> around(of_vertex[a].begin(), of_vertex[a].end());
      around.insert(of_vertex[b].begin(), of_vertex[b].end());
      SharedPoint target{triangle_of(mesh.vertices, {a, b, c}), a < b, {}};
      for (const std::size_t i : around)
        target.around.push_back(triangle_of(mesh.vertices, mesh.triangles[i]));
      targets.push_back(target);
    }
  return targets;
}

std::vector<Ray> rays_to(const SharedPoint& target, const Float3& centre, const Float3& reach, int count,
                         Random& random) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    Float3 origin;
    for (std::size_t axis = 0; axis < 3; ++axis)
      origin[axis] = random.number(centre[axis] - reach[axis], centre[axis] + reach[axis]);
    rays.push_back(ray_to(origin, target.triangle, target.is_corner ? 0 : random.real(0, 1), 0));
  }
  return rays;
}

}  // namespace raylanes::testing
