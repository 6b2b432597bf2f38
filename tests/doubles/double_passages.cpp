// The next passage of rays of doubles through a surface: rational numbers say which hits are passages.
#include <gtest/gtest.h>

#include "../oracles/passage_oracle.hpp"
#include "../oracles/peeled.hpp"
#include "../support/supported_paths.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

TEST(DoublePassages, are_hits_that_cross_and_no_glances) {
  std::size_t touched = 0;
  for (const DoubleCase& c : double_cases(by_level<std::size_t>(60, 120, 600))) {
    const PassingRays of(c.mesh, c.rays);
    const BvhD tree(c.mesh.vertices, c.mesh.triangles);
    for (const Facing facing : {Facing::any, Facing::front, Facing::back})
      for (const bool skips : {false, true}) {
        const auto expected = of.passages(facing, skips);
        for (const Path* path : paths_with_own_queries())
          for (const int threads : {1, 2}) {
            TraceOptionsD options{.path = path, .threads = threads, .facing = facing};
            if (skips) options.skip = of.skip;
            expect_peeled(c.rays, expected, options, passages_of(tree, c.rays, of.skip));
          }
      }
    touched += of.touches;
  }
  EXPECT_GT(touched, 50u);
}

TEST(DoublePassages, are_refused_for_wrong_options) {
  const DoubleMesh mesh = moved(cube(-1, 1), 1, {0, 0, 0});
  const BvhD tree(mesh.vertices, mesh.triangles);
  const std::vector<RayD> rays(3, RayD{{0, 0, 5}, 0, {0, 0, -1}, 9});
  std::vector<HitD> hits(3);
  const std::vector<std::uint32_t> two(2);
  EXPECT_THROW(tree.closest_crossing(rays, hits, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(tree.closest_crossing(rays, std::span(hits).first(2)), std::invalid_argument);
  EXPECT_THROW(tree.closest_crossing(rays[0], {.threads = -1}), std::invalid_argument);
  EXPECT_FALSE(BvhD().closest_crossing(rays[0]));
}

}  // namespace
}  // namespace raylanes::testing
