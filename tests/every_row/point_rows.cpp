// The rows of points: the closest ones, alone and of points that go together, of floats and doubles; terms of
// boundaries; and rays in another space.
#include "../../accel/mesh/boundary_tree.hpp"
#include "../../dispatch/table/points.hpp"
#include "../../dispatch/table/winding.hpp"
#include "every_row.hpp"

namespace raylanes::testing {
namespace {

template <class T>
using OfPoint = void (*)(const TreeViewOf<T>&, const PointOf<T>&, double, ClosestPointOf<T>&);
template <class T>
using InTree = void (*)(const TreeViewOf<T>&, const PointBatchOf<T>&);

// Some are neighbours, far away, or no numbers.
template <class T>
std::vector<PointOf<T>> some_points() {
  std::vector<PointOf<T>> points;
  for (const RayOf<T>& ray : some_rays<T>()) points.push_back(ray.origin);
  for (std::size_t i = most / 3; i < most; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      points[i][axis] = points[0][axis] + T(0x1p-6) * (points[i][axis] - points[0][axis]);
  points[7][1] = points[8][2] = std::numeric_limits<T>::max() / 1000,
  points[9][0] = std::numeric_limits<T>::infinity();
  return points;
}

template <class T>
void check_points(EveryRow& every, OfPoint<T> of_point, std::initializer_list<InTree<T>> in_trees) {
  const std::string name = std::is_same_v<T, float> ? "floats points" : "doubles points";
  const std::vector<PointOf<T>> points = some_points<T>();
  const TreeViewOf<T> tree = small_view<T>();
  const double distances[] = {double{infinity}, 0.5, -1.0};
  for (const InTree<T> in_tree : in_trees)
    for (const LaneBits active : {LaneBits(nullptr), LaneBits(some_lanes.data())}) {
      if (!every.offers(in_tree)) continue;
      Hash hash;
      for (const double max_distance : distances) {
        std::vector<ClosestPointOf<T>> found(most);
        TraceCounters counters;
        PointBatchOf<T> batch;
        batch.points = reinterpret_cast<const std::byte*>(points.data()), batch.stride = sizeof(PointOf<T>);
        batch.end = most, batch.active = active, batch.max_distance = max_distance;
        batch.closest = found.data(), batch.counters = &counters;
        in_tree(tree, batch);
        for (const ClosestPointOf<T>& closest : found) hash.add(closest);
      }
      expect_recorded(active == nullptr ? name : name + ", some", hash, "points that go together");
    }
  if (!every.offers(of_point)) return;
  Hash hash;
  for (const double max_distance : distances)
    for (const PointOf<T>& point : points) {
      ClosestPointOf<T> closest;
      of_point(tree, point, max_distance, closest);
      hash.add(closest);
    }
  expect_recorded(name, hash, "single points");
}

TEST_P(EveryRow, of_points) {
  const PointKernels& rows = kernels().points;
  check_points<float>(*this, rows.closest_of_point, {rows.closest_in_tree, rows.counted});
  const DoubleRayKernels& doubles = kernels().doubles;
  check_points<double>(*this, doubles.closest_of_point, {doubles.closest_in_tree});
  EXPECT_EQ(rows.counted == nullptr, scalar().points.counted == nullptr);
}

template <class T>
void check_boundaries(EveryRow& every, void (*terms_of)(const BoundaryView&, const BoundaryBatch&)) {
  if (!every.offers(terms_of)) return;
  std::vector<CornersOf<T>> triangles;
  for (const Triangle& triangle : some_triangles())
    triangles.push_back({{as<T>(triangle.corner[0]), as<T>(triangle.corner[1]), as<T>(triangle.corner[2])}});
  const BoundaryTree tree(boundary_loops(triangles));
  std::vector<double> columns[3], terms(most);
  for (const RayOf<T>& ray : some_rays<T>())
    for (std::size_t k = 0; k < 3; ++k) columns[k].push_back(static_cast<double>(ray.origin[k]));
  BoundaryBatch batch;
  batch.size = most, batch.terms = terms.data();
  for (std::size_t k = 0; k < 3; ++k) batch.points[k] = columns[k].data();
  Hash hash;
  for (batch.axis = 0; batch.axis < 3; ++batch.axis)
    for (const double accuracy : {0.0, 1e-4}) {
      batch.accuracy = accuracy, batch.sign = -batch.sign;
      terms_of(tree.view(), batch);
      for (const double term : terms) hash.add(term);
    }
  expect_recorded(std::is_same_v<T, float> ? "floats boundaries" : "doubles boundaries", hash, "boundaries");
}

TEST_P(EveryRow, of_boundaries) {
  const WindingKernels& rows = kernels().winding;
  check_boundaries<float>(*this, rows.boundary_terms);
  check_boundaries<double>(*this, rows.boundary_terms_of_doubles);
  expect_all_called(rows, scalar().winding);
}

TEST_P(EveryRow, of_rays_in_another_space) {
  const auto map_rays = kernels().queries.map_rays;
  ASSERT_TRUE(offers(map_rays));
  const double map[12] = {0.1, -2, 3, 5, 7, 0.3, -1, 1e-3, 2, 4, 0.7, -9};
  const std::vector<Ray> rays = some_rays<float>();
  std::vector<std::uint32_t> numbers(most);
  std::iota(numbers.rbegin(), numbers.rend(), 0);
  Hash hash;
  for (const std::uint32_t* some :
       {static_cast<const std::uint32_t*>(nullptr), static_cast<const std::uint32_t*>(numbers.data())}) {
    std::vector<Ray> mapped(most);
    map_rays(rays.data(), some, most, map, mapped.data());
    for (const Ray& ray : mapped)
      for (std::size_t k = 0; k < 3; ++k) hash.add(ray.origin[k]), hash.add(ray.direction[k]);
    for (const Ray& ray : mapped) hash.add(ray.tmin), hash.add(ray.tmax);
  }
  expect_recorded("mapped rays", hash, "scenes");
}

}  // namespace
}  // namespace raylanes::testing
