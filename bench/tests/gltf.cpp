// glTF: scenes of nodes, and files that must be refused before they cost anything.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "mesh_files.hpp"

namespace raylanes::bench {
namespace {

const std::vector<Float3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, denormal, -0.0f}};

// Four corners, then shorts 2 0 1 3: a file's binary part.
std::string buffer_bytes() {
  Bytes bytes;
  for (const Float3& corner : corners) bytes.put(corner);
  for (const int index : {2, 0, 1, 3}) bytes.put(static_cast<std::uint16_t>(index));
  return bytes.str();
}

// The parts of a one-mesh file that a test changes.
struct Document {
  std::string nodes = R"([{"mesh":0}])";
  std::string primitive = R"("attributes":{"POSITION":0},"indices":1,"mode":5)";
  std::string position_accessor = R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC3")";
  std::string index_accessor = R"("bufferView":1,"componentType":5123,"count":4,"type":"SCALAR")";
  std::string index_view = R"("buffer":0,"byteOffset":48,"byteLength":8)";
  std::string buffer = R"("uri":"a.bin","byteLength":56)";
  std::string more = "";

  std::string text() const {
    return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
           R"(,"meshes":[{"primitives":[{)" + primitive + R"(}]}],"accessors":[{)" + position_accessor +
           "},{" + index_accessor + R"(}],"bufferViews":[{"buffer":0,"byteLength":48},{)" + index_view +
           R"(}],"buffers":[{)" + buffer + "}]" + more + "}";
  }
};

std::string glb(std::string json, const std::string& binary) {
  json.append((4 - json.size() % 4) % 4, ' ');
  Bytes bytes("glTF");
  bytes.put(std::uint32_t{2}).put(static_cast<std::uint32_t>(28 + json.size() + binary.size()));
  Bytes json_head, binary_head;
  json_head.put(static_cast<std::uint32_t>(json.size())).put(std::uint32_t{0x4e4f534a});
  binary_head.put(static_cast<std::uint32_t>(binary.size())).put(std::uint32_t{0x004e4942});
  return bytes.str() + json_head.str() + json + binary_head.str() + binary;
}

class Gltf : public MeshReader {
 protected:
  void SetUp() override {
    MeshReader::SetUp();
    write("a.bin", buffer_bytes());
  }
  // The one part of a document that is wrong, and what is said of it.
  struct Wrong {
    std::string Document::*part;
    std::string text, expected;
  };
  void refuse_each(const std::vector<Wrong>& list) const {
    for (const Wrong& wrong : list) {
      Document document;
      document.*wrong.part = wrong.text;
      expect_error("a.gltf", document.text(), wrong.expected);
    }
  }
};

TEST_F(Gltf, strips_fans_lists_and_all_sizes_of_indices) {
  const std::vector<Index3> strip{{2, 0, 1}, {0, 3, 1}}, fan{{0, 1, 2}, {1, 3, 2}};
  Document document;
  expect_same_triangles(read("a.gltf", document.text()), corners, strip);
  document.primitive.back() = '6';
  expect_same_triangles(read("b.gltf", document.text()), corners, fan);
  document.primitive = R"("attributes":{"POSITION":0},"mode":5)";
  expect_same_triangles(read("c.gltf", document.text()), corners, {{0, 1, 2}, {1, 3, 2}});
  document.primitive = R"("attributes":{"POSITION":0},"indices":1)";
  document.index_accessor = R"("bufferView":1,"byteOffset":2,"componentType":5121,"count":3,"type":"SCALAR")";
  document.index_view = R"("buffer":0,"byteOffset":46,"byteLength":10)";  // bytes 2 0 0, from the shorts 2 0
  expect_same_triangles(read("d.gltf", document.text()), corners, {{2, 0, 0}});
}

TEST_F(Gltf, buffers_inside_and_in_glb) {
  Document document;
  document.primitive = R"("attributes":{"POSITION":0},"mode":4)";
  document.position_accessor = R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3")";
  document.buffer = R"("byteLength":56)";
  const std::string whole = glb(document.text(), buffer_bytes());
  expect_same_triangles(read("a.glb", whole), corners, {{0, 1, 2}});
  for (std::size_t size = 0; size < whole.size(); ++size) expect_error("b.glb", whole.substr(0, size), "");
  document.buffer =
      R"("uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA",)"
      R"("byteLength":36)";
  std::string text = document.text();
  const std::string view = R"("byteLength":48})";
  text.replace(text.find(view), view.size(), R"("byteLength":36})");
  expect_same_triangles(read("b.gltf", text), corners, {{0, 1, 2}});
}

TEST_F(Gltf, rotations_matrices_and_points_between) {
  Document document;
  document.nodes = R"([{"children":[1],"rotation":[0,0,0.7071067811865476,0.7071067811865476]},)"
                   R"({"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]}])";
  document.primitive = R"("attributes":{"POSITION":0}},{"attributes":{"POSITION":0},"mode":0)";
  document.position_accessor = R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3")";
  // A quarter turn takes (x, y) to (-y, x).
  expect_same_triangles(read("a.gltf", document.text()), {{-6, 5, 7}, {-6, 6, 7}, {-7, 5, 7}}, {{0, 1, 2}});
  document.nodes = R"([{"children":[1],"translation":[10,0,0]},{"mesh":0,"scale":[2,2,2]}])";
  expect_same_triangles(read("b.gltf", document.text()), {{10, 0, 0}, {12, 0, 0}, {10, 2, 0}}, {{0, 1, 2}});
}

// --- What must be refused

TEST_F(Gltf, nodes_are_trees_of_bounded_depth) {
  // 20 levels of two children each that are the same node: a million meshes from a kilobyte.
  std::string shared = "[", deep = "[";
  for (int i = 1; i <= 20; ++i)
    shared += R"({"children":[)" + std::to_string(i) + "," + std::to_string(i) + "]},";
  for (int i = 1; i <= 100000; ++i) deep += R"({"children":[)" + std::to_string(i) + "]},";
  refuse_each({{&Document::nodes, R"([{"children":[1,1]},{"mesh":0}])", "nodes[1]: is reached twice"},
               {&Document::nodes, R"([{"children":[0],"mesh":0}])", "nodes[0]: is reached twice"},
               {&Document::nodes, shared + R"({"mesh":0}])", "is reached twice"},
               {&Document::nodes, deep + R"({"mesh":0}])", "nodes[128]: is deeper than 128 nodes"},
               {&Document::nodes, R"([{"children":[7]}])", "node 7 is out of range, there are 1"}});
}

TEST_F(Gltf, nested_text_is_refused_wherever_it_is) {
  for (const std::string key : {"extras", "extensions", "nodes", "anything"})
    expect_error("a.gltf", R"({"asset":{"version":"2.0"},")" + key + "\":" + std::string(200000, '['),
                 "nested deeper");
}

TEST_F(Gltf, values_of_the_wrong_kind_or_beyond_their_buffers) {
  for (const std::string children : {"1", "[1.5]", "[-1]", "[\"1\"]", "[4294967297]", "{}", "null"})
    refuse_each({{&Document::nodes, R"([{"children":)" + children + "},{\"mesh\":0}]",
                  "nodes[0].children: allowed is a list of whole numbers"}});
  const auto positions = [](const std::string& place, const std::string& count) {
    return place + R"("componentType":5126,"count":)" + count + R"(,"type":"VEC3")";
  };
  const std::string whole = R"("bufferView":0,)", huge = "9007199254740992",
                    beyond = "do not fit their buffer";
  const Document plain;
  refuse_each({
      {&Document::nodes, R"([{"mesh":0.5}])", "nodes[0].mesh: allowed is a whole number"},
      {&Document::nodes, R"([{"mesh":0,"scale":[1,2]}])", "nodes[0].scale: allowed are 3 numbers"},
      {&Document::nodes, R"([{"mesh":0,"matrix":[1,2,3]}])", "nodes[0].matrix: allowed are 16 numbers"},
      {&Document::nodes, R"([{"mesh":3}])", "mesh 3 is out of range, there are 1"},
      {&Document::primitive, R"("indices":1)", "meshes[0].primitives[0]: has no attributes"},
      {&Document::primitive, R"("attributes":{"NORMAL":0})", "has no attribute POSITION"},
      {&Document::primitive, R"("attributes":{"POSITION":0},"mode":7)", "mode 7, allowed are 0 to 6"},
      {&Document::primitive, R"("attributes":{"POSITION":0})", "has 4 corners, allowed are multiples of 3"},
      {&Document::primitive, R"("attributes":{"POSITION":1})", "allowed positions are three floats"},
      {&Document::primitive, R"("attributes":{"POSITION":0},"indices":0)",
       "allowed indices are unsigned bytes, shorts and ints"},
      {&Document::position_accessor, positions(whole, "5"), beyond},
      {&Document::position_accessor, positions(whole + R"("byteOffset":1,)", "4"), beyond},
      {&Document::position_accessor, positions(whole + R"("byteOffset":)" + huge + ",", "1"), beyond},
      {&Document::position_accessor, positions(whole, huge), beyond},
      {&Document::position_accessor, positions(R"("bufferView":9,)", "4"), "bufferView 9 is out of range"},
      {&Document::position_accessor, positions("", "4"), "has no data"},
      {&Document::position_accessor, positions(whole, "0"), "allowed is a whole number of 1 or more"},
      {&Document::index_view, R"("buffer":0,"byteOffset":)" + huge + R"(,"byteLength":)" + huge, beyond},
      {&Document::index_view, R"("buffer":1,"byteLength":8)", "buffer 1 is out of range"},
      // Data that is not where plain numbers are.
      {&Document::position_accessor, plain.position_accessor + R"(,"sparse":{"count":1})", "[0].sparse"},
      {&Document::primitive, plain.primitive + R"(,"extensions":{"KHR_draco_mesh_compression":{}})",
       "uses KHR_draco_mesh_compression"},
      {&Document::index_view, plain.index_view + R"(,"extensions":{"EXT_meshopt_compression":{}})",
       "uses EXT_meshopt_compression"},
  });
}

TEST_F(Gltf, images_extras_and_materials_are_not_looked_at) {
  Document document;
  document.more =
      R"(,"images":[{"uri":"/etc/passwd"},{"bufferView":99}],"materials":[7],"extras":{"a":[{"b":1}]},)"
      R"("extensions":{"KHR_lights_punctual":3},"animations":[{"channels":0}])";
  EXPECT_EQ(read("a.gltf", document.text()).triangles.size(), 2u);
}

TEST_F(Gltf, buffers_come_from_beside_the_file) {
  fs::create_directory(folder_ / "inner");
  fs::create_directory(folder_ / "a.dir");
  write("inner/b.bin", buffer_bytes());
  Document document;
  document.buffer = R"("uri":"inner/b.bin","byteLength":56)";
  EXPECT_EQ(read("a.gltf", document.text()).triangles.size(), 2u);
  for (const std::string uri : {"../a.bin", "inner/../../a.bin", "/dev/zero", "a.dir", "missing.bin",
                                "%2e%2e/a.bin", "http://example.org/a.bin", "/etc/passwd"}) {
    document.buffer = R"("uri":")" + uri + R"(","byteLength":56)";
    expect_error("inner/a.gltf", document.text(), "allowed is a regular file beside this one");
  }
  refuse_each({{&Document::buffer, R"("uri":"a.bin","byteLength":55)", "size mismatch"},
               {&Document::buffer, R"("byteLength":56)", "buffer '': allowed is"},
               {&Document::buffer, R"("uri":"data:application/octet-stream;base64,????","byteLength":3)",
                "is no glTF 2: "}});
}

}  // namespace
}  // namespace raylanes::bench
