
#include "../builder_table.hpp"

namespace raylanes {
namespace {

// The part of a box that is in another; empty where there is none.
Box4 common(const Box4& a, const Box4& b) {
  return {greatest(a.lo, b.lo), least(a.hi, b.hi)};
}

// Around the point where the edge from a to b crosses the plane, on all axes but the plane's own.
//   t = (at − a)/(b − a) along the axis is off by 3u, u = 2^-53, and a + t(b − a) elsewhere by 6u of the edge's extent
//   and u of the result, less than 2^-49 of the largest coordinate. Rounding to float takes 2^-24 of the point, and
//   flushing of subnormal numbers, here and in the coordinates, 2^-126 each.
Box4 crossing(const Float3& a, const Float3& b, std::size_t axis, float at) {
  const double t = (double{at} - double{a[axis]}) / (double{b[axis]} - double{a[axis]});
  Box4 box;
  for (std::size_t k = 0; k < 3; ++k) {
    const double from = a[k], to = b[k], x = from + t * (to - from);
    const double slack =
        0x1p-49 * std::fmax(std::fabs(from), std::fabs(to)) + 0x1p-23 * std::fabs(x) + 0x1p-124;
    box.lo[k] = static_cast<float>(x - slack);
    box.hi[k] = static_cast<float>(x + slack);
  }
  box.lo[axis] = box.hi[axis] = at;
  box.lo[3] = box.hi[3] = 0.0f;
  return box;
}

}  // namespace

Clipper::Halves TriangleClipper::cut(std::uint32_t primitive, const Box4& box, std::size_t axis,
                                     float at) const {
  const Index3 triangle = triangles_[primitive];
  const Float3 corners[3] = {vertices_[triangle[0]], vertices_[triangle[1]], vertices_[triangle[2]]};
  Box4 below = empty_four_box, above = empty_four_box;
  for (std::size_t i = 0; i < 3; ++i) {
    const Float3 &a = corners[i], &b = corners[i == 2 ? 0 : i + 1];
    const Vec4 corner{a[0], a[1], a[2], 0.0f};
    if (a[axis] <= at) extend(below, corner);
    if (a[axis] >= at) extend(above, corner);
    if ((a[axis] < at && b[axis] > at) || (a[axis] > at && b[axis] < at)) {
      const Box4 point = crossing(a, b, axis, at);
      extend(below, point);
      extend(above, point);
    }
  }
  below = common(below, box), above = common(above, box);
  // Sums with +0 as in four_box.
  return {{below.lo + 0.0f, below.hi + 0.0f}, {above.lo + 0.0f, above.hi + 0.0f}};
}

}  // namespace raylanes
