// Records of any kind may name the triangles that rays skip, in any run of a batch; others are refused.
#include "query_trees.hpp"

namespace raylanes::testing {
namespace {

// Whatever records name the primitives, and however far apart they are; the inactive rays' are not read.
TEST(Skip, is_a_view_of_any_records) {
  const Mesh mesh = triangle_soup(by_level(300), 0.5f, 172);
  const std::vector<Ray> rays = aimed_rays(mesh, by_level(200), 2, 173);
  const Bvh bvh(mesh);
  std::vector<Hit> first(rays.size()), expected(rays.size()), found(rays.size());
  bvh.closest(rays, first);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::vector<Hit> without = oracle_hits(mesh, rays[i], Facing::any, first[i].primitive);
    if (!without.empty()) expected[i] = without[0];
  }
  std::vector<std::uint32_t> indices;
  std::vector<ClosestPoint> points(rays.size());
  std::vector<unsigned char> odd(rays.size() * 7 + 1);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    indices.push_back(first[i].primitive), points[i].primitive = first[i].primitive;
    std::memcpy(odd.data() + 1 + 7 * i, &first[i].primitive, 4);
  }
  const auto expect_found = [&](const char* by, const PrimitiveView& skip) {
    std::ranges::fill(found, Hit());
    bvh.closest(rays, found, {.skip = skip});
    EXPECT_TRUE(same_bytes(found, expected)) << by;
  };
  expect_found("hits", first), expect_found("a view of hits", HitView(first));
  expect_found("indices", indices), expect_found("closest points", points);
  expect_found("bytes", PrimitiveView(odd.data() + 1, rays.size(), 7));
  for (std::size_t i = 0; i < rays.size(); i += 9) {
    EXPECT_TRUE(same_bytes(bvh.closest(rays[i], {.skip = first[i]}), expected[i]));
    EXPECT_TRUE(same_bytes(bvh.closest(rays[i], {.skip = first[i].primitive}), expected[i]));
    EXPECT_EQ(bvh.occluded(rays[i], {.skip = bvh.closest(rays[i])}), static_cast<bool>(expected[i]));
  }
}

// Runs that share an origin are traced apart from the rays between them.
TEST(Skip, is_of_the_ray_in_every_run) {
  const Mesh mesh = triangle_soup(by_level(300), 0.5f, 174);
  std::vector<Ray> rays = aimed_rays(mesh, by_level(600u, 600u, 600u), 2, 175);
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (i / 150 % 2 == 1) rays[i].origin = rays[i / 150 * 150].origin;
  const Bvh bvh(mesh);
  std::vector<Hit> first(rays.size()), found(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  bvh.closest(rays, first);
  bvh.closest(rays, found, {.skip = first});
  bvh.occluded(rays, occluded, {.skip = first});
  std::size_t others = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit alone = bvh.closest(rays[i], {.skip = first[i]});
    ASSERT_TRUE(same_bytes(found[i], alone)) << i;
    ASSERT_EQ(occluded[i], alone ? 1 : 0) << i;
    others += first[i] && alone ? 1 : 0;
  }
  EXPECT_GT(others, 50u);
}

TEST(Skip, is_refused_for_other_tests_and_sizes) {
  const Bvh bvh(cube(-1, 1));
  const std::vector<Ray> rays(3, make_ray({0.1f, 0.2f, 5}, {0, 0, -1}));
  std::vector<Hit> hits(3);
  std::vector<std::uint8_t> occluded(3);
  std::vector<CrossingCount> counts(3);
  const std::vector<std::uint32_t> two(2), none, three(3);
  EXPECT_THROW(bvh.closest(rays, hits, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(bvh.closest(rays, hits, {.skip = two, .after = hits}), std::invalid_argument);
  EXPECT_THROW(bvh.closest(rays, hits, {.skip = PrimitiveView(nullptr, 3)}), std::invalid_argument);
  EXPECT_THROW(bvh.occluded(rays, occluded, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(bvh.closest(rays[0], {.skip = two}), std::invalid_argument);
  EXPECT_THROW(bvh.occluded(rays[0], {.skip = two}), std::invalid_argument);
  EXPECT_THROW(bvh.all_hits(rays, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(bvh.crossings(rays, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(bvh.count_crossings(rays, counts, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(bvh.closest(rays, hits, {.test = TriangleTest::watertight, .skip = three}),
               std::invalid_argument);
  bvh.closest(rays, hits, {.skip = none});
  EXPECT_EQ(hits[2].t, 4);
}

}  // namespace
}  // namespace raylanes::testing
