// The rows of rays of doubles: the bytes of scalar.
#include "../../accel/batch/scratch.hpp"
#include "../../accel/doubles/bvh_d_arrays.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "every_row.hpp"
#include "kept_rows.hpp"

namespace raylanes::testing {
namespace {

Double3 moved(const Float3& p) {
  return {p[0] / 3.0 + 1e6, p[1] / 3.0 - 5e6, p[2] / 3.0};
}

BvhDArrays some_tree() {
  std::vector<Double3> vertices;
  std::vector<Index3> triangles;
  for (const Triangle& triangle : some_triangles()) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const Float3& corner : triangle.corner) vertices.push_back(moved(corner));
    triangles.push_back({first, first + 1, first + 2});
  }
  return build_bvh_d(vertices, triangles, {});
}
std::vector<RayD> some_double_rays() {
  std::vector<RayD> rays;
  for (const Ray& ray : some_rays()) {
    const auto& [o, tmin, d, tmax] = ray;
    rays.push_back({moved(o),
                    static_cast<double>(tmin),
                    {d[0] / 3.0, d[1] / 3.0, d[2] / 3.0},
                    static_cast<double>(tmax)});
    if (rays.size() % 9 == 4)  // far away
      for (std::size_t k = 0; k < 3; ++k) rays.back().origin[k] -= 0x1p30 * rays.back().direction[k];
  }
  return rays;
}

enum class Rays { single, in_flight, stream, packet };

using Kernel = void (*)(const DoubleTreeView&, const DoubleBatch&);
void trace(const DoubleRayKernels& kernels, const BvhDArrays& tree, DoubleBatch batch, Rays as, Kernel single,
           Kernel stream) {
  const std::size_t bytes =
      as == Rays::packet ? kernels.packet_bytes(batch.size) : kernels.stream_bytes(batch.size);
  Scratch scratch(Scratch::bytes_of<std::byte>(bytes));
  batch.scratch = scratch.take<std::byte>(bytes);
  if (as == Rays::packet && batch.size == 0) return;
  DoubleTreeView view = tree.view();
  view.tree.rays_wait = as == Rays::in_flight;
  (as == Rays::packet ? kernels.packet : as == Rays::stream ? stream : single)(view, batch);
}
std::vector<HitD> hits_of(const DoubleRayKernels& kernels, const BvhDArrays& tree,
                          const std::vector<RayD>& rays, Facing facing, const HitD* after,
                          Rays as = Rays::single, const std::uint32_t* skip = nullptr) {
  std::vector<HitD> hits(rays.size());
  DoubleBatch batch;
  batch.rays = rays.data(), batch.size = rays.size(), batch.hits = hits.data();
  batch.facing = facing, batch.after = after, batch.skip = skip;
  trace(kernels, tree, batch, as, kernels.closest, kernels.closest_stream);
  return hits;
}
std::vector<std::uint8_t> occluded_by(const DoubleRayKernels& kernels, const BvhDArrays& tree,
                                      const std::vector<RayD>& rays, Facing facing, Rays as = Rays::single,
                                      const std::uint32_t* skip = nullptr) {
  std::vector<std::uint8_t> occluded(rays.size());
  DoubleBatch batch;
  batch.skip = skip;
  batch.rays = rays.data(), batch.size = rays.size(), batch.occluded = occluded.data(), batch.facing = facing;
  trace(kernels, tree, batch, as, kernels.any, kernels.any_stream);
  return occluded;
}
// In the order of rays, then of primitives.
template <class Entry>
std::vector<Entry> list_of(const DoubleRayKernels& kernels, const BvhDArrays& tree,
                           const std::vector<RayD>& rays, ListKind kind, ListStop stop, Facing facing) {
  std::vector<ListEntryOf<double>> list(most * most);
  std::vector<HitD> hits(list.size());
  std::vector<std::size_t> ends(rays.size());
  DoubleListBatch batch;
  batch.rays = rays.data(), batch.size = rays.size(), batch.kind = kind, batch.stop = stop,
  batch.facing = facing;
  batch.list = list.data(), batch.hits = hits.data(), batch.room = list.size(), batch.end = ends.data();
  EXPECT_EQ(kernels.list(tree.view(), batch), rays.size());
  std::vector<Entry> items;
  if constexpr (std::is_same_v<Entry, HitD>)
    items = hits;
  else
    items = list;
  for (std::size_t i = 0, at = 0; i < rays.size(); at = ends[i++])
    std::ranges::sort(std::span(items).subspan(at, ends[i] - at), {}, &Entry::primitive);
  items.resize(ends.back());
  return items;
}

// Triangles that rays hit, which are not there for them.
void compare_skips(const DoubleRayKernels& mine, const DoubleRayKernels& of_scalar, const BvhDArrays& tree,
                   const std::vector<RayD>& rays, Facing facing, const std::vector<HitD>& first) {
  std::vector<std::uint32_t> skip;
  for (const HitD& hit : first) skip.push_back(skip.size() % 4 == 0 ? no_primitive : hit.primitive);
  const std::vector<HitD> hits = hits_of(of_scalar, tree, rays, facing, nullptr, Rays::single, skip.data());
  const std::vector<std::uint8_t> occluded =
      occluded_by(of_scalar, tree, rays, facing, Rays::single, skip.data());
  for (const Rays as : {Rays::single, Rays::in_flight, Rays::stream}) {
    EXPECT_TRUE(same_bytes(hits_of(mine, tree, rays, facing, nullptr, as, skip.data()), hits));
    EXPECT_EQ(occluded_by(mine, tree, rays, facing, as, skip.data()), occluded);
  }
  for (std::size_t i = 0; i < hits.size(); ++i)
    EXPECT_TRUE(!hits[i] || hits[i].primitive != skip[i]) << "ray " << i;
}

// Batches and single points; some are neighbours, far away, or no numbers.
void compare_closest_points(EveryRow& every, const DoubleRayKernels& mine, const DoubleRayKernels& of_scalar,
                            const BvhDArrays& tree) {
  if (!every.offers(mine.closest_in_tree, of_scalar.closest_in_tree) ||
      !every.offers(mine.closest_of_point, of_scalar.closest_of_point))
    return;
  std::vector<Double3> points;
  for (const RayD& ray : some_double_rays()) points.push_back(ray.origin);
  for (std::size_t i = most / 3; i < points.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      points[i][axis] = points[0][axis] + 0x1p-6 * (points[i][axis] - points[0][axis]);
  points[7][1] = points[8][2] = 1e300, points[9][0] = std::numeric_limits<double>::infinity();
  for (const LaneBits active : {LaneBits(nullptr), LaneBits(some_lanes.data())})
    for (const double max_distance : {std::numeric_limits<double>::infinity(), 0.1, -1.0}) {
      std::vector<ClosestPointD> found(points.size()), scalar(points.size());
      PointBatchOf<double> batch;
      batch.points = reinterpret_cast<const std::byte*>(points.data()), batch.stride = sizeof(Double3);
      batch.end = points.size(), batch.active = active, batch.max_distance = max_distance;
      batch.closest = found.data(), mine.closest_in_tree(tree.view(), batch);
      batch.closest = scalar.data(), of_scalar.closest_in_tree(tree.view(), batch);
      EXPECT_TRUE(same_bytes(found, scalar));
      for (std::size_t i = 0; i < points.size() && active == nullptr; ++i) {
        mine.closest_of_point(tree.view(), points[i], max_distance, found[i]);
        EXPECT_TRUE(same_bytes(found[i], scalar[i])) << "point " << i;
      }
    }
}

TEST_P(EveryRow, of_doubles) {
  const DoubleRayKernels &mine = kernels_of(path()).doubles, &of_scalar = kernels_of(scalar()).doubles;
  if (!offers(mine.closest_of_ray, of_scalar.closest_of_ray) ||
      !offers(mine.any_of_ray, of_scalar.any_of_ray) ||
      !offers(mine.nearest_triangle, of_scalar.nearest_triangle) ||
      !offers(mine.closest, of_scalar.closest) || !offers(mine.any, of_scalar.any) ||
      !offers(mine.list, of_scalar.list) || !offers(mine.closest_stream, of_scalar.closest_stream) ||
      !offers(mine.any_stream, of_scalar.any_stream) || !offers(mine.stream_bytes, of_scalar.stream_bytes) ||
      !offers(mine.packet, of_scalar.packet) || !offers(mine.packet_bytes, of_scalar.packet_bytes))
    return;
  const BvhDArrays tree = some_tree();
  const TrianglesOfHalves triangles{tree.halves.data()};
  const auto next = [&](const RayD& ray, Facing facing, std::uint32_t skipped, const HitD* last) {
    return hits_of(of_scalar, tree, {ray}, facing, last, Rays::single, &skipped)[0];
  };
  compare_kept<double>(*this, mine.kept, of_scalar.kept, tree.view(), some_double_rays(), next);
  for (const std::size_t n : sizes)
    for (const Facing facing : {Facing::any, Facing::front, Facing::back}) {
      std::vector<RayD> rays = some_double_rays();
      rays.resize(n);
      const std::vector<HitD> first = hits_of(mine, tree, rays, facing, nullptr);
      EXPECT_TRUE(same_bytes(first, hits_of(of_scalar, tree, rays, facing, nullptr)));
      EXPECT_TRUE(same_bytes(hits_of(mine, tree, rays, facing, first.data()),
                             hits_of(of_scalar, tree, rays, facing, first.data())));
      EXPECT_TRUE(same_bytes(hits_of(mine, tree, rays, facing, first.data(), Rays::in_flight),
                             hits_of(of_scalar, tree, rays, facing, first.data())));
      for (const Rays as : {Rays::in_flight, Rays::stream})
        EXPECT_TRUE(same_bytes(first, hits_of(mine, tree, rays, facing, nullptr, as)));
      compare_skips(mine, of_scalar, tree, rays, facing, first);
      const std::vector<std::uint8_t> occluded = occluded_by(mine, tree, rays, facing);
      for (std::size_t i = 0; i < n; ++i) {
        const auto call = [&](const DoubleRayKernels& rows, std::uint32_t skipped) {
          const HitD hit = rows.closest_of_ray(tree.view(), rays[i], facing, skipped);
          EXPECT_EQ(rows.any_of_ray(tree.view(), rays[i], facing, skipped), bool(hit));
          return hit;
        };
        EXPECT_TRUE(same_bytes(first[i], call(mine, no_primitive)));
        const HitD behind = call(mine, first[i].primitive);
        EXPECT_TRUE(same_bytes(behind, call(of_scalar, first[i].primitive)));
        EXPECT_TRUE(!behind || behind.primitive != first[i].primitive);
        if (facing != Facing::any) continue;
        EXPECT_EQ(occluded[i] != 0, bool(first[i]));
        const std::uint32_t triangle = mine.nearest_triangle(tree.view(), rays[i]);
        EXPECT_EQ(triangle, of_scalar.nearest_triangle(tree.view(), rays[i]));
        EXPECT_EQ(triangle == ~0u ? no_primitive : triangles.primitive(triangle), first[i].primitive);
      }
      EXPECT_EQ(occluded, occluded_by(of_scalar, tree, rays, facing));
      for (const Rays as : {Rays::in_flight, Rays::stream})
        EXPECT_EQ(occluded, occluded_by(mine, tree, rays, facing, as));
      const auto hits = list_of<HitD>(mine, tree, rays, ListKind::hits, ListStop::never, facing);
      EXPECT_TRUE(
          same_bytes(hits, list_of<HitD>(of_scalar, tree, rays, ListKind::hits, ListStop::never, facing)));
      if (n > 20 && facing == Facing::any) {
        EXPECT_GT(hits.size(), 20u);
      }
      for (const ListKind kind : {ListKind::crossings, ListKind::sides})
        for (const ListStop stop : {ListStop::never, ListStop::at_origin, ListStop::undecided}) {
          const auto list = list_of<ListEntryOf<double>>(mine, tree, rays, kind, stop, facing);
          EXPECT_EQ(list, list_of<ListEntryOf<double>>(of_scalar, tree, rays, kind, stop, facing));
          if (n > 20 && facing == Facing::any && stop != ListStop::undecided) {
            EXPECT_GT(list.size(), 20u);
          }
        }
    }
  // Some begin elsewhere.
  std::vector<RayD> rays = some_double_rays();
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (i % 16 != 3) rays[i].origin = rays[0].origin;
  for (const std::size_t n : sizes) {
    const std::vector<RayD> some(rays.begin(), rays.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_TRUE(same_bytes(hits_of(mine, tree, some, Facing::any, nullptr, Rays::packet),
                           hits_of(of_scalar, tree, some, Facing::any, nullptr)));
    EXPECT_EQ(occluded_by(mine, tree, some, Facing::any, Rays::packet),
              occluded_by(of_scalar, tree, some, Facing::any));
  }
  compare_closest_points(*this, mine, of_scalar, tree);
  expect_all_called(mine);
}

// As Calls.in_flight_keep_what_waits_in_deep_trees of floats: triangles around an axis, each thinner than the last and
// longer, so that a ray along the axis has many boxes waiting.
TEST_P(EveryRow, of_doubles_in_flight_keep_what_waits) {
  const DoubleRayKernels &mine = kernels_of(path()).doubles, &of_scalar = kernels_of(scalar()).doubles;
  if (!offers(mine.closest, of_scalar.closest) || !offers(mine.any, of_scalar.any)) return;
  std::vector<Double3> vertices;
  std::vector<Index3> triangles;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const double s = std::pow(0.98, i);
    vertices.insert(vertices.end(), {{s, -s, -0.001 * i}, {-s, s, -0.001 * i}, {-0.9 * s, -0.9 * s, 1}});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const BvhDArrays tree = build_bvh_d(vertices, triangles, {.builder = TreeBuilder::sweep_sah});
  Source random(85);
  std::vector<RayD> rays;
  for (int i = 0; i < 300; ++i) {
    const double s = std::pow(10, i % 4 == 0 ? random.number(-35, 0) : random.number(-7, -5));
    rays.push_back({{random.number(-1, 1) * s, random.number(-1, 1) * s, -10}, 0, {0, 0, 1}, 100});
  }
  EXPECT_TRUE(same_bytes(hits_of(mine, tree, rays, Facing::any, nullptr, Rays::in_flight),
                         hits_of(of_scalar, tree, rays, Facing::any, nullptr)));
  EXPECT_EQ(occluded_by(mine, tree, rays, Facing::any, Rays::in_flight),
            occluded_by(of_scalar, tree, rays, Facing::any));
}

}  // namespace
}  // namespace raylanes::testing
