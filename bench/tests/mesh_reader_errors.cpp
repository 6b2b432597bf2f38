// Files that read_mesh refuses, and what it says of them.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "mesh_files.hpp"

namespace raylanes::bench {
namespace {

constexpr std::uint32_t billions = 4000000000u;

// The text with one part replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST_F(MeshReader, what_is_not_a_mesh) {
  expect_error(folder_ / "missing.ply", "no such file");
  expect_error((folder_ / "a").parent_path(), "unknown extension");
  fs::create_directory(folder_ / "folder.obj");
  expect_error(folder_ / "folder.obj", "is not a regular file");
  expect_errors({{"a.xyz", "v", "unknown extension '.xyz', allowed are .obj, .ply, .stl, .ra2"},
                 {"a.obj", obj_triangle, "has no triangles"},
                 {"a.stl", binary_stl(0, points, {}), "has no triangles"},
                 {"a.ra2", "", "has no triangles"},
                 {"a.ply", binary_ply(Endian::little, points, {}), "has no triangles"},
                 {"a.gltf", obj_triangle + "f 1 2 3\n", "is no glTF: "},
                 {"b.gltf", "{}", "is no glTF 2: "},
                 {"c.gltf", R"({"asset":{"version":"2.0"}})", "scene 0 is out of range"},
                 {"a.glb", "glTF garbage", "is a truncated or malformed .glb file"}});
}

TEST_F(MeshReader, obj_text) {
  expect_errors({{"a.obj", obj_triangle + "f 1 2 4\n", "line 4: index 3 (counted from 0) is out of range"},
                 {"a.obj", obj_triangle + "f 1 2 0\nv 1 1 1\n", "line 4: index 0 is out of range"},
                 {"a.obj", obj_triangle + "f -1 -2 -4\n", "line 4: index -4 is out of range"},
                 {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1e99 0\nf 1 2 3\n", "coordinate y is inf"},
                 {"a.obj", "v 0 0 0\nv 1 abc 0\n", "line 2: 'abc' is not a coordinate"},
                 {"a.obj", obj_triangle + "f 1 2 3x\n", "line 4: '3x' is not a corner"},
                 {"a.obj", obj_triangle + "f 1 2\n", "line 4: has 2 corners"}});
}

TEST_F(MeshReader, coordinates_that_are_not_finite) {
  const std::vector<Index3> triangle{{0, 1, 2}};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Float3> bad{{0, 0, 0}, {1, 0, 0}, {0, nan, 0}};
  expect_errors({{"a.ply", binary_ply(Endian::little, bad, triangle), "coordinate y is nan"},
                 {"a.ra2", ra2(bad, triangle), "coordinate y is nan"},
                 {"a.stl", binary_stl(1, bad, triangle), "coordinate y is nan"},
                 {"a.obj", obj(bad, triangle), "coordinate y is nan"},
                 {"b.ply", ply_header("ascii", 3, 1) + "0 0 0\n1 0 0\n0 inf 0\n3 0 1 2\n", "malformed"},
                 {"b.stl", ascii_stl(bad, triangle), "STL"}});
}

// No proper prefix of a binary file may pass for a file, no count for another one.
TEST_F(MeshReader, truncated_files_and_promises_of_billions) {
  const std::string ply = binary_ply(Endian::little, points, faces), stl = binary_stl(5, points, faces);
  for (std::size_t size = 0; size < ply.size(); ++size) expect_error("a.ply", ply.substr(0, size), "");
  for (std::size_t size = 0; size < stl.size(); ++size) expect_error("a.stl", stl.substr(0, size), "");
  expect_errors(
      {{"a.ply", ply.substr(0, ply.size() - 1), "after 4 of 4 vertices and 4 of 5 faces"},
       {"b.ply", ply_header("ascii", 3, 2) + ply_triangle + "3 0 1 2\n3 0", "1 of 2 faces"},
       {"c.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "no end_header"},
       {"a.stl", stl + "x", "has 335 bytes, allowed for 5 triangles of a binary STL file are 334"},
       {"b.stl", binary_stl(4, points, faces, "solid thing"), "has 334 bytes, allowed for 4 triangles"},
       {"c.stl", binary_stl(billions, points, faces), "has 334 bytes, allowed for 4000000000 triangles"},
       {"d.stl", ascii_stl(points, faces).substr(0, 300), "truncated or malformed STL"},
       {"a.ra2", std::string(37, '\0'), "has 37 bytes, allowed are multiples of 36"}});
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
    expect_errors(
        {{"a.ply", ply_header(format, 3, billions) + "0 0 0 1 0 0 0 1 0 3 0 1 2", "of 4000000000 faces"},
         {"b.ply", ply_header(format, billions, 1) + "0 0 0 1 0 0", "of 4000000000 vertices"}});
}

TEST_F(MeshReader, ply_headers_and_lists) {
  const std::string good = ply_header("ascii", 3, 1), empty = ply_header("binary_little_endian", 0, 1);
  for (const auto& [from, to, says] : std::vector<std::array<std::string, 3>>{
           {"ply", "plx", "first line must be 'ply'"},
           {"ascii", "binary_middle_endian", "line 2: allowed is format"},
           {"format ascii 1.0\n", "", "no format"},
           {"property float x\n", "", "properties x, y, z"},
           {"vertex_indices", "corners", "vertex_indices or vertex_index"},
           {"float y", "int y", "coordinates of type int"},
           {"int vertex_indices", "float vertex_indices", "indices of type float"},
           {"element face 1", "element face -1", "'-1' is not a whole number"},
           {"element face 1", "element vertex 1", "a second element vertex"},
           {"element vertex", "element hole 18446744073709551615\nelement vertex", "an element hole"}})
    expect_error("a.ply", with(good, from, to) + ply_triangle + "3 0 1 2\n", says);
  expect_errors({{"a.ply", with(empty, "list uchar", "list uint") + "\xff\xff\xff\xff",
                  "allowed is property list char|uchar|short|ushort"},
                 {"b.ply", with(empty, "list uchar", "list char") + "\xff", "malformed"},
                 {"c.ply", binary_ply(Endian::little, points, {{0, 1, 2}, {0, 1, 4}}), "face 1: index 4"},
                 {"d.ply", binary_ply(Endian::big, points, {{0, 0xffffffffu, 2}}), "face 0: index -1"},
                 {"e.ply", with(good, "list uchar", "list char") + ply_triangle + "-3 0 1 2\n",
                  "face 0: '-3' is no length of a list"}});
}

// CGAL ends an integer at the first other character, and takes a count of 259 for 3.
TEST_F(MeshReader, ply_text_has_numbers_of_its_types) {
  const std::string good = ply_header("ascii", 3, 2) + ply_triangle;
  ASSERT_EQ(read("good.ply", good + "3 0 1 2\n3 +2 1 0\n").triangles.size(), 2u);
  for (const char* index : {"2.7", ".5", "2e0", "0x2", "99999999999", "2,"})
    expect_error("a.ply", good + "3 0 1 2\n3 0 1 " + index + "\n",
                 "face 1: '" + std::string(index) + "' is no int");
  for (const char* count : {"259", "3.0", "-3"})
    expect_error("b.ply", good + count + " 0 1 2\n3 0 1 2\n",
                 "face 0: '" + std::string(count) + "' is no uchar");
  expect_errors({{"c.ply", good + "3 0 1 2\n2 0 1\n", "face 1: has 2 corners"},
                 {"d.ply", good + "3 0 1 2\n3 0 1 3\n", "face 1: index 3"},
                 {"e.ply", with(good, "1 0 0", "1 0.5.5 0"), "vertex 1: '0.5.5' is no float"}});
}

TEST_F(MeshReader, what_files_say_is_fit_for_a_terminal) {
  for (const std::string& text : {std::string("\x1b[31m"), std::string(100000, 'x')})
    expect_errors({{"a.obj", "v 0 0 " + text + "\n", ""},
                   {"b.obj", obj_triangle + "f 1 2 " + text + "\n", ""},
                   {"a.ply", ply_header("ascii", 3, 1) + "0 0 " + text + "\n", ""},
                   {"b.ply", "ply\nformat ascii 1.0\nelement vertex " + text + "\n", ""},
                   {"a.gltf", text, ""},
                   {"b.gltf", "{\"asset\": \"" + text + "\"}", ""}});
}

}  // namespace
}  // namespace raylanes::bench
