#include "shapes.hpp"

#include "subdivision.hpp"

namespace raylanes::bench {
namespace {

struct UnitSphere {
  std::vector<Double3> points;
  std::vector<Index3> triangles;
};

UnitSphere icosahedron() {
  constexpr double g = std::numbers::phi;
  UnitSphere sphere{{{-1, g, 0},
                     {1, g, 0},
                     {-1, -g, 0},
                     {1, -g, 0},
                     {0, -1, g},
                     {0, 1, g},
                     {0, -1, -g},
                     {0, 1, -g},
                     {g, 0, -1},
                     {g, 0, 1},
                     {-g, 0, -1},
                     {-g, 0, 1}},
                    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (Double3& point : sphere.points) point = normalized(point);
  return sphere;
}

}  // namespace

void append_box(Mesh& mesh, const Double3& lo, const Double3& hi) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned corner = 0; corner < 8; ++corner)
    mesh.vertices.push_back(
        to_float({corner & 1 ? hi[0] : lo[0], corner & 2 ? hi[1] : lo[1], corner & 4 ? hi[2] : lo[2]}));
  constexpr Index3 faces[] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                              {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (const auto& [a, b, c] : faces) mesh.triangles.push_back({first + a, first + b, first + c});
}

void append_icosphere(Mesh& mesh, const Double3& centre, double radius, int levels) {
  UnitSphere sphere = icosahedron();
  for (int level = 0; level < levels; ++level)
    cut_in_four(sphere.points, sphere.triangles,
                [](const Double3& a, const Double3& b) { return normalized(add(a, b)); });
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Double3& point : sphere.points)
    mesh.vertices.push_back(to_float(add(centre, scale(point, radius))));
  for (const auto& [a, b, c] : sphere.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace raylanes::bench
