// Which builder suits a mesh and a number of rays. docs/trees.md has what was measured, and the regret.
#pragma once

#include <string>

#include <raylanes/builders.hpp>
#include <raylanes/mesh.hpp>

#include "../batch/array.hpp"
#include "reference.hpp"

namespace raylanes {

struct TreeChoice {
  TreeBuilder builder;
  bool optimize;
  std::string why;  // one line
};

// How much more room boxes take than what is in them: half the surfaces of the boxes of triangles by twice the areas of
// the triangles. 1 for triangles that fill flat boxes, 1.5 or so for a scan, large for needles that lie askew. Of
// 4,096 references at most, in doubles: the same on every machine. 1 where no triangle has an area.
double box_waste(const Array<Reference>& references, const VertexView& vertices, const IndexView& triangles);

// `rays`: as of BuildOptions.
TreeChoice choose_tree(std::size_t triangles, double waste, double rays);

}  // namespace raylanes
