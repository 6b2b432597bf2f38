// Files that read_mesh must refuse, with a line that says which and why.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "mesh_files.hpp"

namespace raylanes::bench {
namespace {

TEST_F(MeshReader, what_is_not_a_file) {
  expect_error(folder_ / "missing.ply", "no such file");
  expect_error((folder_ / "a").parent_path(), "unknown extension");
  fs::create_directory(folder_ / "folder.obj");
  expect_error(folder_ / "folder.obj", "is not a regular file");
  expect_error("a.xyz", "v", "unknown extension '.xyz', allowed are .obj, .ply, .stl, .ra2");
}

TEST_F(MeshReader, no_triangles) {
  for (const char* name : {"a.obj", "a.stl", "a.ra2"}) expect_error(name, "", "has no triangles");
  expect_error("b.obj", obj_triangle, "has no triangles");
  expect_error("b.stl", binary_stl(0, points, {}), "has no triangles");
  expect_error("c.stl", "solid x\nendsolid x\n", "has no triangles");
  expect_error("b.ply", binary_ply(Endian::little, points, {}), "has no triangles");
}

TEST_F(MeshReader, index_out_of_range) {
  expect_error("a.obj", obj_triangle + "f 1 2 4\n", "line 4: index 3 (counted from 0) is out of range");
  expect_error("b.obj", obj_triangle + "f 1 2 0\nv 1 1 1\n", "line 4: index 0 is out of range");
  expect_error("c.obj", obj_triangle + "f -1 -2 -4\n", "line 4: index -4 is out of range");
  expect_error("d.obj", obj_triangle + "f 1 2 99999999999999999999\n", "line 4: ");
  expect_error("a.ply", binary_ply(Endian::little, points, {{0, 1, 2}, {0, 1, 4}}), "face 1: index 4");
  expect_error("b.ply", binary_ply(Endian::big, points, {{0, 0xffffffffu, 2}}), "face 0: index -1");
  expect_error("c.ply", ply_header("ascii", 3, 1) + ply_triangle + "3 0 1 3\n", "face 0: index 3");
}

TEST_F(MeshReader, coordinates_that_are_not_finite) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const std::vector<Index3> triangle{{0, 1, 2}};
  const std::vector<std::pair<float, std::string>> cases{{nan, "nan"}, {infinity, "inf"}};
  for (const auto& [value, word] : cases) {
    const std::vector<Float3> bad{{0, 0, 0}, {1, 0, 0}, {0, value, 0}};
    expect_error("a.ply", binary_ply(Endian::little, bad, triangle), "coordinate y is " + word);
    expect_error("a.ra2", ra2(bad, triangle), "coordinate y is " + word);
    expect_error("a.stl", binary_stl(1, bad, triangle), "coordinate y is " + word);
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 " + word + " 0\nf 1 2 3\n", "coordinate y is " + word);
    expect_error("b.ply", ply_header("ascii", 3, 1) + "0 0 0\n1 0 0\n0 " + word + " 0\n3 0 1 2\n",
                 "malformed");
    expect_error("b.stl", ascii_stl(bad, triangle), "STL");
  }
  expect_error("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1e99 0\nf 1 2 3\n", "coordinate y is inf");
}

// No proper prefix of a binary file may pass for a file.
TEST_F(MeshReader, every_truncation_of_a_binary_file_is_an_error) {
  for (const auto& [name, whole] :
       {std::pair<std::string, std::string>{"a.ply", binary_ply(Endian::little, points, faces)},
        {"b.ply", binary_ply(Endian::big, points, faces)},
        {"a.stl", binary_stl(5, points, faces)}})
    for (std::size_t size = 0; size < whole.size(); ++size) expect_error(name, whole.substr(0, size), "");
}

TEST_F(MeshReader, truncated_files_say_so) {
  const std::string whole = binary_ply(Endian::little, points, faces);
  expect_error("a.ply", whole.substr(0, whole.size() - 1), "after 4 of 4 vertices and 4 of 5 faces");
  expect_error("b.ply", ply_header("ascii", 3, 2) + ply_triangle + "3 0 1 2\n3 0", "1 of 2 faces");
  expect_error("c.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "no end_header");
  expect_error("a.stl", binary_stl(6, points, faces), "has 334 bytes, allowed for 6 triangles");
  expect_error("b.stl", ascii_stl(points, faces).substr(0, 300), "truncated or malformed STL");
  expect_error("a.ra2", std::string(37, '\0'), "has 37 bytes, allowed are multiples of 36");
  expect_error("b.ra2", std::string(35, '\0'), "has 35 bytes");
}

TEST_F(MeshReader, promises_of_billions_fail_at_once) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    expect_error("faces.ply", ply_header(format, 3, 4000000000u) + "0 0 0 1 0 0 0 1 0 3 0 1 2",
                 "of 4000000000 faces");
    expect_error("vertices.ply", ply_header(format, 4000000000u, 1) + "0 0 0 1 0 0",
                 "of 4000000000 vertices");
  }
  expect_error("a.stl", binary_stl(4000000000u, points, faces),
               "has 334 bytes, allowed for 4000000000 triangles");
  std::string long_list = ply_header("binary_little_endian", 0, 1);
  long_list.replace(long_list.find("list uchar"), 10, "list uint");
  expect_error("list.ply", long_list + "\xff\xff\xff\xff",
               "allowed is property list char|uchar|short|ushort");
  std::string negative_list = ply_header("binary_little_endian", 0, 1);
  negative_list.replace(negative_list.find("list uchar"), 10, "list char");
  expect_error("negative.ply", negative_list + "\xff", "malformed");
}

TEST_F(MeshReader, garbage) {
  std::string noise;
  std::uint32_t state = 1;
  for (int i = 0; i < 3000; ++i) noise += static_cast<char>((state = state * 1664525u + 1013904223u) >> 24);
  for (const char* name : {"a.obj", "a.ply", "a.stl", "a.gltf", "a.glb", "a.ra2"})
    expect_error(name, noise, "");
}

TEST_F(MeshReader, malformed_obj) {
  expect_error("a.obj", "v 0 0 0\nv 1 abc 0\n", "line 2: 'abc' is not a coordinate");
  expect_error("b.obj", "v 0 0\n", "line 1: '' is not a coordinate");
  expect_error("c.obj", obj_triangle + "f 1 2 3x\n", "line 4: '3x' is not a corner");
  expect_error("d.obj", obj_triangle + "f 1 2\n", "line 4: has 2 corners");
  expect_error("e.obj", obj_triangle + "f\n", "line 4: has 0 corners");
}

TEST_F(MeshReader, malformed_ply) {
  const std::string good = ply_header("ascii", 3, 1);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = good;
    return changed.replace(changed.find(from), from.size(), to) + ply_triangle + "3 0 1 2\n";
  };
  ASSERT_EQ(read("good.ply", with("x", "x")).triangles.size(), 1u);
  expect_error("a.ply", with("ply", "plx"), "first line must be 'ply'");
  expect_error("b.ply", with("ascii", "binary_middle_endian"), "line 2: allowed is format");
  expect_error("c.ply", with("format ascii 1.0\n", ""), "no format");
  expect_error("d.ply", with("property float x\n", ""), "properties x, y, z");
  expect_error("e.ply", with("float y", "int y"), "coordinates of type int");
  expect_error("f.ply", with("int vertex_indices", "float vertex_indices"), "indices of type float");
  expect_error("g.ply", with("vertex_indices", "corners"), "vertex_indices or vertex_index");
  expect_error("h.ply", with("element face 1", "element face one"), "'one' is not a whole number");
  expect_error("i.ply", with("element face 1", "element face -1"), "'-1' is not a whole number");
  expect_error("j.ply", with("float z", "quad z"), "allowed is property TYPE NAME");
  expect_error("k.ply", with("comment by a test", "property float w"), "before the first element");
  expect_error("l.ply", with("element face 1", "element vertex 1"), "a second element vertex");
  expect_error("m.ply", with("comment", "remark"), "allowed are comment");
  expect_error("n.ply", good + "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", "vertex 1: 'zero' is no float");
  expect_error("o.ply", good + ply_triangle + "2 0 1\n", "face 0: has 2 corners");
}

// CGAL ends an integer at the first other character, and takes a count of 259 for 3.
TEST_F(MeshReader, ply_text_has_numbers_of_its_types) {
  const std::string good = ply_header("ascii", 3, 2) + ply_triangle;
  ASSERT_EQ(read("good.ply", good + "3 0 1 2\n3 +2 1 0\n").triangles.size(), 2u);
  for (const std::string face :
       {"3 0 1 2.7", "3 0 1 .5", "3 0 1 2e0", "3 0 1 0x2", "3 0 1 99999999999", "3 0 1 2,"})
    expect_error("a.ply", good + "3 0 1 2\n" + face + "\n", "face 1: '" + face.substr(6) + "' is no int");
  expect_error("b.ply", good + "259 0 1 2\n3 0 1 2\n", "face 0: '259' is no uchar");
  expect_error("c.ply", good + "3.0 0 1 2\n3 0 1 2\n", "face 0: '3.0' is no uchar");
  expect_error("d.ply", good + "-3 0 1 2\n3 0 1 2\n", "face 0: '-3' is no uchar");
  expect_error("e.ply", ply_header("ascii", 3, 1) + "0 0 0\n1 0.5.5 0\n0 1 0\n3 0 1 2\n",
               "vertex 1: '0.5.5' is no float");
  std::string chars = ply_header("ascii", 3, 1);
  chars.replace(chars.find("list uchar"), 10, "list char");
  expect_error("f.ply", chars + ply_triangle + "-3 0 1 2\n", "face 0: '-3' is no length of a list");
  std::string nothing = ply_header("ascii", 3, 1);
  nothing.replace(nothing.find("element vertex"), 0, "element hole 18446744073709551615\n");
  expect_error("g.ply", nothing + ply_triangle + "3 0 1 2\n", "an element hole without properties");
}

TEST_F(MeshReader, binary_stl_has_the_size_that_its_count_says) {
  const std::string whole = binary_stl(5, points, faces);
  expect_error("a.stl", whole + "x", "has 335 bytes, allowed for 5 triangles of a binary STL file are 334");
  expect_error("b.stl", binary_stl(4, points, faces), "has 334 bytes, allowed for 4 triangles");
  expect_error("c.stl", binary_stl(4, points, faces, "solid thing"),
               "has 334 bytes, allowed for 4 triangles");
  // A title that is the beginning of a text does not add to the triangles.
  const std::string title = "solid facet vertex 7 7 7 vertex 8 8 8 vertex 9 9 9 endfacet ";
  expect_same_triangles(read("d.stl", binary_stl(5, points, faces, title)), points, faces);
}

TEST_F(MeshReader, what_files_say_is_fit_for_a_terminal) {
  const std::string colours = "\x1b[31m", many(100000, 'x');
  const auto message_of = [&](const std::string& name, const std::string& content) {
    try {
      read(name, content);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const std::string& text : {colours, many}) {
    for (const std::string& message :
         {message_of("a.obj", "v 0 0 " + text + "\n"),
          message_of("b.obj", obj_triangle + "f 1 2 " + text + "\n"),
          message_of("a.ply", ply_header("ascii", 3, 1) + "0 0 " + text + "\n"),
          message_of("b.ply", "ply\nformat ascii 1.0\nelement vertex " + text + "\n"),
          message_of("a.gltf", text), message_of("b.gltf", "{\"asset\": \"" + text + "\"}")}) {
      EXPECT_FALSE(message.empty());
      EXPECT_LT(message.size(), 600u) << message.substr(0, 1000);
      EXPECT_EQ(message.find('\x1b'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace raylanes::bench
