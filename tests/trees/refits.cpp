// Trees that follow meshes in motion: hits of exact arithmetic over the moved mesh, byte for byte, whatever happens to
// its triangles; and how much worse than new a tree says it is.
#include "../support/message_of.hpp"
#include "refitted.hpp"

namespace raylanes::testing {
namespace {

constexpr int thread_counts[] = {1, 2, 0};

template <class T>
class Refit : public Refitted<T> {};
TYPED_TEST_SUITE(Refit, Numbers, NumberNames);

TYPED_TEST(Refit, of_any_small_size) {
  for (const std::size_t size : {1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 16u, 17u, 63u, 64u, 65u, 129u}) {
    SCOPED_TRACE(size);
    const auto mesh = this->soup(size, 0.5f, size), far = this->shaken(mesh, 3, size);
    const auto rays = this->rays_to(far, this->by_level(300, 60), size);
    const auto built = this->tree_of(far);
    for (const int threads : thread_counts) {
      auto tree = this->tree_of(mesh);
      tree.refit(far.vertices, far.triangles, threads);
      EXPECT_GT(this->expect_exact(tree, far, rays), 0u);
      EXPECT_TRUE(same_bytes(tree.bounds(), built.bounds()));
    }
  }
}

TYPED_TEST(Refit, time_and_again) {
  auto mesh = this->soup(this->by_level(2000, 150), 0.1f, 50);
  auto tree = this->tree_of(mesh);
  for (std::uint64_t frame = 0; frame < 4; ++frame) {
    SCOPED_TRACE(frame);
    mesh = this->shaken(mesh, 0.3f, frame);
    tree.refit(mesh.vertices, mesh.triangles, thread_counts[frame % 3]);
    EXPECT_GT(this->expect_exact(tree, mesh, this->rays_to(mesh, this->by_level(800, 100), frame)), 10u);
  }
}

// The other tree has the bytes of a refit, and shares nothing.
TYPED_TEST(Refit, of_a_copy) {
  const auto mesh = this->soup(2000, 0.1f, 77), far = this->shaken(mesh, 0.3f, 78);
  const auto rays = this->rays_to(mesh, 300, 79);
  const std::vector points(mesh.vertices.begin(), mesh.vertices.begin() + 20);
  auto refitted = this->tree_of(mesh);
  refitted.refit(far.vertices, far.triangles);
  const auto original = this->tree_of(mesh);
  const auto before = answers_of(original, rays, points, nullptr);
  const auto other = original.refitted(far.vertices, far.triangles, 2);
  EXPECT_EQ(saved(other), saved(refitted));
  EXPECT_EQ(saved(original), saved(this->tree_of(mesh)));
  expect_same(answers_of(original, rays, points, nullptr), before);
  expect_same(answers_of(other, rays, points, nullptr),
              answers_of(this->tree_of(far), rays, points, nullptr));
  EXPECT_EQ(typename TestFixture::Tree().refitted({}, {}).node_count(), 0u);
  EXPECT_THROW(original.refitted(far.vertices, mesh.triangles, -1), std::invalid_argument);
  EXPECT_THROW(original.refitted(far.vertices, IndexView()), std::invalid_argument);
}

// Spatial splits have clipped boxes, in which moved triangles are not.
TYPED_TEST(Refit, of_trees_by_every_builder) {
  const auto mesh = this->soup(this->by_level(600, 150), 0.6f, 74), far = this->shaken(mesh, 0.5f, 75);
  auto dead = mesh;
  dead.vertices[mesh.triangles[0][0]] = mesh.vertices[mesh.triangles[0][1]];
  const auto rays = this->rays_to(far, this->by_level(300, 60), 76);
  for (std::size_t i = 0; i < 2 * tree_builder_names.size(); ++i) {
    const BuildOptions options{.builder = static_cast<TreeBuilder>(i / 2), .optimize = i % 2 != 0};
    if (!this->has_floats && options.builder == TreeBuilder::spatial_splits) continue;
    SCOPED_TRACE(i);
    auto tree = this->tree_of(mesh, options), once_dead = this->tree_of(dead, options);
    tree.refit(far.vertices, far.triangles, 2);
    EXPECT_GT(this->expect_exact(tree, far, rays), 10u);
    EXPECT_GT(this->expect_exact(once_dead.refitted(far.vertices, far.triangles), far, rays), 10u);
    once_dead.refit(far.vertices, far.triangles);
    EXPECT_GT(this->expect_exact(once_dead, far, rays), 10u);
    EXPECT_EQ(once_dead.report().builder, options.builder) << "also where a refit is a build";
    EXPECT_EQ(once_dead.report().references, this->tree_of(far, options).report().references);
  }
}

TYPED_TEST(Refit, to_a_point_to_a_plane_and_back) {
  const auto mesh = this->soup(this->by_level(300, 150), 0.4f, 51);
  const auto rays = this->rays_to(mesh, this->by_level(500, 100), 52);
  auto tree = this->tree_of(mesh);
  auto point = mesh, plane = mesh;
  for (auto& vertex : point.vertices) vertex = {1, 2, 3};
  for (auto& vertex : plane.vertices) vertex[2] = 0.5f;
  tree.refit(point.vertices, point.triangles);
  EXPECT_EQ(this->expect_exact(tree, point, rays), 0u);
  EXPECT_TRUE(same_bytes(tree.bounds(), typename TestFixture::Tree().bounds()));
  EXPECT_EQ(tree.sah_cost(), 0);
  EXPECT_EQ(tree.report().depth, 0);
  tree.refit(plane.vertices, plane.triangles);
  EXPECT_GT(this->expect_exact(tree, plane, rays), 10u);
  tree.refit(mesh.vertices, mesh.triangles);
  EXPECT_GT(this->expect_exact(tree, mesh, rays), 10u);
  EXPECT_EQ(tree.decay(), 1);
}

TYPED_TEST(Refit, to_the_ends_of_the_usable_scale) {
  const auto mesh = this->soup(this->by_level(200, 100), 0.4f, 53);
  const double most = this->has_floats ? 1e12 : 1e200;
  for (const double scaling : {1 / most, most}) {
    auto scaled = mesh;
    for (auto& vertex : scaled.vertices)
      for (auto& x : vertex) x = static_cast<TypeParam>(x * scaling);
    auto tree = this->tree_of(mesh);
    tree.refit(scaled.vertices, scaled.triangles);
    auto rays = this->rays_to(mesh, this->by_level(600, 100), 54);
    for (auto& ray : rays)
      for (auto& x : ray.origin) x = static_cast<TypeParam>(x * scaling);
    EXPECT_GT(this->expect_exact(tree, scaled, rays), 10u);
  }
}

// The build leaves triangles with two equal corners out; what lives later is hit, what dies is not.
TYPED_TEST(Refit, triangles_that_come_to_life_and_die) {
  auto alive = this->soup(100, 0.5f, 55), half_dead = alive, dead = alive;
  const auto set_corners = [](auto& mesh, std::size_t triangle, const auto&... corner) {
    std::size_t k = 0;
    ((mesh.vertices[mesh.triangles[triangle][k++]] = corner), ...);
  };
  for (std::size_t i = 0; i < 100; ++i) {
    const Index3& corners = alive.triangles[i];
    const auto& a = alive.vertices[corners[0]];
    set_corners(dead, i, a, a, i % 3 == 0 ? a : alive.vertices[corners[2]]);
    if (i % 2 == 0) set_corners(half_dead, i, a, alive.vertices[corners[1]], a);
  }
  const auto rays = this->rays_to(alive, this->by_level(500, 100), 56);
  for (const auto* const first : {&half_dead, &alive, &dead}) {
    auto tree = this->tree_of(*first);
    for (const auto* frame : {&half_dead, &alive, &dead, &alive, &dead, &half_dead, &dead}) {
      tree.refit(frame->vertices, frame->triangles);
      EXPECT_EQ(this->expect_exact(tree, *frame, rays) > 10, frame != &dead);
    }
  }
}

TYPED_TEST(Refit, takes_other_indices_and_other_views) {
  const auto mesh = this->soup(150, 0.5f, 57), other = this->soup(150, 0.5f, 58);
  struct Wide {
    TypeParam x, y, z, w;
  };
  std::vector<Wide> vertices;
  std::vector<std::int32_t> flat;
  for (const auto& vertex : other.vertices) vertices.push_back({vertex[0], vertex[1], vertex[2], nan});
  for (const Index3& triangle : other.triangles)
    for (const std::uint32_t index : triangle) flat.push_back(static_cast<std::int32_t>(index));
  auto tree = this->tree_of(mesh);
  tree.refit(vertices, flat);
  EXPECT_GT(this->expect_exact(tree, other, this->rays_to(other, this->by_level(500, 100), 59)), 10u);
  // Fewer vertices than before, shared by all.
  typename TestFixture::AnyMesh fan{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}};
  for (std::uint32_t i = 0; i < 150; ++i) fan.triangles.push_back({i % 4, (i + 1) % 4, (i + 2) % 4});
  tree.refit(fan.vertices, fan.triangles);
  EXPECT_GT(this->expect_exact(tree, fan, this->rays_to(fan, this->by_level(500, 100), 60)), 10u);
}

TEST(RefitOfFloats, serves_every_test) {
  using Floats = Refitted<float>;
  const Mesh mesh = triangle_soup(300, 0.4f, 61), far = Floats::shaken(mesh, 0.5f, 62);
  Random random(63);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(600); ++i)
    rays.push_back(make_ray(random.point(2), {0.25f, -0.5f, 1}));
  Bvh refitted(mesh);
  refitted.refit(far.vertices, far.triangles);
  const Bvh built(far);
  for (const TriangleTestInfo& test : triangle_tests) {
    if (!test.serves_trees) continue;
    for (const TraceOptions& way : ways_to_trace({.test = test.test}))
      EXPECT_TRUE(same_bytes(trace(refitted, rays, way), trace(built, rays, way))) << name_of(way);
  }
}

TYPED_TEST(Refit, of_empty_trees) {
  typename TestFixture::Tree none;
  none.refit({}, {});
  none.refit(std::vector<PointOf<TypeParam>>{{1, 2, 3}}, std::vector<Index3>{});
  EXPECT_FALSE(none.closest(RayOf<TypeParam>{{0, 0, 0}, 0, {1, 2, 3}, 9}));
  auto empty = this->tree_of({});
  empty.refit({}, {});
  for (const auto* tree : {&none, &empty}) {
    EXPECT_EQ(tree->sah_cost(), 0);
    EXPECT_EQ(tree->decay(), 1);
  }
}

TYPED_TEST(Refit, refuses_what_is_no_such_mesh_and_leaves_the_tree_alone) {
  const auto mesh = this->soup(50, 0.5f, 64), far = this->shaken(mesh, 1, 65);
  auto tree = this->tree_of(mesh);
  const std::string before = saved(tree);
  const auto expect_refused = [&](const auto& wrong, int threads, const std::vector<std::string>& words) {
    expect_words(
        message_of<std::invalid_argument>([&] { tree.refit(wrong.vertices, wrong.triangles, threads); }),
        words);
    EXPECT_EQ(saved(tree), before);
  };
  auto spoilt = far;
  spoilt.triangles.pop_back();
  expect_refused(spoilt, 1, {"refit", "49", "50"});
  for (const float value : {nan, infinity, -infinity}) {
    spoilt = far;
    spoilt.vertices.back()[2] = value;
    expect_refused(spoilt, 1, {"vertex 149", "z"});
  }
  spoilt = far;
  spoilt.triangles.back()[1] = 150;
  expect_refused(spoilt, 1, {"triangle 49", "150"});
  expect_refused(far, -2, {"-2", "thread"});
  typename TestFixture::Tree none;
  expect_words(message_of<std::invalid_argument>([&] { none.refit(mesh.vertices, mesh.triangles); }),
               {"50", "0"});
}

TYPED_TEST(Refit, decay_is_one_after_a_build_and_on_the_way_back) {
  const auto mesh = this->soup(2000, 0.05f, 67);
  auto tree = this->tree_of(mesh);
  const double cost = tree.sah_cost();
  EXPECT_EQ(cost, tree.report().sah_cost);
  EXPECT_EQ(tree.decay(), 1);
  double last = 1;
  for (const float by : {0.01f, 0.1f, 0.5f}) {
    const auto far = this->shaken(mesh, by, 68);
    tree.refit(far.vertices, far.triangles);
    EXPECT_GT(tree.decay(), last) << by;
    EXPECT_EQ(tree.decay(), tree.sah_cost() / cost);
    last = tree.decay();
    EXPECT_GT(tree.sah_cost(), this->tree_of(far).sah_cost()) << "a new tree is better";
  }
  tree.refit(mesh.vertices, mesh.triangles);
  EXPECT_EQ(tree.decay(), 1);
}

TYPED_TEST(Refit, costs_of_a_leaf) {
  const auto cost_of = [&](const auto& mesh) { return static_cast<float>(this->tree_of(mesh).sah_cost()); };
  EXPECT_FLOAT_EQ(cost_of(this->soup(4, 0.4f, 69)), 0.9f);
  auto once = this->soup(1, 0.4f, 70);
  once.triangles.resize(8, once.triangles[0]);
  EXPECT_FLOAT_EQ(cost_of(once), 0.9f);
}

}  // namespace
}  // namespace raylanes::testing
