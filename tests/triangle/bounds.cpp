// All triangle tests against exact arithmetic: right outside the derived bound of each, and how many cases that
// leaves open; the canonical test byte for byte, and exact signs of the watertight one.
#include "../support/float_modes.hpp"
#include "../support/random_input.hpp"
#include "../traverse/reference/reference_tracer.hpp"
#include "judge/triangle_answers.hpp"
#include "judge/triangle_judge.hpp"

namespace raylanes::testing {
namespace {

struct Shares {
  std::size_t pairs = 0, either = 0, must_hit = 0;
  double of_either() const { return static_cast<double>(either) / static_cast<double>(pairs); }
  double of_hits() const { return static_cast<double>(must_hit) / static_cast<double>(pairs); }
};

// Judges each pair of the scene once, and the answers of every path, grade and float mode to it.
void check(TriangleTest test, const TriangleScene& scene, Shares& shares) {
  std::vector<TriangleJudgement> judgements;
  for (std::size_t i = 0; i < scene.size(); ++i)
    judgements.push_back(judge(test, scene.ray(i), scene.triangle(i)));
  shares.pairs += judgements.size();
  for (const TriangleJudgement& j : judgements) {
    shares.either += j.decision == oracle::Class::either;
    shares.must_hit += j.decision == oracle::Class::must_hit;
  }
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    if (variant.test != test) continue;
    for (const FloatMode mode : float_modes) {
      const Results results = answers(variant, scene.rays, scene.triangles, mode);
      for (std::size_t i = 0; i < results.size(); ++i)
        ASSERT_EQ(fault(results[i], scene.ray(i), judgements[i]), "")
            << variant.name() << ' ' << name_of(mode) << " pair " << i;
    }
  }
}

// The share of pairs that may go either way: outside of these, the generator has lost its point. A 19th of
// the pairs are of a ray and the triangle it is aimed at.
struct AimCase {
  TriangleTest test;
  Aim aim;
  double min_either, max_either;
};

class AimedTriangles : public ::testing::TestWithParam<AimCase> {};

TEST_P(AimedTriangles, are_right_outside_their_bound) {
  const AimCase& c = GetParam();
  Random random(103 + static_cast<std::uint64_t>(c.aim));
  Shares shares;
  for (int round = 0; round < by_level(1, 3, 8); ++round) {
    check(c.test, scene_for_all_widths(c.aim, random), shares);
    if (HasFailure()) return;
  }
  if (quick()) return;
  EXPECT_GE(shares.of_either(), c.min_either);
  EXPECT_LE(shares.of_either(), c.max_either);
}

constexpr TriangleTest plain = TriangleTest::plane_edges_plain, planes = TriangleTest::plane_edges,
                       rows = TriangleTest::precomputed;
INSTANTIATE_TEST_SUITE_P(
    OnPlanes, AimedTriangles,
    ::testing::Values(AimCase{plain, Aim::anywhere, 0, 0.001}, AimCase{plain, Aim::edge, 0.02, 0.08},
                      AimCase{plain, Aim::corner, 0.02, 0.08}, AimCase{plain, Aim::off_edge, 0.002, 0.03},
                      AimCase{plain, Aim::far, 0.005, 0.05}, AimCase{planes, Aim::anywhere, 0, 0.001},
                      AimCase{planes, Aim::edge, 0.02, 0.08}, AimCase{planes, Aim::corner, 0.02, 0.08},
                      AimCase{planes, Aim::off_edge, 0.002, 0.03}, AimCase{planes, Aim::far, 0.005, 0.05}));
INSTANTIATE_TEST_SUITE_P(Precomputed, AimedTriangles,
                         ::testing::Values(AimCase{rows, Aim::anywhere, 0, 0.001},
                                           AimCase{rows, Aim::edge, 0.02, 0.08},
                                           AimCase{rows, Aim::corner, 0.02, 0.08},
                                           AimCase{rows, Aim::off_edge, 0, 0.02},
                                           AimCase{rows, Aim::far, 0, 0.002}));

// --- Tests by determinants

TriangleResult to_result(const Hit& hit) {
  return {hit.t, hit.u, hit.v, hit.primitive == no_primitive ? 0 : hit_flag};
}

// In the reproducible grade the watertight test is the canonical one, byte for byte.
void expect_canonical(const TriangleScene& scene) {
  Results canonical;
  for (std::size_t i = 0; i < scene.size(); ++i)
    canonical.push_back(to_result(canonical_hit(scene.ray(i), scene.triangle(i))));
  for (const TriangleVariant& variant : all_variants<TriangleTest>())
    if (variant.test == TriangleTest::watertight && variant.grade == Grade::reproducible)
      expect_all(scene, canonical, variant);
}

// Tests by determinants, at more that is hard; a fifth of the pairs are of a ray and the triangle it is aimed at.
struct HardCase {
  Aim aim;
  double min_either, max_either;
};

class HardTriangles : public ::testing::TestWithParam<HardCase> {};

TEST_P(HardTriangles, are_decided_right_and_alike) {
  Random random(21 + static_cast<std::uint64_t>(GetParam().aim));
  Shares shares, of_exact;
  for (int round = 0; round < by_level(2, 15, 40); ++round) {
    const TriangleScene scene = aimed_scene(GetParam().aim, 35, 5, random);
    expect_canonical(scene);
    for (const TriangleTest test : {TriangleTest::watertight, TriangleTest::moller_trumbore})
      check(test, scene, shares);
    check(TriangleTest::exact, scene, of_exact);
    if (HasFailure()) return;
  }
  EXPECT_EQ(of_exact.of_either(), 0);
  if (quick()) return;
  EXPECT_GE(shares.of_either(), GetParam().min_either);
  EXPECT_LE(shares.of_either(), GetParam().max_either);
}

INSTANTIATE_TEST_SUITE_P(Aims, HardTriangles,
                         ::testing::Values(HardCase{Aim::anywhere, 0, 0.001}, HardCase{Aim::edge, 0.1, 0.2},
                                           HardCase{Aim::corner, 0.1, 0.2}, HardCase{Aim::off_edge, 0, 0.05},
                                           HardCase{Aim::far, 0, 0.01},
                                           HardCase{Aim::small_and_distant, 0, 0.02},
                                           HardCase{Aim::beside_a_tiny_one, 0.01, 0.1},
                                           HardCase{Aim::tied_axes, 0, 0.01}));

TEST(WatertightTriangles, have_exact_signs_on_the_sheared_corners) {
  Random random(31);
  const std::vector<TriangleVariant> variants = all_variants<TriangleTest>();
  for (int round = 0; round < by_level(4, 300, 1500); ++round) {
    for (const Aim aim : {Aim::edge, Aim::corner, Aim::beside_a_tiny_one}) {
      TriangleScene scene = aimed_scene(aim, 35, 5, random);
      for (Ray& ray : scene.rays) ray.tmin = -infinity, ray.tmax = infinity;
      for (const TriangleVariant& variant : variants) {
        if (variant.test != TriangleTest::watertight) continue;
        const bool fused = variant.is_fused();
        const Results results = answers(variant, scene.rays, scene.triangles);
        for (std::size_t i = 0; i < scene.size(); ++i)
          ASSERT_EQ(results[i].hit != 0, axis_passes(shear_triangle(scene.ray(i), scene.triangle(i), fused)))
              << variant.name() << " pair " << i;
      }
    }
  }
}

// --- The ladder: rays at k times the bound from an edge, to either side

constexpr double rungs[] = {2, 4, 16, 100};

// Past the edge opposite to `corner`, at `from_edge` in barycentric weight.
Ray ray_beside_edge(const Float3& origin, const Triangle& triangle, std::size_t corner, double from_edge,
                    double along) {
  double weight[3];
  weight[corner] = from_edge;
  weight[(corner + 1) % 3] = (1 - from_edge) * along,
                        weight[(corner + 2) % 3] = (1 - from_edge) * (1 - along);
  return ray_to(origin, triangle, weight[1], weight[2]);
}

// One ray per edge, rung and side, each from a place of its own.
TriangleScene ladder(TriangleTest test, double rung, Random& random) {
  TriangleScene scene{{}, {random.triangle(1)}};
  const Triangle triangle = scene.triangles[0];
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t corner = i / 2;
    const double side = i % 2 == 0 ? 1 : -1, along = random.real(0.2, 0.8);
    const Float3 origin = random.point(2);
    const double bound =
        judge(test, ray_beside_edge(origin, triangle, corner, 0, along), triangle).weight[corner];
    // Views along the plane have no ladder: the step must stay small against the triangle.
    if (bound < 1e-3)
      scene.rays.push_back(ray_beside_edge(origin, triangle, corner, side * rung * bound, along));
  }
  return scene;
}

class TriangleLadder : public ::testing::TestWithParam<TriangleTest> {};

TEST_P(TriangleLadder, is_climbed_without_a_wrong_step) {
  for (const double rung : rungs) {
    SCOPED_TRACE(rung);
    Random random(104);
    Shares shares;
    for (int round = 0; round < by_level(2, 8, 25); ++round) {
      check(GetParam(), ladder(GetParam(), rung, random), shares);
      if (HasFailure()) return;
    }
    // The bound beside the edge is nearly that on it, and a direction rounds by less: all is decided.
    EXPECT_LE(shares.of_either(), 0.01);
    EXPECT_GE(shares.of_hits(), 0.4) << "half of the rays are on the inner side";
  }
}

// All but the exact test, the first, whose bound is zero.
INSTANTIATE_TEST_SUITE_P(Forms, TriangleLadder,
                         ::testing::ValuesIn(all_triangle_tests.begin() + 1, all_triangle_tests.end()),
                         [](const auto& each) { return name_of(each.param); });

}  // namespace
}  // namespace raylanes::testing
