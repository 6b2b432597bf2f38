// Winding numbers of doubles: of all sizes and far away.
#include "../queries/open_meshes.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

TEST(DoubleWindings, meshes_of_all_sizes) {
  const Mesh open = without(double_fan(12, 0.25f), 0.3, 95);
  for (const double size :
       {0x1p-1070, 0x1p-1000, 0x1p-600, 0x1p-300, 0x1p-100, 0x1p100, 0x1p300, 0x1p600, 0x1p1000, 0x1p1022}) {
    SCOPED_TRACE(std::log2(size));
    const DoubleMesh mesh = moved(open, size, {0, 0, 0});
    const bool is_ordinary = size > 0x1p-200;
    EXPECT_GT(expect_windings(mesh, points_around(mesh, by_level<std::size_t>(20, 40, 400), 96), is_ordinary),
              4u);
  }
}

TEST(DoubleWindings, points_far_from_the_mesh) {
  for (const double size : {1.0, 0x1p-900, 0x1p900}) {
    const DoubleMesh mesh = moved(without(ellipsoid(1, {0, 0, 0}), 0.2, 97), size, {0, 0, 0});
    std::vector<Double3> points;
    for (const double far : {1e3, 1e10, 1e20, 1e38, 1e100, 1e200, 1e300, 1.7e308}) {
      points.push_back({far, -far, 0.5 * far}), points.push_back({0, 0, far});
      if (far * size < 1e300) points.push_back({far * size, -far * size, 0.5 * far * size});
    }
    expect_windings(mesh, points);
  }
}

// In a cube whose sides are longer than the largest double, with one face open.
TEST(DoubleWindings, a_box_of_all_doubles) {
  Mesh open = cube(-1, 1);
  std::erase_if(open.triangles, [&](const Index3& t) {
    return std::ranges::all_of(t, [&](std::uint32_t corner) { return open.vertices[corner][2] > 0; });
  });
  const DoubleMesh mesh = moved(open, 1.7e308, {0, 0, 0});
  Random random(3);
  std::vector<Double3> points{{0, 0, 0}, {1, 1, 1}, {0, 0, 1.7e308}, {0x1p-1074, 0, 0}};
  for (const double c : {-1.6e308, -1e308, 0.5e308, 1.5e308})  // on diagonals of the open face
    points.push_back({c, c, 1.7e308}), points.push_back({c, -c, 1.7e308});
  for (std::size_t i = 0; i < by_level(100); ++i)
    points.push_back(
        {1.7e308 * random.real(-1, 1), 1.7e308 * random.real(-1, 1), 1.7e308 * random.real(-1, 1)});
  EXPECT_GT(expect_windings(mesh, points, false), 50u);
}

// Triangles without an area, so small that powers of distances in a large boundary are flushed.
TEST(DoubleWindings, tiny_parts_of_a_large_boundary) {
  DoubleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const double y = i, large = 0x1p300 * (1 + y);
    append(mesh, {-1, y, 0}, {1, y, 0}, {0, y, 0});
    append(mesh, {large, 0, 0}, {0, large, 0}, {0, 0, large});
  }
  expect_windings(mesh, {{0, 3, 4}, {0, 0x1p20, 3}, {0x1p299, 0x1p298, 0x1p297}, {20, 1, 30}, {0, -40, 1}});
}

}  // namespace
}  // namespace raylanes::testing
