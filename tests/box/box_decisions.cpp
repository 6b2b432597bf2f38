// All box tests on every path: each within its rounding of exact slabs, the directional one without a false miss
// and with false hits only where its padding reaches; the conservative one by a sharper bound too, and with the same
// bits in both grades.
#include "box_answers.hpp"
#include "box_judge.hpp"

namespace raylanes::testing {
namespace {

using Results = std::vector<IntervalResult>;
using Tests = std::vector<BoxTest>;
const Tests all_tests{BoxTest::conservative, BoxTest::plain, BoxTest::directional},
    conservative_alone{BoxTest::conservative};

// Pairs as a scene has them; in a fifth of them the ray grazes the box.
struct Shares {
  std::size_t pairs = 0, hits = 0, open[std::size(box_tests)] = {};
  std::size_t sharply_open = 0, false_hits = 0;  // of the conservative test
  double of_open(BoxTest test) const {
    return static_cast<double>(open[static_cast<std::size_t>(test)]) / static_cast<double>(pairs);
  }
};

void check_conservative(const BoxVariant& variant, const BoxScene& scene, const Results& results,
                        const std::vector<BoxJudgement>& judgements) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Ray& ray = scene.ray(i);
    ASSERT_EQ(fault(results[i], judgements[i].exact), "")
        << variant.name() << " pair " << i << " o " << ray.origin[0] << ' ' << ray.origin[1] << ' '
        << ray.origin[2] << " d " << ray.direction[0] << ' ' << ray.direction[1] << ' ' << ray.direction[2];
  }
}

void check(const BoxScene& scene, const Tests& tests, Shares& shares) {
  std::vector<BoxJudgement> judgements;
  for (std::size_t i = 0; i < scene.size(); ++i)
    judgements.push_back(judge(scene.ray(i), scene.primitive(i)));
  shares.pairs += judgements.size();
  for (const BoxJudgement& j : judgements) {
    shares.hits += j.exact.hit;
    shares.sharply_open += is_open(j.exact);
    for (std::size_t test = 0; test < std::size(box_tests); ++test)
      shares.open[test] += is_open(static_cast<BoxTest>(test), j);
  }
  for (const FloatMode mode : float_modes) {
    std::optional<Results> conservative;
    for (const BoxVariant& variant : all_variants<BoxTest>()) {
      if (std::find(tests.begin(), tests.end(), variant.test) == tests.end()) continue;
      const Results results = answers(variant, scene.rays, scene.primitives, mode);
      for (std::size_t i = 0; i < results.size(); ++i)
        ASSERT_EQ(fault(variant.test, results[i], scene.ray(i), scene.primitive(i), judgements[i]), "")
            << variant.name() << ' ' << name_of(mode) << " pair " << i;
      if (variant.test != BoxTest::conservative) continue;
      if (conservative) {
        ASSERT_EQ(results, *conservative) << variant.name() << ' ' << name_of(mode);
        continue;
      }
      conservative = results;
      if (mode == FloatMode::flush) continue;
      check_conservative(variant, scene, results, judgements);
      for (std::size_t i = 0; i < results.size(); ++i)
        shares.false_hits += !judgements[i].exact.hit && results[i].hit != 0;
    }
  }
}

// The distance of the origins, and the share of pairs that are decided by rounding: outside, the generator
// has lost its point.
struct GrazingCase {
  float scale;
  bool sun;
  double min_open, max_open;
};

class GrazedBoxes : public ::testing::TestWithParam<GrazingCase> {};

TEST_P(GrazedBoxes, are_decided_as_the_contracts_say) {
  const GrazingCase& c = GetParam();
  Random random(201);
  Shares shares;
  // Most rounds for the test that trees stand on.
  for (int round = 0; round < (c.sun ? 12 : by_level(400, 150, 400)) / (quick() ? 12 : 1); ++round) {
    const bool first = round < (quick() ? 1 : 12);
    check(grazing_scene(50, 5, c.scale, c.sun, random), first ? all_tests : conservative_alone, shares);
    if (HasFailure()) return;
  }
  EXPECT_GT(shares.hits, quick() ? 1u : c.sun ? 50u : 1000u) << "the rays are aimed badly";
  if (quick()) return;
  for (const BoxTest test : {BoxTest::conservative, BoxTest::directional}) {
    EXPECT_GE(shares.of_open(test), c.min_open);
    EXPECT_LE(shares.of_open(test), c.max_open);
  }
  // Hits may be missed too, of rays that lie in faces most of all.
  EXPECT_GE(shares.of_open(BoxTest::plain), 0.12);
  EXPECT_LE(shares.of_open(BoxTest::plain), c.max_open + 0.25);
  EXPECT_LE(shares.false_hits, shares.sharply_open);
}

// Far away rounding reaches across the boxes.
INSTANTIATE_TEST_SUITE_P(
    Distances, GrazedBoxes,
    ::testing::Values(GrazingCase{1e0f, false, 0.05, 0.12}, GrazingCase{1e1f, false, 0.05, 0.12},
                      GrazingCase{1e2f, false, 0.05, 0.12}, GrazingCase{1e3f, false, 0.05, 0.12},
                      GrazingCase{1e4f, false, 0.05, 0.15}, GrazingCase{1e5f, false, 0.1, 0.3},
                      GrazingCase{1e6f, false, 0.4, 0.8}, GrazingCase{1e7f, false, 0.6, 0.95}));
// Rays in the planes of faces are hits exactly.
INSTANTIATE_TEST_SUITE_P(SunAlongAnAxis, GrazedBoxes,
                         ::testing::Values(GrazingCase{1e0f, true, 0, 0.01}, GrazingCase{1e1f, true, 0, 0.01},
                                           GrazingCase{1e3f, true, 0, 0.01},
                                           GrazingCase{1e5f, true, 0, 0.01}));

void shorten_some(Ray& ray, Random& random) {
  if (random.chance(0.3)) ray.tmin = random.number(0, 3);
  if (random.chance(0.3)) ray.tmax = random.number(0, 3);
}

TEST(Boxes, anywhere_are_decided_by_exact_slabs) {
  Random random(204);
  Shares thick, flat;  // a ray enters a flat box and leaves it at one distance: rounding decides
  for (int round = 0; round < by_level(5, 10, 30); ++round) {
    const bool is_flat = round % 5 == 4;
    BoxScene scene;
    for (int i = 0; i < 7; ++i) scene.primitives.push_back(random_box(random, is_flat ? 0.4 : 0));
    for (int i = 0; i < 30; ++i) {
      const Float3 from = random.point(2);
      Ray ray = make_ray(from, random.point(1));
      if (random.chance(0.3)) ray.direction[random.integer(0, 2)] = random.chance(0.5) ? 0.0f : -0.0f;
      shorten_some(ray, random);
      scene.rays.push_back(ray);
    }
    check(scene, all_tests, is_flat ? flat : thick);
    if (HasFailure()) return;
  }
  EXPECT_GT(thick.hits, thick.pairs / 200);
  EXPECT_GT(flat.pairs, 0u);
  EXPECT_EQ(thick.false_hits + flat.false_hits, 0u);
  // Rounding decided none of half a million pairs by other seeds.
  for (const BoxTest test : all_tests) EXPECT_EQ(thick.of_open(test), 0) << "random rays graze nothing";
}

TEST(Boxes, grazed_by_segments_are_decided_by_exact_slabs) {
  Random random(202);
  Shares shares;
  for (int round = 0; round < (quick() ? 1 : 10); ++round) {
    BoxScene scene;
    for (int i = 0; i < 21; ++i) {
      scene.primitives.push_back(random_box(random, 0.2));
      scene.rays.push_back(grazing_ray(scene.primitives.back(), 2, i % 3 == 0, random));
      shorten_some(scene.rays.back(), random);
    }
    check(scene, all_tests, shares);
    if (HasFailure()) return;
  }
}

// The plain test must be seen to miss: else the conservative one's widening would not be tested. Found by search.
TEST(Boxes, plain_slabs_miss_what_conservative_ones_keep) {
  const Ray rays[] = {make_ray({-2, -1.5f, 0}, {0.644531f, 0.708984f, 0}),
                      make_ray({-1.25f, -0.75f, 0}, {0.587891f, 0.0839844f, 0})};
  const Box boxes[] = {{{-2, -0.125f, -1}, {-0.75f, 1, 1}}, {{-1, -0.625f, -1}, {-0.375f, 0, 1}}};
  Shares shares;
  for (std::size_t i = 0; i < 2; ++i) {
    check({{rays[i]}, {boxes[i]}}, conservative_alone, shares);
    for (const BoxVariant& variant : all_variants<BoxTest>()) {
      const bool hit = answers(variant, {&rays[i], 1}, {&boxes[i], 1})[0].hit != 0;
      if (variant.test != BoxTest::plain) {
        EXPECT_TRUE(hit) << variant.name() << ' ' << i;
      } else if (i == 0) {
        EXPECT_FALSE(hit) << variant.name() << ' ' << i;
      }
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
