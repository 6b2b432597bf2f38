#include <charconv>
#include <istream>

#include "ply_header.hpp"
#include "printable.hpp"

namespace raylanes::bench {
namespace {

struct WholeType {
  std::string_view name, other_name;
  std::int64_t least, greatest;
};

constexpr WholeType whole_types[] = {{"char", "int8", -128, 127},
                                     {"uchar", "uint8", 0, 255},
                                     {"short", "int16", -32768, 32767},
                                     {"ushort", "uint16", 0, 65535},
                                     {"int", "int32", -2147483648, 2147483647},
                                     {"uint", "uint32", 0, 4294967295}};

[[noreturn]] void refuse(const std::string& word, const std::string& type) {
  throw std::runtime_error("'" + printable(word) + "' is no " + type);
}

// Whether all of the word is a number.
template <class Number>
bool parse(std::string_view word, Number& number) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return stop == word.data() + word.size() && error != std::errc::invalid_argument;
}

// The number, if the type is a whole one, else 0.
std::int64_t check(const std::string& word, const std::string& type) {
  for (const WholeType& whole : whole_types) {
    if (type != whole.name && type != whole.other_name) continue;
    std::int64_t number = 0;
    if (!parse(word, number) || number < whole.least || number > whole.greatest) refuse(word, type);
    return number;
  }
  double number = 0;
  if (!parse(word, number)) refuse(word, type);
  return 0;
}

// False at the end of the file.
bool check_property(std::istream& in, const PlyProperty& property) {
  std::string word;
  std::int64_t count = 1;
  if (!property.count_type.empty()) {
    if (!(in >> word)) return false;
    count = check(word, property.count_type);
    if (count < 0) refuse(word, "length of a list");
  }
  for (; count > 0; --count) {
    if (!(in >> word)) return false;
    check(word, property.type);
  }
  return true;
}

}  // namespace

void check_ply_numbers(std::istream& in, const PlyHeader& header) {
  for (const PlyElement& element : header.elements)
    for (std::size_t i = 0; i < element.count; ++i) try {
        for (const PlyProperty& property : element.properties)
          if (!check_property(in, property)) return;
      } catch (const std::runtime_error& error) {
        throw std::runtime_error(printable(element.name) + " " + std::to_string(i) + ": " + error.what());
      }
}

}  // namespace raylanes::bench
