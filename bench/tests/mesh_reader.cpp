// read_mesh against files that the test writes byte by byte.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "mesh_files.hpp"

namespace raylanes::bench {
namespace {

// As Windows writes text: lines end in "\r\n", after a byte order mark.
std::string of_windows(const std::string& text) {
  std::string out = "\xef\xbb\xbf";
  for (const char c : text) out += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return out;
}

TEST_F(MeshReader, keeps_order_bits_and_numbers_of_vertices_in_every_format) {
  std::string text = ply_header("ascii", points.size(), faces.size());
  for (const Float3& v : points) text += text_of(v) + "\n";
  for (const Index3& t : faces)
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  const std::string title = "solid facet vertex 7 7 7 vertex 8 8 8 endfacet ";  // adds no triangle
  const std::pair<const char*, std::string> files[] = {{"a.obj", obj(points, faces)},
                                                       {"b.OBJ", of_windows(obj(points, faces))},
                                                       {"a.ply", binary_ply(Endian::little, points, faces)},
                                                       {"b.ply", binary_ply(Endian::big, points, faces)},
                                                       {"c.ply", text},
                                                       {"a.stl", binary_stl(5, points, faces)},
                                                       {"b.stl", binary_stl(5, points, faces, title)},
                                                       {"c.stl", ascii_stl(points, faces)},
                                                       {"d.stl", of_windows(ascii_stl(points, faces))},
                                                       {"a.ra2", ra2(points, faces)}};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    const Mesh mesh = read(name, content);
    expect_same_triangles(mesh, points, faces);
    if (content.find("vertex_indices") != std::string::npos || name[2] == 'o') {
      EXPECT_EQ(mesh.triangles, faces);
    }
  }
}

TEST_F(MeshReader, stl_joins_only_identical_corners) {
  const std::vector<Float3> signed_zeros{{0.0f, 0, 0}, {-0.0f, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Index3> triangles{{0, 2, 3}, {1, 3, 2}};
  const Mesh mesh = read("a.stl", binary_stl(2, signed_zeros, triangles));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  expect_same_triangles(mesh, signed_zeros, triangles);
}

TEST_F(MeshReader, obj_rounds_to_the_nearest_float_and_knows_the_syntax) {
  // Assimp gives other floats for these.
  const Mesh rounded =
      read("a.obj", "v 1.368074 2.435437 -0.227403\nv -2.991600 1e-50 +4.5\nv 8.644791 7 1E2\nf 1 2 3");
  EXPECT_EQ(rounded.vertices[0], (Float3{1.368074f, 2.435437f, -0.227403f}));
  EXPECT_EQ(rounded.vertices[1], (Float3{-2.991600f, 0.0f, 4.5f}));
  EXPECT_EQ(rounded.vertices[2], (Float3{8.644791f, 7.0f, 100.0f}));
  const Mesh mesh =
      read("a.obj",
           "# comment\r\nmtllib x.mtl\no one\nv 0 0 0 1.0\nv\t1 0 0\nv 0 1 0\n\nusemtl a\n"
           "f 1/1/1 2//2 3/3\nv 1 1 0\ng two\nusemtl b\nf -4 -3 \\\n -2 -1 # fan\nusemtl a\nl 1 2\n"
           "f 5 1 2\r\nv 0 0 1\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Index3>{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {4, 0, 1}}));
  EXPECT_EQ(mesh.vertices[4], (Float3{0, 0, 1}));
}

TEST_F(MeshReader, ply_polygons_other_elements_and_doubles) {
  const Mesh mesh =
      read("a.ply",
           "ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement vertex 4\r\nproperty uchar red\r\n"
           "property double x\r\nproperty double y\r\nproperty double z\r\nelement edge 1\r\n"
           "property int vertex1\r\nproperty int vertex2\r\nelement face 2\r\n"
           "property list uchar float weights\r\nproperty list ushort uint vertex_index\r\nend_header\r\n"
           "1 0.1 0 0\r\n2 1 0 0\r\n3 1 1 0\r\n4 0 1 0\r\n0 1\r\n1 0.5 4 0 1 2 3\r\n0 3 3 1 0\r\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Index3>{{0, 1, 2}, {0, 2, 3}, {3, 1, 0}}));
  EXPECT_EQ(mesh.vertices[0][0], 0.1f);
}

}  // namespace
}  // namespace raylanes::bench
