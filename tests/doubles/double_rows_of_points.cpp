// Points of doubles in rows along an axis, which share a ray: located as exactly as single points.
#include <cfenv>

#include "../support/meshes.hpp"
#include "../support/supported_paths.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

// The rows of a mesh: along each axis through points in its box, some on the lattice of its vertices. In a row are
// points anywhere, and those next to the crossings, by units in the last place of their position and of their t.
class Rows {
 public:
  Rows(const DoubleMesh& mesh, std::size_t count, std::uint64_t seed)
      : mesh_(mesh), tree_(mesh.vertices, mesh.triangles), box_(tree_.bounds()), random_(seed) {
    for (std::size_t i = 0; i < count; ++i) add_row(i % 3);
  }
  const std::vector<Double3>& points() const { return points_; }

 private:
  double anywhere(std::size_t axis) {
    const double half = 0.5 * box_.hi[axis] - 0.5 * box_.lo[axis];
    return 0.5 * box_.lo[axis] + 0.5 * box_.hi[axis] + half * random_.real(-1.1, 1.1);
  }
  void add_row(std::size_t axis) {
    const Double3& vertex = mesh_.vertices[random_.index(mesh_.vertices.size())];
    Double3 point;
    for (std::size_t k = 0; k < 3; ++k) point[k] = random_.chance(0.3) ? vertex[k] : anywhere(k);
    std::vector<double> positions;
    for (int k = 0; k < 6; ++k) positions.push_back(anywhere(axis));
    const double extent = box_.hi[axis] - box_.lo[axis];
    RayD ray{point, 0, {0, 0, 0}, std::numeric_limits<double>::infinity()};
    ray.origin[axis] = box_.lo[axis] - 0.5 * extent, ray.direction[axis] = 1;
    for (const CrossingD& crossing : exact_crossings(mesh_, ray)) {
      const double position = ray.origin[axis] + crossing.t, ulp_of_t = crossing.t * 0x1p-52;
      const double ulp = std::nextafter(std::fabs(position), HUGE_VAL) - std::fabs(position);
      for (int k = -3; k <= 3; ++k) {
        positions.push_back(position + k * ulp);
        positions.push_back(position + k * 0.25 * ulp_of_t);
      }
    }
    for (std::size_t k = positions.size() - 1; k > 0; --k)
      std::swap(positions[k], positions[random_.index(k + 1)]);
    for (const double position : positions) point[axis] = position, points_.push_back(point);
  }

  const DoubleMesh& mesh_;
  BvhD tree_;
  BoxD box_;
  Random random_;
  std::vector<Double3> points_;
};

void expect_exact_rows(const DoubleMesh& mesh, std::size_t count, std::uint64_t seed,
                       int rounding = FE_TONEAREST) {
  const std::vector<Double3> points = Rows(mesh, count, seed).points();
  const BvhD tree(mesh.vertices, mesh.triangles);
  std::vector<Location> exact;
  for (const Double3& point : points) exact.push_back(exact_location(mesh, point));
  for (const Location location : {Location::inside, Location::outside})
    EXPECT_GT(std::ranges::count(exact, location), 20);
  for (const Path* path : paths_with_own_queries())
    for (const InsideRule rule : {InsideRule::parity, InsideRule::nonzero}) {
      std::vector<Location> locations(points.size());
      const int threads = rounding == FE_TONEAREST ? 2 : 1;
      std::fesetround(rounding);
      tree.locate(points, locations, {.rule = rule, .path = path, .threads = threads});
      std::fesetround(FE_TONEAREST);
      for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_EQ(locations[i], exact[i])
            << path->name << ", rule " << static_cast<int>(rule) << ", point " << i;
    }
}

std::size_t rows(std::size_t count) {
  return by_level<std::size_t>(count / 4, count / 2, 2 * count);
}

TEST(DoubleRows, near_zero) {
  expect_exact_rows(moved(double_fan(24, 0.3f), 1, {0, 0, 0}), rows(100), 1);
}
TEST(DoubleRows, of_millimetres_thousands_of_kilometres_away) {
  expect_exact_rows(moved(double_fan(24, 0.3f), 1e-3, {5e6, -4e6, 1e5}), rows(100), 2);
}
TEST(DoubleRows, of_cubes_on_a_lattice) {
  expect_exact_rows(moved(cube(-1, 1), 3, {1e15, 7, -2e15}), rows(100), 3);
}
TEST(DoubleRows, by_any_rounding) {
  for (const int rounding : {FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO})
    expect_exact_rows(moved(double_fan(24, 0.3f), 1e-3, {5e6, -4e6, 1e5}), rows(100), 5, rounding);
}
TEST(DoubleRows, of_all_sizes) {
  for (const double size : {0x1p-250, 0x1p-190, 0x1p-130, 0x1p130, 0x1p190, 0x1p300, 0x1p1000})
    expect_exact_rows(moved(double_fan(8, 0.2f), size, {0, 0, 0}), 40, 4);
}

// Single points look to the nearest side, which is missing; rows look along themselves.
TEST(DoubleRows, look_along_themselves) {
  DoubleMesh mesh = moved(cube(-1, 1), 1, {0.1, 0.2, 0.3});
  const double top = 1 + 0.3;
  std::erase_if(mesh.triangles, [&](const Index3& t) {
    return std::ranges::all_of(t, [&](std::uint32_t i) { return mesh.vertices[i][2] == top; });
  });
  const BvhD tree(mesh.vertices, mesh.triangles);
  std::vector<Double3> row;
  for (int i = 0; i < 8; ++i) row.push_back({0.1 * i - 0.3, 0.25, top - 0.05});
  std::vector<Location> single(row.size()), shared(row.size());
  for (std::size_t i = 0; i < row.size(); ++i) tree.locate(std::span(&row[i], 1), std::span(&single[i], 1));
  tree.locate(row, shared);
  EXPECT_EQ(single, std::vector<Location>(row.size(), Location::outside));
  EXPECT_EQ(shared, std::vector<Location>(row.size(), Location::inside));
}

}  // namespace
}  // namespace raylanes::testing
