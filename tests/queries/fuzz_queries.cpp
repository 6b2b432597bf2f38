// Questions beyond the nearest hit, of rays and points of any bits to trees over meshes of any finite ones, on any
// path: lists, counts and next hits with the bytes of rational numbers, locations, nothing written
// elsewhere.
#include <algorithm>

#include <raylanes/kdtree.hpp>

#include "../fuzz/any_filters.hpp"
#include "../fuzz/any_mesh.hpp"
#include "../fuzz/query_checks.hpp"

namespace raylanes::testing {
namespace {

// A point in a line of many has the place that it has beside its neighbour alone, which is found in another way.
template <class Tree>
void expect_places_of_lines(const Tree& tree, const std::vector<Ray>& rays,
                            std::span<const Location> locations, const LocateOptions& options) {
  for (std::size_t i = 1; i < rays.size(); ++i) {
    const Float3 &before = rays[i - 1].origin, &point = rays[i].origin;
    int equal = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) equal += before[axis] == point[axis] ? 1 : 0;
    if (equal < 2) continue;
    Location pair[2];
    tree.locate(VertexView(&rays[i - 1], 2, sizeof(Ray)), pair, options);
    if (pair[1] != locations[i]) fail("a point in a line has another place than beside its neighbour");
  }
}

template <class Tree>
void expect_locations(const Tree& tree, const Mesh& mesh, const std::vector<Ray>& rays,
                      const LocateOptions& options, bool is_exact) {
  static Fence fence(max_queries * sizeof(Location));
  const std::span<Location> locations(fence.last<Location>(rays.size()), rays.size());
  tree.locate(VertexView(rays.data(), rays.size(), sizeof(Ray)), locations, options);
  fence.expect_intact("locations");
  expect_places_of_lines(tree, rays, locations, options);
  static Fence distance_fence(max_queries * sizeof(float));
  const std::span<float> distances(distance_fence.last<float>(rays.size()), rays.size());
  tree.signed_distances(VertexView(rays.data(), rays.size(), sizeof(Ray)), distances,
                        {.rule = options.rule, .path = options.path, .threads = options.threads});
  distance_fence.expect_intact("signed distances");
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Float3& point = rays[i].origin;
    if (locations[i] > Location::on) fail("no location");
    const Location side = distances[i] == 0  ? Location::on
                          : distances[i] < 0 ? Location::inside
                                             : Location::outside;
    if (side != locations[i]) fail("a signed distance of another sign than its location");
    // Meshes of any bits are not closed: inside depends on the direction, which is not known here.
    const bool on = is_exact && is_finite(point) && is_on(mesh, point);
    if (is_exact && on != (locations[i] == Location::on))
      fail(std::string(options.path->name) + ": point " + std::to_string(i) + ": on is wrong");
  }
}

// A vertex, the middle of two, or a point in the plane of three: of triangles, of chords between corners of a boundary,
// and of caps.
Float3 at_or_between(Bytes& bytes, const std::vector<Float3>& vertices) {
  const Float3 &a = bytes.pick(vertices), &b = bytes.chance(64) ? a : bytes.pick(vertices);
  const Float3& c = bytes.chance(128) ? b : bytes.pick(vertices);
  Float3 point;
  for (std::size_t axis = 0; axis < 3; ++axis)
    point[axis] = 0.5f * a[axis] + (0.25f * b[axis] + 0.25f * c[axis]);
  return point;
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_queries(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes;
  using namespace raylanes::testing;
  Bytes bytes(data, size);
  Mesh mesh = any_mesh(bytes);
  const Placement placement(bytes);
  const Path* const path = bytes.pick(fuzzed_paths());
  const bool flush = bytes.chance(64), is_bvh = bytes.chance(128);
  const auto builder = static_cast<TreeBuilder>(bytes.below(tree_builder_names.size()));
  const auto kd_builder = static_cast<KdBuilder>(bytes.below(kd_builder_names.size()));
  const std::uint32_t most = bytes.chance(128) ? ~0u : static_cast<std::uint32_t>(bytes.below(70));
  const int threads = bytes.chance(32) ? 2 : 1;
  const Facing facing = bytes.chance(128) ? Facing::any : bytes.chance(128) ? Facing::front : Facing::back;
  const double accuracy = bytes.chance(128) ? 1e-6 : bytes.chance(128) ? 0.1 : 0.0;
  const auto rule = static_cast<InsideRule>(bytes.below(inside_rule_names.size()));
  // Rational numbers take long.
  const std::size_t n = mesh.triangles.size() > 100 ? bytes.below(3) : bytes.below(max_queries + 1);
  Coordinates coordinates(bytes);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < n; ++i) {
    rays.push_back(any_ray(bytes, coordinates, mesh));
    if (bytes.chance(64) && !mesh.vertices.empty()) rays[i].origin = at_or_between(bytes, mesh.vertices);
    placement.move(rays[i]);
    // On a line along an axis with the one before.
    if (i > 0 && bytes.chance(128)) {
      const std::size_t axis = bytes.below(3);
      const float x = bytes.chance(64) ? finite(rays[bytes.below(i)].origin[axis]) : rays[i].origin[axis];
      rays[i].origin = rays[i - 1].origin;
      rays[i].origin[axis] = x;
    }
  }
  for (Float3& vertex : mesh.vertices) {
    placement.move(vertex);
    for (float& x : vertex) x = finite(x);
  }
  ExpectedLists<float> expected;
  const bool skips = bytes.chance(96);
  std::vector<std::uint32_t> skip;
  for (const Ray& ray : rays) {
    std::uint32_t skipped = no_primitive;
    if (skips && bytes.chance(160)) {
      const std::vector<Hit> all = oracle_hits(mesh, ray);
      skipped = all.empty() ? static_cast<std::uint32_t>(bytes.below(1000)) : bytes.pick(all).primitive;
    }
    if (skips) skip.push_back(skipped);
    expected.hits.push_back(oracle_hits(mesh, ray, facing, skipped));
    expected.crossings.push_back(oracle_crossings(mesh, ray));
    std::erase_if(expected.crossings.back(), [&](const Crossing& crossing) {
      return crossing.primitive == skipped ||
             (facing != Facing::any && crossing.side != (facing == Facing::front ? -1 : 1));
    });
  }
  std::vector<std::uint32_t> names;
  for (std::size_t i = 0; i < n; ++i)
    names.push_back(static_cast<std::uint32_t>(bytes.below(mesh.triangles.size() + 2)) - 1);
  const Rounding rounding(flush);
  const auto ask = [&](const auto& tree) {
    expect_corners(tree, mesh, names);
    run_out_of_memory(bytes, tree, rays, rule);
    expect_active_alone(tree, rays, path, rule);
    expect_locations(tree, mesh, rays, {.rule = rule, .path = path, .threads = threads}, !flush);
    expect_windings(tree, mesh, rays, {.accuracy = accuracy, .path = path, .threads = threads}, !flush);
    if (!flush) {
      expect_lists(tree, rays, expected,
                   {.max_count = most, .facing = facing, .path = path, .threads = threads, .skip = skip});
      expect_passages(tree, mesh, rays,
                      TraceOptions{.path = path, .threads = threads, .facing = facing, .skip = skip});
      expect_kept(tree, rays, expected.hits, TraceOptions{.path = path, .facing = facing, .skip = skip});
      return expect_next_hits(tree, rays, expected, path, facing, skip);
    }
    std::vector<Hit> passages(n);
    tree.closest_crossing(rays, passages, {.path = path, .facing = facing, .skip = skip});
    // Results that depend on subnormal numbers may differ then: only faults and the order of lists are checked.
    const RayLists<Hit> hits =
        tree.all_hits(rays, {.max_count = most, .facing = facing, .path = path, .skip = skip});
    const RayLists<Crossing> crossings = tree.crossings(rays, {.max_count = most, .path = path});
    for (std::size_t i = 0; i < n; ++i)
      if (!std::ranges::is_sorted(hits[i], {}, &Hit::t) ||
          !std::ranges::is_sorted(crossings[i], {}, &Crossing::t))
        fail("a list is not in order");
  };
  if (!is_bvh) {
    ask(KdTree(mesh, {.builder = kd_builder}));
    return 0;
  }
  // Now and then of triangles of other vertices, of which some collapse or come back at a refit.
  const bool refits = bytes.chance(64);
  Mesh before = mesh;
  for (std::uint32_t i = 0; refits && i < before.triangles.size(); ++i)
    before.triangles[i] = {i, i + 1, i + 2};
  Bvh tree(before, {.builder = builder});
  if (refits) tree.refit(mesh.vertices, mesh.triangles);
  ask(tree);
  return 0;
}
