// The header of a PLY file (G. Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <cstddef>
#include <iosfwd>

namespace raylanes::bench {

// What a header promises.
struct PlyHeader {
  std::size_t vertices;
  std::size_t faces;
};

// Reads up to and with "end_header" and throws std::runtime_error, naming the line, unless the rest can be
// given to CGAL 5.5, which trusts some of it: a vertex needs x, y, z of type float or double (CGAL takes a
// missing one for 0), a face needs a list vertex_indices or vertex_index of int or uint, and list
// lengths have one or two bytes (CGAL allocates whatever a longer one says before it looks for the data).
PlyHeader read_ply_header(std::istream& in);

}  // namespace raylanes::bench
