// The table's ray-triangle kernels on random triangles, with rays aimed at what is hard: the rational
// oracle's classes and bounds, the canonical test byte for byte, and exact signs of the watertight test.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "../support/random_input.hpp"
#include "../traverse/reference_tracer.hpp"
#include "judge.hpp"
#include "scenes.hpp"

namespace raylanes::testing {
namespace {

using Results = std::vector<TriangleResult>;

TriangleResult to_result(const Hit& hit) {
  return {hit.t, hit.u, hit.v, hit.primitive == no_primitive ? 0 : hit_flag};
}

// The share of pairs for which either answer is right.
double check_against_oracle(const TriangleScene& scene, TriangleTest test,
                            const std::vector<KernelVariant>& variants) {
  const TriangleForm form =
      test == TriangleTest::watertight ? TriangleForm::watertight : TriangleForm::moller_trumbore;
  std::vector<TriangleJudgement> judgements;
  for (std::size_t i = 0; i < scene.size(); ++i)
    judgements.push_back(judge(form, scene.ray(i), scene.triangle(i)));
  std::set<std::string> seen;  // results of equal bits are judged once
  for (const KernelVariant& variant : variants) {
    if (variant.test != test) continue;
    const Results results = many_rays(variant.kernels(), scene.rays, scene.triangles);
    const std::string bytes(reinterpret_cast<const char*>(results.data()),
                            results.size() * sizeof(TriangleResult));
    if (!seen.insert(bytes).second) continue;
    for (std::size_t i = 0; i < scene.size(); ++i)
      EXPECT_EQ(fault(results[i], scene.ray(i), judgements[i]), "") << variant.name() << " pair " << i;
  }
  const auto either = std::count_if(judgements.begin(), judgements.end(), [](const TriangleJudgement& j) {
    return j.decision == oracle::Class::either;
  });
  return static_cast<double>(either) / static_cast<double>(scene.size());
}

void check_reproducible(const TriangleScene& scene, const std::vector<KernelVariant>& variants) {
  Results canonical;
  for (std::size_t i = 0; i < scene.size(); ++i)
    canonical.push_back(to_result(canonical_hit(scene.ray(i), scene.triangle(i))));
  const KernelVariant first{&paths().front(), TriangleTest::moller_trumbore, Grade::reproducible};
  const Results plain = many_rays(first.kernels(), scene.rays, scene.triangles);
  for (const KernelVariant& variant : variants) {
    if (variant.grade == Grade::fast) {
      EXPECT_EQ(many_rays(variant.kernels(), scene.rays, scene.triangles),
                many_triangles(variant.kernels(), scene.rays, scene.triangles))
          << variant.name() << ": the two forms differ";
    } else {
      expect_all(scene, variant.test == TriangleTest::watertight ? canonical : plain, variant);
    }
  }
}

// The largest and smallest share of pairs that may go either way: outside, a generator has lost its point.
struct AimCase {
  Aim aim;
  double least_share, most_share;
};

class AimedTriangles : public ::testing::TestWithParam<AimCase> {};

TEST_P(AimedTriangles, are_decided_right_and_alike) {
  Random random(21 + static_cast<std::uint64_t>(GetParam().aim));
  const std::vector<KernelVariant> variants = all_variants<TriangleTest>();
  const int rounds = quick() ? 2 : 40;
  double share = 0;
  for (int round = 0; round < rounds; ++round) {
    const TriangleScene scene = aimed_scene(GetParam().aim, 35, 5, random);
    check_reproducible(scene, variants);
    for (const TriangleTest test : {TriangleTest::watertight, TriangleTest::moller_trumbore})
      share += check_against_oracle(scene, test, variants) / (2 * rounds);
    if (HasFailure()) return;
  }
  if (quick()) return;
  EXPECT_GE(share, GetParam().least_share);
  EXPECT_LE(share, GetParam().most_share);
}

// A fifth of the pairs are of a ray and the triangle it is aimed at.
INSTANTIATE_TEST_SUITE_P(Aims, AimedTriangles,
                         ::testing::Values(AimCase{Aim::anywhere, 0, 0.001}, AimCase{Aim::edge, 0.1, 0.2},
                                           AimCase{Aim::corner, 0.1, 0.2}, AimCase{Aim::off_edge, 0, 0.05},
                                           AimCase{Aim::far, 0, 0.01},
                                           AimCase{Aim::small_and_distant, 0, 0.02},
                                           AimCase{Aim::beside_a_tiny_one, 0.01, 0.1},
                                           AimCase{Aim::tied_axes, 0, 0.01}));

TEST(WatertightTriangles, have_exact_signs_on_the_sheared_corners) {
  Random random(31);
  const std::vector<KernelVariant> variants = all_variants<TriangleTest>();
  for (int round = 0; round < (quick() ? 4 : 1500); ++round) {
    for (const Aim aim : {Aim::edge, Aim::corner, Aim::beside_a_tiny_one}) {
      TriangleScene scene = aimed_scene(aim, 35, 5, random);
      for (Ray& ray : scene.rays) ray.tmin = -infinity, ray.tmax = infinity;
      for (const KernelVariant& variant : variants) {
        if (variant.test != TriangleTest::watertight) continue;
        const bool fused = variant.is_fused();
        const Results results = many_triangles(variant.kernels(), scene.rays, scene.triangles);
        for (std::size_t i = 0; i < scene.size(); ++i)
          ASSERT_EQ(results[i].hit != 0, axis_passes(shear_triangle(scene.ray(i), scene.triangle(i), fused)))
              << variant.name() << " pair " << i;
      }
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
