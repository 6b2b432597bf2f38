#include "meshes.hpp"

#include "../../bench/support/scenes/shapes.hpp"
#include "random_input.hpp"

namespace raylanes::testing {

Mesh ellipsoid(int levels, const Float3& centre, const Float3& semi_axes) {
  Mesh mesh;
  bench::append_icosphere(mesh, {0, 0, 0}, 1, levels);
  for (Float3& vertex : mesh.vertices)
    for (std::size_t axis = 0; axis < 3; ++axis) vertex[axis] = vertex[axis] * semi_axes[axis] + centre[axis];
  return mesh;
}

Mesh triangle_soup(std::size_t count, float size, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Float3 centre = random.point(1);
    append(mesh,
           Triangle{{random.point(size, centre), random.point(size, centre), random.point(size, centre)}});
  }
  return mesh;
}

Mesh integer_grid(std::uint32_t cells) {
  Mesh mesh;
  bench::append_grid(mesh, cells, cells, [&](double u, double v) {
    return bench::Double3{std::round(u * cells), std::round(v * cells), 0.0};
  });
  return mesh;
}

NeedlesAndSlivers needles_and_slivers(std::uint32_t count, std::uint64_t seed) {
  NeedlesAndSlivers meshes;
  Random random(seed);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Float3 a = random.point(1), b = random.point(1);
    append(meshes.needles, a, b, random.point(1e-6f, b));
    const float y = random.number(-1, 1);
    append(meshes.across, {-1, y, -1}, {1, -y, 1}, {1, 0.01f - y, 1});
  }
  return meshes;
}

Mesh triangles_beside_z() {
  constexpr float side = 0x1p-41f, far = 0x1p100f;
  Mesh mesh;
  for (std::uint32_t i = 0; i < 20; ++i) {
    const float y = 4.0f * static_cast<float>(i);
    append(mesh, {side, y - 1, far}, {side, y + 1, far}, {1, y, far});
  }
  return mesh;
}

void append(Mesh& mesh, const Triangle& triangle) {
  append(mesh, triangle.corner[0], triangle.corner[1], triangle.corner[2]);
}

void scale(Mesh& mesh, float by) {
  for (Float3& vertex : mesh.vertices)
    for (float& x : vertex) x *= by;
}

Mesh stack_of(std::uint32_t triangles) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const float z = 0.001f * static_cast<float>(i);
    append(mesh, {-1, -1, z}, {1, -1, z}, {0, 1, z});
  }
  return mesh;
}

Mesh double_fan(std::uint32_t degree, float wave) {
  Mesh mesh{{{0, 0, 1}, {0, 0, -1}}, {}};
  for (std::uint32_t i = 0; i < degree; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(degree);
    const float radius = 1 + wave * (i % 2 == 0 ? 1.0f : -1.0f);
    mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), i % 3 == 0 ? wave : 0.0f});
  }
  for (std::uint32_t i = 0; i < degree; ++i) {
    const std::uint32_t a = 2 + i, b = 2 + (i + 1) % degree;
    mesh.triangles.push_back({0, a, b});
    mesh.triangles.push_back({1, b, a});
  }
  return mesh;
}

Mesh cube(float lo, float hi) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back({(i & 1) != 0 ? hi : lo, (i & 2) != 0 ? hi : lo, (i & 4) != 0 ? hi : lo});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Mesh tetrahedron(const Float3& at) {
  Mesh mesh;
  for (const Float3& v : {Float3{0, 0, 0}, Float3{1, 0, 0}, Float3{0, 1, 0}, Float3{0, 0, 1}})
    mesh.vertices.push_back({at[0] + v[0], at[1] + v[1], at[2] + v[2]});
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

Mesh unshared(const Mesh& mesh) {
  Mesh apart;
  for (const Index3& t : mesh.triangles) append(apart, triangle_of(mesh.vertices, t));
  return apart;
}

Mesh doubled(const Mesh& mesh) {
  Mesh twice = mesh;
  append(twice, mesh);
  for (std::uint32_t i = 0; i < 20; ++i) twice.triangles.insert(twice.triangles.begin() + i, {i, i, i + 1});
  return twice;
}

Mesh without(Mesh mesh, double share, std::uint64_t seed) {
  Random random(seed);
  std::erase_if(mesh.triangles, [&](const Index3&) { return random.chance(share); });
  return mesh;
}
Mesh turned_over(Mesh mesh, double share, std::uint64_t seed) {
  Random random(seed);
  for (Index3& t : mesh.triangles)
    if (random.chance(share)) std::swap(t[1], t[2]);
  return mesh;
}

Mesh tube(std::size_t axis, float length) {
  Mesh mesh;
  constexpr std::uint32_t around = 8;
  for (std::uint32_t i = 0; i < 2 * around; ++i) {
    const double angle = 0.25 * std::numbers::pi * static_cast<double>(i / 2);
    Float3 corner;
    corner[axis] = i % 2 == 0 ? 0 : length;
    corner[(axis + 1) % 3] = static_cast<float>(std::cos(angle));
    corner[(axis + 2) % 3] = static_cast<float>(std::sin(angle));
    mesh.vertices.push_back(corner);
    mesh.triangles.push_back(i % 2 == 0 ? Index3{i, (i + 2) % (2 * around), i + 1}
                                        : Index3{i, (i + 1) % (2 * around), (i + 2) % (2 * around)});
  }
  return mesh;
}

Mesh row_of_tubes(std::size_t axis, float length) {
  Mesh tubes;
  for (int k = 0; k < 6; ++k) {
    Mesh next = tube(axis, length);
    for (Float3& vertex : next.vertices) vertex[(axis + 1) % 3] += 2.5f * static_cast<float>(k);
    append(tubes, next);
  }
  return tubes;
}

}  // namespace raylanes::testing
