#include "mesh_reader.hpp"

#include <cctype>
#include <fstream>

#include "mesh_formats.hpp"
#include "printable.hpp"

namespace raylanes::bench {
namespace {

constexpr std::size_t ra2_triangle_bytes = 36;
constexpr std::size_t longest_name = 400;  // in messages

template <FileMesh (*read)(std::istream&)>
FileMesh read_stream(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot be opened for reading");
  return read(in);
}

struct Format {
  const char* extension;
  FileMesh (*read)(const std::filesystem::path&);
};

constexpr std::array formats{
    Format{".obj", read_stream<read_obj>},
    Format{".ply", read_stream<read_ply>},
    Format{".stl", read_stream<read_stl>},
    Format{".ra2", read_stream<read_ra2>},
    Format{".gltf", read_gltf},
    Format{".glb", read_gltf},
};

const Format& format_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::string allowed;
  for (const Format& format : formats) {
    if (extension == format.extension) return format;
    allowed += std::string(allowed.empty() ? "" : ", ") + format.extension;
  }
  throw std::invalid_argument("unknown extension '" + printable(extension) + "', allowed are " + allowed);
}

void require_regular_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw std::runtime_error("no such file");
  if (!std::filesystem::is_regular_file(status)) throw std::runtime_error("is not a regular file");
}

FileMesh read_checked(const std::filesystem::path& file) {
  const Format& format = format_of(file);
  require_regular_file(file);
  FileMesh mesh = format.read(file);
  if (mesh.triangles.empty()) throw std::runtime_error("has no triangles");
  validate_mesh(mesh.vertices, mesh.triangles);
  return mesh;
}

float little_endian_float(const char* bytes) {
  std::array<char, 4> ordered{};
  std::copy_n(bytes, 4, ordered.begin());
  if constexpr (std::endian::native == std::endian::big) std::reverse(ordered.begin(), ordered.end());
  return std::bit_cast<float>(ordered);
}

}  // namespace

FileMesh read_mesh(const std::filesystem::path& file) {
  try {
    return read_checked(file);
  } catch (const std::exception& error) {
    throw std::runtime_error(printable(file.string(), longest_name) + ": " + error.what());
  }
}

FileMesh read_ra2(std::istream& in) {
  in.seekg(0, std::ios::end);
  const auto size = static_cast<std::size_t>(in.tellg());
  in.seekg(0);
  if (size % ra2_triangle_bytes != 0)
    throw std::runtime_error("has " + std::to_string(size) + " bytes, allowed are multiples of " +
                             std::to_string(ra2_triangle_bytes) + " (one triangle)");
  const std::size_t count = size / ra2_triangle_bytes;
  if (count > std::numeric_limits<std::uint32_t>::max() / 3)
    throw std::runtime_error("has " + std::to_string(count) + " triangles, allowed are 1431655765");
  FileMesh mesh;
  mesh.vertices.reserve(3 * count);
  mesh.triangles.reserve(count);
  std::array<char, ra2_triangle_bytes> bytes{};
  for (std::size_t i = 0; i < count; ++i) {
    if (!in.read(bytes.data(), ra2_triangle_bytes))
      throw std::runtime_error("cannot be read beyond triangle " + std::to_string(i));
    const auto first = static_cast<std::uint32_t>(3 * i);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const char* at = bytes.data() + 12 * corner;
      mesh.vertices.push_back(
          {little_endian_float(at), little_endian_float(at + 4), little_endian_float(at + 8)});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

void append_fan(Mesh& mesh, std::span<const std::size_t> corners, const std::string& name) {
  if (corners.size() < 3)
    throw std::runtime_error(name + ": has " + std::to_string(corners.size()) +
                             " corners, allowed are 3 or more");
  const std::size_t limit =
      std::min<std::size_t>(mesh.vertices.size(), std::numeric_limits<std::uint32_t>::max());
  for (const std::size_t corner : corners)
    if (corner >= limit)
      throw std::runtime_error(name + ": index " + std::to_string(static_cast<std::ptrdiff_t>(corner)) +
                               " (counted from 0) is out of range, the mesh has " + std::to_string(limit) +
                               " vertices");
  const auto index = [&](std::size_t i) { return static_cast<std::uint32_t>(corners[i]); };
  for (std::size_t i = 2; i < corners.size(); ++i)
    mesh.triangles.push_back({index(0), index(i - 1), index(i)});
}

}  // namespace raylanes::bench
