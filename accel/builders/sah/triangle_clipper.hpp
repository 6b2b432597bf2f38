// The parts of triangles between planes, for builders that split triangles.
#pragma once

#include <raylanes/mesh.hpp>

#include "../builder_table.hpp"

namespace raylanes {

// The box of a half of a triangle is that of the corners on its side and of the points where edges cross the plane
// (Stich, Friedrich, Dietrich 2009). These points are computed in double and pushed outwards by more than their error,
// so that every point of the triangle is in one of the two boxes; also where subnormal numbers count as zero.
class TriangleClipper : public Clipper {
 public:
  TriangleClipper(VertexView vertices, IndexView triangles) : vertices_(vertices), triangles_(triangles) {}

  Halves cut(std::uint32_t primitive, const Box4& box, std::size_t axis, float at) const override;

 private:
  VertexView vertices_;
  IndexView triangles_;
};

}  // namespace raylanes
