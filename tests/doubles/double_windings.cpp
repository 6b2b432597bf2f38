// Winding numbers of doubles: where coordinates and triangles are as large, or as small, as doubles are.
#include "../queries/open_meshes.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

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
