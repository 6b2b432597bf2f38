// read_mesh against files that the test writes byte by byte, and what it says of those that it refuses.
#include "mesh_files.hpp"

namespace raylanes::bench {
namespace {

constexpr std::endian little = std::endian::little, big = std::endian::big;
const std::string obj_triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", ply_triangle = "0 0 0\n1 0 0\n0 1 0\n";

// As Windows writes text: lines end in "\r\n", after a byte order mark.
std::string of_windows(const std::string& text) {
  std::string out = "\xef\xbb\xbf";
  for (const char c : text) out += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return out;
}

// The text with one part replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST_F(MeshReader, keeps_order_bits_and_numbers_of_vertices_in_every_format) {
  std::string text = ply_header("ascii", points.size(), faces.size());
  for (const Float3& v : points) text += text_of(v);
  for (const Index3& t : faces) text += "3 " + text_of(t);
  const std::string title = "solid facet vertex 7 7 7 vertex 8 8 8 endfacet ";  // adds no triangle
  for (const auto& [name, content] : {std::pair<const char*, std::string>{"a.obj", obj(points, faces)},
                                      {"b.OBJ", of_windows(obj(points, faces))},
                                      {"a.ply", binary_ply(little, points, faces)},
                                      {"b.ply", binary_ply(big, points, faces)},
                                      {"c.ply", text},
                                      {"a.stl", binary_stl(5, points, faces)},
                                      {"b.stl", binary_stl(5, points, faces, title)},
                                      {"c.stl", ascii_stl(points, faces)},
                                      {"d.stl", of_windows(ascii_stl(points, faces))},
                                      {"a.ra2", ra2(points, faces)}}) {
    expect_triangles(name, content, points, faces);
    const bool keeps_numbers = name[2] == 'o' || name[2] == 'p';
    EXPECT_TRUE(!keeps_numbers || read(name, content).triangles == faces) << name;
  }
}

TEST_F(MeshReader, stl_joins_only_identical_corners) {
  const std::vector<Float3> signed_zeros{{0.0f, 0, 0}, {-0.0f, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::string file = binary_stl(2, signed_zeros, {{0, 2, 3}, {1, 3, 2}});
  EXPECT_EQ(read("a.stl", file).vertices.size(), 4u);
  expect_triangles("a.stl", file, signed_zeros, {{0, 2, 3}, {1, 3, 2}});
}

TEST_F(MeshReader, obj_rounds_to_the_nearest_float_and_knows_the_syntax) {
  // Assimp gives other floats for these.
  const Mesh rounded =
      read("a.obj", "v 1.368074 2.435437 -0.227403\nv -2.991600 1e-50 +4.5\nv 8.644791 7 1E2\nf 1 2 3");
  EXPECT_EQ(
      rounded.vertices,
      (std::vector<Float3>{{1.368074f, 2.435437f, -0.227403f}, {-2.991600f, 0, 4.5f}, {8.644791f, 7, 100}}));
  const Mesh mesh =
      read("a.obj",
           "# comment\r\nmtllib x.mtl\no one\nv 0 0 0 1.0\nv\t1 0 0\nv 0 1 0\n\nusemtl a\n"
           "f 1/1/1 2//2 3/3\nv 1 1 0\ng two\nusemtl b\nf -4 -3 \\\n -2 -1 # fan\nusemtl a\nl 1 2\n"
           "f 5 1 2\r\nv 0 0 1\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Index3>{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {4, 0, 1}}));
  EXPECT_EQ(mesh.vertices[4], (Float3{0, 0, 1}));
}

TEST_F(MeshReader, obj_has_groups_and_objects) {
  const std::string faces = "f 1 2 3\n",
                    text = obj_triangle + faces + "g a b\n" + faces + faces + "o c\ng d\n" + faces;
  EXPECT_EQ(read_mesh(folder_.write("a.obj", text)).groups, (std::vector<std::uint32_t>{1, 3, 3}));
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

TEST_F(MeshReader, refuses_what_is_not_a_mesh) {
  expect_error(folder_ / "missing.ply", "no such file");
  expect_error((folder_ / "a").parent_path(), "unknown extension");
  fs::create_directory(folder_ / "folder.obj");
  expect_error(folder_ / "folder.obj", "is not a regular file");
  expect_errors({{"a.xyz", "v", "unknown extension '.xyz', allowed are .obj, .ply, .stl, .ra2"},
                 {"a.obj", obj_triangle, "has no triangles"},
                 {"a.stl", binary_stl(0, points, {}), "has no triangles"},
                 {"a.ra2", "", "has no triangles"},
                 {"a.ply", binary_ply(little, points, {}), "has no triangles"},
                 {"a.gltf", obj_triangle + "f 1 2 3\n", "is no glTF: "},
                 {"b.gltf", "{}", "is no glTF 2: "},
                 {"c.gltf", R"({"asset":{"version":"2.0"}})", "scene 0 is out of range"},
                 {"a.glb", "glTF garbage", "is a truncated or malformed .glb file"},
                 {"a.obj", obj_triangle + "f 1 2 4\n", "line 4: index 3 (counted from 0) is out of range"},
                 {"a.obj", obj_triangle + "f 1 2 0\nv 1 1 1\n", "line 4: index 0 is out of range"},
                 {"a.obj", obj_triangle + "f -1 -2 -4\n", "line 4: index -4 is out of range"},
                 {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1e99 0\nf 1 2 3\n", "coordinate y is inf"},
                 {"a.obj", "v 0 0 0\nv 1 abc 0\n", "line 2: 'abc' is not a coordinate"},
                 {"a.obj", obj_triangle + "f 1 2 3x\n", "line 4: '3x' is not a corner"},
                 {"a.obj", obj_triangle + "f 1 2\n", "line 4: has 2 corners"}});
  const std::vector<Float3> bad{{0, 0, 0}, {1, 0, 0}, {0, std::numeric_limits<float>::quiet_NaN(), 0}};
  expect_errors({{"a.ply", binary_ply(little, bad, {{0, 1, 2}}), "coordinate y is nan"},
                 {"a.ra2", ra2(bad, {{0, 1, 2}}), "coordinate y is nan"},
                 {"a.stl", binary_stl(1, bad, {{0, 1, 2}}), "coordinate y is nan"},
                 {"a.obj", obj(bad, {{0, 1, 2}}), "coordinate y is nan"},
                 {"b.ply", ply_header("ascii", 3, 1) + "0 0 0\n1 0 0\n0 inf 0\n3 0 1 2\n", "malformed"},
                 {"b.stl", ascii_stl(bad, {{0, 1, 2}}), "STL"}});
}

// No proper prefix of a binary file may pass for a file, no count for another one.
TEST_F(MeshReader, refuses_truncated_files_and_promises_of_billions) {
  constexpr std::uint32_t billions = 4000000000u;
  const std::string ply = binary_ply(little, points, faces), stl = binary_stl(5, points, faces);
  for (std::size_t size = 0; size < ply.size(); ++size) expect_errors({{"a.ply", ply.substr(0, size), ""}});
  for (std::size_t size = 0; size < stl.size(); ++size) expect_errors({{"a.stl", stl.substr(0, size), ""}});
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

// CGAL ends an integer at the first other character, and takes a count of 259 for 3.
TEST_F(MeshReader, refuses_ply_headers_lists_and_numbers_of_other_types) {
  const std::string one = ply_header("ascii", 3, 1), two = ply_header("ascii", 3, 2) + ply_triangle,
                    empty = ply_header("binary_little_endian", 0, 1);
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
    expect_errors({{"a.ply", with(one, from, to) + ply_triangle + "3 0 1 2\n", says}});
  expect_errors({{"a.ply", with(empty, "list uchar", "list uint") + "\xff\xff\xff\xff",
                  "allowed is property list char|uchar|short|ushort"},
                 {"b.ply", with(empty, "list uchar", "list char") + "\xff", "malformed"},
                 {"c.ply", binary_ply(little, points, {{0, 1, 2}, {0, 1, 4}}), "face 1: index 4"},
                 {"d.ply", binary_ply(big, points, {{0, 0xffffffffu, 2}}), "face 0: index -1"},
                 {"e.ply", with(one, "list uchar", "list char") + ply_triangle + "-3 0 1 2\n",
                  "face 0: '-3' is no length of a list"},
                 {"f.ply", two + "3 0 1 2\n2 0 1\n", "face 1: has 2 corners"},
                 {"g.ply", two + "3 0 1 2\n3 0 1 3\n", "face 1: index 3"},
                 {"h.ply", with(two, "1 0 0", "1 0.5.5 0"), "vertex 1: '0.5.5' is no float"}});
  EXPECT_EQ(read("good.ply", two + "3 0 1 2\n3 +2 1 0\n").triangles.size(), 2u);
  for (const std::string index : {"2.7", ".5", "2e0", "0x2", "99999999999", "2,"})
    expect_errors({{"a.ply", two + "3 0 1 2\n3 0 1 " + index + "\n", "face 1: '" + index + "' is no int"}});
  for (const std::string count : {"259", "3.0", "-3"})
    expect_errors({{"b.ply", two + count + " 0 1 2\n3 0 1 2\n", "face 0: '" + count + "' is no uchar"}});
}

TEST_F(MeshReader, says_what_is_fit_for_a_terminal) {
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
