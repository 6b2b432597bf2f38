// How batches in mode automatic are traced: by streams from as many rays on as the tree says.
#include "../../accel/batch/routing.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "../../accel/queries/traced_tree.hpp"
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
  return TreeOf::bvh(bvh).view.streams_from;
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

class CountedRouting : public Counting {};

// By what the modes cost, which is never the same.
TEST_F(CountedRouting, begins_streams_where_the_tree_says) {
  Random random(2802);
  for (const bool large : {false, true}) {
    const Bvh bvh(small_triangles(large));
    const StreamSizes sizes = sizes_of(bvh);
    for (const std::size_t size : {std::size_t{sizes.closest}, std::size_t{sizes.occluded}})
      for (const std::size_t n : {size - 1, size}) {
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < n; ++i) rays.push_back(make_ray(random.point(1), random.point(1)));
        const auto cost = [&](TraversalMode mode, bool only_decides) {
          TraceCounters counters;
          std::vector<Hit> hits(n);
          std::vector<std::uint8_t> occluded(n);
          const TraceOptions options{.mode = mode, .counters = &counters};
          only_decides ? bvh.occluded(rays, occluded, options) : bvh.closest(rays, hits, options);
          return counters;
        };
        for (const bool only_decides : {false, true}) {
          const bool streams = n >= (only_decides ? sizes.occluded : sizes.closest);
          const TraceCounters single = cost(TraversalMode::single, only_decides),
                              stream = cost(TraversalMode::stream, only_decides);
          ASSERT_NE(single, stream);
          EXPECT_EQ(cost(TraversalMode::automatic, only_decides), streams ? stream : single)
              << n << (only_decides ? " any" : " nearest");
        }
      }
  }
}

}  // namespace
}  // namespace raylanes::testing
