// Changes that must not affect the results of a triangle test: order of corners, signs of zeros, lengths of directions.
#include "../support/float_modes.hpp"
#include "../support/random_input.hpp"
#include "judge/triangle_answers.hpp"
#include "judge/triangle_judge.hpp"

namespace raylanes::testing {
namespace {

constexpr Aim aims[] = {Aim::anywhere, Aim::edge, Aim::corner, Aim::off_edge, Aim::far};

// Calls check(variant) for every variant in both float modes.
template <class Check>
void in_all_ways(Check check) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    SCOPED_TRACE(name_of(mode));
    for (const TriangleVariant& variant : all_variants<TriangleTest>()) check(variant);
  }
}

// Rounding depends on the order of the corners; what it cannot touch does not. Decisions of tests that never leak do
// not depend on it at all, on the whole line.
TEST(TriangleSymmetries, the_order_of_corners_changes_nothing_beyond_rounding) {
  Random random(108);
  for (int round = 0; round < by_level(1, 2, 5); ++round)
    for (const TriangleTest test :
         {TriangleTest::plane_edges_plain, TriangleTest::plane_edges, TriangleTest::moller_trumbore,
          TriangleTest::exact, TriangleTest::watertight, TriangleTest::precomputed}) {
      TriangleScene scene = aimed_scene(aims[round], 10, 2, random);
      for (Ray& ray : scene.rays) ray.tmin = -infinity, ray.tmax = infinity;
      for (const Triangle& triangle : scene.triangles) {
        const std::vector<Triangle> orders = corner_orders(triangle);
        std::vector<TriangleJudgement> judgements;
        for (const Triangle& order : orders)
          for (const Ray& ray : scene.rays) judgements.push_back(judge(test, ray, order));
        for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
          // The same bits as moller_trumbore, see triangle_decisions.cpp.
          if (variant.test != test) continue;
          const Results results = answers(variant, scene.rays, orders);
          for (std::size_t i = 0; i < results.size(); ++i) {
            const Ray& ray = scene.rays[i % 10];
            ASSERT_EQ(fault(results[i], ray, judgements[i]), "") << variant.name() << " order " << i / 10;
            if (never_leaks(test)) {
              ASSERT_EQ(results[i].hit, results[i % 10].hit) << variant.name() << " order " << i / 10;
            }
          }
        }
      }
    }
}

TEST(TriangleSymmetries, the_length_of_the_direction_scales_t_only) {
  Random random(109);
  TriangleScene scene = scene_for_all_widths(Aim::anywhere, random);
  for (Ray& ray : scene.rays) ray.tmin = -infinity, ray.tmax = infinity;
  in_all_ways([&](const TriangleVariant& variant) {
    const Results results = answers(variant, scene.rays, scene.triangles);
    for (const int exponent : {-40, -20, 7, 40}) {
      TriangleScene longer = scene;
      for (Ray& ray : longer.rays)
        for (float& x : ray.direction) x = std::ldexp(x, exponent);
      Results expected = results;
      for (TriangleResult& r : expected)
        if (r.hit != 0) r.t = std::ldexp(r.t, -exponent);
      ASSERT_EQ(answers(variant, longer.rays, longer.triangles), expected)
          << variant.name() << " 2^" << exponent;
    }
  });
}

// Directions with one and with two zeros, along and against each axis, with each sign of each zero.
TEST(TriangleSymmetries, the_signs_of_zeros_in_the_direction_change_no_bit) {
  Random random(110);
  for (std::size_t zero = 0; zero < 3; ++zero)
    for (const bool two : {false, true}) {
      const std::size_t other = (zero + 1) % 3, major = (zero + 2) % 3;
      TriangleScene plus;
      for (int i = 0; i < 5; ++i) plus.triangles.push_back(random.triangle(1));
      for (int i = 0; i < 20; ++i) {
        Float3 origin = random.point(0.5f), direction{};
        direction[major] = random.chance(0.5) ? 1.5f : -1.5f;
        direction[other] = two ? 0.0f : random.number(-1, 1);
        plus.rays.push_back(make_ray(origin, direction, -infinity));
      }
      TriangleScene minus = plus;
      for (Ray& ray : minus.rays) {
        ray.direction[zero] = -0.0f;
        if (two && random.chance(0.5)) ray.direction[other] = -0.0f;
      }
      std::size_t hits = 0;
      in_all_ways([&](const TriangleVariant& variant) {
        const Results results = answers(variant, plus.rays, plus.triangles);
        ASSERT_EQ(answers(variant, minus.rays, minus.triangles), results) << variant.name() << zero << two;
        for (const TriangleResult& r : results) hits += r.hit != 0;
      });
      if (HasFatalFailure()) return;
      EXPECT_GT(hits, 0u) << "the rays are aimed badly";
    }
}

}  // namespace
}  // namespace raylanes::testing
