// The rows of closest points: the bytes of scalar, of points alone and of points that go together.
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/points.hpp"
#include "../support/same_bytes.hpp"
#include "every_row.hpp"
#include "small_tree.hpp"

namespace raylanes::testing {
namespace {

void compare_points_in_trees(EveryRow& every, void (*mine)(const TreeView&, const PointBatch&),
                             void (*of_scalar)(const TreeView&, const PointBatch&)) {
  if (!every.offers(mine, of_scalar)) return;
  const SmallTree tree;
  Source source(5);
  std::vector<Float3> points;
  for (std::size_t i = 0; i < most; ++i) points.push_back(source.point(i % 2 == 0 ? 1 : 5));
  // These go together.
  for (std::size_t i = most / 3; i < most; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      points[i][axis] = points[0][axis] + 0x1p-6f * points[i][axis];
  points[7][1] = infinity;
  for (const LaneBits active : {LaneBits(nullptr), LaneBits(some_lanes.data())})
    for (const double max_distance : {double{infinity}, 0.1}) {
      std::vector<ClosestPoint> found(most), scalar(most);
      TraceCounters counters;
      PointBatch batch;
      batch.points = reinterpret_cast<const std::byte*>(points.data()), batch.stride = sizeof(Float3);
      batch.end = most, batch.active = active, batch.max_distance = max_distance, batch.counters = &counters;
      batch.closest = found.data(), mine(tree.view, batch);
      batch.closest = scalar.data(), of_scalar(tree.view, batch);
      EXPECT_TRUE(same_bytes(found, scalar));
    }
}

void compare_single_points(EveryRow& every, const PointKernels& mine, const PointKernels& of_scalar) {
  if (!every.offers(mine.closest_of_point, of_scalar.closest_of_point)) return;
  const SmallTree tree;
  Source source(7);
  for (std::size_t i = 0; i < most; ++i)
    for (const double max_distance : {double{infinity}, 0.1, -1.0}) {
      const Float3 point = source.point(i % 2 == 0 ? 1 : 5);
      ClosestPoint found, expected;
      mine.closest_of_point(tree.view, point, max_distance, found);
      of_scalar.closest_of_point(tree.view, point, max_distance, expected);
      EXPECT_TRUE(same_bytes(found, expected)) << "point " << i;
    }
}

TEST_P(EveryRow, of_points) {
  const PointKernels &mine = kernels_of(path()).points, &of_scalar = kernels_of(scalar()).points;
  compare_points_in_trees(*this, mine.closest_in_tree, of_scalar.closest_in_tree);
  compare_points_in_trees(*this, mine.counted, of_scalar.counted);
  compare_single_points(*this, mine, of_scalar);
  expect_all_called(std::array{mine.closest_in_tree, mine.counted});
}

}  // namespace
}  // namespace raylanes::testing
