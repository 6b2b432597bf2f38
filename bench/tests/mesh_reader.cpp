// read_mesh against files that the test writes byte by byte.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "mesh_files.hpp"

namespace raylanes::bench {
namespace {

TEST_F(MeshReader, keeps_order_and_bits_in_every_format) {
  expect_same_triangles(read("a.obj", obj(points, faces)), points, faces);
  expect_same_triangles(read("a.stl", binary_stl(5, points, faces)), points, faces);
  expect_same_triangles(read("b.stl", ascii_stl(points, faces)), points, faces);
  expect_same_triangles(read("a.ra2", ra2(points, faces)), points, faces);
  expect_same_triangles(read("a.ply", binary_ply(Endian::little, points, faces)), points, faces);
  expect_same_triangles(read("b.ply", binary_ply(Endian::big, points, faces)), points, faces);
  std::string text = ply_header("ascii", points.size(), faces.size());
  for (const Float3& v : points) text += text_of(v) + "\n";
  for (const Index3& t : faces)
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  expect_same_triangles(read("c.ply", text), points, faces);
}

TEST_F(MeshReader, indexed_formats_keep_the_vertex_numbers) {
  for (const Mesh& mesh :
       {read("a.obj", obj(points, faces)), read("a.ply", binary_ply(Endian::big, points, faces))}) {
    EXPECT_EQ(mesh.vertices.size(), points.size());
    EXPECT_EQ(mesh.triangles, faces);
  }
}

TEST_F(MeshReader, stl_joins_only_identical_corners) {
  const std::vector<Float3> signed_zeros{{0.0f, 0, 0}, {-0.0f, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Index3> triangles{{0, 2, 3}, {1, 3, 2}};
  const Mesh mesh = read("a.stl", binary_stl(2, signed_zeros, triangles));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  expect_same_triangles(mesh, signed_zeros, triangles);
}

TEST_F(MeshReader, stl_may_be_binary_though_it_says_solid) {
  expect_same_triangles(read("a.stl", binary_stl(5, points, faces, "solid name")), points, faces);
}

TEST_F(MeshReader, extension_in_any_case) {
  EXPECT_EQ(read("A.OBJ", obj_triangle + "f 1 2 3\n").triangles.size(), 1u);
}

TEST_F(MeshReader, obj_text_rounds_to_the_nearest_float) {
  // Assimp gives other floats for these.
  const Mesh mesh =
      read("a.obj", "v 1.368074 2.435437 -0.227403\nv -2.991600 1e-50 +4.5\nv 8.644791 7 1E2\nf 1 2 3");
  EXPECT_EQ(mesh.vertices[0], (Float3{1.368074f, 2.435437f, -0.227403f}));
  EXPECT_EQ(mesh.vertices[1], (Float3{-2.991600f, 0.0f, 4.5f}));
  EXPECT_EQ(mesh.vertices[2], (Float3{8.644791f, 7.0f, 100.0f}));
}

TEST_F(MeshReader, obj_syntax) {
  const Mesh mesh =
      read("a.obj",
           "# comment\r\nmtllib x.mtl\no one\nv 0 0 0 1.0\nv\t1 0 0\nv 0 1 0\n\nusemtl a\n"
           "f 1/1/1 2//2 3/3\nv 1 1 0\ng two\nusemtl b\nf -4 -3 \\\n -2 -1 # fan\nusemtl a\nl 1 2\n"
           "f 5 1 2\r\nv 0 0 1\n");
  const std::vector<Index3> expected{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {4, 0, 1}};
  EXPECT_EQ(mesh.triangles, expected);
  EXPECT_EQ(mesh.vertices[4], (Float3{0, 0, 1}));
}

// As Windows writes text: lines that end in "\r\n", after a byte order mark.
TEST_F(MeshReader, lines_of_windows_and_a_byte_order_mark) {
  const auto with_returns = [](const std::string& text) {
    std::string out;
    for (const char c : text) out += c == '\n' ? std::string("\r\n") : std::string(1, c);
    return out;
  };
  const std::string mark = "\xef\xbb\xbf";
  for (const std::string& text : {obj(points, faces), with_returns(obj(points, faces))})
    for (const std::string& before : {std::string(), mark}) {
      const Mesh mesh = read("a.obj", before + text);
      expect_same_triangles(mesh, points, faces);
      EXPECT_EQ(mesh.vertices.size(), points.size());
    }
  for (const std::string& text : {ascii_stl(points, faces), with_returns(ascii_stl(points, faces))})
    for (const std::string& before : {std::string(), mark})
      expect_same_triangles(read("a.stl", before + text), points, faces);
}

TEST_F(MeshReader, ply_polygons_other_elements_and_doubles) {
  const std::string text =
      "ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement vertex 4\r\nproperty uchar red\r\nproperty double "
      "x\r\n"
      "property double y\r\nproperty double z\r\nelement edge 1\r\nproperty int vertex1\r\nproperty int "
      "vertex2\r\n"
      "element face 2\r\nproperty list uchar float weights\r\nproperty list ushort uint "
      "vertex_index\r\nend_header\r\n"
      "1 0.1 0 0\r\n2 1 0 0\r\n3 1 1 0\r\n4 0 1 0\r\n0 1\r\n1 0.5 4 0 1 2 3\r\n0 3 3 1 0\r\n";
  const Mesh mesh = read("a.ply", text);
  const std::vector<Index3> expected{{0, 1, 2}, {0, 2, 3}, {3, 1, 0}};
  EXPECT_EQ(mesh.triangles, expected);
  EXPECT_EQ(mesh.vertices[0][0], 0.1f);
}

TEST_F(MeshReader, gltf_applies_the_transformations_of_its_nodes) {
  Bytes buffer;
  buffer.put(Float3{0, 0, 0}).put(Float3{1, 0, 0}).put(Float3{0, 1, 0});
  for (const std::uint32_t index : {2u, 0u, 1u}) buffer.put(index);
  write("a.bin", buffer.str());
  const Mesh mesh = read("a.gltf", gltf("48"));
  expect_same_triangles(mesh, {{10, 0, 0}, {12, 0, 0}, {10, 2, 0}}, {{2, 0, 1}});
}

}  // namespace
}  // namespace raylanes::bench
