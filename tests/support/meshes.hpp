// Meshes that suites share, and what is made of meshes.
#pragma once

#include <raylanes/mesh.hpp>
#include <raylanes/triangles.hpp>

#include "testing.hpp"

namespace raylanes::testing {

// A closed ellipsoid around `centre`: 20·4^levels triangles.
Mesh ellipsoid(int levels, const Float3& centre, const Float3& semi_axes = {3, 2, 1});

// `count` triangles in the cube [-1, 1)³, none sharing corners; `size` is half the extent of one.
Mesh triangle_soup(std::size_t count, float size, std::uint64_t seed);

// A square grid of cells·cells·2 triangles in the plane z = 0 with corners on the integers 0 … cells.
Mesh integer_grid(std::uint32_t cells);

// As many needles, and as many diagonals of one box, which nothing but splits separates.
struct NeedlesAndSlivers {
  Mesh needles, across;
};
NeedlesAndSlivers needles_and_slivers(std::uint32_t count, std::uint64_t seed);

// Twenty triangles 4 apart along y, at z = 2^100, whose nearest corners have x = 2^-41: what a ray up z comes to with a
// component along x whose reciprocal is infinite.
Mesh triangles_beside_z();

// Adds a triangle with corners of its own, or all triangles of another mesh, which may be the same.
template <class AnyMesh, class Point = typename decltype(AnyMesh::vertices)::value_type>
void append(AnyMesh& mesh, const std::type_identity_t<Point>& a, const std::type_identity_t<Point>& b,
            const std::type_identity_t<Point>& c) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}
void append(Mesh& mesh, const Triangle& triangle);
template <class AnyMesh>
void append(AnyMesh& mesh, const AnyMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const AnyMesh added = other;
  mesh.vertices.insert(mesh.vertices.end(), added.vertices.begin(), added.vertices.end());
  for (const Index3& t : added.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}
// Multiplies all coordinates.
void scale(Mesh& mesh, float by);

// Equal triangles across the z axis, 0.001 apart from z = 0 upwards.
Mesh stack_of(std::uint32_t triangles);

// A closed mesh in which each vertex at a pole has `degree` triangles; not convex where `wave` is not 0.
Mesh double_fan(std::uint32_t degree, float wave);

// A closed cube from lo to hi, normals out.
Mesh cube(float lo, float hi);

// A closed tetrahedron whose sides along the axes have the length 1.
Mesh tetrahedron(const Float3& at = {0, 0, 0});

// As STL files have it: each triangle its own corners.
Mesh unshared(const Mesh& mesh);

// Every triangle twice, and some with equal corners among them.
Mesh doubled(const Mesh& mesh);

// Without that share of its triangles, or with that share turned over, from a seed.
Mesh without(Mesh mesh, double share, std::uint64_t seed);
Mesh turned_over(Mesh mesh, double share, std::uint64_t seed);

// A tube of `length` along `axis` without its ends, each face in strips.
Mesh tube(std::size_t axis, float length);

// Six of them side by side: some nodes and leaves.
Mesh row_of_tubes(std::size_t axis, float length);

}  // namespace raylanes::testing
