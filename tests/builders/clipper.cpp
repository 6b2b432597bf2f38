// The boxes of clipped triangles hold every part of them, and little more.
#include "../../accel/builders/builder_table.hpp"
#include "../support/float_modes.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {
namespace {

bool holds(const Box4& box, const double (&point)[3], double slack = 0.0) {
  bool inside = true;
  for (std::size_t axis = 0; axis < 3; ++axis)
    inside = inside && box.lo[axis] - slack <= point[axis] && point[axis] <= box.hi[axis] + slack;
  return inside;
}

Box4 box_around(const Triangle& triangle) {
  Box4 box = empty_four_box;
  for (const Float3& c : triangle.corner) extend(box, Vec4{c[0], c[1], c[2], 0.0f});
  return box;
}

// Means of the corners by sixteenths, which are exact in double where coordinates are alike in size: each that is in
// the box must be in the half of its side, and on the plane in both.
void expect_covered(const Triangle& triangle, const Box4& box, std::size_t axis, float at,
                    FloatMode mode = FloatMode::ieee) {
  const std::vector<Float3> vertices(std::begin(triangle.corner), std::end(triangle.corner));
  const std::vector<Index3> triangles{{0, 1, 2}};
  const auto cut = [&] {
    const FloatModeScope scope(mode);
    return TriangleClipper(vertices, triangles).cut(0, box, axis, at);
  };
  const Clipper::Halves halves = cut();
  // Bounds that count as zero may be zeros.
  const double slack = mode == FloatMode::flush ? 0x1p-126 : 0.0;
  for (int i = 0; i <= 16; ++i)
    for (int j = 0; i + j <= 16; ++j) {
      double point[3];
      for (std::size_t k = 0; k < 3; ++k)
        point[k] = (double(vertices[0][k]) * i + double(vertices[1][k]) * j +
                    double(vertices[2][k]) * (16 - i - j)) /
                   16;
      if (!holds(box, point)) continue;
      EXPECT_TRUE(point[axis] > at || holds(halves.below, point, slack)) << axis << " at " << at;
      EXPECT_TRUE(point[axis] < at || holds(halves.above, point, slack)) << axis << " at " << at;
    }
  for (const Box4& half : {halves.below, halves.above})
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_TRUE(half.lo[k] > half.hi[k] ||
                  (half.lo[k] + slack >= box.lo[k] && half.hi[k] - slack <= box.hi[k]));
}

TEST(TriangleClipper, leaves_every_point_in_a_half) {
  Random random(1);
  for (std::size_t i = 0; i < by_level(6000); ++i) {
    const float size = random.magnitude(1e-37, 1e37);
    Triangle triangle = random.triangle(1);
    if (random.chance(0.3)) triangle.corner[1][0] = triangle.corner[0][0];
    for (Float3& corner : triangle.corner)
      for (float& x : corner) x *= size;
    Box4 box = box_around(triangle);
    for (int cuts = 0; cuts < 4; ++cuts) {
      const auto axis = random.index(3);
      const float at = random.chance(0.2) ? triangle.corner[random.integer(0, 2)][axis]
                                          : static_cast<float>(random.real(box.lo[axis], box.hi[axis]));
      expect_covered(triangle, box, axis, at);
      // On with a part of the box.
      if (random.chance(0.5)) box.hi[axis] = std::max(at, box.lo[axis]);
    }
  }
}

// Middles of edges that lie exactly on the plane, and are no floats on the other axes: rounding must go outwards.
TEST(TriangleClipper, leaves_crossings_in_both_halves) {
  Random random(3);
  for (std::size_t i = 0; i < by_level(1000); ++i) {
    Triangle triangle = random.triangle(1);
    for (Float3& corner : triangle.corner) corner[0] = std::round(corner[0] * 1024) / 1024;
    const float at = 0.5f * (triangle.corner[0][0] + triangle.corner[1][0]);
    expect_covered(triangle, box_around(triangle), 0, at);
  }
}

TEST(TriangleClipper, leaves_little_more) {
  const std::vector<Float3> vertices{{0, 0, 0}, {4, 4, 2}, {4, 0, 0}};
  const std::vector<Index3> triangles{{0, 1, 2}};
  const TriangleClipper clipper(vertices, triangles);
  const Box4 box{Vec4{0, 0, 0, 0}, Vec4{4, 4, 2, 0}};
  const Clipper::Halves halves = clipper.cut(0, box, 0, 1.0f);
  EXPECT_EQ(halves.below.hi[0], 1.0f);
  EXPECT_EQ(halves.above.lo[0], 1.0f);
  EXPECT_NEAR(halves.below.hi[1], 1.0f, 0x1p-22f);
  EXPECT_NEAR(halves.below.hi[2], 0.5f, 0x1p-23f);
  EXPECT_EQ(halves.above.hi[1], 4.0f);
  // Nothing of it is below a plane that it does not reach.
  const Clipper::Halves none = clipper.cut(0, box, 0, -1.0f);
  EXPECT_FALSE(none.below.lo[0] <= none.below.hi[0]);
}

// Coordinates that count as zero then are moved by as much as the slack has room for.
TEST(TriangleClipper, leaves_every_point_in_a_half_where_subnormal_numbers_are_zeros) {
  for (const FloatMode mode : float_modes) {
    Random random(2);
    for (std::size_t i = 0; i < by_level(2000); ++i) {
      Triangle triangle = random.triangle(1);
      for (Float3& corner : triangle.corner) corner[1] *= 1e-38f, corner[2] *= 1e-37f;
      expect_covered(triangle, box_around(triangle), 0, random.number(-1, 1), mode);
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
