#include <charconv>
#include <istream>

#include "mesh_formats.hpp"
#include "printable.hpp"

namespace raylanes::bench {
namespace {

constexpr std::string_view blanks = " \t\r";

// A polygon waits until all vertices are known, as it may use later ones.
struct PendingPolygon {
  std::size_t first_corner;
  std::size_t line;
};

struct ObjText {
  std::vector<Float3> vertices;
  std::vector<std::size_t> corners;
  std::vector<PendingPolygon> polygons;
  std::vector<std::size_t> groups;  // their first polygons
};

// Cuts the first word off `text`; empty if there is none.
std::string_view take_word(std::string_view& text) {
  const std::size_t begin = std::min(text.find_first_not_of(blanks), text.size());
  const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

// The float nearest to a decimal number.
float parse_float(std::string_view word) {
  std::string_view digits = word;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  const char* end = digits.data() + digits.size();
  float value = 0;
  auto result = std::from_chars(digits.data(), end, value);
  if (result.ec == std::errc::result_out_of_range) {
    // Too small for a float is 0, too large is infinite, which validate_mesh reports.
    double wide = 0;
    result = std::from_chars(digits.data(), end, wide);
    value = static_cast<float>(wide);
  }
  if (result.ec != std::errc() || result.ptr != end)
    throw std::runtime_error("'" + printable(word) + "' is not a coordinate, allowed are decimal numbers");
  return value;
}

Float3 parse_vertex(std::string_view text) {
  Float3 vertex;
  for (float& coordinate : vertex) coordinate = parse_float(take_word(text));
  return vertex;
}

// "7", "7/1", "7//3", "7/1/3" or negative, counted back from the last vertex read; gives an index from 0.
std::size_t parse_corner(std::string_view word, std::size_t vertices_so_far) {
  std::ptrdiff_t number = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  if (error != std::errc() || (stop != end && *stop != '/'))
    throw std::runtime_error("'" + printable(word) + "' is not a corner of a face, allowed are " +
                             "v, v/vt, v//vn, v/vt/vn");
  if (number == 0 || number < -static_cast<std::ptrdiff_t>(vertices_so_far))
    throw std::runtime_error("index " + std::to_string(number) +
                             " is out of range, allowed are 1 and more or -" +
                             std::to_string(vertices_so_far) + " to -1");
  return number > 0 ? static_cast<std::size_t>(number - 1)
                    : vertices_so_far - static_cast<std::size_t>(-number);
}

void parse_line(ObjText& obj, std::string_view text, std::size_t line) {
  const std::string_view statement = take_word(text);
  if (statement == "v") {
    obj.vertices.push_back(parse_vertex(text));
  } else if (statement == "f") {
    obj.polygons.push_back({obj.corners.size(), line});
    for (std::string_view word = take_word(text); !word.empty() && word[0] != '#'; word = take_word(text))
      obj.corners.push_back(parse_corner(word, obj.vertices.size()));
  } else if (statement == "g" || statement == "o") {
    obj.groups.push_back(obj.polygons.size());
  } else if (std::any_of(statement.begin(), statement.end(), [](char c) { return c == '\0'; })) {
    throw std::runtime_error("is not text");
  }
}

// One statement: lines that end in a backslash continue on the next one.
bool get_statement(std::istream& in, std::string& statement, std::size_t& line) {
  if (!std::getline(in, statement)) return false;
  ++line;
  if (line == 1 && statement.starts_with(byte_order_mark)) statement.erase(0, byte_order_mark.size());
  std::string next;
  for (;;) {
    const std::size_t last = statement.find_last_not_of('\r');
    if (last == std::string::npos || statement[last] != '\\' || !std::getline(in, next)) return true;
    ++line;
    statement.replace(last, std::string::npos, " " + next);
  }
}

ObjText parse_obj(std::istream& in) {
  ObjText obj;
  std::string statement;
  for (std::size_t line = 0; get_statement(in, statement, line);) try {
      parse_line(obj, statement, line);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("line " + std::to_string(line) + ": " + error.what());
    }
  if (in.bad()) throw std::runtime_error("cannot be read to its end");
  return obj;
}

}  // namespace

FileMesh read_obj(std::istream& in) {
  ObjText obj = parse_obj(in);
  FileMesh mesh;
  mesh.vertices = std::move(obj.vertices);
  mesh.triangles.reserve(obj.polygons.size());
  auto group = obj.groups.begin();
  for (std::size_t i = 0; i < obj.polygons.size(); ++i) {
    for (; group != obj.groups.end() && *group == i; ++group)
      mesh.groups.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    const std::size_t begin = obj.polygons[i].first_corner;
    const std::size_t end =
        i + 1 < obj.polygons.size() ? obj.polygons[i + 1].first_corner : obj.corners.size();
    append_fan(mesh, std::span(obj.corners).subspan(begin, end - begin),
               "line " + std::to_string(obj.polygons[i].line));
  }
  return mesh;
}

}  // namespace raylanes::bench
