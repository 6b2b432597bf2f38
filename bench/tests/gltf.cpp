// glTF: scenes of nodes, and files that must be refused before they cost anything.
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

constexpr auto nodes = &Document::nodes, primitive = &Document::primitive,
               positions = &Document::position_accessor, indices = &Document::index_accessor,
               index_view = &Document::index_view, buffer = &Document::buffer;

const std::string three = R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3")",
                  plain = R"("attributes":{"POSITION":0})";

// The text of the document with some parts replaced.
using Changes = std::vector<std::pair<std::string Document::*, std::string>>;
std::string with(const Changes& changes) {
  Document document;
  for (const auto& [part, text] : changes) document.*part = text;
  return document.text();
}

std::string glb(std::string json, const std::string& binary) {
  json.append((4 - json.size() % 4) % 4, ' ');
  const auto size = [](std::size_t bytes) { return static_cast<std::uint32_t>(bytes); };
  return Bytes("glTF").put(2u).put(size(28 + json.size() + binary.size())).put(size(json.size())).str() +
         "JSON" + json + Bytes().put(size(binary.size())).str() + std::string("BIN\0", 4) + binary;
}

class Gltf : public MeshReader {
 protected:
  void SetUp() override { folder_.write("a.bin", buffer_bytes()); }
  // The one part of a document that is wrong, and what is said of it.
  struct Wrong {
    std::string Document::*part;
    std::string text, expected;
  };
  void refuse_each(const std::vector<Wrong>& list) const {
    for (const auto& [part, text, expected] : list)
      expect_errors({{"a.gltf", with({{part, text}}), expected}});
  }
};

TEST_F(Gltf, strips_fans_lists_sizes_of_indices_and_nodes) {
  struct Good {
    Changes changes;
    std::vector<Float3> vertices;
    std::vector<Index3> triangles;
  };
  for (const auto& [changes, vertices, triangles] : std::vector<Good>{
           {{}, corners, {{2, 0, 1}, {0, 3, 1}}},
           {{{primitive, plain + R"(,"indices":1,"mode":6)"}}, corners, {{0, 1, 2}, {1, 3, 2}}},
           {{{primitive, plain + R"(,"mode":5)"}}, corners, {{0, 1, 2}, {1, 3, 2}}},
           // Bytes 2 0 0, from the shorts 2 0.
           {{{primitive, plain + R"(,"indices":1)"},
             {indices, R"("bufferView":1,"byteOffset":2,"componentType":5121,"count":3,"type":"SCALAR")"},
             {index_view, R"("buffer":0,"byteOffset":46,"byteLength":10)"}},
            corners,
            {{2, 0, 0}}},
           // Points between, and a quarter turn, which takes (x, y) to (-y, x).
           {{{nodes, R"([{"children":[1],"rotation":[0,0,0.7071067811865476,0.7071067811865476]},)"
                     R"({"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]}])"},
             {primitive, plain + "},{" + plain + R"(,"mode":0)"},
             {positions, three}},
            {{-6, 5, 7}, {-6, 6, 7}, {-7, 5, 7}},
            {{0, 1, 2}}},
           {{{nodes, R"([{"children":[1],"translation":[10,0,0]},{"mesh":0,"scale":[2,2,2]}])"},
             {primitive, plain},
             {positions, three}},
            {{10, 0, 0}, {12, 0, 0}, {10, 2, 0}},
            {{0, 1, 2}}}})
    expect_triangles("a.gltf", with(changes), vertices, triangles);
}

// Nodes share a mesh in its own space; their triangles in the scene are the same ones, moved.
TEST_F(Gltf, nodes_share_meshes) {
  const FileMesh mesh =
      read_mesh(folder_.write("a.gltf", with({{nodes, R"([{"children":[1,2],"mesh":0,"translation":[1,2,3]},)"
                                                      R"({"mesh":0},{"mesh":0,"scale":[2,4,8]}])"},
                                              {primitive, plain},
                                              {positions, three}})));
  EXPECT_EQ(mesh.groups, (std::vector<std::uint32_t>{0, 1, 2}));
  ASSERT_EQ(mesh.nodes.meshes.size(), 1u);
  EXPECT_EQ(mesh.nodes.meshes[0].vertices, (std::vector<Float3>{corners[0], corners[1], corners[2]}));
  ASSERT_EQ(mesh.nodes.places.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& [number, transform] = mesh.nodes.places[i];
    EXPECT_EQ(number, 0u);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(transform.row[k][k], i < 2 ? 1.0f : static_cast<float>(2 << k));
      EXPECT_EQ(transform.row[k][3], static_cast<float>(k + 1));
      for (std::size_t corner = 0; corner < 3; ++corner)
        EXPECT_EQ(mesh.vertices[3 * i + corner][k],
                  transform.row[k][k] * corners[corner][k] + transform.row[k][3]);
    }
  }
}

TEST_F(Gltf, buffers_inside_and_in_glb) {
  Changes changes{{primitive, plain}, {positions, three}, {buffer, R"("byteLength":56)"}};
  const std::string whole = glb(with(changes), buffer_bytes());
  expect_triangles("a.glb", whole, corners, {{0, 1, 2}});
  for (std::size_t size = 0; size < whole.size(); ++size)
    expect_errors({{"b.glb", whole.substr(0, size), ""}});
  changes.back().second =
      R"("uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAA)"
      R"(AAAAAAAA","byteLength":48)";
  expect_triangles("b.gltf", with(changes), corners, {{0, 1, 2}});
}

TEST_F(Gltf, refuses_values_of_the_wrong_kind_or_beyond_their_buffers_and_depth) {
  // 20 levels of two children each that are the same node: a million meshes from a kilobyte.
  std::string shared = "[", deep = "[";
  for (int i = 1; i <= 20; ++i)
    shared += R"({"children":[)" + std::to_string(i) + "," + std::to_string(i) + "]},";
  for (int i = 1; i <= 100000; ++i) deep += R"({"children":[)" + std::to_string(i) + "]},";
  for (const std::string key : {"extras", "extensions", "nodes", "anything"})
    expect_errors({{"a.gltf", R"({"asset":{"version":"2.0"},")" + key + "\":" + std::string(200000, '['),
                    "nested deeper"}});
  for (const std::string children : {"1", "[1.5]", "[-1]", "[\"1\"]", "[4294967297]", "{}", "null"})
    refuse_each({{nodes, R"([{"children":)" + children + "},{\"mesh\":0}]",
                  "nodes[0].children: allowed is a list of whole numbers"}});
  const auto accessor = [](const std::string& place, const std::string& count) {
    return place + R"("componentType":5126,"count":)" + count + R"(,"type":"VEC3")";
  };
  const std::string whole = R"("bufferView":0,)", huge = "9007199254740992",
                    beyond = "do not fit their buffer";
  const Document whole_file;
  refuse_each({
      {nodes, R"([{"children":[1,1]},{"mesh":0}])", "nodes[1]: is reached twice"},
      {nodes, R"([{"children":[0],"mesh":0}])", "nodes[0]: is reached twice"},
      {nodes, shared + R"({"mesh":0}])", "is reached twice"},
      {nodes, deep + R"({"mesh":0}])", "nodes[128]: is deeper than 128 nodes"},
      {nodes, R"([{"children":[7]}])", "node 7 is out of range, there are 1"},
      {nodes, R"([{"mesh":0.5}])", "nodes[0].mesh: allowed is a whole number"},
      {nodes, R"([{"mesh":0,"scale":[1,2]}])", "nodes[0].scale: allowed are 3 numbers"},
      {nodes, R"([{"mesh":0,"matrix":[1,2,3]}])", "nodes[0].matrix: allowed are 16 numbers"},
      {nodes, R"([{"mesh":3}])", "mesh 3 is out of range, there are 1"},
      {primitive, R"("indices":1)", "meshes[0].primitives[0]: has no attributes"},
      {primitive, R"("attributes":{"NORMAL":0})", "has no attribute POSITION"},
      {primitive, plain + R"(,"mode":7)", "mode 7, allowed are 0 to 6"},
      {primitive, plain, "has 4 corners, allowed are multiples of 3"},
      {primitive, R"("attributes":{"POSITION":1})", "allowed positions are three floats"},
      {primitive, plain + R"(,"indices":0)", "allowed indices are unsigned bytes, shorts and ints"},
      {positions, accessor(whole, "5"), beyond},
      {positions, accessor(whole + R"("byteOffset":1,)", "4"), beyond},
      {positions, accessor(whole + R"("byteOffset":)" + huge + ",", "1"), beyond},
      {positions, accessor(whole, huge), beyond},
      {positions, accessor(R"("bufferView":9,)", "4"), "bufferView 9 is out of range"},
      {positions, accessor("", "4"), "has no data"},
      {positions, accessor(whole, "0"), "allowed is a whole number of 1 or more"},
      {index_view, R"("buffer":0,"byteOffset":)" + huge + R"(,"byteLength":)" + huge, beyond},
      {index_view, R"("buffer":1,"byteLength":8)", "buffer 1 is out of range"},
      // Data that is not where plain numbers are.
      {positions, whole_file.position_accessor + R"(,"sparse":{"count":1})", "[0].sparse"},
      {primitive, whole_file.primitive + R"(,"extensions":{"KHR_draco_mesh_compression":{}})",
       "uses KHR_draco_mesh_compression"},
      {index_view, whole_file.index_view + R"(,"extensions":{"EXT_meshopt_compression":{}})",
       "uses EXT_meshopt_compression"},
  });
}

TEST_F(Gltf, buffers_come_from_beside_the_file_and_nothing_else_is_looked_at) {
  fs::create_directory(folder_ / "inner");
  fs::create_directory(folder_ / "a.dir");
  folder_.write("inner/b.bin", buffer_bytes());
  const std::string more =
      R"(,"images":[{"uri":"/etc/passwd"},{"bufferView":99}],"materials":[7],"extras":{"a":[{"b":1}]},)"
      R"("extensions":{"KHR_lights_punctual":3},"animations":[{"channels":0}])";
  const auto beside = [](const std::string& uri) { return R"("uri":")" + uri + R"(","byteLength":56)"; };
  EXPECT_EQ(read("a.gltf", with({{&Document::more, more}, {buffer, beside("inner/b.bin")}})).triangles.size(),
            2u);
  for (const std::string uri : {"../a.bin", "inner/../../a.bin", "/dev/zero", "a.dir", "missing.bin",
                                "%2e%2e/a.bin", "http://example.org/a.bin", "/etc/passwd"})
    expect_errors(
        {{"inner/a.gltf", with({{buffer, beside(uri)}}), "allowed is a regular file beside this one"}});
  refuse_each(
      {{buffer, R"("uri":"a.bin","byteLength":55)", "size mismatch"},
       {buffer, R"("byteLength":56)", "buffer '': allowed is"},
       {buffer, R"("uri":"data:application/octet-stream;base64,????","byteLength":3)", "is no glTF 2: "}});
}

}  // namespace
}  // namespace raylanes::bench
