// Embree in every mode beside our own answers, and contenders that lie.
#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <optional>
#include <stdexcept>
#include <utility>

#include "../contenders/trace/agreement.hpp"
#include "../support/scenes/procedural.hpp"

namespace raylanes::bench {
namespace {

class Contenders : public testing::Test {
 protected:
  Contenders()
      : scene_(make_procedural_scene("hall")),
        bvh_(scene_.mesh.vertices, scene_.mesh.triangles),
        workload_(scene_, bvh_, 48, 48),
        ours_(our_contender(bvh_, {})) {}

  Answers answers_of(const Contender& contender, const RaySet& set) const {
    Answers answers(set);
    contender.trace(set, answers);
    return answers;
  }
  Agreement compare(const Contender& theirs, const RaySet& set, oracle::Form form) const {
    const Answers our_answers = answers_of(ours_, set), their_answers = answers_of(theirs, set);
    return compare_answers(scene_, set, {our_answers, ours_, oracle::Form::exact},
                           {their_answers, theirs, form});
  }

  Scene scene_;
  Bvh bvh_;
  Workload workload_;
  Contender ours_;
};

TEST_F(Contenders, every_mode_of_embree_answers_right_and_leaves_the_processor_as_it_was) {
  const unsigned before = _mm_getcsr();
  std::size_t checked = 0;
  for (const char* isa : {"sse2", "avx", "avx2", "avx512"})
    for (const EmbreeBuild build :
         {EmbreeBuild::medium, EmbreeBuild::high, EmbreeBuild::robust, EmbreeBuild::low}) {
      std::optional<EmbreeContender> embree;
      try {
        embree.emplace(scene_.mesh.vertices, scene_.mesh.triangles, isa, build);
      } catch (const std::runtime_error&) {  // no Embree, or not for this machine
        continue;
      }
      const oracle::Form form =
          build == EmbreeBuild::robust ? oracle::Form::embree_robust : oracle::Form::embree_fast;
      for (const Contender& contender : embree_contenders(*embree))
        for (const RayKind kind :
             {RayKind::primary, RayKind::shadow, RayKind::light, RayKind::diffuse, RayKind::ao}) {
          const Agreement agreement = compare(contender, workload_.rays(kind), form);
          EXPECT_EQ(agreement.ours_wrong, 0u) << isa << ' ' << contender.mode;
          EXPECT_LE(agreement.embree_wrong, 2u) << isa << ' ' << contender.mode;
          ++checked;
        }
    }
  EXPECT_EQ(_mm_getcsr() & 0x8040u, before & 0x8040u) << "flush to zero and subnormals as zero";
  if (checked == 0) GTEST_SKIP() << "SKIPPED: no Embree here";
}

// Each disagreement is judged, whether it is about the closest hit or about any.
TEST_F(Contenders, who_lies_is_blamed) {
  const RaySet primary = workload_.rays(RayKind::primary);
  const Contender blind{"blind", [](const RaySet&, Answers& answers) {
                          for (Hit& hit : answers.hits) hit = Hit{};
                          for (std::uint8_t& flag : answers.occluded) flag = 0;
                        }};
  EXPECT_GT(compare(blind, primary, oracle::Form::embree_fast).embree_wrong, primary.rays.size() * 99 / 100);
  const RaySet ao = workload_.rays(RayKind::ao);
  const std::size_t blocked = answers_of(ours_, ao).hit_count();
  EXPECT_GT(compare(blind, ao, oracle::Form::embree_fast).embree_wrong, blocked * 9 / 10);
  EXPECT_GT(blocked, 100u);
}

// Modes of ours that differ are excused where the test may round, but not for a hit that no rounding takes away.
class ModesApart : public testing::Test {
 protected:
  // The verdict on a mode that is wrong for each ray: it sees a hit where there is none, and none where there is one.
  Agreement judged(const std::vector<Ray>& rays, bool agree, bool may_reverse) const {
    const RaySet set{"rays", Query::any, rays};
    const Contender honest = our_contender(bvh_, {.test = TriangleTest::moller_trumbore});
    const Contender torn{"torn", [&](const RaySet& all, Answers& answers) {
                           honest.trace(all, answers);
                           for (std::uint8_t& flag : answers.occluded) flag ^= 1;
                         }};
    Answers right(set), wrong(set);
    honest.trace(set, right), torn.trace(set, wrong);
    const auto form = oracle::Form::moller_trumbore;
    return compare_answers(scene_, set, {wrong, torn, form, agree, may_reverse}, {right, honest, form});
  }

  const Scene scene_{"triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {}};
  const Bvh bvh_{scene_.mesh};
};

TEST_F(ModesApart, are_excused_where_the_test_promises_nothing_else) {
  std::vector<Ray> rays;  // to the inside, an edge, and beside
  for (const Float3& origin : {Float3{0.25f, 0.25f, 1}, Float3{0.25f, 0, 1}, Float3{2, 2, 1}})
    rays.push_back({.origin = origin, .direction = {0, 0, -1}});
  for (const bool agree : {true, false}) {
    const Agreement agreement = judged(rays, agree, false);
    EXPECT_EQ(agreement.disagreements, 3u);
    EXPECT_EQ(agreement.ours_wrong, agree ? 3u : 1u);
    EXPECT_EQ(agreement.within_rounding, agree ? 0u : 2u);
  }
}

// A hit that is certain from where the ray begins and within rounding from where it ends: packets of Möller–Trumbore
// in the fast grade may see it from there.
TEST_F(ModesApart, are_excused_within_rounding_as_seen_from_the_end_of_the_ray) {
  std::vector<Ray> rays;
  for (const auto& [beside, length] : {std::pair{1e-5f, 1000.f}, std::pair{0.25f, 10.f}})
    rays.push_back({.origin = {0.25f, beside, -0x1p-10f}, .direction = {length, length, length}, .tmax = 1});
  for (const bool may_reverse : {false, true})
    EXPECT_EQ(judged(rays, false, may_reverse).ours_wrong, may_reverse ? 1u : 2u);
}

}  // namespace
}  // namespace raylanes::bench
