// Whether a mesh is closed, and where it is not.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <raylanes/mesh.hpp>
#include <raylanes/progress.hpp>

namespace raylanes {

/// Faults of an edge.
/// An edge is a pair of different positions, whatever the indices: vertices duplicated for normals or texture
/// coordinates are one corner. Positions are the same if their coordinates are; −0 equals +0. Triangles with two equal
/// corners are ignored; other triangles without an area are not.
enum class EdgeFault : std::uint8_t {
  /// An odd number of triangles has the edge, as at the rim of a hole. InsideRule::parity is not well defined.
  open,
  /// An even number of triangles has the edge, but not half of them in each direction, as next to a triangle that is
  /// turned over. InsideRule::nonzero is not well defined.
  inconsistent,
  /// More than two triangles have the edge, half of them in each direction, as where two solids touch along an edge.
  /// Inside and outside are well defined, but the surface is not a manifold.
  shared
};
/// The names of the faults, by enumerator.
inline constexpr std::array<std::string_view, 3> edge_fault_names{"open", "inconsistent", "shared"};

/// An edge with a fault.
struct FaultyEdge {
  EdgeFault fault;         ///< what is wrong
  std::uint32_t triangle;  ///< the first triangle that has the edge
  std::uint32_t from, to;  ///< the indices of its vertices in that triangle
};

/// The findings of closed_report().
struct ClosedReport {
  std::size_t edges = 0;                               ///< edges of the mesh
  std::size_t open = 0, inconsistent = 0, shared = 0;  ///< edges with these faults
  std::size_t degenerate = 0;                          ///< triangles with two equal corners
  /// Triangles with the three corners of an earlier one, in any order. InsideRule::parity counts each of them: within a
  /// solid all of whose triangles are doubled, every point is outside. InsideRule::nonzero and winding find it inside
  /// if the copies have the same direction.
  std::size_t doubled = 0;
  std::vector<FaultyEdge> first;  ///< the first faulty edges, in the order of triangles
  /// The volume within the mesh if has_winding_numbers(), by sums of doubles; negative if normals point inwards. 0 if
  /// rounding may have made its sign.
  double volume = 0;

  /// Returns whether each edge has two triangles, in opposite directions. An empty mesh is closed.
  bool is_closed() const { return open == 0 && inconsistent == 0 && shared == 0; }
  /// Returns whether InsideRule::parity is well defined: it does not depend on the direction of rays.
  bool has_parity() const { return open == 0; }
  /// Returns whether InsideRule::nonzero is well defined: it does not depend on the direction of rays.
  bool has_winding_numbers() const { return open == 0 && inconsistent == 0; }
  /// Returns whether the mesh bounds a solid, but its normals point inwards: InsideRule::winding finds no point inside
  /// then, and rays enter the solid at Facing::back.
  bool is_inside_out() const { return volume < 0; }
};

/// Examines all edges of a mesh, and lists the first `max_listed` faulty ones.
/// Takes O(n log n) time and about 100 bytes for each of n triangles. Throws std::invalid_argument if validate_mesh()
/// refuses the mesh, or it has 2^32 vertices or 2^30 triangles.
/// If `progress` is not null, the calling thread calls it every 10 ms or so with the share of work done, never
/// decreasing; exceptions pass through.
ClosedReport closed_report(VertexView vertices, IndexView triangles, std::size_t max_listed = 16,
                           const Progress* progress = nullptr);
/// Examines all edges of a mesh of doubles, whose positions are compared as doubles; otherwise as for floats.
ClosedReport closed_report(VertexRecords<double> vertices, IndexView triangles, std::size_t max_listed = 16,
                           const Progress* progress = nullptr);

/// Returns whether each edge of the mesh has two triangles, in opposite directions.
inline bool is_closed(VertexView vertices, IndexView triangles) {
  return closed_report(vertices, triangles, 0).is_closed();
}
/// Returns whether each edge of the mesh of doubles has two triangles, in opposite directions.
inline bool is_closed(VertexRecords<double> vertices, IndexView triangles) {
  return closed_report(vertices, triangles, 0).is_closed();
}
/// Returns whether each edge of the mesh has two triangles, in opposite directions.
inline bool is_closed(const Mesh& mesh) {
  return is_closed(mesh.vertices, mesh.triangles);
}

}  // namespace raylanes
