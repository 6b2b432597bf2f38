// Rays of doubles of any bits to trees over meshes of any finite ones, on any path: hits, occlusion, lists, crossings,
// next hits and rows of points with the bytes of rational numbers, closest points within their bound, nothing written
// elsewhere.
#include "../../bench/support/oracles/exact_point.hpp"
#include "../fuzz/any_doubles.hpp"
#include "../fuzz/any_queries.hpp"
#include "../traverse/reference/in_flight.hpp"

namespace raylanes::testing {
using namespace oracle;

namespace {

constexpr std::size_t max_double_rays = 12;

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
    const bool is_inside = is_in_box && exact_crossings(mesh, ray).size() % 2 != 0;
    const Location expected = is_on(mesh, row[i]) ? Location::on
                              : is_inside         ? Location::inside
                                                  : Location::outside;
    if (locations[i] != expected)
      fail(std::string(path->name) + ": point " + std::to_string(i) + " of a row is wrong");
  }
}

// Points of any bits, in batches and alone, by rational numbers.
void expect_closest_points(const DoubleMesh& mesh, const BvhD& tree, const VertexViewD& points,
                           const Path* path) {
  static Fence fence(max_double_rays * sizeof(ClosestPointD));
  const std::span<ClosestPointD> closest(fence.last<ClosestPointD>(points.count), points.count);
  tree.closest_points(points, closest, {.path = path});
  fence.expect_intact("closest points");
  for (std::size_t i = 0; i < points.count; ++i) {
    const std::string point = std::string(path->name) + ": point " + std::to_string(i) + ": ";
    const Double3 p = points[i];
    if (!same_bytes(closest[i], tree.closest_point(p, {.path = path}))) fail(point + "alone it is another");
    if (closest[i] && !is_finite(p)) fail(point + "it is no number");
    if (!is_finite(p)) continue;
    const std::string fault = fault_of_closest_point(mesh, p, closest[i]);
    if (!fault.empty()) fail(point + fault);
  }
}

// The same rays again and again, in turns or each in a row, so many that they are traced together: as streams, or as
// packets if they share an origin.
void expect_hits_of_many(const BvhD& tree, const std::vector<RayD>& rays, std::size_t times, bool in_turns,
                         const AnyQueries<double>& queries) {
  const std::size_t count = rays.size() * times;
  const auto place = [&](std::size_t i) { return in_turns ? i % rays.size() : i / times; };
  std::vector<RayD> many;
  std::vector<std::uint32_t> skips;
  for (std::size_t i = 0; i < count; ++i) {
    many.push_back(rays[place(i)]);
    if (!queries.skip.empty()) skips.push_back(queries.skip[place(i)]);
  }
  const TraceOptionsD options{.path = queries.path,
                              .facing = queries.facing,
                              .skip = skips,
                              .mask = queries.mask,
                              .masks = queries.masks};
  std::vector<HitD> hits(count);
  std::vector<std::uint8_t> occluded(count);
  tree.closest(many, hits, options), tree.occluded(many, occluded, options);
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<HitD>& of_ray = queries.expected.hits[place(i)];
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
  std::vector<RayD> rays;
  for (std::size_t n = bytes.below(max_double_rays); rays.size() < n;)
    rays.push_back(any_double_ray(bytes, coordinates, mesh));
  const bool share_origin = bytes.chance(64);
  if (share_origin)
    for (RayD& ray : rays) ray.origin = rays[0].origin;
  const AnyQueries<double> queries(bytes, mesh, rays);
  const auto tree =
      any_refitted<BvhD>(bytes, mesh, bytes.chance(128) ? TreeBuilder::binned_sah : TreeBuilder::morton);
  tree.each_triangle([&](std::uint32_t primitive, const std::array<Double3, 3>& corners) {
    for (std::size_t k = 0; k < 3; ++k)
      if (corners[k] != mesh.vertices[mesh.triangles[primitive][k]]) fail("a corner is another");
    if (same_bytes(corners[0], corners[1]) || same_bytes(corners[1], corners[2])) fail("corners are equal");
  });
  const bool flush = bytes.chance(48);
  const Rounding rounding(flush);
  queries.ask(tree, flush);
  if (flush) return 0;
  const bool flies = bytes.chance(48);
  if (flies) let_rays_fly(tree);
  const bool streams = bytes.chance(12) && mesh.triangles.size() < 20;  // integers take their time
  const bool in_turns = bytes.chance(128);
  if (!rays.empty() && (streams || share_origin || flies || !in_turns))
    expect_hits_of_many(tree, rays, (streams ? 4100 : 80) / rays.size() + 1, in_turns, queries);
  expect_row(bytes, mesh, tree, queries.path);
  if (bytes.chance(40))
    expect_closest_points(mesh, tree, VertexViewD(rays.data(), rays.size(), sizeof(RayD)), queries.path);
  return 0;
}
