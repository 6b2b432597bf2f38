// Whether meshes are closed, and what is said of those that are not.
#include <raylanes/closed_mesh.hpp>

#include "../support/meshes.hpp"
#include "../support/message_of.hpp"

namespace raylanes::testing {
namespace {

ClosedReport report_of(const Mesh& mesh, std::size_t most = 16) {
  return closed_report(mesh.vertices, mesh.triangles, most);
}

TEST(ClosedMesh, is_one_whose_edges_have_two_triangles_each) {
  EXPECT_TRUE(is_closed(Mesh{}));
  for (const Mesh& mesh : {tetrahedron(), ellipsoid(3, {1, 2, 3})}) {
    const ClosedReport report = report_of(mesh);
    EXPECT_TRUE(report.is_closed() && report.has_parity() && report.has_winding_numbers());
    EXPECT_EQ(2 * report.edges, 3 * mesh.triangles.size());
    EXPECT_TRUE(report.first.empty());
    EXPECT_TRUE(is_closed(mesh));
  }
  EXPECT_FALSE(is_closed(integer_grid(3)));
}

TEST(ClosedMesh, knows_corners_by_their_positions) {
  Mesh mesh = unshared(tetrahedron());
  EXPECT_TRUE(is_closed(mesh));
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 2)
    for (float& x : mesh.vertices[i])
      if (x == 0) x = -0.0f;
  EXPECT_TRUE(is_closed(mesh));
  Float3& moved = mesh.vertices[4];
  moved[1] = 0x1p-149f;  // a subnormal number is not zero
  const ClosedReport report = report_of(mesh);
  EXPECT_FALSE(report.is_closed());
  EXPECT_EQ(report.open, 4u);
}

// A gap that floats would round away.
TEST(ClosedMesh, compares_doubles_as_they_are) {
  const Mesh mesh = unshared(tetrahedron());
  std::vector<Double3> vertices;
  for (const auto& [x, y, z] : mesh.vertices) vertices.push_back({double(x), double(y), double(z)});
  EXPECT_TRUE(is_closed(vertices, mesh.triangles));
  EXPECT_EQ(closed_report(vertices, mesh.triangles).edges, 6u);
  const Double3 corner = vertices[4];
  vertices[4][0] += 0x1p-52;
  EXPECT_FALSE(is_closed(vertices, mesh.triangles));
  EXPECT_EQ(closed_report(vertices, mesh.triangles).open, 4u);
  for (Double3& vertex : vertices)
    if (vertex == corner) vertex = vertices[4];
  EXPECT_TRUE(is_closed(vertices, mesh.triangles));
  vertices[0][0] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(closed_report(vertices, mesh.triangles), std::invalid_argument);
}

TEST(ClosedMesh, says_where_a_hole_is) {
  Mesh mesh = tetrahedron();
  mesh.triangles.erase(mesh.triangles.begin() + 2);  // of 1 2 3
  const ClosedReport report = report_of(mesh);
  EXPECT_FALSE(report.has_parity());
  EXPECT_EQ(report.edges, 6u);
  EXPECT_EQ(report.open, 3u);
  EXPECT_EQ(report.inconsistent + report.shared, 0u);
  ASSERT_EQ(report.first.size(), 3u);
  const std::array<std::array<std::uint32_t, 3>, 3> expected{{{0, 2, 1}, {1, 1, 3}, {2, 3, 2}}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(report.first[i].fault, EdgeFault::open);
    EXPECT_EQ(report.first[i].triangle, expected[i][0]);
    EXPECT_EQ(report.first[i].from, expected[i][1]);
    EXPECT_EQ(report.first[i].to, expected[i][2]);
  }
  EXPECT_EQ(report_of(mesh, 1).first.size(), 1u);
  EXPECT_EQ(report_of(mesh, 0).open, 3u);
}

TEST(ClosedMesh, says_what_is_turned_over) {
  Mesh mesh = tetrahedron();
  std::swap(mesh.triangles[1][0], mesh.triangles[1][1]);
  const ClosedReport report = report_of(mesh);
  EXPECT_TRUE(report.has_parity());
  EXPECT_FALSE(report.has_winding_numbers());
  EXPECT_EQ(report.inconsistent, 3u);
  EXPECT_EQ(report.open + report.shared, 0u);
  for (const FaultyEdge& edge : report.first) EXPECT_EQ(edge.fault, EdgeFault::inconsistent);
}

// Two tetrahedra that have an edge in common.
TEST(ClosedMesh, says_where_solids_touch) {
  Mesh mesh = unshared(tetrahedron());
  for (Mesh other = unshared(tetrahedron()); const Index3& t : other.triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const std::uint32_t corner : {t[0], t[2], t[1]}) {  // mirrored
      const Float3& v = other.vertices[corner];
      mesh.vertices.push_back({-v[0], -v[1], v[2]});
    }
    mesh.triangles.push_back({first, first + 2, first + 1});
  }
  const ClosedReport report = report_of(mesh);
  EXPECT_FALSE(report.is_closed());
  EXPECT_TRUE(report.has_winding_numbers());
  EXPECT_EQ(report.edges, 11u);
  EXPECT_EQ(report.shared, 1u);
  ASSERT_EQ(report.first.size(), 1u);
  EXPECT_EQ(report.first[0].fault, EdgeFault::shared);
}

TEST(ClosedMesh, leaves_out_triangles_with_equal_corners) {
  Mesh mesh = tetrahedron();
  mesh.vertices.push_back(mesh.vertices[1]);
  mesh.triangles.push_back({0, 1, 4});
  mesh.triangles.push_back({2, 2, 2});
  const ClosedReport report = report_of(mesh);
  EXPECT_TRUE(report.is_closed());
  EXPECT_EQ(report.degenerate, 2u);
  mesh.vertices.push_back({0.5f, 0, 0});  // between 0 and 1: this one has corners on a line, and three edges
  mesh.triangles.push_back({0, 1, 5});
  EXPECT_EQ(report_of(mesh).open, 3u);
}

// By positions, whatever the order of the corners; a triangle three times is one and two copies.
TEST(ClosedMesh, counts_triangles_that_are_there_again) {
  Mesh mesh = unshared(tetrahedron());
  EXPECT_EQ(report_of(mesh).doubled, 0u);
  const std::vector<Index3> once = mesh.triangles;
  for (const Index3& t : once) mesh.triangles.push_back({t[1], t[2], t[0]});
  EXPECT_EQ(report_of(mesh).doubled, 4u);
  EXPECT_TRUE(report_of(mesh).has_parity());
  EXPECT_TRUE(report_of(mesh).has_winding_numbers());
  EXPECT_FALSE(report_of(mesh).is_closed());
  mesh.triangles.push_back({once[2][1], once[2][0], once[2][2]});
  EXPECT_EQ(report_of(mesh).doubled, 5u);
  const Mesh leaf{mesh.vertices, {once[0], {once[0][1], once[0][0], once[0][2]}}};
  EXPECT_TRUE(is_closed(leaf));
  EXPECT_EQ(report_of(leaf).doubled, 1u);
}

// Exact for these corners, near zero and far from it.
TEST(ClosedMesh, has_a_volume_that_is_negative_inside_out) {
  for (const double far : {0.0, 0x1p30}) {
    Mesh mesh = tetrahedron();
    std::vector<Double3> vertices;
    for (const auto& [x, y, z] : mesh.vertices)
      vertices.push_back({double(x) + far, double(y) - far, double(z)});
    const double sixth = 1.0 / 6;
    EXPECT_EQ(closed_report(vertices, mesh.triangles).volume, sixth);
    EXPECT_FALSE(closed_report(vertices, mesh.triangles).is_inside_out());
    for (Index3& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    EXPECT_EQ(closed_report(vertices, mesh.triangles).volume, -sixth);
    EXPECT_TRUE(closed_report(vertices, mesh.triangles).is_inside_out());
    EXPECT_EQ(report_of(mesh).volume, -sixth);
    for (Double3& vertex : vertices) vertex[2] = far;
    EXPECT_EQ(closed_report(vertices, mesh.triangles).volume, 0);
    mesh.triangles.pop_back();
    EXPECT_EQ(report_of(mesh).volume, 0);
    EXPECT_FALSE(report_of(mesh).is_inside_out());
  }
  EXPECT_EQ(report_of(Mesh{}).volume, 0);
}

TEST(ClosedMesh, refuses_what_is_no_mesh) {
  Mesh mesh = tetrahedron();
  mesh.triangles[0][0] = 9;
  EXPECT_NE(message_of([&] { is_closed(mesh); }).find("out of range"), std::string::npos);
}

}  // namespace
}  // namespace raylanes::testing
