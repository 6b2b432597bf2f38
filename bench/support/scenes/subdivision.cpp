#include "subdivision.hpp"

namespace raylanes::bench {

void subdivide(Mesh& mesh, int times) {
  constexpr std::size_t max_triangles = std::size_t{1} << 28;
  if (times > 0 && mesh.triangles.size() > max_triangles >> 2 * times)
    throw std::invalid_argument("--subdivide " + std::to_string(times) + ": " +
                                std::to_string(mesh.triangles.size()) +
                                " triangles would become more than 2^28");
  for (; times > 0; --times)
    cut_in_four(mesh.vertices, mesh.triangles, [](const Float3& a, const Float3& b) {
      Float3 middle;
      for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] = 0.5f * a[axis] + 0.5f * b[axis];
      return middle;
    });
}

}  // namespace raylanes::bench
