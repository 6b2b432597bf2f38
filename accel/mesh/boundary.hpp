// The boundary of a mesh as closed loops.
#pragma once

#include <raylanes/numbers.hpp>
#include <raylanes/progress.hpp>

#include "../standard.hpp"

namespace raylanes {

// The corners of a triangle.
template <class T>
struct CornersOf {
  PointOf<T> vertex[3];
};
using Corners = CornersOf<float>;

// Loops of corners, one behind the other; loop i ends before corner end[i]. An edge goes from each corner to the next
// one, and from the last to the first.
template <class T>
struct LoopsOf {
  std::vector<PointOf<T>> corners;
  std::vector<std::size_t> end;
};

// The edges that more triangles have in one direction than in the other, as often as that, in loops that come to no
// corner twice. Ends of edges are the same where closed_report() finds them so; triangles with two equal corners count
// as nothing. Each corner has as many edges that begin there as edges that end there, so that loops can be found.
// Throws std::invalid_argument for 2^30 triangles or more. `progress`, if not null, is told of some shares of the work.
LoopsOf<float> boundary_loops(std::span<const Corners> triangles, const Progress* progress = nullptr);
LoopsOf<double> boundary_loops(std::span<const CornersOf<double>> triangles,
                               const Progress* progress = nullptr);

// Cuts loops of more than `most` edges, at least 4, by chords: both parts have the chord, in opposite directions.
template <class T>
LoopsOf<T> short_loops(const LoopsOf<T>& loops, std::size_t most);

}  // namespace raylanes
