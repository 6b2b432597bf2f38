// Calls with counters: the same answers, and counts that lie between the counts of two walks in double precision, by
// boxes a little smaller and a little larger than the tree's.
#include "../support/message_of.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "reference/traced.hpp"

namespace raylanes::testing {
namespace {

TraceCounters counted(const Bvh& bvh, std::span<const Ray> rays, TraceOptions options) {
  TraceCounters counters;
  options.counters = &counters;
  trace(bvh, rays, options);
  return counters;
}

// Whether the segment meets the box, whose sides are moved outwards by `margin`.
bool meets(const Ray& ray, const WideNode& node, int child, double margin) {
  double in = ray.tmin, out = ray.tmax;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    double near = (node.lo[axis][child] - margin - o) / d, far = (node.hi[axis][child] + margin - o) / d;
    if (near > far) std::swap(near, far);
    in = std::max(in, near), out = std::min(out, far);
  }
  return in <= out;
}

// The cost of rays that meet no triangle, so that nothing is culled.
TraceCounters walk(const BvhView& tree, std::span<const Ray> rays, double margin) {
  TraceCounters counters;
  for (const Ray& ray : rays)
    for (std::vector<TreeReference> open{tree.root}; !open.empty();) {
      const TreeReference at = open.back();
      open.pop_back();
      if (refers_to_leaf(at)) {
        ++counters.leaves, counters.triangle_tests += leaf_of(at).size;
        continue;
      }
      const WideNode& node = tree.nodes[at];
      ++counters.nodes, counters.box_tests += static_cast<std::uint64_t>(std::popcount(node.occupied));
      for (int child = 0; child < tree_width; ++child)
        if ((node.occupied >> child & 1u) != 0 && meets(ray, node, child, margin))
          open.push_back(node.child[child]);
    }
  return counters;
}

struct Scene {
  Mesh mesh = triangle_soup(3000, 0.05f, 81);
  Bvh bvh{mesh};
};

std::vector<Ray> neighbours(std::size_t count, float spread) {
  Random random(82);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Float3 corner{0.002f * static_cast<float>(i % 64), 0.002f * static_cast<float>(i / 64), 3};
    rays.push_back(make_ray(random.point(spread, corner), {0.1f, 0.2f, -2.0f}));
  }
  return rays;
}
// To where they went, from above.
std::vector<Ray> from_one_point(std::vector<Ray> rays) {
  constexpr Float3 point{0, 0, 3};
  for (Ray& ray : rays) {
    for (std::size_t axis = 0; axis < 3; ++axis) ray.direction[axis] += ray.origin[axis] - point[axis];
    ray.origin = point;
  }
  return rays;
}
std::vector<Ray> misses(const Bvh& bvh, std::vector<Ray> rays) {
  std::erase_if(rays, [&](const Ray& ray) { return bvh.occluded(ray); });
  return rays;
}

bool is_between(std::uint64_t least, std::uint64_t x, std::uint64_t most) {
  return least <= x && x <= most;
}

class Counters : public Counting {};

TEST_F(Counters, tests_are_those_of_a_walk_in_double_precision) {
  const Scene scene;
  for (const float spread : {0.0f, 1.0f}) {
    const std::vector<Ray> rays = misses(scene.bvh, neighbours(by_level(3000), spread));
    ASSERT_GT(rays.size(), 100u);
    const TraceCounters least = walk(scene.bvh.view(), rays, -1e-5),
                        most = walk(scene.bvh.view(), rays, 1e-5);
    EXPECT_LT(static_cast<double>(most.triangle_tests), 1.02 * static_cast<double>(least.triangle_tests));
    for (const TraceOptions& way : ways_to_trace()) {
      const TraceCounters counters = counted(scene.bvh, rays, way);
      EXPECT_EQ(counters.hits, 0u) << name_of(way);
      if (way.mode == TraversalMode::packet) continue;
      EXPECT_TRUE(is_between(least.box_tests, counters.box_tests, most.box_tests)) << name_of(way);
      EXPECT_TRUE(is_between(least.triangle_tests, counters.triangle_tests, most.triangle_tests))
          << name_of(way);
      EXPECT_EQ(counters.frustum_tests, 0u) << name_of(way);
      if (way.mode == TraversalMode::single) {
        EXPECT_TRUE(is_between(least.nodes, counters.nodes, most.nodes)) << name_of(way);
        EXPECT_TRUE(is_between(least.leaves, counters.leaves, most.leaves)) << name_of(way);
      } else {
        EXPECT_LE(counters.nodes, most.nodes) << name_of(way);
      }
    }
  }
}

TEST_F(Counters, registers_of_single_rays_follow_from_the_lanes) {
  const Scene scene;
  const std::vector<Ray> rays = neighbours(by_level(1000), 0.5f);
  for (const Path* path : supported_paths()) {
    const TraceCounters c = counted(scene.bvh, rays, {.mode = TraversalMode::single, .path = path});
    const std::uint64_t of_nodes = c.nodes * (path->lanes < tree_width ? tree_width / path->lanes : 1);
    const std::uint64_t of_leaves = c.registers - of_nodes;
    // A leaf of four triangles or fewer takes half a node's registers.
    EXPECT_TRUE(is_between(c.leaves, of_leaves, path->lanes == 4 ? 2 * c.leaves : of_leaves)) << path->name;
    EXPECT_EQ(of_leaves, path->lanes == 1   ? c.triangle_tests
                         : path->lanes >= 8 ? c.leaves
                                            : of_leaves)
        << path->name;
  }
}

// Tests other than exact are counted in the mode single alone.
void expect_hits_counted(const Bvh& bvh, const std::vector<Ray>& rays) {
  for (const TriangleTest test : {TriangleTest::exact, TriangleTest::moller_trumbore})
    for (TraceOptions way : ways_to_trace({.test = test})) {
      if (test != TriangleTest::exact && way.mode != TraversalMode::single) {
        EXPECT_EQ(
            message_of<std::invalid_argument>([&] { counted(bvh, rays, way); }),
            "trace: the test moller_trumbore is counted in the mode single alone; exact is in every mode");
        continue;
      }
      const std::vector<Hit> hits = trace(bvh, rays, way);
      const auto hit =
          static_cast<std::uint64_t>(std::ranges::count_if(hits, [](const Hit& h) { return !!h; }));
      TraceCounters closest = counted(bvh, rays, way), any;
      way.counters = &any;
      trace_occluded(bvh, rays, way);
      for (const TraceCounters& counters : {closest, any}) {
        EXPECT_TRUE(is_between(hit, counters.hits + counters.undecided, hit + counters.undecided))
            << name_of(way);
        EXPECT_LE(counters.triangle_tests, rays.size()) << name_of(way);
        EXPECT_GE(counters.triangle_tests, hit) << name_of(way);
        EXPECT_EQ(counters.nodes + counters.box_tests, 0u) << name_of(way);
        const bool has_frusta = way.mode == TraversalMode::packet;
        EXPECT_TRUE(has_frusta || counters.triangle_tests == rays.size()) << name_of(way);
      }
    }
}

// All meet a tree without nodes; with one triangle nothing is tested twice.
TEST_F(Counters, hits_of_one_triangle_are_the_rays_that_hit) {
  const Mesh mesh{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const Bvh bvh(mesh);
  const std::vector<Ray> apart = neighbours(700, 1.0f);
  for (const std::vector<Ray>& rays : {apart, from_one_point(apart)}) expect_hits_counted(bvh, rays);
}

// So far away that boxes keep nothing out; the segment is before all triangles.
TEST_F(Counters, where_boxes_keep_nothing_out_each_ray_meets_each_triangle) {
  const Mesh mesh = triangle_soup(300, 0.1f, 71);
  const Bvh bvh(mesh);
  const std::vector<Ray> rays(40, make_ray({3e38f, 2e38f, -2.5e38f}, {1, 1, 1}, 0, 1));
  for (const TraceOptions& way : ways_to_trace()) {
    const TraceCounters counters = counted(bvh, rays, way);
    EXPECT_EQ(counters.triangle_tests, rays.size() * mesh.triangles.size()) << name_of(way);
    if (way.mode != TraversalMode::single) continue;
    EXPECT_EQ(counters.nodes, rays.size() * bvh.node_count()) << name_of(way);
    EXPECT_EQ(counters.leaves, rays.size() * bvh.leaf_count()) << name_of(way);
  }
}

TEST_F(Counters, frusta_stand_for_many_rays) {
  const Scene scene;
  const std::vector<Ray> rays = from_one_point(neighbours(2048, 0.0f));
  for (const TraceOptions& way : ways_to_trace()) {
    const TraceCounters counters = counted(scene.bvh, rays, way);
    const bool has_frusta = way.mode == TraversalMode::packet;
    EXPECT_EQ(counters.frustum_tests > 0, has_frusta) << name_of(way);
    EXPECT_TRUE(!has_frusta || counters.nodes < rays.size()) << name_of(way);
  }
}

// A comparison that floats leave undecided costs a hundred times as much. Floats nearly always tell which of two hits
// is nearer.
TEST_F(Counters, next_to_nothing_is_left_undecided) {
  const Scene scene;
  const std::vector<Ray> apart = neighbours(by_level(3000), 1.0f);
  for (const std::vector<Ray>& rays : {apart, from_one_point(apart)})
    for (const TraceOptions& way : ways_to_trace()) {
      const TraceCounters counters = counted(scene.bvh, rays, way);
      EXPECT_GT(counters.hits, rays.size() / 16) << name_of(way);
      EXPECT_LE(100 * counters.undecided, counters.hits) << name_of(way);
    }
}

// One that misses the light widens no packet.
TEST_F(Counters, rays_that_go_elsewhere_cost_others_nothing) {
  const Scene scene;
  std::vector<Ray> rays = from_one_point(neighbours(2048, 0.0f));
  for (Ray& ray : rays)
    for (std::size_t axis = 0; axis < 3; ++axis)
      ray.origin[axis] += ray.direction[axis], ray.direction[axis] = -ray.direction[axis], ray.tmax = 0.999f;
  for (TraceOptions way : ways_to_trace()) {
    TraceCounters all, others;
    way.counters = &all;
    trace_occluded(scene.bvh, rays, way);
    std::vector<Ray> strange = rays;
    for (std::size_t i = 100; i < strange.size(); i += 256) strange[i].direction[0] += 0.05f;
    way.counters = &others;
    trace_occluded(scene.bvh, strange, way);
    EXPECT_LE(static_cast<double>(others.triangle_tests + others.frustum_tests),
              1.1 * static_cast<double>(all.triangle_tests + all.frustum_tests))
        << name_of(way);
  }
}

// A packet that comes to few leaves asks no ray for a box.
TEST_F(Counters, boxes_of_packets_are_asked_for_frusta) {
  const Bvh bvh(triangle_soup(30, 0.3f, 86));
  ASSERT_TRUE(bvh.node_count() >= 1 && bvh.leaf_count() <= 10);
  const std::vector<Ray> rays = from_one_point(neighbours(512, 0.0f));
  for (const TraceOptions& way : ways_to_trace()) {
    const TraceCounters counters = counted(bvh, rays, way);
    const bool has_frusta = way.mode == TraversalMode::packet;
    EXPECT_EQ(counters.box_tests == 0, has_frusta) << name_of(way);
    EXPECT_EQ(counters.frustum_tests > 0, has_frusta) << name_of(way);
  }
}

TEST_F(Counters, answers_are_those_of_uncounted_calls) {
  const Scene scene;
  std::vector<Ray> rays = neighbours(by_level(2000), 0.0f);
  for (const Ray& ray : mixed_rays(scene.mesh, by_level(2000), 2, {0, 0, 0}, 83)) rays.push_back(ray);
  for (std::size_t i = 0; i < 600; ++i) rays.push_back(rays[i]), rays.back().origin = {0.1f, 0.2f, 3};
  rays[7].direction[1] = nan, rays[9].tmin = infinity;
  for (std::size_t test = 0; test < tree_test_names.size(); ++test) {
    const auto as = static_cast<TriangleTest>(test);
    for (TraceOptions way : ways_to_trace({.test = as})) {
      if (as != TriangleTest::exact && way.mode != TraversalMode::single) continue;
      const std::vector<Hit> hits = trace(scene.bvh, rays, way);
      const std::vector<std::uint8_t> occluded = trace_occluded(scene.bvh, rays, way);
      TraceCounters closest, any;
      way.counters = &closest;
      const std::vector<Hit> counted_hits = trace(scene.bvh, rays, way);
      EXPECT_TRUE(same_bytes(hits, counted_hits)) << name_of(way);
      way.counters = &any;
      EXPECT_EQ(occluded, trace_occluded(scene.bvh, rays, way)) << name_of(way);
      EXPECT_GT(closest.hits, 0u) << name_of(way);
      EXPECT_GT(any.hits, 0u) << name_of(way);
      // Neighbours are packets, whose frusta are asked, or, for any hit, streams.
      if (way.mode == TraversalMode::packet) continue;
      EXPECT_LT(any.box_tests + any.triangle_tests, closest.box_tests + closest.triangle_tests)
          << name_of(way);
    }
  }
}

TEST_F(Counters, sums_over_threads_masks_and_calls) {
  const Scene scene;
  const std::vector<Ray> rays = mixed_rays(scene.mesh, 20000, 2, {0, 0, 0}, 85);
  TraceOptions options{.mode = TraversalMode::single};
  const TraceCounters all = counted(scene.bvh, rays, options);
  for (const int threads : {0, 2}) {
    options.threads = threads;
    EXPECT_EQ(counted(scene.bvh, rays, options), all) << threads << " threads";
  }
  TraceCounters halves;
  options.counters = &halves;
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> mask(rays.size() / 8, 0x0f);
  for (std::uint8_t& bits : mask) options.active = mask.data(), bits = 0x0f;
  scene.bvh.closest(rays, hits, options);
  EXPECT_LT(halves.nodes, all.nodes);
  std::ranges::fill(mask, std::uint8_t{0xf0});
  scene.bvh.closest(rays, hits, options);
  EXPECT_EQ(halves, all) << "what is counted is added";
  for (const Ray& ray : rays) scene.bvh.closest(ray, options);
  TraceCounters twice = all;
  EXPECT_EQ(halves, twice += all);
}

TEST_F(Counters, what_is_not_offered_is_refused) {
  const Scene scene;
  TraceCounters counters;
  const auto message = [&](const TraceOptions& options) {
    return message_of([&] { scene.bvh.closest(Ray{}, options); });
  };
  EXPECT_EQ(message({.grade = Grade::fast, .counters = &counters}),
            "trace: the test exact in the grade fast is not counted; allowed is the grade reproducible");
  EXPECT_EQ(counters, TraceCounters{});
  EXPECT_FALSE(Bvh().closest(Ray{}, {.counters = &counters}));
  EXPECT_EQ(counters, TraceCounters{}) << "an empty tree costs nothing";
}

TEST(BuildsWithoutCounters, refuse_to_count) {
  TraceCounters counters;
  for (TraceOptions way : ways_to_trace()) {
    way.counters = &counters;
    EXPECT_EQ(message_of<std::invalid_argument>([&] { trace(Bvh(), {}, way); }),
              has_counters()
                  ? "no exception"
                  : "trace: this build has no counters; its option -Dcounters=true would give it some")
        << name_of(way);
  }
}

}  // namespace
}  // namespace raylanes::testing
