// The conservative box test on every path against exact rational slabs, by a bound sharper than what all tests are held
// to: aimed at edges and anywhere.
#include <gtest/gtest.h>

#include <vector>

#include "answers.hpp"
#include "judge.hpp"

namespace raylanes::testing {
namespace {

using Results = std::vector<BoxResult>;
using oracle::exact_interval;
using oracle::ExactInterval;

// Every ray against every box by each conservative test: all bits alike, whatever the grade, and right by the oracle.
// Returns the numbers of pairs, exact hits, false ones, and misses within rounding of a hit.
struct Counts {
  std::size_t pairs = 0, hits = 0, false_hits = 0, open = 0;
};
Counts check(const std::vector<Ray>& rays, const std::vector<Box>& boxes) {
  const std::vector<BoxVariant> variants = conservative_variants();
  const Results results = answers(variants[0], rays, boxes);
  for (const BoxVariant& variant : variants)
    EXPECT_EQ(answers(variant, rays, boxes), results) << variant.name();
  Counts counts;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Ray& ray = rays[i % rays.size()];
    const Box& box = boxes[i / rays.size()];
    const ExactInterval exact = exact_interval(ray, box);
    ++counts.pairs;
    counts.hits += exact.hit;
    counts.open += is_open(exact);
    counts.false_hits += !exact.hit && results[i].hit != 0;
    EXPECT_EQ(fault(results[i], exact), "")
        << "ray " << i % rays.size() << " o " << ray.origin[0] << ' ' << ray.origin[1] << ' ' << ray.origin[2]
        << " d " << ray.direction[0] << ' ' << ray.direction[1] << ' ' << ray.direction[2] << " box "
        << i / rays.size();
  }
  return counts;
}

class BoxesFarAway : public ::testing::TestWithParam<float> {};

TEST_P(BoxesFarAway, are_never_missed_by_rays_that_graze_them) {
  Random random(3);
  Counts total;
  for (int round = 0; round < (quick() ? 4 : 400); ++round) {
    const BoxScene scene = grazing_scene(50, 5, GetParam(), false, random);
    const Counts counts = check(scene.rays, scene.boxes);
    total.pairs += counts.pairs, total.hits += counts.hits, total.false_hits += counts.false_hits;
    total.open += counts.open;
    if (HasFailure()) return;
  }
  EXPECT_GT(total.hits, quick() ? 20u : 1000u) << "the rays are aimed badly";
  if (quick()) return;
  const double share_open = static_cast<double>(total.open) / static_cast<double>(total.pairs);
  // A fifth of the pairs are aimed at each other; from far away rounding reaches across the boxes.
  EXPECT_GE(share_open, 0.05);
  EXPECT_LE(share_open, GetParam() < 5e5f ? 0.15 : 0.85);
  EXPECT_LE(total.false_hits, total.open);
}

INSTANTIATE_TEST_SUITE_P(Scales, BoxesFarAway,
                         ::testing::Values(1e0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f, 1e7f));

TEST(ConservativeBoxes, anywhere_are_hit_exactly) {
  Random random(4);
  std::vector<Box> boxes;
  std::vector<Ray> rays;
  for (int i = 0; i < (quick() ? 20 : 60); ++i) boxes.push_back(random_box(random, 0.1));
  for (int i = 0; i < 100; ++i) {
    Ray ray = make_ray(random.point(2), random.point(1));
    if (random.chance(0.3)) ray.direction[random.integer(0, 2)] = random.chance(0.5) ? 0.0f : -0.0f;
    if (random.chance(0.3)) ray.tmin = random.number(0, 3);
    if (random.chance(0.3)) ray.tmax = random.number(0, 3);
    rays.push_back(ray);
  }
  const Counts counts = check(rays, boxes);
  EXPECT_GT(counts.hits, 10u);
  EXPECT_EQ(counts.false_hits, 0u) << "random rays graze nothing";
}

// Rays that the plain slab test, without widening, misses; found by search.
TEST(ConservativeBoxes, keep_corners_that_rounding_would_miss) {
  const Ray rays[] = {make_ray({-2, -1.5f, 0}, {0.644531f, 0.708984f, 0}),
                      make_ray({-1.25f, -0.75f, 0}, {0.587891f, 0.0839844f, 0})};
  const Box boxes[] = {{{-2, -0.125f, -1}, {-0.75f, 1, 1}}, {{-1, -0.625f, -1}, {-0.375f, 0, 1}}};
  for (std::size_t i = 0; i < 2; ++i) check({rays[i]}, {boxes[i]});
}

TEST(ConservativeBoxes, have_the_same_bits_in_both_grades) {
  Random random(202);
  for (int round = 0; round < (quick() ? 1 : 10); ++round) {
    std::vector<Box> boxes;
    std::vector<Ray> rays;
    for (int i = 0; i < 21; ++i) boxes.push_back(random_box(random, 0.2));
    for (std::size_t i = 0; i < 21; ++i) {
      Ray ray = grazing_ray(boxes[i], 2, i % 3 == 0, random);
      if (random.chance(0.3)) ray.tmin = random.number(0, 3);
      if (random.chance(0.3)) ray.tmax = random.number(0, 3);
      rays.push_back(ray);
    }
    const std::vector<BoxVariant> variants = conservative_variants();
    for (const FloatMode mode : float_modes) {
      const Results first = answers(variants[0], rays, boxes, mode);
      for (const BoxVariant& variant : variants)
        ASSERT_EQ(answers(variant, rays, boxes, mode), first) << variant.name() << ' ' << name_of(mode);
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
