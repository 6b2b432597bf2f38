// Every reader of mesh files on files that were damaged: a mesh that is valid, or an error of one line that
// names the file; in bounded memory and time.
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>

#include "../../../bench/support/readers/mesh_reader.hpp"
#include "../../../bench/tests/temporary_folder.hpp"
#include "../bytes.hpp"
#include "../support.hpp"

namespace raylanes::testing {
namespace {

struct Sample {
  std::string extension, content;
};

template <class T>
std::string raw(T value, bool reversed = false) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  std::string text(bytes, sizeof bytes);
  return reversed ? std::string(text.rbegin(), text.rend()) : text;
}

std::string binary_ply(bool big) {
  std::string text =
      std::string("ply\nformat binary_") + (big ? "big" : "little") +
      "_endian 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\n"
      "property uchar red\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 4; ++i)
    text += raw(static_cast<float>(i), big) + raw(i * 0.5, big) + raw(static_cast<float>(i % 2), big) + 'r';
  for (const int size : {3, 4}) {
    text += static_cast<char>(size);
    for (int k = 0; k < size; ++k) text += raw(k, big);
  }
  return text;
}

std::string binary_stl() {
  std::string text(80, 's');
  text += raw(std::uint32_t{2});
  for (int i = 0; i < 24; ++i) {
    text += raw(static_cast<float>(i % 5));
    if (i % 12 == 11) text += raw(std::uint16_t{0});
  }
  return text;
}

// A triangle in a scene of two nodes; its numbers follow in a buffer, 36 bytes of corners and 6 of indices.
std::string gltf_json(const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
         R"("nodes":[{"children":[1],"translation":[1,0,0]},)"
         R"({"mesh":0,"scale":[2,2,2],"rotation":[0,0,0,1]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},)"
         R"("indices":1,"mode":4}]}],"buffers":[{)" +
         uri +
         R"("byteLength":42}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,)"
         R"("byteLength":6}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
         R"("min":[0,0,0],"max":[1,1,0]},{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}]})";
}

std::string glb() {
  std::string json = gltf_json("");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string binary;
  for (const int x : {0, 0, 0, 1, 0, 0, 0, 1, 0}) binary += raw(static_cast<float>(x));
  for (const int i : {0, 1, 2, 0}) binary += raw(static_cast<std::uint16_t>(i));
  const auto size = [](const std::string& text) { return raw(static_cast<std::uint32_t>(text.size())); };
  const std::string chunks = size(json) + "JSON" + json + size(binary) + std::string("BIN\0", 4) + binary;
  return "glTF" + raw(std::uint32_t{2}) + raw(static_cast<std::uint32_t>(chunks.size() + 12)) + chunks;
}

const std::vector<Sample>& samples() {
  static const std::vector<Sample> all{
      {".obj",
       "# c\no thing\nv 0 0 0\nv 1e0 0 0 1\nv 0 1.5 -0\nv 1 1 1\nvt 0 0\nvn 0 0 1\nusemtl m\nf 1 2 3\n"
       "f 1/1/1 2/1/1 -1/1/1\nf 1//1 2//1 3//1 4//1\n"},
      {".ply",
       "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
       "z\nelement "
       "face 2\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 1e-3\n3 0 1 2\n4 "
       "0 1 "
       "2 3\n"},
      {".ply", binary_ply(false)},
      {".ply", binary_ply(true)},
      {".stl",
       "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
       "0\nendloop\nendfacet\n"
       "endsolid s\n"},
      {".stl", binary_stl()},
      {".ra2", std::string(72, '\x3e')},
      {".gltf",
       gltf_json(R"("uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8A)"
                 R"(AAAAAAABAAIA",)")},
      {".glb", glb()}};
  return all;
}

const char* const numbers[] = {
    "0",   "-1",         "3",          "1.7",  "255",  "256",    "4294967295",
    "nan", "4294967296", "2147483648", "1e39", "-inf", "1e-400", "18446744073709551616"};

void damage(Bytes& bytes, std::string& text) {
  if (text.empty()) return;
  const std::size_t at = bytes.below(std::min<std::size_t>(text.size(), 65536));
  const std::size_t length = std::min(text.size() - at, 1 + bytes.below(bytes.chance(200) ? 8 : 256));
  switch (bytes.below(9)) {
    case 0:
      text[at] = static_cast<char>(text[at] ^ 1 << bytes.below(8));
      break;
    case 1:
      text[at] = static_cast<char>(bytes.byte());
      break;
    case 2:
      text.erase(at, length);
      break;
    case 3:
      text.insert(at, text.substr(at, length));
      break;
    case 4:
      text.resize(at);
      break;
    case 5:
      text.insert(at, 1 + bytes.below(16), static_cast<char>(bytes.byte()));
      break;
    case 6: {  // the next number as text
      const std::size_t first = text.find_first_of("0123456789", at);
      if (first == std::string::npos) break;
      const std::size_t behind = text.find_first_not_of("0123456789.e+-", first);
      text.replace(first, (behind == std::string::npos ? text.size() : behind) - first, bytes.pick(numbers));
      break;
    }
    case 7: {  // four bytes as a number
      const auto word = bytes.chance(128) ? std::bit_cast<std::uint32_t>(bytes.number<float>())
                                          : static_cast<std::uint32_t>(bytes.below(5)) - 2;
      if (at + 4 <= text.size()) text.replace(at, 4, raw(word, bytes.chance(64)));
      break;
    }
    default:  // a part again elsewhere
      text.insert(bytes.below(std::min<std::size_t>(text.size(), 65536)), text.substr(at, length));
  }
}

// Sanitizers reserve more addresses than any limit.
void bound_memory() {
#ifndef RAYLANES_SANITIZED
  const rlimit limit{1u << 31, 1u << 31};
  setrlimit(RLIMIT_AS, &limit);
#endif
}

void read(const std::filesystem::path& file, std::size_t bytes) {
  constexpr unsigned seconds = 10;
  alarm(seconds);  // a reader that hangs ends the process
  try {
    const Mesh mesh = bench::read_mesh(file);
    validate_mesh(mesh.vertices, mesh.triangles);
    if (mesh.triangles.empty()) fail("a mesh without triangles was read");
    if (mesh.triangles.size() > bytes) fail("more triangles than bytes");
  } catch (const std::exception& error) {
    const std::string message = error.what();
    if (dynamic_cast<const std::runtime_error*>(&error) == nullptr &&
        dynamic_cast<const std::invalid_argument*>(&error) == nullptr)
      fail("an exception of another kind: " + message);
    if (!message.starts_with(file.string() + ": ") || message.find('\n') != std::string::npos)
      fail("a message that does not begin with the file or is not one line: " + message);
  }
  alarm(0);
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_readers(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes::testing;
  static const raylanes::bench::TemporaryFolder folder;
  [[maybe_unused]] static const bool bounded = (bound_memory(), true);
  Bytes bytes(data, size);
  Sample sample = bytes.pick(samples());
  if (bytes.chance(8))
    sample.content.assign(reinterpret_cast<const char*>(data), size);
  else
    for (std::size_t left = bytes.below(6); left > 0; --left) damage(bytes, sample.content);
  read(folder.write("a" + sample.extension, sample.content), sample.content.size());
  return 0;
}
