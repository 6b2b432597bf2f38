// Embree in every mode beside our own answers, contenders that lie, and trees that follow.
#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "../contenders/fast_winding.hpp"
#include "../contenders/trace/agreement.hpp"
#include "../rows/double_rows.hpp"
#include "../support/rulers/follower.hpp"
#include "../support/scenes/damage.hpp"
#include "../support/scenes/procedural.hpp"
#include "../support/scenes/splitmix.hpp"

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

// Null, and a skip, where there is no Embree or not for this machine.
std::unique_ptr<EmbreeContender> embree_of(const Scene& scene, const std::string& isa, EmbreeBuild build) {
  try {
    return std::make_unique<EmbreeContender>(scene.mesh.vertices, scene.mesh.triangles, isa, build);
  } catch (const std::runtime_error&) {
    return nullptr;
  }
}

TEST_F(Contenders, every_mode_of_embree_answers_right_and_leaves_the_processor_as_it_was) {
  const unsigned before = _mm_getcsr();
  std::size_t checked = 0;
  for (const char* isa : {"sse2", "avx", "avx2", "avx512"})
    for (std::size_t build = 0; build < embree_build_names.size(); ++build) {
      const auto embree = embree_of(scene_, isa, static_cast<EmbreeBuild>(build));
      if (!embree) continue;
      const bool is_robust = static_cast<EmbreeBuild>(build) == EmbreeBuild::robust;
      for (const Contender& contender : embree_contenders(*embree))
        for (const RayKind kind :
             {RayKind::primary, RayKind::shadow, RayKind::light, RayKind::diffuse, RayKind::ao}) {
          const Agreement agreement =
              compare(contender, workload_.rays(kind),
                      is_robust ? oracle::Form::embree_robust : oracle::Form::embree_fast);
          EXPECT_EQ(agreement.ours_wrong, 0u) << isa << ' ' << contender.mode;
          EXPECT_LE(agreement.embree_wrong, 2u)
              << isa << ' ' << contender.mode << ' ' << agreement.sentences[0];
          ++checked;
        }
    }
  EXPECT_EQ(_mm_getcsr() & 0x8040u, before & 0x8040u) << "flush to zero and subnormals as zero";
  if (checked == 0) GTEST_SKIP() << "SKIPPED: no Embree here";
  RecordProperty("checked", static_cast<int>(checked));
}

// Rays that miss by contract among others, and a rest that fills no packet.
TEST_F(Contenders, packed_rays_and_calls_have_the_answers_of_batches) {
  for (const RayKind kind : {RayKind::primary, RayKind::shadow}) {
    RaySet set = workload_.rays(kind);
    set.rays.resize(101);
    set.rays[3].tmax = -1;
    set.rays[7].direction = {0, 0, 0};
    for (const TriangleTest test : {TriangleTest::exact, TriangleTest::watertight}) {
      const Answers batch = answers_of(our_contender(bvh_, {.test = test}), set);
      EXPECT_TRUE(answers_of(our_caller(bvh_, {.test = test}), set).same_bytes(batch));
      EXPECT_TRUE(batch.hit_count() > 20 || kind == RayKind::shadow);
    }
    const auto embree = embree_of(scene_, "", EmbreeBuild::medium);
    if (!embree) continue;
    std::size_t packed = 0;
    std::vector<Contender> contenders = embree_contenders(*embree);
    for (Contender& caller : embree_callers(*embree)) contenders.push_back(std::move(caller));
    for (const Contender& contender : contenders) {
      if (!contender.is_packed()) continue;
      ++packed;
      const std::string base = contender.mode.substr(0, contender.mode.find("_packed"));
      const auto beside = std::find_if(contenders.begin(), contenders.end(),
                                       [&](const Contender& other) { return other.mode == base; });
      ASSERT_NE(beside, contenders.end()) << base;
      Answers answers(set);
      EXPECT_GT(contender.timed(set, answers), 0.0);
      EXPECT_TRUE(answers.same_bytes(answers_of(*beside, set))) << contender.mode;
    }
    EXPECT_EQ(packed, 3u);
  }
}

TEST_F(Contenders, a_refused_ray_leaves_the_processor_as_it_was) {
  const auto embree = embree_of(scene_, "", EmbreeBuild::medium);
  if (!embree) GTEST_SKIP() << "SKIPPED: no Embree here";
  const unsigned before = _mm_getcsr();
  Ray ray;
  ray.origin = {1e30f, 0, 0}, ray.direction = {-1, 0, 0};
  Hit hit;
  EXPECT_THROW(embree->closest(EmbreeMode::single, false, {&ray, 1}, {&hit, 1}), std::invalid_argument);
  EXPECT_EQ(_mm_getcsr() & 0x8040u, before & 0x8040u);
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

// Modes that see a hit where a triangle has none, or none where it has one, at its inside, its edge and beside it. They
// are excused where they may differ, but not for the hit that no rounding takes away.
TEST(ModesApart, are_excused_where_the_test_promises_nothing_else) {
  const Scene scene{"triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {}};
  const Bvh bvh(scene.mesh);
  RaySet set{"down", Query::any, {}};
  for (const Float3& origin : {Float3{0.25f, 0.25f, 1}, Float3{0.25f, 0, 1}, Float3{2, 2, 1}})
    set.rays.push_back({.origin = origin, .direction = {0, 0, -1}});
  const Contender honest = our_contender(bvh, {.test = TriangleTest::moller_trumbore});
  const Contender torn{"torn", [&](const RaySet& rays, Answers& answers) {
                         honest.trace(rays, answers);
                         for (std::uint8_t& flag : answers.occluded) flag ^= 1;
                       }};
  Answers right(set), wrong(set);
  honest.trace(set, right), torn.trace(set, wrong);
  const auto form = oracle::Form::moller_trumbore;
  for (const bool agree : {true, false}) {
    const Agreement agreement =
        compare_answers(scene, set, {wrong, torn, form, agree}, {right, honest, form});
    EXPECT_EQ(agreement.disagreements, 3u);
    EXPECT_EQ(agreement.ours_wrong, agree ? 3u : 1u);
    EXPECT_EQ(agreement.within_rounding, agree ? 0u : 2u);
  }
}

// A hit that is certain from where the ray begins and within rounding from where it ends: packets of Möller–Trumbore
// in the fast grade may see it from there.
TEST(ModesApart, are_excused_within_rounding_as_seen_from_the_end_of_the_ray) {
  const Scene scene{"triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {}};
  const Bvh bvh(scene.mesh);
  RaySet set{"up", Query::any, {}};
  for (const auto& [beside, length] : {std::pair{1e-5f, 1000.f}, std::pair{0.25f, 10.f}})
    set.rays.push_back(
        {.origin = {0.25f, beside, -0x1p-10f}, .direction = {length, length, length}, .tmax = 1});
  const Contender honest = our_contender(bvh, {.test = TriangleTest::moller_trumbore});
  const Contender blind{"blind", [&](const RaySet& rays, Answers& answers) {
                          honest.trace(rays, answers);
                          for (std::uint8_t& flag : answers.occluded) flag = 0;
                        }};
  Answers right(set), wrong(set);
  honest.trace(set, right), blind.trace(set, wrong);
  ASSERT_EQ(right.hit_count(), 2u);
  const auto form = oracle::Form::moller_trumbore;
  for (const bool may_reverse : {false, true}) {
    const Agreement agreement =
        compare_answers(scene, set, {wrong, blind, form, false, may_reverse}, {right, honest, form});
    EXPECT_EQ(agreement.disagreements, 2u);
    EXPECT_EQ(agreement.ours_wrong, may_reverse ? 1u : 2u);
  }
}

// Signs of rounded edge functions name the wrong neighbour for some rays towards edges: the judge finds it, and finds
// nothing against exact arithmetic, near and far from zero.
TEST(DoubleRows, count_wrong_answers_towards_edges) {
  const Scene scene = make_procedural_scene("spheres");
  for (const double offset : {0.0, 5e6}) {
    const DoubleOptions options{.ray_sets = {RayKind::primary, RayKind::shadow},
                                .paths = {&active_path()},
                                .width = 24,
                                .height = 24,
                                .offset = offset,
                                .seconds = 0,
                                .against_embree = offset == 0,
                                .against_cgal = true,
                                .judged = 20};
    std::size_t wrong_of_others = 0, rows_of_floats = 0;
    for (const DoubleRow& row : double_rows(scene, options)) {
      EXPECT_EQ(row.ratio.has_value(), row.contender == "raylanes" && offset == 0);
      if (row.contender == "raylanes")
        EXPECT_EQ(row.wrong, 0u) << row.rays;
      else if (row.contender == "floats")
        ++rows_of_floats;
      else if (row.rays == "edges")
        wrong_of_others += row.wrong;
    }
    EXPECT_GT(offset == 0 ? wrong_of_others : 1u, 0u);
    EXPECT_EQ(rows_of_floats, offset == 0 ? 4u : 0u);
  }
}

// Builds refuse the threads that refits refuse: they are given the same ones.
TEST(Follower, builds_on_the_threads_of_refits) {
  const Mesh mesh = make_procedural_scene("spheres").mesh;
  EXPECT_THROW(Follower(MotionPolicy::rebuild, mesh, -1), std::invalid_argument);
}

// The sum of all solid angles is ours within our accuracy and a rounding. Expansions have terms up to the third degree:
// what they leave out falls at least as β^-4 at each node.
TEST(FastWinding, sums_solid_angles_and_expands_them) {
  const Scene scene = make_procedural_scene("spheres");
  for (const Mesh& mesh : {scene.mesh, with_holes(scene.mesh, 8), in_pieces(scene.mesh)}) {
    const FastWinding summed(mesh);
    const Bvh bvh(mesh);
    SplitMix random(7);
    std::vector<Float3> points(40);
    for (Float3& point : points)
      for (std::size_t k = 0; k < 3; ++k) {
        const float lo = bvh.bounds().lo[k], hi = bvh.bounds().hi[k];
        point[k] = lo + static_cast<float>(random.uniform()) * (hi - lo);
      }
    std::vector<double> sums(points.size()), coarse(points.size()), fine(points.size());
    summed.numbers(points, std::numeric_limits<double>::infinity(), sums);
    summed.numbers(points, 2, coarse);
    summed.numbers(points, 8, fine);
    std::vector<float> ours(points.size());
    bvh.winding_numbers(points, ours);
    double coarse_error = 0, fine_error = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(sums[i], static_cast<double>(ours[i]), 1e-6 + 0x1p-24 * std::abs(sums[i]) + 1e-9)
          << "point " << i;
      coarse_error = std::max(coarse_error, std::abs(coarse[i] - sums[i]));
      fine_error = std::max(fine_error, std::abs(fine[i] - sums[i]));
    }
    EXPECT_GT(coarse_error, 0);
    EXPECT_LT(fine_error, coarse_error / 64);
  }
}

}  // namespace
}  // namespace raylanes::bench
