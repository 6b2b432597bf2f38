// Whether a mesh encloses a volume, and where it does not.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <raylanes/mesh.hpp>

namespace raylanes {

// What may be wrong with an edge. An edge is a pair of different positions, whatever the indices say: vertices that
// were doubled for their normals or texture coordinates are one corner. Positions are the same if their coordinates
// are the same floats, −0 and +0 being one. Triangles with two equal corners have no area, no tree has them, and they
// count as absent; others whose corners lie on a line do not.
//   open          an odd number of triangles has it, as at a hole's rim: "inside" has no meaning by parity
//   inconsistent  an even number has it, but not half of them in each direction, as where a triangle is turned over:
//                 "inside" has no meaning by winding numbers
//   shared        more than two have it, half of them in each direction, as where two solids touch along an edge:
//                 inside and outside are well defined, but the surface is no manifold
enum class EdgeFault : std::uint8_t { open, inconsistent, shared };
inline constexpr std::array<std::string_view, 3> edge_fault_names{"open", "inconsistent", "shared"};

struct FaultyEdge {
  EdgeFault fault;
  std::uint32_t triangle;  // the first one that has it,
  std::uint32_t from, to;  // and between which of its vertices
};

struct ClosedReport {
  std::size_t edges = 0;
  std::size_t open = 0, inconsistent = 0, shared = 0;  // of these
  std::size_t degenerate = 0;                          // triangles with two equal corners
  std::vector<FaultyEdge> first;                       // of the faulty edges, in the order of triangles

  // Each edge has two triangles, in opposite directions. An empty mesh is closed: it encloses nothing.
  bool is_closed() const { return open == 0 && inconsistent == 0 && shared == 0; }
  // What parity of crossings and what winding numbers need: inside and outside do not depend on the direction.
  bool has_parity() const { return open == 0; }
  bool has_winding_numbers() const { return open == 0 && inconsistent == 0; }
};

// Looks at all edges; keeps the first `max_listed` faulty ones. Takes n log n time for n triangles and some 100 bytes
// for each. Throws std::invalid_argument for a mesh that validate_mesh refuses, or of 2^32 vertices, 2^30 triangles.
ClosedReport closed_report(VertexView vertices, IndexView triangles, std::size_t max_listed = 16);

inline bool is_closed(VertexView vertices, IndexView triangles) {
  return closed_report(vertices, triangles, 0).is_closed();
}
inline bool is_closed(const Mesh& mesh) {
  return is_closed(mesh.vertices, mesh.triangles);
}

}  // namespace raylanes
