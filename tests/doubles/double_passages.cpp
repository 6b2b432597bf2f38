// The next passage of rays of doubles through a surface: rational numbers say which hits are passages.
#include <gtest/gtest.h>

#include "../oracles/passage_oracle.hpp"
#include "../oracles/peeled.hpp"
#include "../support/supported_paths.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

// The rays of a case with their hits and crossings.
struct KnownRays {
  DoubleCase of;
  BvhD tree{of.mesh.vertices, of.mesh.triangles};
  std::vector<std::vector<HitD>> hits;
  std::vector<std::vector<CrossingD>> crossings;
  std::vector<std::uint32_t> skip;  // of each second ray one of its hits

  // From any side: of all triangles, and of all but those to skip.
  std::vector<std::vector<HitD>> all_passages[2];

  explicit KnownRays(const DoubleCase& c) : of(c) {
    for (const RayD& ray : of.rays) {
      const std::size_t i = hits.size();
      const std::vector<HitD>& all = hits.emplace_back(exact_double_hits(of.mesh, ray));
      crossings.push_back(exact_double_crossings(of.mesh, ray));
      skip.push_back(i % 2 == 0 || all.empty() ? no_primitive : all[i % all.size()].primitive);
      std::vector<HitD> left = all;
      all_passages[0].push_back(passages_among(i, left));
      std::erase_if(left, [&](const HitD& hit) { return hit.primitive == skip[i]; });
      all_passages[1].push_back(passages_among(i, left));
    }
  }
  // From one side, of all triangles but one.
  std::vector<HitD> passages(std::size_t i, Facing facing, bool skips) const {
    std::vector<HitD> passages = all_passages[skips][i];
    std::erase_if(passages, [&](const HitD& hit) {
      const auto own = std::ranges::find(crossings[i], hit.primitive, &CrossingD::primitive);
      return facing != Facing::any && own->side != (facing == Facing::front ? -1 : 1);
    });
    return passages;
  }

 private:
  std::vector<HitD> passages_among(std::size_t i, const std::vector<HitD>& left) const {
    return oracle_passages<Double3>(of.rays[i], left, crossings[i],
                                    [&](std::uint32_t primitive, Double3(&corners)[3]) {
                                      const DoubleCorners all = corners_of(of.mesh, primitive);
                                      std::copy(all.begin(), all.end(), corners);
                                    });
  }
};

void expect_passages(const KnownRays& known, Facing facing, bool skips) {
  const std::vector<RayD>& rays = known.of.rays;
  std::vector<std::vector<HitD>> expected;
  for (std::size_t i = 0; i < rays.size(); ++i) expected.push_back(known.passages(i, facing, skips));
  for (const Path* path : paths_with_own_queries())
    for (const int threads : {1, 2}) {
      TraceOptionsD options{.path = path, .threads = threads, .facing = facing};
      if (skips) options.skip = known.skip;
      expect_peeled(rays, expected, options, passages_of(known.tree, rays, known.skip));
    }
}

TEST(DoublePassages, are_hits_that_cross_and_no_glances) {
  std::size_t touched = 0;
  for (const DoubleCase& c : double_cases(by_level<std::size_t>(60, 300, 600))) {
    const KnownRays known(c);
    for (const Facing facing : {Facing::any, Facing::front, Facing::back})
      for (const bool skips : {false, true}) expect_passages(known, facing, skips);
    for (std::size_t i = 0; i < c.rays.size(); ++i)
      touched += known.hits[i].size() - known.passages(i, Facing::any, false).size();
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
