// Rays of any bits through a tree of either kind over a mesh of any finite ones, by any builder and on any path. They
// are traced in any mode, test and grade, counted or not, with and without FTZ and DAZ. There is no fault, nothing
// outside the outputs, and hits say what hits may say. The exact test has the bytes of exact arithmetic, the watertight
// one of the reproducible grade the bytes of a brute force, each but for what its Truth leaves out.
#include <raylanes/kdtree.hpp>

#include "../../../dispatch/table/kernel_table.hpp"
#include "../../queries/query_oracle.hpp"
#include "../../support/random_input.hpp"
#include "../../support/same_bytes.hpp"
#include "../../support/soa.hpp"
#include "../../traverse/reference/in_flight.hpp"
#include "../../traverse/reference/reference_tracer.hpp"
#include "../../traverse/reference/segment_to.hpp"
#include "../any_masks.hpp"
#include "../any_mesh.hpp"
#include "../fence.hpp"
#include "../strided.hpp"
#include "../support.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t usual_rays = 80,
                      max_rays = 4096;  // more than streams, packets and coherent packets want

void end_at(const Float3& point, Ray& ray) {
  for (std::size_t axis = 0; axis < 3; ++axis) ray.direction[axis] = point[axis] - ray.origin[axis];
  ray.tmin = 0, ray.tmax = 1;
}

bool is_moderate(const float* x, std::size_t n) {
  return std::all_of(x, x + n,
                     [](float a) { return a == 0 || (std::fabs(a) >= 0x1p-40f && std::fabs(a) <= 0x1p40f); });
}

// The largest distance along an axis between the origin and a vertex.
float reach(const Ray& ray, const Mesh& mesh) {
  float largest = 0;
  for (const Float3& vertex : mesh.vertices)
    for (std::size_t axis = 0; axis < 3; ++axis)
      largest = std::max(largest, std::fabs(vertex[axis] - ray.origin[axis]));
  return largest;
}

// Whether the point of the hit is in the triangle's own box, but for 20u of the reach: what the traversal's
// padding is derived from.
bool is_in_own_box(const Ray& ray, float t, const Triangle& triangle, float reach) {
  bool inside = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = ray.origin[axis] + double(t) * ray.direction[axis], slack = 20 * 0x1p-24 * double(reach);
    const auto [lo, hi] =
        std::minmax({triangle.corner[0][axis], triangle.corner[1][axis], triangle.corner[2][axis]});
    inside = inside && x >= lo - slack && x <= hi + slack;
  }
  return inside;
}

// The brute-force hit of the ray for the watertight test; `comparable`: whether the traversal must say the same.
// Left out are
//   numbers other than 0 and 2^-40 … 2^40 in size: reciprocals and differences of bounds may overflow or
//   underflow, and TriangleTree::closest() promises independence of the tree for none such;
//   rays for which the canonical test reports a triangle at a point outside that triangle's own box: rays
//   nearly in its plane, whose t is rounding error. In trees with parts of triangles all rays are left out, because
//   such a point may be in the triangle's box and in that of no part.
struct Truth {
  Hit hit{infinity, 0, 0, no_primitive};
  bool comparable = false;
};
Truth canonical_truth(const Ray& ray, const Mesh& mesh) {
  Truth truth;
  truth.comparable = is_moderate(ray.origin.data(), 3) && is_moderate(ray.direction.data(), 3);
  if (!truth.comparable) return truth;
  const float largest = reach(ray, mesh);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle triangle = triangle_of(mesh.vertices, mesh.triangles[i]);
    Hit hit = canonical_hit(ray, triangle);
    if (hit.primitive != 0) continue;
    truth.comparable = truth.comparable && is_in_own_box(ray, hit.t, triangle, largest);
    hit.primitive = i;
    if (truth.hit.primitive == no_primitive || hit.t < truth.hit.t) truth.hit = hit;
  }
  return truth;
}

bool is_subnormal(float x) {
  return std::fpclassify(x) == FP_SUBNORMAL;
}
// Whether a number lies below the normal numbers, though it may round to the first of them: flushed before it does.
bool may_be_flushed(float x) {
  return x != 0 && std::fabs(x) <= 0x1p-126f;
}

// The hit of the ray by exact arithmetic. Left out, with FTZ and DAZ, is what depends on a subnormal: an end of the
// segment, a direction of nothing else, a t, u or v; a t of zero may be equalled by one.
Truth exact_truth(const Ray& ray, const Mesh& mesh, bool flush, Facing facing, std::uint32_t skipped) {
  Truth truth;
  truth.hit = nearest_of_chosen(mesh, ray, facing, skipped);
  truth.comparable = true;
  if (!flush) return truth;
  for (const float x : {ray.tmin, ray.tmax}) truth.comparable = truth.comparable && !is_subnormal(x);
  for (const float x : {truth.hit.u, truth.hit.v}) truth.comparable = truth.comparable && !may_be_flushed(x);
  truth.comparable = truth.comparable && truth.hit.t != 0 && !may_be_flushed(truth.hit.t);
  const bool has_length = std::any_of(ray.direction.begin(), ray.direction.end(),
                                      [](float x) { return x != 0 && !is_subnormal(x); });
  truth.comparable = truth.comparable && has_length;
  return truth;
}

std::string words(const Hit& hit) {
  char numbers[96];
  std::snprintf(numbers, sizeof numbers, "%a, u %a, v %a", static_cast<double>(hit.t),
                static_cast<double>(hit.u), static_cast<double>(hit.v));
  return "primitive " + std::to_string(hit.primitive) + " at " + numbers;
}

void expect_possible(const Ray& ray, const Hit& hit, std::uint8_t occluded, std::size_t triangles) {
  if (occluded > 1) fail("occluded is " + std::to_string(occluded));
  if (hit.primitive == no_primitive) {
    if (!(hit.t == infinity && hit.u == 0 && hit.v == 0)) fail("a miss says " + words(hit));
  } else if (hit.primitive >= triangles || !(hit.t >= ray.tmin && hit.t <= ray.tmax)) {
    fail("a hit says " + words(hit) + ", of a segment from " + std::to_string(ray.tmin) + " to " +
         std::to_string(ray.tmax));
  }
}

// From the first ray's origin to the origins of all, and in its direction: as single rays from these points, with the
// exact test.
void expect_segments(const TriangleTree& tree, std::span<const Ray> rays, const SegmentEnds& ends,
                     TraceOptions options) {
  static Fence fence(max_rays);
  const std::span<std::uint8_t> occluded(fence.last<std::uint8_t>(rays.size()), rays.size());
  const Float3 from = rays[0].origin;
  TraceOptions turned = options;  // sides are those that the shared end sees
  if (options.facing != Facing::any)
    turned.facing = options.facing == Facing::front ? Facing::back : Facing::front;
  tree.occluded_from(from, VertexView(rays.data(), rays.size(), sizeof(Ray)), occluded, ends, options);
  fence.expect_intact("occluded segments");
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Float3 to = rays[i].origin;
    Ray ray = segment_to<float>(from, to, ends);
    if (!std::ranges::all_of(ray.direction, [](float x) { return std::isfinite(x); })) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        ray.direction[axis] = static_cast<float>(0.5 * (double{from[axis]} - double{to[axis]}));
      ray.tmin *= 2, ray.tmax *= 2;
    }
    if (occluded[i] > 1 ||
        (options.test == TriangleTest::exact && (occluded[i] != 0) != tree.occluded(ray, turned)))
      fail("segment " + std::to_string(i) + ": occluded is " + std::to_string(occluded[i]));
  }
  const Float3 direction = rays[0].direction;
  tree.occluded_towards(direction, VertexView(rays.data(), rays.size(), sizeof(Ray)), occluded, options);
  fence.expect_intact("occluded in a direction");
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (occluded[i] > 1 ||
        (options.test == TriangleTest::exact &&
         (occluded[i] != 0) != tree.occluded(make_ray(rays[i].origin, direction), options)))
      fail("point " + std::to_string(i) + ": occluded is " + std::to_string(occluded[i]));
}

// With origins near that of the first one: their closest points are looked for together.
std::vector<Ray> crowded(std::vector<Ray> rays) {
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      rays[i].origin[axis] =
          rays[0].origin[axis] * (1.0f + 0x1p-16f * static_cast<float>(i * (axis + 1) % 37));
  return rays;
}

// From the origins of rays, whatever their bits: what all triangles one by one give on the first path.
void expect_closest_points(const TriangleTree& tree, const Mesh& mesh, std::span<const Ray> rays, float most,
                           const TraceOptions& options) {
  static Fence fence(max_rays * sizeof(ClosestPoint));
  const std::span<ClosestPoint> closest(fence.last<ClosestPoint>(rays.size()), rays.size());
  tree.closest_points(VertexView(rays.data(), rays.size(), sizeof(Ray)), closest,
                      {.max_distance = most, .path = options.path, .threads = options.threads});
  fence.expect_intact("closest points");
  std::vector<Triangle> triangles;
  for (const Index3& t : mesh.triangles) triangles.push_back(triangle_of(mesh.vertices, t));
  const TriangleColumns columns(triangles);
  const std::size_t step = 1 + rays.size() * (1 + triangles.size() / 100) / usual_rays;
  for (std::size_t i = 0; i < rays.size(); i += step)
    for (const Path* path : {&paths().front(), options.path}) {
      const ClosestPoint expected =
          closest_point(rays[i].origin, columns.arrays(), {.max_distance = most, .path = path});
      const ClosestPoint called = tree.closest_point(rays[i].origin, {.max_distance = most});
      for (const ClosestPoint& found : {closest[i], called})
        if (!same_bytes(expected, found))
          fail(std::string(path->name) + ": the closest point to " + std::to_string(i) + " is of " +
               std::to_string(found.primitive) + ", one by one of " + std::to_string(expected.primitive));
    }
}

// With a mask and on threads: answers of active rays are those without, the others are left alone.
void expect_masked(const TriangleTree& tree, Bytes& bytes, std::span<const Ray> rays, TraceOptions options,
                   bool agrees) {
  static Fence hit_fence(max_rays * sizeof(Hit)), flag_fence(max_rays), mask_fence((max_rays + 7) / 8);
  const std::size_t n = rays.size();
  const std::span<Hit> hits(hit_fence.last<Hit>(n), n);
  const std::span<std::uint8_t> flags(flag_fence.last<std::uint8_t>(n), n);
  auto* const mask = mask_fence.last<std::uint8_t>((n + 7) / 8);
  for (std::size_t i = 0; i < (n + 7) / 8; ++i) mask[i] = bytes.byte();
  std::vector<Hit> expected_hits(n);
  std::vector<std::uint8_t> expected_flags(n);
  options.counters = nullptr;
  tree.closest(rays, expected_hits, options), tree.occluded(rays, expected_flags, options);
  constexpr Hit untouched{-1, -2, -3, 4};
  constexpr std::uint8_t unset = 0x5a;
  std::fill(hits.begin(), hits.end(), untouched), std::fill(flags.begin(), flags.end(), unset);
  options.active = mask, options.threads = bytes.chance(64) ? 2 : 1;
  tree.closest(rays, hits, options), tree.occluded(rays, flags, options);
  hit_fence.expect_intact("masked hits"), flag_fence.expect_intact("masked occlusion");
  for (std::size_t i = 0; i < n; ++i) {
    const bool is_active = (mask[i / 8] >> i % 8 & 1) != 0;
    const Hit& hit = is_active ? expected_hits[i] : untouched;
    const std::uint8_t flag = is_active ? expected_flags[i] : unset;
    if ((agrees || !is_active) && (!same_bytes(hits[i], hit) || flags[i] != flag))
      fail("ray " + std::to_string(i) +
           (is_active ? " is another with a mask" : " is masked and was written"));
  }
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_trace(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes;
  using namespace raylanes::testing;
  static Strided<Ray, max_rays> ray_view;
  static Strided<Hit, max_rays> hit_view;
  static Fence occluded_fence(max_rays);
  Bytes bytes(data, size);
  Mesh mesh = any_mesh(bytes);
  const Placement placement(bytes);
  TraceOptions options{.test = any_tree_test(bytes),
                       .grade = static_cast<Grade>(bytes.below(grade_names.size())),
                       .mode = static_cast<TraversalMode>(bytes.below(traversal_mode_names.size())),
                       .hint = static_cast<BatchHint>(bytes.below(batch_hint_names.size())),
                       .path = bytes.pick(fuzzed_paths())};
  if (options.test == TriangleTest::exact && bytes.chance(96))
    options.facing = bytes.chance(128) ? Facing::front : Facing::back;
  const bool flush = bytes.chance(96);
  const auto builder = static_cast<TreeBuilder>(bytes.below(tree_builder_names.size()));
  const int threads = bytes.chance(32) ? 2 : 1;
  const bool is_bvh = bytes.chance(160);
  const auto kd_builder = static_cast<KdBuilder>(bytes.below(kd_builder_names.size()));
  const bool optimize = bytes.chance(64), choose = bytes.chance(32);
  const double rays_to_come = choose ? bytes.number<double>() : 0.0;
  TraceCounters counters;
  if (options.grade == Grade::reproducible && bytes.chance(64) && kernels_of(*options.path).has_counters() &&
      (options.mode == TraversalMode::single || options.test == TriangleTest::exact))
    options.counters = &counters;
  const bool many = bytes.chance(16);
  const std::size_t n = many                          ? bytes.below(max_rays + 1)
                        : mesh.triangles.size() > 100 ? bytes.below(8)
                                                      : bytes.below(usual_rays + 1);
  ray_view.take(n, bytes.chance(128) ? 0 : bytes.below(max_gap + 1));
  hit_view.take(n, bytes.chance(128) ? 0 : bytes.below(max_gap + 1));
  std::vector<Ray> rays(n);
  const std::span<std::uint8_t> occluded(occluded_fence.last<std::uint8_t>(n), n);
  Coordinates coordinates(bytes);
  const bool share_origin = bytes.chance(64), share_end = bytes.chance(64);
  const bool share_octant = bytes.chance(96);  // few of them are traced as columns
  const Ray to_end = any_ray(bytes, coordinates, mesh);
  for (std::size_t i = 0; i < n; ++i) {
    rays[i] = i > 0 && bytes.chance(64) ? rays[i - 1] : any_ray(bytes, coordinates, mesh);
    if (share_origin && !bytes.chance(16)) rays[i].origin = rays[0].origin;
    if (share_end && !bytes.chance(8)) end_at(to_end.origin, rays[i]);
    for (std::size_t axis = 0; axis < 3 && share_octant; ++axis)
      rays[i].direction[axis] = std::copysign(rays[i].direction[axis], rays[0].direction[axis]);
  }
  for (Ray& ray : rays) placement.move(ray);
  ray_view.put(rays);
  for (Float3& vertex : mesh.vertices) {
    placement.move(vertex);
    for (float& x : vertex) x = finite(x);
  }
  std::vector<std::uint32_t> skip;
  if (options.test == TriangleTest::exact && bytes.chance(64))
    for (std::size_t i = 0; i < n; ++i)
      skip.push_back(bytes.chance(32) ? no_primitive
                                      : static_cast<std::uint32_t>(bytes.below(mesh.triangles.size() + 1)));
  const std::span<const std::uint32_t> masks = options.test == TriangleTest::exact
                                                   ? any_masks(bytes, mesh.triangles.size())
                                                   : std::span<const std::uint32_t>();
  const auto mask = static_cast<std::uint32_t>(bytes.below(8));
  std::vector<Hit> hits, single(n);
  {
    const Rounding rounding(flush);
    const auto trace = [&](auto tree) {
      if constexpr (std::is_same_v<decltype(tree), Bvh>) bytes.chance(128) ? let_rays_fly(tree) : void();
      const RayView view(ray_view.first, n, ray_view.stride);
      TraceOptions chosen = options;
      chosen.skip = skip, chosen.mask = mask, chosen.masks = masks;
      tree.closest(view, HitView(hit_view.first, n, hit_view.stride), chosen);
      tree.occluded(view, occluded, chosen);
      if (n > 0) expect_segments(tree, rays, {coordinates(), coordinates()}, options);
      if (n > 0 && bytes.chance(96))
        expect_masked(tree, bytes, rays, options, !flush && options.test == TriangleTest::exact);
      expect_closest_points(tree, mesh, bytes.chance(96) ? crowded(rays) : rays,
                            bytes.chance(128) ? infinity : coordinates(), options);
      TraceOptions one_by_one = chosen;
      one_by_one.mode = TraversalMode::single;
      tree.closest(RayColumns(rays).arrays(), single, one_by_one);
      const auto other = std::move(tree);
      if (n > 0 && (tree.closest(rays[0], options) || tree.occluded(rays[0], options)))
        fail("a moved-from tree has hits");
      if (n > 0 && tree.closest_point(rays[0].origin)) fail("a moved-from tree has closest points");
    };
    if (is_bvh)
      trace(Bvh(mesh, {.builder = builder,
                       .threads = threads,
                       .optimize = optimize,
                       .choose = choose,
                       .rays = rays_to_come}));
    else
      trace(KdTree(mesh, {.builder = kd_builder, .threads = threads}));
  }
  ray_view.expect_intact("rays");
  hit_view.expect_intact("hits");
  hits = hit_view.get();
  occluded_fence.expect_intact("occluded");

  const bool is_exact = options.test == TriangleTest::exact;
  const auto seen = seen_by(mesh, masks, mask);
  // Rational numbers take long: of many rays they judge some.
  const std::size_t compared_apart = many ? 1 + n * (1 + mesh.triangles.size() / 100) / usual_rays : 1;
  const bool promised =
      is_exact ||
      (options.test == TriangleTest::watertight && options.grade == Grade::reproducible && !flush &&
       (is_bvh ? builder != TreeBuilder::spatial_splits : kd_builder != KdBuilder::sah) &&
       is_moderate(mesh.vertices.empty() ? nullptr : mesh.vertices[0].data(), 3 * mesh.vertices.size()));
  for (std::size_t i = 0; i < n; ++i) {
    {
      const Rounding rounding(flush);  // a subnormal tmin counts as zero then
      expect_possible(rays[i], hits[i], occluded[i], mesh.triangles.size());
    }
    if (is_exact && !flush && (!same_bytes(single[i], hits[i]) || occluded[i] != (single[i] ? 1 : 0)))
      fail(std::string(options.path->name) + ": ray " + std::to_string(i) + " of " + std::to_string(n) +
           ": " + words(hits[i]) + ", alone " + words(single[i]) + ", occluded " +
           std::to_string(occluded[i]));
    if (!promised || i % compared_apart != 0) continue;
    const Truth truth =
        is_exact ? exact_truth(rays[i], seen, flush, options.facing, skip.empty() ? no_primitive : skip[i])
                 : canonical_truth(rays[i], mesh);
    if (!truth.comparable) continue;
    if (!same_bytes(truth.hit, hits[i]))
      fail(std::string(options.path->name) + ' ' + std::string(is_exact ? "exact " : "watertight ") +
           (flush ? "FTZ " : "") +
           std::string(is_bvh ? tree_builder_names[static_cast<std::size_t>(builder)]
                              : kd_builder_names[static_cast<std::size_t>(kd_builder)]) +
           ' ' + std::string(traversal_mode_names[static_cast<std::size_t>(options.mode)]) + ": ray " +
           std::to_string(i) + ": " + words(hits[i]) + ", by brute force " + words(truth.hit));
    if (occluded[i] != (truth.hit.primitive == no_primitive ? 0 : 1))
      fail(std::string(options.path->name) + ": ray " + std::to_string(i) + ": occluded is wrong");
  }
  return 0;
}
