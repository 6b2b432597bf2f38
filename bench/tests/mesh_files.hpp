// Mesh files written byte by byte, and a folder for them that goes with the test.
#pragma once

#include "../../tests/support/message_of.hpp"
#include "../support/readers/mesh_reader.hpp"
#include "temporary_folder.hpp"

namespace raylanes::bench {

// The bytes of a file under construction.
class Bytes {
 public:
  explicit Bytes(std::string text = "", std::endian order = std::endian::little)
      : bytes_(std::move(text)), order_(order) {}

  template <typename T>
  Bytes& put(T value) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (std::endian::native != order_) std::reverse(raw.begin(), raw.end());
    bytes_.append(raw.data(), raw.size());
    return *this;
  }
  Bytes& put(const Float3& v) { return put(v[0]).put(v[1]).put(v[2]); }
  Bytes& fill(std::size_t count) { return bytes_.append(count, '\0'), *this; }
  const std::string& str() const { return bytes_; }

 private:
  std::string bytes_;
  std::endian order_;
};

inline constexpr float denormal = std::numeric_limits<float>::denorm_min();

// Values whose bits a reader could lose: -0, denormals, the largest float, ones without a short decimal.
const std::vector<Float3> points{{-0.0f, 0.0f, 1.0f},
                                 {0.1f, 16777215.0f, denormal},
                                 {std::numeric_limits<float>::max(), -1.17549435e-38f, 3.14159274f},
                                 {-0.333333343f, 1e-20f, 24000.0234f}};
// A degenerate triangle, a duplicate, and both orders of turning.
const std::vector<Index3> faces{{0, 1, 2}, {2, 1, 3}, {1, 1, 3}, {0, 1, 2}, {3, 2, 0}};

inline std::string text_of(const auto& v) {
  std::ostringstream out;
  out.precision(9);
  out << v[0] << ' ' << v[1] << ' ' << v[2] << '\n';
  return out.str();
}

inline std::string ply_header(const std::string& format, std::uint64_t vertices, std::uint64_t face_count) {
  return "ply\nformat " + format + " 1.0\ncomment by a test\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(face_count) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string binary_ply(std::endian order, const std::vector<Float3>& vertices,
                              const std::vector<Index3>& triangles) {
  const char* format = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
  Bytes bytes(ply_header(format, vertices.size(), triangles.size()), order);
  for (const Float3& v : vertices) bytes.put(v);
  for (const Index3& t : triangles) bytes.put(std::uint8_t{3}).put(t[0]).put(t[1]).put(t[2]);
  return bytes.str();
}

inline std::string binary_stl(std::uint32_t promised, const std::vector<Float3>& vertices,
                              const std::vector<Index3>& triangles, const std::string& title = "binary") {
  Bytes bytes(title);
  bytes.fill(80 - title.size()).put(promised);
  for (const Index3& t : triangles)
    bytes.fill(12).put(vertices[t[0]]).put(vertices[t[1]]).put(vertices[t[2]]).fill(2);
  return bytes.str();
}

inline std::string ascii_stl(const std::vector<Float3>& vertices, const std::vector<Index3>& triangles) {
  std::string text = "solid test\n";
  for (const Index3& t : triangles) {
    text += "facet normal 0 0 1\n outer loop\n";
    for (const std::uint32_t index : t) text += "  vertex " + text_of(vertices[index]);
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid test\n";
}

inline std::string ra2(const std::vector<Float3>& vertices, const std::vector<Index3>& triangles) {
  Bytes bytes;
  for (const Index3& t : triangles)
    for (const std::uint32_t index : t) bytes.put(vertices.at(index));
  return bytes.str();
}

inline std::string obj(const std::vector<Float3>& vertices, const std::vector<Index3>& triangles) {
  std::string text;
  for (const Float3& v : vertices) text += "v " + text_of(v);
  for (const Index3& t : triangles) text += "f " + text_of(Index3{t[0] + 1, t[1] + 1, t[2] + 1});
  return text;
}

class MeshReader : public testing::Test {
 protected:
  Mesh read(const std::string& name, const std::string& content) const {
    return read_mesh(folder_.write(name, content));
  }
  // The corners of every triangle, in order and bit by bit, whatever the numbering of vertices.
  void expect_triangles(const std::string& name, const std::string& content,
                        const std::vector<Float3>& vertices, const std::vector<Index3>& triangles) const {
    const Mesh mesh = read(name, content);
    EXPECT_TRUE(ra2(mesh.vertices, mesh.triangles) == ra2(vertices, triangles)) << name;
  }
  // Reading must throw one short line that starts with the file's name and contains `expected`, for a terminal.
  void expect_error(const fs::path& file, const std::string& expected) const {
    const std::string message = message_of<std::runtime_error>([&] { read_mesh(file); });
    EXPECT_TRUE(message.starts_with(file.string() + ": ")) << message;
    EXPECT_NE(message.find(expected), std::string::npos) << expected << " is not in " << message;
    EXPECT_EQ(message.find_first_of("\n\x1b"), std::string::npos) << message;
    EXPECT_LT(message.size(), 600u) << message.substr(0, 1000);
  }
  // Rows of file name, content, words of the message.
  void expect_errors(const std::vector<std::array<std::string, 3>>& rows) const {
    for (const auto& [name, content, expected] : rows) expect_error(folder_.write(name, content), expected);
  }

  const TemporaryFolder folder_;
};

}  // namespace raylanes::bench
