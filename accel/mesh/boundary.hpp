// The boundary of a mesh as closed loops.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <raylanes/types.hpp>

namespace raylanes {

// The corners of a triangle.
struct Corners {
  Float3 vertex[3];
};

// Loops of corners, one behind the other; loop i ends before corner end[i]. An edge goes from each corner to the next
// one, and from the last to the first.
struct Loops {
  std::vector<Float3> corners;
  std::vector<std::size_t> end;
};

// The edges that more triangles have in one direction than in the other, as often as that, in loops that come to no
// corner twice. Ends of edges are the same where closed_report() finds them so; triangles with two equal corners count
// as nothing. Each corner has as many edges that begin there as edges that end there, so that loops can be found.
// Throws std::invalid_argument for 2^30 triangles or more.
Loops boundary_loops(std::span<const Corners> triangles);

// Cuts loops of more than `most` edges, at least 4, by chords: both parts have the chord, in opposite directions.
Loops short_loops(const Loops& loops, std::size_t most);

}  // namespace raylanes
