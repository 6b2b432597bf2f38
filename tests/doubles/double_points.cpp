// Closest points of trees of doubles: neighbours together, and all scales at once.
#include "../point/every_tree.hpp"
#include "../support/float_modes.hpp"

namespace raylanes::testing {
namespace {

TEST(DoubleClosestPoints, go_together_as_they_go_alone) {
  for (const DoubleCase& c : double_cases(0)) {
    const std::vector<Double3> points =
        clusters(points_for(c.mesh, by_level<std::size_t>(12, 30, 300), 22), size_of(c.mesh), 23);
    const BvhD tree(c.mesh.vertices, c.mesh.triangles);
    std::vector<ClosestPointD> alone;
    for (const Double3& point : points)
      alone.push_back(tree.closest_point(point, {.path = &paths().front()}));
    expect_same(alone, one_by_one(c.mesh, points), c.name);
    expect_everywhere(c.mesh, points, alone, c.name);
    if (HasFatalFailure()) return;
  }
}

// Numbers of all sizes in one mesh, and planes that are far thinner than their coordinates.
TEST(DoubleClosestPoints, have_all_scales_at_once) {
  DoubleMesh mesh;
  for (const int exponent : {-1070, -900, -500, -100, 0, 100, 400, 900})
    append(mesh, moved(triangle_soup(12, 0.5f, 2721), std::ldexp(1.0, exponent), {0, 0, 0}));
  DoubleMesh flat;
  for (int i = 0; i < 40; ++i) {
    const double y = i * 1e-300;
    append(flat, {1e300, y, 0}, {1e300, y + 1e-300, 0}, {1e300, y, 1e-300});
  }
  DoubleMesh far;  // seen from 2^62 sizes away, 2^70 from zero
  for (int i = 0; i < 40; ++i) {
    const double y = i % 7, z = i;
    append(far, {0x1p70, y, z}, {0x1p70, y + 1, z}, {0x1p70, y, z + 1});
  }
  for (DoubleMesh* each : {&mesh, &flat, &far}) {
    std::vector<Double3> points = points_for(*each, by_level<std::size_t>(30, 90, 250), 29);
    for (const double off : {0x1p40, 0x1p55, 0x1p62, 0x1p66, 0x1p70})
      points.insert(points.end(), {{0x1p70, off, 0}, {0x1p70, -off, off}, {0x1p70 + off, 3, 5}});
    const std::vector<ClosestPointD> found = closest_of(BvhD(each->vertices, each->triangles), points);
    expect_near(*each, points, found, "all scales");
    expect_everywhere(*each, points, found, "all scales");
    if (each == &far) expect_same(found, one_by_one(far, points), "far");
    const FloatModeScope scope(FloatMode::flush);
    closest_of(BvhD(each->vertices, each->triangles), points);
  }
}

}  // namespace
}  // namespace raylanes::testing
