#include "ply_header.hpp"

#include <charconv>
#include <istream>

#include "printable.hpp"

namespace raylanes::bench {
namespace {

constexpr std::array<std::string_view, 8> short_types{"char",  "int8",  "uchar",  "uint8",
                                                      "short", "int16", "ushort", "uint16"};
constexpr std::array<std::string_view, 4> long_types{"int", "int32", "uint", "uint32"};
constexpr std::array<std::string_view, 4> real_types{"float", "float32", "double", "float64"};

bool contains(std::span<const std::string_view> names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool known_type(std::string_view name) {
  return contains(short_types, name) || contains(long_types, name) || contains(real_types, name);
}

struct HeaderState {
  bool format_seen = false;
  std::array<bool, 3> axis_seen{};
  bool indices_seen = false;
  PlyHeader header{};

  bool is_in(std::string_view element) const { return header.elements.back().name == element; }
  bool has(std::string_view element) const {
    return std::ranges::any_of(header.elements, [&](const PlyElement& e) { return e.name == element; });
  }
};

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

void read_format(HeaderState& state, const std::vector<std::string>& words) {
  constexpr std::array<std::string_view, 3> names{"ascii", "binary_little_endian", "binary_big_endian"};
  if (words.size() != 3 || !contains(names, words[1]) || words[2] != "1.0")
    throw std::runtime_error("allowed is format ascii|binary_little_endian|binary_big_endian 1.0");
  state.format_seen = true;
  state.header.is_ascii = words[1] == names[0];
}

void read_element(HeaderState& state, const std::vector<std::string>& words) {
  std::size_t count = 0;
  if (words.size() != 3) throw std::runtime_error("allowed is element NAME COUNT");
  const char* end = words[2].data() + words[2].size();
  const auto [stop, error] = std::from_chars(words[2].data(), end, count);
  if (error != std::errc() || stop != end)
    throw std::runtime_error("element count '" + printable(words[2]) + "' is not a whole number");
  if ((words[1] == "vertex" || words[1] == "face") && state.has(words[1]))
    throw std::runtime_error("a second element " + words[1] + ", allowed is one");
  state.header.elements.push_back({words[1], count, {}});
}

void read_list(HeaderState& state, const std::vector<std::string>& words) {
  if (words.size() != 5 || !contains(short_types, words[2]) || !known_type(words[3]))
    throw std::runtime_error("allowed is property list char|uchar|short|ushort TYPE NAME");
  state.header.elements.back().properties.push_back({words[3], words[2]});
  if (!state.is_in("face") || (words[4] != "vertex_indices" && words[4] != "vertex_index")) return;
  if (!contains(long_types, words[3]))
    throw std::runtime_error("vertex indices of type " + words[3] + ", allowed are int and uint");
  state.indices_seen = true;
}

void read_property(HeaderState& state, const std::vector<std::string>& words) {
  if (state.header.elements.empty()) throw std::runtime_error("a property before the first element");
  if (words.size() > 1 && words[1] == "list") return read_list(state, words);
  if (words.size() != 3 || !known_type(words[1])) throw std::runtime_error("allowed is property TYPE NAME");
  state.header.elements.back().properties.push_back({words[1], ""});
  if (!state.is_in("vertex") || words[2].size() != 1 || words[2] < "x" || words[2] > "z") return;
  if (!contains(real_types, words[1]))
    throw std::runtime_error("coordinates of type " + words[1] + ", allowed are float and double");
  state.axis_seen[static_cast<std::size_t>(words[2][0] - 'x')] = true;
}

void read_line(HeaderState& state, const std::string& line) {
  const std::vector<std::string> words = words_of(line);
  if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return;
  if (words[0] == "format") return read_format(state, words);
  if (words[0] == "element") return read_element(state, words);
  if (words[0] == "property") return read_property(state, words);
  throw std::runtime_error("allowed are comment, obj_info, format, element, property, end_header");
}

bool is_line(const std::string& line, std::string_view text) {
  return line == text || (line.size() == text.size() + 1 && line.starts_with(text) && line.back() == '\r');
}

void require_complete(const HeaderState& state) {
  if (!state.format_seen) throw std::runtime_error("PLY header has no format");
  for (const PlyElement& element : state.header.elements)
    if (element.properties.empty())
      throw std::runtime_error("PLY header has an element " + printable(element.name) +
                               " without properties");
  if (!state.has("vertex") || !std::ranges::all_of(state.axis_seen, [](bool seen) { return seen; }))
    throw std::runtime_error("PLY header has no element vertex with properties x, y, z");
  if (!state.has("face") || !state.indices_seen)
    throw std::runtime_error("PLY header has no element face with a list vertex_indices or vertex_index");
}

}  // namespace

std::size_t PlyHeader::count(const std::string& name) const {
  for (const PlyElement& element : elements)
    if (element.name == name) return element.count;
  return 0;
}

PlyHeader read_ply_header(std::istream& in) {
  std::string line;
  if (!std::getline(in, line) || !is_line(line, "ply"))
    throw std::runtime_error("is not a PLY file, the first line must be 'ply'");
  HeaderState state;
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    if (is_line(line, "end_header")) {
      require_complete(state);
      return state.header;
    }
    try {
      read_line(state, line);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("PLY header line " + std::to_string(number) + ": " + error.what());
    }
  }
  throw std::runtime_error("PLY header has no end_header");
}

}  // namespace raylanes::bench
