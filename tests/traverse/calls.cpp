// One ray a call: the bytes of a batch of single rays on the scalar path, whatever the tree went through.
#include <raylanes/bvh.hpp>
#include <raylanes/kdtree.hpp>

#include "../../bench/support/scenes/vector3.hpp"
#include "../support/message_of.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "reference/in_flight.hpp"
#include "reference/traced.hpp"

namespace raylanes::testing {
namespace {

// Makes a path the active one while it lives.
class ForcedPath {
 public:
  explicit ForcedPath(const Path& path) { force_path(path.name); }
  ForcedPath(const ForcedPath&) = delete;
  ForcedPath& operator=(const ForcedPath&) = delete;
  ~ForcedPath() { unforce_path(); }
};

// Rays of usual numbers, and those with zeros, ends and sizes that are not.
std::vector<Ray> all_kinds_of_rays(const Mesh& mesh) {
  std::vector<Ray> rays =
      mixed_rays(mesh, static_cast<std::size_t>(by_level(200, 1000, 4000)), 2, {0, 0, 0}, 71);
  const std::size_t usual = rays.size();
  Random random(72);
  const float ends[] = {-0.0f, 0.0f, -1.0f, 0.25f, 1e-40f, infinity, -infinity, nan};
  const float sizes[] = {0.0f, -0.0f, 1e-20f, -1e-20f, 1e-40f, 1e20f, -infinity, nan};
  for (std::size_t i = 0; i < usual; ++i) {
    Ray ray = rays[i];
    switch (random.integer(0, 4)) {
      case 0:
        ray.tmin = ends[random.integer(0, 7)];
        break;
      case 1:
        ray.tmax = ends[random.integer(0, 7)];
        break;
      case 2:
        ray.direction[random.index(3)] = sizes[random.integer(0, 7)];
        break;
      case 3:
        ray.direction = {0, 0, 0};
        ray.direction[random.index(3)] = random.chance(0.5) ? 1.0f : -1.0f;
        for (float& x : ray.direction) x = x == 0.0f && random.chance(0.5) ? -0.0f : x;
        break;
      default:
        for (float& x : ray.direction) x *= random.magnitude(1e-30, 1e30);
        ray.tmin = -0.0f;
    }
    rays.push_back(ray);
  }
  return rays;
}

std::vector<TraceOptions> options_of_calls() {
  std::vector<TraceOptions> all;
  for (const TriangleTest test :
       {TriangleTest::exact, TriangleTest::watertight, TriangleTest::moller_trumbore})
    for (const Grade grade : {Grade::reproducible, Grade::fast})
      all.push_back({.test = test, .grade = grade});
  for (const Facing facing : {Facing::front, Facing::back}) all.push_back({.facing = facing});
  return all;
}

// The primitive that each ray hits, or none for each third one.
std::vector<std::uint32_t> most_primitives(const std::vector<Hit>& hits) {
  std::vector<std::uint32_t> primitives;
  for (std::size_t i = 0; i < hits.size(); ++i)
    primitives.push_back(i % 3 == 0 ? no_primitive : hits[i].primitive);
  return primitives;
}

// Adds a failure unless calls on each path have the bytes of a batch, and by the exact test the bytes of the scalar
// path. By the exact test rays are traced again without the primitives that they hit.
void expect_calls_as_batches(const TriangleTree& tree, const std::vector<Ray>& rays) {
  for (const Path* path : supported_paths()) {
    const ForcedPath forced(*path);
    for (const TraceOptions& options : options_of_calls()) {
      const bool is_exact = options.test == TriangleTest::exact;
      TraceOptions batch = options;
      batch.mode = TraversalMode::single, batch.path = is_exact ? &paths().front() : path;
      const std::vector<Hit> hits = trace(tree, rays, batch);
      const std::vector<std::uint8_t> occluded = trace_occluded(tree, rays, batch);
      const std::vector<std::uint32_t> skip = most_primitives(hits);
      if (is_exact) batch.skip = skip;
      const std::vector<Hit> others = trace(tree, rays, batch);
      const std::vector<std::uint8_t> others_occluded = trace_occluded(tree, rays, batch);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto expect_same = [&](const Hit& hit, bool is_occluded, const char* call, const Hit& wanted,
                                     std::uint8_t wanted_occluded) {
          EXPECT_TRUE(same_bytes(hit, wanted)) << call << " of ray " << i << " of " << name_of(batch);
          EXPECT_EQ(is_occluded, wanted_occluded != 0) << call << " of ray " << i << " on " << path->name;
        };
        expect_same(tree.closest(rays[i], options), tree.occluded(rays[i], options), "with options", hits[i],
                    occluded[i]);
        if (is_exact && options.facing == Facing::any)
          expect_same(tree.closest(rays[i]), tree.occluded(rays[i]), "without options", hits[i], occluded[i]);
        TraceOptions chosen = options;
        if (is_exact) chosen.skip = skip[i];
        expect_same(tree.closest(rays[i], chosen), tree.occluded(rays[i], chosen), "with skip", others[i],
                    others_occluded[i]);
        if (::testing::Test::HasFailure()) return;
      }
    }
  }
}

// In a tree whose rays are let fly batches of any length, with and without triangles left out, have the bytes of the
// scalar path.
void expect_flights(Bvh& bvh, const std::vector<Ray>& rays) {
  const TraceOptions scalar{.mode = TraversalMode::single, .path = &paths().front()};
  const std::vector<Hit> hits = trace(bvh, rays, scalar);
  const std::vector<std::uint32_t> skip = most_primitives(hits);
  TraceOptions chosen = scalar;
  chosen.skip = skip;
  const std::vector<Hit> others = trace(bvh, rays, chosen);
  const std::vector<std::uint8_t> occluded = trace_occluded(bvh, rays, scalar),
                                  others_occluded = trace_occluded(bvh, rays, chosen);
  let_rays_fly(bvh);
  for (const Path* path : supported_paths())
    for (const std::size_t n : {std::size_t{31}, std::size_t{32}, std::size_t{57}, rays.size()}) {
      const std::size_t size = std::min(n, rays.size());
      const std::span<const Ray> some(rays.data(), size);
      TraceOptions options{.mode = TraversalMode::single, .path = path};
      EXPECT_TRUE(same_bytes(trace(bvh, some, options), std::span(hits).first(size))) << path->name << n;
      EXPECT_TRUE(same_bytes(trace_occluded(bvh, some, options), std::span(occluded).first(size)))
          << path->name << n;
      options.skip = std::span(skip).first(size);
      EXPECT_TRUE(same_bytes(trace(bvh, some, options), std::span(others).first(size))) << path->name << n;
      EXPECT_TRUE(same_bytes(trace_occluded(bvh, some, options), std::span(others_occluded).first(size)))
          << path->name << n;
    }
}

TEST(Calls, in_flight_have_the_hits_of_scalar_code) {
  const Mesh mesh = triangle_soup(3000, 0.2f, 82), few = triangle_soup(9, 0.5f, 74);
  Bvh bvh(mesh), small(few);
  expect_flights(bvh, all_kinds_of_rays(mesh));
  expect_flights(small, all_kinds_of_rays(few));
  Mesh grid = integer_grid(12);
  Random random(83);
  std::vector<Ray> rays = grid_rays(12, 600, random);
  for (std::size_t i = 0; i < rays.size(); i += 2) rays[i].origin[2] = 0, rays[i].tmin = -0.0f;
  Bvh of_grid(grid);
  expect_flights(of_grid, rays);
}

// Triangles around an axis, each thinner than the one before and longer: a ray along the axis enters the boxes of those
// that are left first, and has many waiting. Boxes are padded by 1e-6 and more: most rays pass
// by the thinnest triangles, and hit those that wait.
TEST(Calls, in_flight_keep_what_waits_in_deep_trees) {
  Mesh mesh;
  for (int i = 0; i < 4000; ++i) {
    const float s = static_cast<float>(std::pow(0.98, i)), z = -0.001f * static_cast<float>(i);
    append(mesh, {s, -s, z}, {-s, s, z}, {-0.9f * s, -0.9f * s, 1});
  }
  Random random(84);
  std::vector<Ray> rays;
  for (int i = 0; i < 300; ++i) {
    const float s = static_cast<float>(random.magnitude(i % 4 == 0 ? 1e-35 : 1e-7, i % 4 == 0 ? 1 : 1e-5));
    rays.push_back(make_ray({random.number(-s, s), random.number(-s, s), -10}, {0, 0, 1}));
  }
  Bvh bvh(mesh, {.builder = TreeBuilder::sweep_sah});
  EXPECT_GE(bvh.report().depth, 20);
  expect_flights(bvh, rays);
}

TEST(Calls, have_the_hits_of_batches) {
  const Mesh mesh = triangle_soup(600, 0.2f, 70);
  const std::vector<Ray> rays = all_kinds_of_rays(mesh);
  std::size_t hits = 0;
  for (const Hit& hit : trace(Bvh(mesh), rays, {})) hits += hit ? 1u : 0u;
  EXPECT_GE(hits, rays.size() / 4);
  expect_calls_as_batches(Bvh(mesh), rays);
  expect_calls_as_batches(KdTree(mesh), rays);
}

TEST(Calls, of_small_trees) {
  const Mesh one = triangle_soup(1, 0.5f, 73), few = triangle_soup(9, 0.5f, 74);
  expect_calls_as_batches(Bvh(one), all_kinds_of_rays(one));
  expect_calls_as_batches(Bvh(few), all_kinds_of_rays(few));
  expect_calls_as_batches(Bvh(Mesh()), all_kinds_of_rays(few));
  expect_calls_as_batches(Bvh(), all_kinds_of_rays(few));
  expect_calls_as_batches(KdTree(), all_kinds_of_rays(few));
}

// Many children at one distance, in doubles of one place: ties, and long lists of children.
TEST(Calls, in_grids) {
  const Mesh mesh = integer_grid(12);
  Random random(75);
  std::vector<Ray> rays = grid_rays(12, static_cast<std::size_t>(by_level(100, 600, 3000)), random);
  for (std::size_t i = 0; i < rays.size(); i += 2) rays[i].origin[2] = 0, rays[i].tmin = -0.0f;
  expect_calls_as_batches(Bvh(mesh), rays);
}

// A tree a thousand times as large as it was built: its boxes and triangles round a thousand times as much.
TEST(Calls, follow_a_tree_that_grows) {
  Mesh mesh = triangle_soup(300, 0.3f, 77);
  Bvh bvh(mesh);
  scale(mesh, 1000);
  bvh.refit(mesh.vertices, mesh.triangles);
  expect_calls_as_batches(bvh, all_kinds_of_rays(mesh));
}

// Rays nearly in the planes of small triangles far away: few bits of t, u and v are right in doubles.
TEST(Calls, beside_planes_have_the_numbers_of_batches) {
  Random random(78);
  Mesh mesh = triangle_soup(200, 0.01f, 79);
  std::vector<Ray> rays;
  for (int i = 0; i < by_level(2000, 6000, 20000); ++i) {
    const Triangle t = triangle_of(mesh.vertices, mesh.triangles[static_cast<std::size_t>(i) % 200]);
    Float3 origin;
    const double away = random.magnitude(1, 1000), along = random.real(-1, 1);
    const float beside = random.number(-1e-3f, 1e-3f);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double to_second = t.corner[1][axis] - t.corner[0][axis],
                   to_third = t.corner[2][axis] - t.corner[0][axis];
      origin[axis] = static_cast<float>(t.corner[0][axis] + away * (to_second + along * to_third)) + beside;
    }
    rays.push_back(ray_to(origin, t, random.real(0, 0.6), random.real(0, 0.4)));
  }
  expect_calls_as_batches(Bvh(mesh), rays);
}

// Rays to corners of triangles that are no slivers and not seen from the side: a tree of one triangle asks no box, and
// boxes around ten equal ones must not lose what the test's roundings let it hit, nor the first of equals.
TEST(Calls, meet_in_boxes_what_rounded_tests_hit) {
  Random random(81);
  for (int i = 0; i < by_level(4000, 6000, 10000); ++i) {
    const Triangle t = random.triangle(0.5f);
    const auto edge = [&](std::size_t from, std::size_t to) {
      return bench::subtract(bench::to_double(t.corner[to]), bench::to_double(t.corner[from]));
    };
    const bench::Double3 e1 = edge(0, 1), e2 = edge(0, 2), e3 = edge(1, 2), n = bench::cross(e1, e2);
    const double square = bench::dot(n, n),
                 longest = std::max({bench::dot(e1, e1), bench::dot(e2, e2), bench::dot(e3, e3)});
    if (square < 0.04 * longest * longest) continue;
    Mesh one{{t.corner[0], t.corner[1], t.corner[2]}, {{0, 1, 2}}}, ten = one;
    ten.triangles.resize(10, one.triangles[0]);
    const Bvh without_boxes(one), with_boxes(ten);
    for (int k = 0; k < 64; ++k) {
      const Float3& corner = t.corner[i % 3];
      Ray ray = make_ray(random.point(static_cast<float>(random.magnitude(1, 1000)), corner), {});
      for (std::size_t axis = 0; axis < 3; ++axis) ray.direction[axis] = corner[axis] - ray.origin[axis];
      const bench::Double3 d = bench::to_double(ray.direction);
      if (std::abs(bench::dot(n, d)) < 0.1 * std::sqrt(square * bench::dot(d, d))) continue;
      for (const Grade grade : {Grade::reproducible, Grade::fast}) {
        const TraceOptions options{.test = TriangleTest::moller_trumbore, .grade = grade};
        ASSERT_EQ(with_boxes.closest(ray, options).primitive, without_boxes.closest(ray, options).primitive)
            << i << ", " << k;
      }
    }
  }
}

TEST(Calls, refuse_what_batches_refuse) {
  const Bvh bvh(triangle_soup(10, 0.2f, 80));
  const Path foreign = path_of_no_machine();
  for (const TraceOptions& wrong : {TraceOptions{.path = &foreign},
                                    {.mode = static_cast<TraversalMode>(99)},
                                    {.hint = static_cast<BatchHint>(99)},
                                    {.threads = -1}}) {
    EXPECT_THROW(bvh.closest(Ray{}, wrong), std::invalid_argument);
    EXPECT_THROW(bvh.occluded(Ray{}, wrong), std::invalid_argument);
  }
}

TEST(Calls, follow_the_tree) {
  Mesh mesh = triangle_soup(300, 0.3f, 76);
  const std::vector<Ray> rays = all_kinds_of_rays(mesh);
  Bvh bvh(mesh);
  for (Float3& vertex : mesh.vertices) vertex = {vertex[1] + 0.5f, vertex[2], -vertex[0]};
  bvh.refit(mesh.vertices, mesh.triangles);
  expect_calls_as_batches(bvh, rays);
  std::stringstream file;
  bvh.save(file);
  expect_calls_as_batches(Bvh::load(file), rays);
  Bvh moved(std::move(bvh));
  expect_calls_as_batches(moved, rays);
  expect_calls_as_batches(bvh, rays);  // empty
  bvh = std::move(moved);
  expect_calls_as_batches(bvh, rays);
  expect_calls_as_batches(moved, rays);
  KdTree kdtree(mesh), other = std::move(kdtree);
  expect_calls_as_batches(kdtree, rays);
  expect_calls_as_batches(other, rays);
  std::stringstream cells;
  other.save(cells);
  expect_calls_as_batches(KdTree::load(cells), rays);
}

}  // namespace
}  // namespace raylanes::testing
