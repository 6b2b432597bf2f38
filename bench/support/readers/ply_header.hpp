// The header of a PLY file (G. Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <iosfwd>

#include "../std.hpp"

namespace raylanes::bench {

struct PlyProperty {
  std::string type;        // "float", "uchar", …
  std::string count_type;  // of a list, else empty
};

struct PlyElement {
  std::string name;
  std::size_t count;
  std::vector<PlyProperty> properties;
};

// The promises of a header.
struct PlyHeader {
  bool is_ascii = false;
  std::vector<PlyElement> elements;

  // 0 if there is no such element.
  std::size_t count(const std::string& name) const;
};

// Reads up to and with "end_header". Throws std::runtime_error, naming the line, unless the rest can be given to CGAL
// 5.5, which trusts some of it. Every element needs a property, as CGAL counts through billions of empty ones. A vertex
// needs x, y, z of type float or double, as CGAL takes a missing one for 0. A face needs a list vertex_indices or
// vertex_index of int or uint. List lengths have one or two bytes, as CGAL allocates a longer one before it looks for
// the data.
PlyHeader read_ply_header(std::istream& in);

// Reads the rest of an ASCII file up to the end that the header promises, or to the end of the file, which CGAL
// reports, and throws std::runtime_error unless each word is a number of its property's type: CGAL ends an
// integer at the first other character, takes what follows for the next number, and cuts large ones.
void check_ply_numbers(std::istream& in, const PlyHeader& header);

}  // namespace raylanes::bench
