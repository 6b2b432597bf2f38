// PLY and STL through CGAL. Assimp, the other candidate, hangs on a PLY header that ends early, and gives
// uninitialised memory as the faces of a truncated PLY.
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>

#include <istream>

#include "mesh_formats.hpp"
#include "ply_header.hpp"

namespace raylanes::bench {
namespace {

using Polygons = std::vector<std::vector<std::size_t>>;

// With a float kernel CGAL dereferences a null pointer on double coordinates. The way from
// float over double to float keeps the value.
using WidePoint = CGAL::Simple_cartesian<double>::Point_3;

// CGAL joins equal corners of an STL file through a map. Ordered by value, -0 would join 0 and a NaN any
// number; ordered by bits only identical corners join.
struct BitPoint {
  Float3 coordinates;
  float& operator[](std::size_t axis) { return coordinates[axis]; }
  float x() const { return coordinates[0]; }
  float y() const { return coordinates[1]; }
  float z() const { return coordinates[2]; }
  friend bool operator<(const BitPoint& a, const BitPoint& b) {
    using Bits = std::array<std::uint32_t, 3>;
    return std::bit_cast<Bits>(a.coordinates) < std::bit_cast<Bits>(b.coordinates);
  }
};

template <typename Point>
FileMesh to_mesh(const std::vector<Point>& points, const Polygons& polygons) {
  FileMesh mesh;
  mesh.vertices.reserve(points.size());
  mesh.triangles.reserve(polygons.size());
  for (const Point& p : points)
    mesh.vertices.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  for (std::size_t i = 0; i < polygons.size(); ++i)
    append_fan(mesh, polygons[i], "face " + std::to_string(i));
  return mesh;
}

std::string part(std::size_t read, std::size_t promised, const char* what) {
  return std::to_string(read) + " of " + std::to_string(promised) + " " + what;
}

bool read_ply_body(std::istream& in, std::vector<WidePoint>& points, Polygons& polygons) {
  try {
    return CGAL::IO::read_PLY(in, points, polygons, CGAL::parameters::verbose(false));
  } catch (const std::length_error&) {
    return false;  // a list of negative length
  }
}

}  // namespace

FileMesh read_ply(std::istream& in) {
  const PlyHeader header = read_ply_header(in);
  if (header.is_ascii) check_ply_numbers(in, header);
  in.clear();
  in.seekg(0);
  std::vector<WidePoint> points;
  Polygons polygons;
  const std::size_t vertices = header.count("vertex"), faces = header.count("face");
  if (!read_ply_body(in, points, polygons) || points.size() != vertices || polygons.size() != faces)
    throw std::runtime_error("is truncated or malformed after " +
                             part(points.size(), vertices, "vertices and ") +
                             part(polygons.size(), faces, "faces"));
  return to_mesh(points, polygons);
}

FileMesh read_stl(std::istream& in) {
  std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (bytes.empty()) return {};
  // CGAL guesses by the first word, and tries the other format on what the first attempt left over.
  constexpr std::size_t title = 80, head = 84, facet = 50;
  std::uint32_t count = 0;
  if (bytes.size() >= head) std::memcpy(&count, bytes.data() + title, sizeof count);
  const bool is_binary = bytes.size() >= head && bytes.size() == head + facet * count;
  if (!is_binary && bytes.starts_with(byte_order_mark)) bytes.erase(0, byte_order_mark.size());
  // The letters of a text are a count far beyond its size.
  const bool may_be_text = bytes.size() < head || head + facet * count > bytes.size();
  if (is_binary)
    bytes.replace(0, title, title, 'b');
  else if (!may_be_text || !bytes.substr(0, head).starts_with("solid"))
    throw std::runtime_error("has " + std::to_string(bytes.size()) + " bytes, allowed for " +
                             std::to_string(count) + " triangles of a binary STL file are " +
                             std::to_string(head + facet * count));
  std::istringstream stream(std::move(bytes));
  std::vector<BitPoint> points;
  Polygons polygons;
  if (!CGAL::IO::read_STL(stream, points, polygons, CGAL::parameters::verbose(false)))
    throw std::runtime_error("is a truncated or malformed STL file of text");
  return to_mesh(points, polygons);
}

}  // namespace raylanes::bench
