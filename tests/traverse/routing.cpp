// How batches in mode automatic are traced: by streams from as many rays on as the tree says.
#include "../../accel/batch/routing.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "../../accel/batch/shared_points.hpp"
#include "../../accel/doubles/bvh_d_arrays.hpp"
#include "../../accel/queries/traced_tree.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"
#include "reference/traced.hpp"

namespace raylanes::testing {
namespace {

// Small triangles alone, or behind two as large as all of them.
Mesh small_triangles(bool with_large_ones) {
  Mesh mesh = triangle_soup(with_large_ones ? 300 : 4000, 0.05f, 2801);
  if (!with_large_ones) return mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const float x : {-1.0f, 1.0f})
    for (const float y : {-1.0f, 1.0f}) mesh.vertices.push_back({x, y, -1.0f});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first + 3, first + 2, first + 1});
  return mesh;
}

StreamSizes sizes_of(const Bvh& bvh) {
  return TreeAccess::traced(bvh).view.streams_from;
}
void expect_sizes(const Bvh& bvh, const StreamSizes& expected, const char* name) {
  EXPECT_EQ(sizes_of(bvh).closest, expected.closest) << name;
  EXPECT_EQ(sizes_of(bvh).occluded, expected.occluded) << name;
}

// Σ area² by area · Σ area of the root and all below it.
double shared_visits_of(const BvhView& view) {
  const auto area = [](const Float3& lo, const Float3& hi) {
    const double x = double(hi[0]) - lo[0], y = double(hi[1]) - lo[1], z = double(hi[2]) - lo[2];
    return 2 * (x * y + x * z + y * z);
  };
  const double whole = area(view.bounds.lo, view.bounds.hi);
  double sum = whole, squares = whole * whole;
  for (const WideNode& node : view.nodes)
    for (std::size_t slot = 0; slot < tree_width; ++slot) {
      if (node.child[slot] == empty_reference) continue;
      const double one = area({node.lo[0][slot], node.lo[1][slot], node.lo[2][slot]},
                              {node.hi[0][slot], node.hi[1][slot], node.hi[2][slot]});
      sum += one, squares += one * one;
    }
  return squares / (whole * sum);
}

TEST(Routing, asks_how_many_visits_rays_share) {
  struct Case {
    Mesh mesh;
    bool is_shared;
  };
  // Without its root the second tree would be as the first one.
  for (const Case& of : {Case{small_triangles(false), false}, Case{triangle_soup(400, 0.05f, 2801), true},
                         Case{small_triangles(true), true}}) {
    const Mesh& mesh = of.mesh;
    Bvh bvh(mesh);
    const double shared = shared_visits_of(bvh.view());
    EXPECT_EQ(shared > 0.23, of.is_shared) << shared;
    const StreamSizes expected = streams_from(shared);
    expect_sizes(bvh, expected, "built");
    std::stringstream file;
    bvh.save(file);
    expect_sizes(Bvh::load(file), expected, "loaded");
    bvh.refit(mesh.vertices, mesh.triangles);
    const Bvh moved = std::move(bvh);
    expect_sizes(moved, expected, "refitted and moved");
  }
  EXPECT_LT(streams_from(1).closest, streams_from(0).closest);
  EXPECT_LT(streams_from(1).occluded, streams_from(0).occluded);
}

// A square of cells, two triangles each, at z = 0.
Mesh square_of(std::uint32_t cells) {
  Mesh mesh;
  for (std::uint32_t i = 0; i <= cells; ++i)
    for (std::uint32_t k = 0; k <= cells; ++k) {
      const auto place = [&](std::uint32_t x) {
        return static_cast<float>(x) / static_cast<float>(cells) - 0.5f;
      };
      mesh.vertices.push_back({place(i), place(k), 0});
    }
  for (std::uint32_t i = 0; i < cells; ++i)
    for (std::uint32_t k = 0; k < cells; ++k) {
      const std::uint32_t a = i * (cells + 1) + k, b = a + cells + 1;
      mesh.triangles.insert(mesh.triangles.end(), {{a, b, a + 1}, {a + 1, b, b + 1}});
    }
  return mesh;
}
// To the middles of `side` × `side` squares of it: from a point, to that point, or side by side.
std::vector<Ray> rays_to_square(std::uint32_t side, SharedApex shared) {
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < side; ++i)
    for (std::uint32_t k = 0; k < side; ++k) {
      const auto place = [&](std::uint32_t x) {
        return (static_cast<float>(x) + 0.5f) / static_cast<float>(side) - 0.5f;
      };
      const float x = place(i), y = place(k), distance = 3;
      if (shared == SharedApex::origin) rays.push_back(make_ray({0, 0, distance}, {x, y, -distance}));
      if (shared == SharedApex::end) rays.push_back({{x, y, 0.001f}, 0, {-x, -y, distance}, 1});
      if (shared == SharedApex::none) rays.push_back(make_ray({x, y, distance}, {0, 0, -1}));
    }
  return rays;
}

// As doubles, far away.
Double3 far_away(const Float3& p) {
  return {p[0] + 5e6, p[1] - 4e6, double{p[2]}};
}
std::vector<RayD> far_away(const std::vector<Ray>& rays) {
  std::vector<RayD> doubles;
  for (const auto& [o, tmin, d, tmax] : rays)
    doubles.push_back({far_away(o), double{tmin}, {double{d[0]}, double{d[1]}, double{d[2]}}, double{tmax}});
  return doubles;
}
BvhDArrays far_away(const Mesh& mesh) {
  std::vector<Double3> vertices;
  for (const Float3& vertex : mesh.vertices) vertices.push_back(far_away(vertex));
  return build_bvh_d(vertices, mesh.triangles, {});
}

// As many as there are for each ray. The square is seen under 19 degrees, so that solid angles of equal squares differ
// by cos³ of 13.5 degrees, 8 %. Corners of the sample's rectangle are rounded by as much, and 64 places spread evenly
// leave 5 % of a variance.
TEST(Routing, estimates_how_many_triangles_a_ray_has) {
  for (const SharedApex shared : {SharedApex::origin, SharedApex::end, SharedApex::none})
    for (const std::uint32_t side : {50u, 64u, 128u}) {
      const std::vector<Ray> rays = rays_to_square(side, shared);
      for (const std::uint32_t cells : {10u, 40u}) {
        const Bvh bvh(square_of(cells));
        const Float3 point{0, 0, shared == SharedApex::end ? 3.001f : 3.0f};
        const KernelTable& kernels = kernels_of(paths().front());
        const double expected = 2.0 * cells * cells / (side * side),
                     found =
                         triangles_of_a_ray<float>(TreeAccess::traced(bvh).view,
                                                   kernels.traversal.nearest_triangle, rays, shared, point)
                             .mean,
                     of_doubles = triangles_of_a_ray<double>(far_away(square_of(cells)).view(),
                                                             kernels.doubles.nearest_triangle, far_away(rays),
                                                             shared, far_away(point))
                                      .mean;
        EXPECT_GT(found, expected / 1.25) << side << ' ' << cells << ' ' << static_cast<int>(shared);
        EXPECT_LT(found, expected * 1.25) << side << ' ' << cells << ' ' << static_cast<int>(shared);
        EXPECT_NEAR(of_doubles, found, 1e-3 * found);
      }
    }
}

// Views without triangles, and rays without numbers.
TEST(Routing, estimates_something_of_any_rays) {
  const Bvh bvh(square_of(10));
  const TreeView view = TreeAccess::traced(bvh).view;
  const auto nearest = kernels_of(paths().front()).traversal.nearest_triangle;
  for (const float x : {0.0f, nan, infinity, 1e38f, 1e-45f})
    for (const std::size_t n : {3u, 64u, 4096u})
      for (const SharedApex shared : {SharedApex::origin, SharedApex::end, SharedApex::none}) {
        const std::vector<Ray> rays(n, make_ray({x, x, 3}, {x, 0, 1}));
        for (const bool by_origins : {false, true}) {
          const TrianglesOfRays found =
              triangles_of_a_ray<float>(view, nearest, rays, shared, {x, x, 3}, by_origins);
          EXPECT_TRUE(found.mean >= 0 && found.mean <= 8 && found.middle >= 0) << x << ' ' << n;
        }
      }
}

class CountedRouting : public Counting {};

TraceCounters counts_of(const Bvh& bvh, const std::vector<Ray>& rays, bool only_decides,
                        TraceOptions options) {
  TraceCounters counters;
  options.counters = &counters;
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  only_decides ? bvh.occluded(rays, occluded, options) : bvh.closest(rays, hits, options);
  return counters;
}
bool flies_on(const Path& path) {
  return path.required.contains({CpuFeature::avx2, CpuFeature::fma});
}

// By what the modes cost: packets where rays are dense, streams where they are not, also by a hint.
TEST_F(CountedRouting, takes_packets_of_dense_rays) {
  for (const SharedApex shared : {SharedApex::origin, SharedApex::end, SharedApex::none})
    for (const bool dense : {true, false}) {
      const Bvh bvh(square_of(dense ? 4 : 120));
      const std::vector<Ray> rays = rays_to_square(64, shared);
      const bool only_decides = shared == SharedApex::end;
      const auto cost = [&](TraversalMode mode, BatchHint hint) {
        return counts_of(bvh, rays, only_decides, {.mode = mode, .hint = hint});
      };
      const BatchHint hints[] = {BatchHint::shared_origin, BatchHint::shared_end, BatchHint::coherent};
      const TraceCounters packet = cost(TraversalMode::packet, BatchHint::none),
                          stream = cost(TraversalMode::stream, BatchHint::none);
      ASSERT_NE(packet, stream);
      for (const BatchHint hint : {BatchHint::none, hints[static_cast<std::size_t>(shared)]})
        EXPECT_EQ(cost(TraversalMode::automatic, hint), dense ? packet : stream)
            << static_cast<int>(shared) << (dense ? " dense" : "");
    }
}

// By what the modes cost: 32 rays are a packet in a narrow view of large triangles, and single rays elsewhere.
TEST_F(CountedRouting, takes_packets_of_few_rays_in_narrow_views) {
  for (const std::size_t count : {31u, 32u, 64u})
    for (const float distance : {1.0f, 30.0f})
      for (const std::uint32_t cells : {2u, 120u}) {
        const Bvh bvh(square_of(cells));
        std::vector<Ray> rays = rays_to_square(8, SharedApex::origin);
        rays.resize(count);
        for (auto& [origin, tmin, direction, tmax] : rays) origin[2] = distance, direction[2] = -distance;
        const auto cost = [&](TraversalMode mode) { return counts_of(bvh, rays, false, {.mode = mode}); };
        ASSERT_NE(cost(TraversalMode::single), cost(TraversalMode::stream));
        ASSERT_NE(cost(TraversalMode::single), cost(TraversalMode::packet));
        const bool is_packet = count >= 32 && distance == 30 && cells == 2;
        EXPECT_EQ(cost(TraversalMode::automatic),
                  cost(is_packet ? TraversalMode::packet : TraversalMode::single))
            << count << ' ' << distance << ' ' << cells;
      }
}

// From the middles of such squares, in directions that have nothing in common.
std::vector<Ray> rays_from_square(std::uint32_t side) {
  Random random(2803);
  std::vector<Ray> rays = rays_to_square(side, SharedApex::none);
  for (auto& [origin, tmin, direction, tmax] : rays) origin[2] = 0.01f, direction = random.point(1);
  return rays;
}

// Coherent rays from a point, 128 or 32 triangles for each, or 6; and rays that have nothing in common.
TEST_F(CountedRouting, lets_rays_go_alone_where_they_are_far_apart) {
  struct Case {
    bool coherent;
    std::uint32_t side, cells;
    bool alone, alone_in_flight;
  };
  const Case cases[] = {{true, 40, 320, true, true},
                        {true, 80, 320, false, true},
                        {true, 40, 70, false, false},
                        {false, 40, 320, true, true},
                        {false, 40, 20, false, false}};
  for (const auto& [coherent, side, cells, alone, alone_in_flight] : cases) {
    const std::vector<Ray> rays =
        coherent ? rays_to_square(side, SharedApex::origin) : rays_from_square(side);
    const Bvh bvh(square_of(cells));
    for (const Path* path : supported_paths())
      for (const bool only_decides : {false, true}) {
        const auto cost = [&](TraversalMode mode) {
          return counts_of(bvh, rays, only_decides, {.mode = mode, .path = path});
        };
        const bool is_single = flies_on(*path) ? alone_in_flight : alone;
        ASSERT_NE(cost(TraversalMode::single), cost(TraversalMode::stream));
        EXPECT_EQ(cost(TraversalMode::automatic),
                  cost(is_single ? TraversalMode::single : TraversalMode::stream))
            << path->name << ' ' << cells << (coherent ? " coherent" : "") << (only_decides ? " any" : "");
      }
  }
}

// By what the modes cost, which is never the same. Rays begin near each other, so that they meet together.
TEST_F(CountedRouting, begins_streams_where_the_tree_says) {
  Random random(2802);
  for (const Path* path : supported_paths())
    for (const bool large : {false, true}) {
      const Bvh bvh(small_triangles(large));
      const StreamSizes sizes = sizes_of(bvh);
      for (const std::size_t size : {std::size_t{sizes.closest}, std::size_t{sizes.occluded}})
        for (const std::size_t n : {size - 1, size}) {
          std::vector<Ray> rays;
          for (std::size_t i = 0; i < n; ++i) rays.push_back(make_ray(random.point(0.001f), random.point(1)));
          for (const bool only_decides : {false, true}) {
            const auto cost = [&](TraversalMode mode) {
              return counts_of(bvh, rays, only_decides, {.mode = mode, .path = path});
            };
            const bool streams = n >= (only_decides ? sizes.occluded : sizes.closest);
            ASSERT_NE(cost(TraversalMode::single), cost(TraversalMode::stream));
            EXPECT_EQ(cost(TraversalMode::automatic),
                      cost(streams ? TraversalMode::stream : TraversalMode::single))
                << path->name << ' ' << n << (only_decides ? " any" : " nearest");
          }
        }
    }
}

}  // namespace
}  // namespace raylanes::testing
