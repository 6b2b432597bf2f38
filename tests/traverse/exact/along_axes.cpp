// Rays along axes and in the planes of a mesh, against rational numbers: weights that are exactly zero, and triangles
// that a ray cannot hit because it stays beside them.
#include <random>

#include "../../../bench/support/oracles/exact_rays.hpp"
#include "../../../bench/support/scenes/shapes.hpp"
#include "../../queries/query_trees.hpp"
#include "../reference/traced.hpp"

namespace raylanes::testing {
namespace {

// A floor with walls across it. Rays in its plane meet the walls alone, and do not look at the floor row by row.
TEST(AlongAxes, lists_of_many_rays_in_a_floor) {
  constexpr std::size_t cells = 60, walls = 12;
  Mesh mesh;
  bench::append_grid(mesh, cells, cells, [](double u, double v) {
    return bench::Double3{u * cells, v * cells, 0.1};
  });
  for (std::size_t i = 0; i < walls; ++i) {
    const float x = 5.0f * static_cast<float>(i) + 2.25f;
    append(mesh, {x, -200, -9}, {x, 200, -9}, {x, 30, 90});
  }
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < rays_for_streams; ++i)
    rays.push_back(make_ray({-1, 0.5f * static_cast<float>(i % (2 * cells)), 0.1f}, {1, 0, 0}));
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    std::vector<CrossingCount> counts(rays.size());
    tree.count_crossings(rays, counts, {.path = path});
    const auto hits = tree.all_hits(rays, {.path = path});
    TraceCounters counters;
    const auto one_by_one = tree.all_hits(rays, {.path = path, .counters = &counters});
    ASSERT_EQ(hits.items.size(), rays.size() * walls);
    ASSERT_TRUE(same_bytes(hits.items, one_by_one.items));
    ASSERT_EQ(tree.crossings(rays, {.path = path}).items.size(), rays.size() * walls);
    for (const CrossingCount& count : counts) ASSERT_EQ(count.crossings, walls);
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(tree)>, Bvh>) {
      EXPECT_LT(counters.triangle_tests, rays.size() * cells);
    }
  });
}

// A triangle whose corners are subnormal is not flat because a mode takes them for zeros.
TEST(AlongAxes, subnormal_numbers_are_not_zeros) {
  const Mesh mesh{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0x1p-140f}}, {{0, 1, 2}}};
  std::vector<Ray> rays;
  for (const float z : {0.0f, -0.0f, 0x1p-141f, 0x1p-140f, -0x1p-149f, 0x1p-139f})
    rays.push_back(make_ray({0, -4, z}, {0, 1, 0}));
  const std::vector<Hit> hits = oracle::nearest_hits(mesh, rays);
  ASSERT_TRUE(hits[0] && hits[2] && !hits[4] && !hits[5]);
  expect_hits(Bvh(mesh), rays, hits);
}

// Corners at t = P/direction half way between floats, and origins that bring the difference next to P, nearer than
// doubles tell.
TEST(AlongAxes, corners_whose_t_doubles_round_to_half_way) {
  std::mt19937_64 random(65);
  int cases = 0;
  for (int i = 0; cases < by_level(60, 200, 1000); ++i) {
    ASSERT_LT(i, 1'000'000);
    const std::uint64_t t = (random() % (1u << 22) << 2) + (1u << 24) + 3;  // ties go up
    const std::uint64_t direction = (random() % (1u << 23)) | (1u << 23) | 1u, product = t * direction;
    const auto corner = static_cast<float>(product);
    const double gap = static_cast<double>(corner) - static_cast<double>(product);
    if (!(std::fabs(gap) < 0x1p15)) continue;
    ++cases;
    std::vector<Ray> rays;
    for (const double nearer : {-0x1p-7, 0.0, 0x1p-7}) {
      const double origin = gap + nearer;
      ASSERT_EQ(static_cast<double>(static_cast<float>(origin)), origin);
      rays.push_back(make_ray({0, 0, static_cast<float>(origin)}, {0, 0, static_cast<float>(direction)}));
    }
    const Mesh mesh{{{0, 0, corner}, {1, 0, corner}, {-1, 1, corner}, {-1, -1, 0}},
                    {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}};
    const std::vector<Hit> hits = oracle::nearest_hits(mesh, rays);
    ASSERT_NE(hits[0].t, hits[2].t);
    expect_hits(Bvh(mesh), rays, hits);
  }
}

}  // namespace
}  // namespace raylanes::testing
