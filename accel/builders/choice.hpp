// Which builder suits a mesh and a number of rays. docs/trees.md has what was measured, and the regret.
#pragma once

#include <string>

#include <raylanes/builders.hpp>
#include <raylanes/mesh.hpp>

#include "../batch/array.hpp"
#include "../layout/reference.hpp"

namespace raylanes {

struct TreeChoice {
  TreeBuilder builder;
  bool optimize;
  std::string why;  // one line
};

// How much larger boxes are than their content: half the surfaces of the boxes of triangles by twice the areas of the
// triangles. It is 1 for triangles that fill flat boxes, about 1.5 for a scan, and large for needles that lie askew.
// Looks at 4,096 references at most, in doubles: the result is the same on every machine. Returns 1 if no triangle has
// an area.
double box_waste(const Array<Reference>& references, const VertexView& vertices, const IndexView& triangles);

// `rays` means the same as in BuildOptions.
TreeChoice choose_tree(std::size_t triangles, double waste, double rays);

}  // namespace raylanes
