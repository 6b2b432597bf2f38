// Rays of doubles of any bits to trees over meshes of any finite ones, on any path: hits, occlusion, lists, crossings,
// next hits and rows of points with the bytes of rational numbers, closest points within their bound, nothing written
// elsewhere.
#include <algorithm>
#include <cmath>

#include "../fuzz/any_doubles.hpp"
#include "../fuzz/any_passages.hpp"
#include "../fuzz/fence.hpp"
#include "../fuzz/support.hpp"
#include "../support/filtered.hpp"
#include "../support/same_bytes.hpp"
#include "../traverse/reference/in_flight.hpp"
#include "summed_windings.hpp"

namespace raylanes::testing {
using namespace oracle;

namespace {

constexpr std::size_t max_rays = 12;

void expect_hits(const BvhD& tree, const std::vector<RayD>& rays,
                 const std::vector<std::vector<HitD>>& expected, const TraceOptionsD& options) {
  static Fence fence(max_rays * sizeof(HitD));
  const std::span<HitD> hits(fence.last<HitD>(rays.size()), rays.size());
  std::fill(hits.begin(), hits.end(), HitD{-HUGE_VAL, 0, 0, 0, 0});
  TraceOptionsD behind = options;
  behind.after = hits;
  std::vector<std::uint8_t> occluded(rays.size());
  tree.occluded(rays, occluded, options);
  const RayLists<HitD> lists =
      tree.all_hits(rays, {.facing = options.facing, .path = options.path, .skip = options.skip});
  for (std::size_t layer = 0; layer <= max_double_triangles; ++layer) {
    tree.closest(rays, hits, behind);
    fence.expect_intact("hits");
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!same_bytes(hits[i], layer < expected[i].size() ? expected[i][layer] : HitD()))
        fail(std::string(options.path->name) + ": ray " + std::to_string(i) + ": hit " +
             std::to_string(layer));
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::string ray = std::string(options.path->name) + ": ray " + std::to_string(i) + ": ";
    if ((occluded[i] != 0) != !expected[i].empty()) fail(ray + "occluded is wrong");
    TraceOptionsD alone = options;
    if (options.skip.count > 0)
      alone.skip = PrimitiveView(static_cast<const std::uint32_t*>(options.skip.first) + i, 1);
    if (!same_bytes(tree.closest(rays[i], alone), expected[i].empty() ? HitD() : expected[i][0]))
      fail(ray + "the nearest hit is wrong");
    if (!same_bytes(lists[i], expected[i])) fail(ray + "the list is wrong");
  }
}

// The first few hits of each ray, from records and from one array per number.
void expect_few_hits(const BvhD& tree, const std::vector<RayD>& rays,
                     const std::vector<std::vector<HitD>>& expected, const ListOptions& options) {
  const RayColumns columns(rays);
  const RayLists<HitD> few = tree.all_hits(rays, options), of_arrays = tree.all_hits(columns.view(), options);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::size_t size = std::min<std::size_t>(expected[i].size(), options.max_count);
    if (!same_bytes(few[i], std::span(expected[i]).first(size)) || !same_bytes(of_arrays[i], few[i]))
      fail(std::string(options.path->name) + ": ray " + std::to_string(i) + ": the first hits are wrong");
  }
}

// Points along an axis, by the crossings of each point's own ray along it.
void expect_row(Bytes& bytes, const DoubleMesh& mesh, const BvhD& tree, const Path* path) {
  const std::size_t axis = bytes.below(3);
  std::vector<Double3> row(10, bytes.pick(mesh.vertices));
  for (Double3& point : row) {
    const double a = bytes.pick(mesh.vertices)[axis], b = bytes.pick(mesh.vertices)[axis];
    point[axis] = bytes.chance(100) ? a : 0.5 * a + 0.5 * b;
  }
  std::ranges::sort(row);
  row.erase(std::unique(row.begin(), row.end()), row.end());
  if (row.size() < 2) return;
  std::vector<Location> locations(row.size());
  tree.locate(row, locations, {.path = path});
  for (std::size_t i = 0; i < row.size(); ++i) {
    RayD ray{row[i], 0, {0, 0, 0}, HUGE_VAL};
    ray.direction[axis] = 4;
    bool is_in_box = true;
    for (std::size_t k = 0; k < 3; ++k)
      is_in_box = is_in_box && row[i][k] >= tree.bounds().lo[k] && row[i][k] <= tree.bounds().hi[k];
    const bool is_inside = is_in_box && exact_double_crossings(mesh, ray).size() % 2 != 0;
    const Location expected = is_on(mesh, row[i]) ? Location::on
                              : is_inside         ? Location::inside
                                                  : Location::outside;
    if (locations[i] != expected)
      fail(std::string(path->name) + ": point " + std::to_string(i) + " of a row is wrong");
  }
}

// Winding numbers beside sums over all triangles, at points off edges.
void expect_windings(const DoubleMesh& mesh, const BvhD& tree, const VertexViewD& points, double accuracy,
                     const Path* path) {
  static Fence fence(max_rays * sizeof(double));
  const std::span<double> numbers(fence.last<double>(points.count), points.count);
  tree.winding_numbers(points, numbers, {.accuracy = accuracy, .path = path});
  fence.expect_intact("winding numbers");
  const double edges = boundary_edges(mesh);
  for (std::size_t i = 0; i < points.count; ++i) {
    const Double3 point = points[i];
    if (!std::ranges::all_of(point, [](double x) { return std::isfinite(x); })) {
      if (numbers[i] != 0) fail("a point that is not finite has a winding number");
      continue;
    }
    if (is_on_edge(mesh, point)) continue;
    const SummedWinding sum = summed_winding(mesh, point);
    if (!(std::abs(numbers[i] - sum.number) <= bound_of_winding(sum, accuracy, edges)))
      fail(std::string(path->name) + ": point " + std::to_string(i) + ": the winding number is " +
           std::to_string(numbers[i]) + ", not " + std::to_string(static_cast<double>(sum.number)));
  }
}

// Points of any bits, in batches and alone, by rational numbers. Points on triangles, and no others, have the signed
// distance 0.
void expect_closest_points(const DoubleMesh& mesh, const BvhD& tree, const VertexViewD& points,
                           const std::vector<Location>& locations, const Path* path) {
  static Fence fence(max_rays * sizeof(ClosestPointD));
  const std::span<ClosestPointD> closest(fence.last<ClosestPointD>(points.count), points.count);
  std::vector<double> distances(points.count);
  tree.closest_points(points, closest, {.path = path});
  fence.expect_intact("closest points");
  tree.signed_distances(points, distances, {.path = path});
  for (std::size_t i = 0; i < points.count; ++i) {
    const std::string point = std::string(path->name) + ": point " + std::to_string(i) + ": ";
    const Double3 p = points[i];
    const bool is_finite = std::ranges::all_of(p, [](double x) { return std::isfinite(x); });
    if (!same_bytes(closest[i], tree.closest_point(p, {.path = path}))) fail(point + "alone it is another");
    if (closest[i] && !is_finite) fail(point + "it is no number");
    if (std::isnan(distances[i]) || (distances[i] == 0) != (locations[i] == Location::on))
      fail(point + "the signed distance is wrong");
    if (!is_finite) continue;
    const std::string fault = fault_of_closest_point(mesh, p, closest[i]);
    if (!fault.empty()) fail(point + fault);
  }
}

// The same rays again and again, so many that they are traced together: as streams, or as packets if they share an
// origin.
void expect_hits_of_many(const BvhD& tree, const std::vector<RayD>& rays, std::size_t count,
                         const std::vector<std::vector<HitD>>& expected, const TraceOptionsD& options) {
  std::vector<RayD> many;
  while (many.size() < count) many.insert(many.end(), rays.begin(), rays.end());
  std::vector<HitD> hits(many.size());
  std::vector<std::uint8_t> occluded(many.size());
  tree.closest(many, hits, options), tree.occluded(many, occluded, options);
  for (std::size_t i = 0; i < many.size(); ++i) {
    const std::vector<HitD>& of_ray = expected[i % rays.size()];
    if (!same_bytes(hits[i], of_ray.empty() ? HitD() : of_ray[0]) || (occluded[i] != 0) == of_ray.empty())
      fail(std::string(options.path->name) + ": ray " + std::to_string(i) + " of many");
  }
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_doubles(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes;
  using namespace raylanes::testing;
  Bytes bytes(data, size);
  DoubleCoordinates coordinates(bytes);
  const DoubleMesh mesh = any_double_mesh(bytes, coordinates);
  const Path* const path = bytes.pick(fuzzed_paths());
  const Facing facing = bytes.chance(128) ? Facing::any : bytes.chance(128) ? Facing::front : Facing::back;
  const TreeBuilder builder = bytes.chance(128) ? TreeBuilder::binned_sah : TreeBuilder::morton;
  const bool flush = bytes.chance(48);
  std::vector<RayD> rays;
  for (std::size_t n = bytes.below(max_rays); rays.size() < n;)
    rays.push_back(any_double_ray(bytes, coordinates, mesh));
  const bool share_origin = bytes.chance(64);
  if (share_origin)
    for (RayD& ray : rays) ray.origin = rays[0].origin;
  std::vector<std::vector<HitD>> hits;
  std::vector<std::vector<CrossingD>> crossings;
  const bool skips = bytes.chance(96);
  std::vector<std::uint32_t> skip;
  for (const RayD& ray : rays) {
    hits.push_back(exact_double_hits(mesh, ray, facing));
    if (skips) {
      skip.push_back(hits.back().empty() ? static_cast<std::uint32_t>(bytes.below(1000))
                                         : bytes.pick(hits.back()).primitive);
      std::erase_if(hits.back(), [&](const HitD& hit) { return hit.primitive == skip.back(); });
    }
    crossings.push_back(exact_double_crossings(mesh, ray));
  }
  // Now and then of triangles of other vertices, of which some collapse or come back at a refit.
  const bool refits = bytes.chance(64);
  DoubleMesh before = mesh;
  for (std::uint32_t i = 0; refits && i < before.triangles.size(); ++i)
    before.triangles[i] = {i, i + 1, i + 2};
  BvhD tree(before.vertices, before.triangles, {.builder = builder});
  if (refits) tree.refit(mesh.vertices, mesh.triangles);
  tree.each_triangle([&](std::uint32_t primitive, const std::array<Double3, 3>& corners) {
    for (std::size_t k = 0; k < 3; ++k)
      if (corners[k] != mesh.vertices[mesh.triangles[primitive][k]]) fail("a corner is another");
    if (same_bytes(corners[0], corners[1]) || same_bytes(corners[1], corners[2])) fail("corners are equal");
  });
  std::vector<Location> locations(rays.size());
  const VertexViewD origins(rays.data(), rays.size(), sizeof(RayD));
  const Rounding rounding(flush);
  tree.locate(
      origins, locations,
      {.rule = bytes.pick({InsideRule::parity, InsideRule::vote, InsideRule::winding}), .path = path});
  // Results that depend on subnormal numbers may differ then: only faults are looked for.
  if (flush) {
    tree.all_hits(rays, {.facing = facing, .path = path, .skip = skip});
    tree.crossings(rays, {.path = path});
    std::vector<HitD> passages(rays.size());
    tree.closest_crossing(rays, passages, {.path = path, .facing = facing, .skip = skip});
    std::vector<double> numbers(rays.size());
    tree.winding_numbers(origins, numbers, {.path = path});
    std::vector<double> distances(rays.size());
    tree.signed_distances(origins, distances, {.path = path});
    return 0;
  }
  expect_hits(tree, rays, hits, {.path = path, .facing = facing, .skip = skip});
  expect_passages(tree, mesh, rays, TraceOptionsD{.path = path, .facing = facing, .skip = skip});
  const bool flies = bytes.chance(48);
  if (flies) let_rays_fly(tree);
  const bool streams = bytes.chance(12) && mesh.triangles.size() < 20;  // integers take their time
  if (!skips && !rays.empty() && (streams || share_origin || flies))
    expect_hits_of_many(tree, rays, streams ? 4100 : 80, hits, {.path = path, .facing = facing});
  const RayLists<CrossingD> lists = tree.crossings(rays, {.path = path});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!std::ranges::equal(lists[i], crossings[i]))
      fail(std::string(path->name) + ": ray " + std::to_string(i) + ": crossings differ");
    const bool is_finite = std::ranges::all_of(rays[i].origin, [](double x) { return std::isfinite(x); });
    if ((locations[i] == Location::on) != (is_finite && is_on(mesh, rays[i].origin)))
      fail(std::string(path->name) + ": point " + std::to_string(i) + ": on is wrong");
  }
  const auto most = static_cast<std::uint32_t>(bytes.below(5));
  expect_few_hits(tree, rays, hits, {.max_count = most, .facing = facing, .path = path, .skip = skip});
  expect_row(bytes, mesh, tree, path);
  expect_windings(mesh, tree, origins, bytes.pick({0.0, 1e-6, 0.1}), path);
  if (bytes.chance(40)) expect_closest_points(mesh, tree, origins, locations, path);
  return 0;
}
