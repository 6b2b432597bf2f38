// read_mesh against files that the test writes byte by byte, and against scenes with known counts.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "../bench/mesh_reader.hpp"

namespace raylanes::bench {
namespace {

namespace fs = std::filesystem;

enum class Endian { little, big };

// The bytes of a file under construction.
class Bytes {
 public:
  explicit Bytes(std::string text = "", Endian order = Endian::little)
      : bytes_(std::move(text)), order_(order) {}

  template <typename T>
  Bytes& put(T value) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if ((std::endian::native == std::endian::little) != (order_ == Endian::little))
      std::reverse(raw.begin(), raw.end());
    bytes_.append(raw.data(), raw.size());
    return *this;
  }
  Bytes& put(const Float3& v) { return put(v[0]).put(v[1]).put(v[2]); }
  Bytes& fill(std::size_t count) {
    bytes_.append(count, '\0');
    return *this;
  }
  const std::string& str() const { return bytes_; }

 private:
  std::string bytes_;
  Endian order_;
};

class MeshReader : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "raylanes_mesh_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& content) const {
    std::ofstream out(folder_ / name, std::ios::binary);
    out << content;
    return folder_ / name;
  }
  Mesh read(const std::string& name, const std::string& content) const {
    return read_mesh(write(name, content));
  }

  // Reading must throw one line that starts with the file's name and contains `expected`.
  void expect_error(const fs::path& file, const std::string& expected) const {
    try {
      read_mesh(file);
      ADD_FAILURE() << file << " was read, expected an error with '" << expected << "'";
    } catch (const std::exception& error) {
      const bool declared = dynamic_cast<const std::runtime_error*>(&error) != nullptr ||
                            dynamic_cast<const std::invalid_argument*>(&error) != nullptr;
      EXPECT_TRUE(declared) << error.what();
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with(file.string() + ": ")) << message;
      EXPECT_NE(message.find(expected), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
  void expect_error(const std::string& name, const std::string& content, const std::string& expected) const {
    expect_error(write(name, content), expected);
  }

  fs::path folder_;
};

constexpr float denormal = std::numeric_limits<float>::denorm_min();

// Values whose bits a reader could lose: -0, denormals, the largest float, ones without a short decimal.
const std::vector<Float3> points{{-0.0f, 0.0f, 1.0f},
                                 {0.1f, 16777215.0f, denormal},
                                 {std::numeric_limits<float>::max(), -1.17549435e-38f, 3.14159274f},
                                 {-0.333333343f, 1e-20f, 24000.0234f}};
// A degenerate triangle, a duplicate, and both orders of turning.
const std::vector<Index3> faces{{0, 1, 2}, {2, 1, 3}, {1, 1, 3}, {0, 1, 2}, {3, 2, 0}};

std::string exact_decimal(float value) {
  std::ostringstream out;
  out.precision(9);
  out << value;
  return out.str();
}

std::string text_of(const Float3& v) {
  return exact_decimal(v[0]) + " " + exact_decimal(v[1]) + " " + exact_decimal(v[2]);
}

std::array<std::uint32_t, 3> bits_of(const Float3& v) {
  return std::bit_cast<std::array<std::uint32_t, 3>>(v);
}

// The corners of every triangle, in order and bit by bit, whatever the numbering of vertices.
void expect_same_triangles(const Mesh& mesh, const std::vector<Float3>& vertices,
                           const std::vector<Index3>& expected) {
  ASSERT_EQ(mesh.triangles.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(bits_of(mesh.vertices.at(mesh.triangles[i][k])), bits_of(vertices.at(expected[i][k])))
          << "triangle " << i << " corner " << k;
}

std::string ply_header(const std::string& format, std::uint64_t vertices, std::uint64_t face_count,
                       const std::string& real = "float") {
  return "ply\nformat " + format + " 1.0\ncomment by a test\nelement vertex " + std::to_string(vertices) +
         "\nproperty " + real + " x\nproperty " + real + " y\nproperty " + real + " z\nelement face " +
         std::to_string(face_count) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string binary_ply(Endian order, const std::vector<Float3>& vertices,
                       const std::vector<Index3>& triangles) {
  const char* format = order == Endian::little ? "binary_little_endian" : "binary_big_endian";
  Bytes bytes(ply_header(format, vertices.size(), triangles.size()), order);
  for (const Float3& v : vertices) bytes.put(v);
  for (const Index3& t : triangles) bytes.put(std::uint8_t{3}).put(t[0]).put(t[1]).put(t[2]);
  return bytes.str();
}

std::string binary_stl(std::uint32_t promised, const std::vector<Float3>& vertices,
                       const std::vector<Index3>& triangles, const std::string& title = "binary") {
  Bytes bytes(title);
  bytes.fill(80 - title.size()).put(promised);
  for (const Index3& t : triangles) {
    bytes.fill(12);
    for (const std::uint32_t index : t) bytes.put(vertices[index]);
    bytes.fill(2);
  }
  return bytes.str();
}

std::string ascii_stl(const std::vector<Float3>& vertices, const std::vector<Index3>& triangles) {
  std::string text = "solid test\n";
  for (const Index3& t : triangles) {
    text += "facet normal 0 0 1\n outer loop\n";
    for (const std::uint32_t index : t) text += "  vertex " + text_of(vertices[index]) + "\n";
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid test\n";
}

std::string ra2(const std::vector<Float3>& vertices, const std::vector<Index3>& triangles) {
  Bytes bytes;
  for (const Index3& t : triangles)
    for (const std::uint32_t index : t) bytes.put(vertices[index]);
  return bytes.str();
}

std::string obj(const std::vector<Float3>& vertices, const std::vector<Index3>& triangles) {
  std::string text;
  for (const Float3& v : vertices) text += "v " + text_of(v) + "\n";
  for (const Index3& t : triangles)
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  return text;
}

const std::string obj_triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string ply_triangle = "0 0 0\n1 0 0\n0 1 0\n";

TEST_F(MeshReader, KeepsOrderAndBitsInEveryFormat) {
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

TEST_F(MeshReader, IndexedFormatsKeepTheVertexNumbers) {
  for (const Mesh& mesh :
       {read("a.obj", obj(points, faces)), read("a.ply", binary_ply(Endian::big, points, faces))}) {
    EXPECT_EQ(mesh.vertices.size(), points.size());
    EXPECT_EQ(mesh.triangles, faces);
  }
}

TEST_F(MeshReader, StlJoinsOnlyIdenticalCorners) {
  const std::vector<Float3> signed_zeros{{0.0f, 0, 0}, {-0.0f, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Index3> triangles{{0, 2, 3}, {1, 3, 2}};
  const Mesh mesh = read("a.stl", binary_stl(2, signed_zeros, triangles));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  expect_same_triangles(mesh, signed_zeros, triangles);
}

TEST_F(MeshReader, StlMayBeBinaryThoughItSaysSolid) {
  expect_same_triangles(read("a.stl", binary_stl(5, points, faces, "solid name")), points, faces);
}

TEST_F(MeshReader, ExtensionInAnyCase) {
  EXPECT_EQ(read("A.OBJ", obj_triangle + "f 1 2 3\n").triangles.size(), 1u);
}

TEST_F(MeshReader, ObjTextRoundsToTheNearestFloat) {
  // Assimp gives other floats for these.
  const Mesh mesh =
      read("a.obj", "v 1.368074 2.435437 -0.227403\nv -2.991600 1e-50 +4.5\nv 8.644791 7 1E2\nf 1 2 3");
  EXPECT_EQ(mesh.vertices[0], (Float3{1.368074f, 2.435437f, -0.227403f}));
  EXPECT_EQ(mesh.vertices[1], (Float3{-2.991600f, 0.0f, 4.5f}));
  EXPECT_EQ(mesh.vertices[2], (Float3{8.644791f, 7.0f, 100.0f}));
}

TEST_F(MeshReader, ObjSyntax) {
  const Mesh mesh =
      read("a.obj",
           "# comment\r\nmtllib x.mtl\no one\nv 0 0 0 1.0\nv\t1 0 0\nv 0 1 0\n\nusemtl a\n"
           "f 1/1/1 2//2 3/3\nv 1 1 0\ng two\nusemtl b\nf -4 -3 \\\n -2 -1 # fan\nusemtl a\nl 1 2\n"
           "f 5 1 2\r\nv 0 0 1\n");
  const std::vector<Index3> expected{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {4, 0, 1}};
  EXPECT_EQ(mesh.triangles, expected);
  EXPECT_EQ(mesh.vertices[4], (Float3{0, 0, 1}));
}

TEST_F(MeshReader, PlyPolygonsOtherElementsAndDoubles) {
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

std::string gltf(const std::string& payload_bytes, const std::string& indices_count = "3") {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"children":[1],"translation":[10,0,0]},{"mesh":0,"scale":[2,2,2]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"buffers":[{"uri":"a.bin","byteLength":)" +
         payload_bytes + R"(}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":12}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5125,"count":)" +
         indices_count + R"(,"type":"SCALAR"}]})";
}

TEST_F(MeshReader, GltfAppliesTheTransformationsOfItsNodes) {
  Bytes buffer;
  buffer.put(Float3{0, 0, 0}).put(Float3{1, 0, 0}).put(Float3{0, 1, 0});
  for (const std::uint32_t index : {2u, 0u, 1u}) buffer.put(index);
  write("a.bin", buffer.str());
  const Mesh mesh = read("a.gltf", gltf("48"));
  expect_same_triangles(mesh, {{10, 0, 0}, {12, 0, 0}, {10, 2, 0}}, {{2, 0, 1}});
}

TEST_F(MeshReader, GltfErrors) {
  expect_error("a.gltf", gltf("48"), "cannot be read");  // without its buffer
  expect_error("b.gltf", "{\"asset\":", "cannot be read");
  expect_error("c.glb", "glTF garbage", "cannot be read");
  expect_error("d.gltf", "", "cannot be read");
}

TEST_F(MeshReader, WhatIsNotAFile) {
  expect_error(folder_ / "missing.ply", "no such file");
  expect_error(folder_, "unknown extension");
  fs::create_directory(folder_ / "folder.obj");
  expect_error(folder_ / "folder.obj", "is not a regular file");
  expect_error("a.xyz", "v", "unknown extension '.xyz', allowed are .obj, .ply, .stl, .ra2");
}

TEST_F(MeshReader, NoTriangles) {
  for (const char* name : {"a.obj", "a.stl", "a.ra2"}) expect_error(name, "", "has no triangles");
  expect_error("b.obj", obj_triangle, "has no triangles");
  expect_error("b.stl", binary_stl(0, points, {}), "has no triangles");
  expect_error("c.stl", "solid x\nendsolid x\n", "has no triangles");
  expect_error("b.ply", binary_ply(Endian::little, points, {}), "has no triangles");
}

TEST_F(MeshReader, IndexOutOfRange) {
  expect_error("a.obj", obj_triangle + "f 1 2 4\n", "line 4: index 3 (counted from 0) is out of range");
  expect_error("b.obj", obj_triangle + "f 1 2 0\nv 1 1 1\n", "line 4: index 0 is out of range");
  expect_error("c.obj", obj_triangle + "f -1 -2 -4\n", "line 4: index -4 is out of range");
  expect_error("d.obj", obj_triangle + "f 1 2 99999999999999999999\n", "line 4: ");
  expect_error("a.ply", binary_ply(Endian::little, points, {{0, 1, 2}, {0, 1, 4}}), "face 1: index 4");
  expect_error("b.ply", binary_ply(Endian::big, points, {{0, 0xffffffffu, 2}}), "face 0: index -1");
  expect_error("c.ply", ply_header("ascii", 3, 1) + ply_triangle + "3 0 1 3\n", "face 0: index 3");
}

TEST_F(MeshReader, CoordinatesThatAreNotFinite) {
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
TEST_F(MeshReader, EveryTruncationOfABinaryFileIsAnError) {
  for (const auto& [name, whole] :
       {std::pair<std::string, std::string>{"a.ply", binary_ply(Endian::little, points, faces)},
        {"b.ply", binary_ply(Endian::big, points, faces)},
        {"a.stl", binary_stl(5, points, faces)}})
    for (std::size_t size = 0; size < whole.size(); ++size) expect_error(name, whole.substr(0, size), "");
}

TEST_F(MeshReader, TruncatedFilesSaySo) {
  const std::string whole = binary_ply(Endian::little, points, faces);
  expect_error("a.ply", whole.substr(0, whole.size() - 1), "after 4 of 4 vertices and 4 of 5 faces");
  expect_error("b.ply", ply_header("ascii", 3, 2) + ply_triangle + "3 0 1 2\n3 0", "1 of 2 faces");
  expect_error("c.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "no end_header");
  expect_error("a.stl", binary_stl(6, points, faces), "truncated STL");
  expect_error("b.stl", ascii_stl(points, faces).substr(0, 300), "truncated STL");
  expect_error("a.ra2", std::string(37, '\0'), "has 37 bytes, allowed are multiples of 36");
  expect_error("b.ra2", std::string(35, '\0'), "has 35 bytes");
}

TEST_F(MeshReader, PromisesOfBillionsFailAtOnce) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    expect_error("faces.ply", ply_header(format, 3, 4000000000u) + "0 0 0 1 0 0 0 1 0 3 0 1 2",
                 "of 4000000000 faces");
    expect_error("vertices.ply", ply_header(format, 4000000000u, 1) + "0 0 0 1 0 0",
                 "of 4000000000 vertices");
  }
  expect_error("a.stl", binary_stl(4000000000u, points, faces), "truncated STL");
  std::string long_list = ply_header("binary_little_endian", 0, 1);
  long_list.replace(long_list.find("list uchar"), 10, "list uint");
  expect_error("list.ply", long_list + "\xff\xff\xff\xff",
               "allowed is property list char|uchar|short|ushort");
  std::string negative_list = ply_header("binary_little_endian", 0, 1);
  negative_list.replace(negative_list.find("list uchar"), 10, "list char");
  expect_error("negative.ply", negative_list + "\xff", "malformed");
}

TEST_F(MeshReader, Garbage) {
  std::string noise;
  std::uint32_t state = 1;
  for (int i = 0; i < 3000; ++i) noise += static_cast<char>((state = state * 1664525u + 1013904223u) >> 24);
  for (const char* name : {"a.obj", "a.ply", "a.stl", "a.gltf", "a.glb", "a.ra2"})
    expect_error(name, noise, "");
}

TEST_F(MeshReader, MalformedObj) {
  expect_error("a.obj", "v 0 0 0\nv 1 abc 0\n", "line 2: 'abc' is not a coordinate");
  expect_error("b.obj", "v 0 0\n", "line 1: '' is not a coordinate");
  expect_error("c.obj", obj_triangle + "f 1 2 3x\n", "line 4: '3x' is not a corner");
  expect_error("d.obj", obj_triangle + "f 1 2\n", "line 4: has 2 corners");
  expect_error("e.obj", obj_triangle + "f\n", "line 4: has 0 corners");
}

TEST_F(MeshReader, MalformedPly) {
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
  expect_error("n.ply", good + "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", "malformed");
  expect_error("o.ply", good + ply_triangle + "2 0 1\n", "face 0: has 2 corners");
}

// Bit for bit what the file says, for scenes on this machine.
class RealScenes : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("RAYLANES_SCENES");
    if (!folder)
      GTEST_SKIP() << "RAYLANES_SCENES is not set: the triangle counts of real scenes are NOT checked";
    folder_ = folder;
  }
  fs::path folder_;
};

TEST_F(RealScenes, HaveTheListedNumberOfTriangles) {
  std::ifstream list(folder_ / "scenes.tsv");
  ASSERT_TRUE(list) << "no scenes.tsv in " << folder_;
  std::size_t scenes = 0;
  for (std::string line; std::getline(list, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream columns(line);
    std::string name, file;
    std::size_t triangles = 0;
    ASSERT_TRUE(columns >> name >> file >> triangles) << line;
    EXPECT_EQ(read_mesh(folder_ / file).triangles.size(), triangles) << name;
    ++scenes;
  }
  EXPECT_GT(scenes, 0u);
}

TEST_F(RealScenes, RawTrianglesEqualTheIndexedOnes) {
  const Mesh raw = read_mesh(folder_ / "sibenik.ra2"), indexed = read_mesh(folder_ / "sibenik.ply");
  ASSERT_EQ(raw.triangles.size(), indexed.triangles.size());
  for (std::size_t i = 0; i < raw.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(bits_of(raw.vertices[raw.triangles[i][k]]),
                bits_of(indexed.vertices[indexed.triangles[i][k]]))
          << i;
}

TEST_F(RealScenes, ConferenceKeepsItsTrianglesWithoutArea) {
  const Mesh mesh = read_mesh(folder_ / "conference.ply");
  std::size_t flat = 0;
  for (const auto& [ia, ib, ic] : mesh.triangles) {
    const Float3 &a = mesh.vertices[ia], &b = mesh.vertices[ib], &c = mesh.vertices[ic];
    double squares = 0;
    for (std::size_t x = 0; x < 3; ++x) {
      const std::size_t y = (x + 1) % 3;
      const double minor =
          (double(b[x]) - a[x]) * (double(c[y]) - a[y]) - (double(b[y]) - a[y]) * (double(c[x]) - a[x]);
      squares += minor * minor;
    }
    flat += squares == 0;
  }
  EXPECT_EQ(flat, 53627u);
}

}  // namespace
}  // namespace raylanes::bench
