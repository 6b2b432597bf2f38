// Embree in every mode beside our own answers, contenders that lie, and results that the tool calls a broken promise.
#include <xmmintrin.h>

#include <raylanes/bvh.hpp>

#include "../../tests/queries/open_meshes.hpp"
#include "../../tests/queries/query_trees.hpp"
#include "../contenders/fast_winding.hpp"
#include "../contenders/trace/agreement.hpp"
#include "../rows/kernels/kernel_rows.hpp"
#include "../rows/point_rows.hpp"
#include "../support/oracles/winding_sum.hpp"
#include "../support/scenes/damage.hpp"
#include "../support/scenes/procedural.hpp"

namespace raylanes::bench {
namespace {

class Contenders : public ::testing::Test {
 protected:
  Agreement compare(const Contender& theirs, const RaySet& set, oracle::Form form) const {
    Answers our_answers(set), their_answers(set);
    ours_.trace(set, our_answers), theirs.trace(set, their_answers);
    return compare_answers(scene_, set, {our_answers, ours_, oracle::Form::exact},
                           {their_answers, theirs, form});
  }

  const Scene scene_ = make_procedural_scene("hall");
  const Bvh bvh_{scene_.mesh};
  const Workload workload_{scene_, bvh_, 48, 48};
  const Contender ours_ = our_contender(bvh_, {});
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
      for (const Contender& contender :
           embree_contenders(*embree, false, std::vector<std::size_t>{0, 10, 100}))
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
  const Contender blind{"blind", [](const RaySet&, Answers& answers) {
                          for (Hit& hit : answers.hits) hit = Hit{};
                          for (std::uint8_t& flag : answers.occluded) flag = 0;
                        }};
  const RaySet primary = workload_.rays(RayKind::primary), ao = workload_.rays(RayKind::ao);
  Answers ours(ao);
  ours_.trace(ao, ours);
  EXPECT_GT(ours.hit_count(), 100u);
  EXPECT_GT(compare(blind, ao, oracle::Form::embree_fast).embree_wrong, ours.hit_count() * 9 / 10);
  EXPECT_GT(compare(blind, primary, oracle::Form::embree_fast).embree_wrong, primary.rays.size() * 99 / 100);
}

// Modes of ours that differ are excused where the test may round, but not for a hit that no rounding takes away: the
// verdict on a mode that is wrong for each ray, which sees a hit where there is none, and none where there is one.
Agreement judged(const std::vector<Ray>& rays, bool agree, bool may_reverse) {
  const Scene scene{"triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {}};
  const Bvh bvh(scene.mesh);
  const RaySet set{"rays", Query::any, rays};
  const Contender honest = our_contender(bvh, {.test = TriangleTest::moller_trumbore});
  const Contender torn{"torn", [&](const RaySet& all, Answers& answers) {
                         honest.trace(all, answers);
                         for (std::uint8_t& flag : answers.occluded) flag ^= 1;
                       }};
  Answers right(set), wrong(set);
  honest.trace(set, right), torn.trace(set, wrong);
  const auto form = oracle::Form::moller_trumbore;
  return compare_answers(scene, set, {wrong, torn, form, agree, may_reverse}, {right, honest, form});
}

TEST(ModesApart, are_excused_where_the_test_promises_nothing_else) {
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
TEST(ModesApart, are_excused_within_rounding_as_seen_from_the_end_of_the_ray) {
  std::vector<Ray> rays;
  for (const auto& [beside, length] : {std::pair{1e-5f, 1000.f}, std::pair{0.25f, 10.f}})
    rays.push_back({.origin = {0.25f, beside, -0x1p-10f}, .direction = {length, length, length}, .tmax = 1});
  for (const bool may_reverse : {false, true})
    EXPECT_EQ(judged(rays, false, may_reverse).ours_wrong, may_reverse ? 1u : 2u);
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Promises, of_kernels) {
  using Case = std::tuple<const char*, const char*, double, double, bool>;
  for (const auto& [kernel, test, wrong, leaks, kept] : {Case{"triangle", "exact", 0, 0, true},
                                                         {"triangle", "exact", nan, 0, false},
                                                         {"triangle", "exact", 0, 1, false},
                                                         {"triangle", "integers", 1, 0, false},
                                                         {"triangle", "watertight", 1, 0, true},
                                                         {"triangle", "watertight", 0, 1, false},
                                                         {"triangle", "moller_trumbore", 1, 1, true},
                                                         {"box", "conservative", 1, 0, false},
                                                         {"box", "plain", 1, 0, true}}) {
    KernelAccuracy accuracy;
    accuracy.wrong_per_million[1] = wrong;
    KernelRow row{};
    row.kernel = kernel, row.test = test, row.accuracy = &accuracy, row.leaks = leaks;
    EXPECT_EQ(keeps_promise(row), kept) << kernel << ' ' << test;
  }
}

// A point that is not where rational numbers have it says nothing where the mesh has holes.
TEST(Promises, of_points) {
  const std::vector<double> near{4, 9, infinity}, far{4, 16, infinity}, lost{4, nan, infinity};
  EXPECT_EQ(largest_difference(near, near, 10), 0);
  EXPECT_EQ(largest_difference(near, far, 10), 0.1);
  EXPECT_EQ(largest_difference(near, lost, 10), infinity);
  EXPECT_EQ(largest_difference(lost, near, 10), infinity);
  using Case = std::tuple<const char*, double, std::size_t, bool, bool>;
  for (const auto& [contender, difference, wrong, is_closed, is_sound] :
       {Case{"bvh", 0, 0, true, true},
        {"kdtree", infinity, 0, true, false},
        {"embree", infinity, 1, true, true},
        {"bvh", 0, 1, true, false},
        {"bvh", 0, 1, false, true}}) {
    PointRow row{};
    row.contender = contender, row.largest_difference = difference;
    row.wrong = wrong, row.is_closed = is_closed;
    EXPECT_EQ(row.is_sound(), is_sound) << contender;
  }
}

// A row is right until one of its numbers is moved by `broken`. Points without a limit do not count.
TEST(Promises, of_winding_numbers) {
  const Mesh spheres = with_holes(make_procedural_scene("spheres").mesh, 4);
  const Mesh flat{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
  const std::vector<Float3> on_flat{{1, 1, 0}, {2, 0, 0}, {3, 3, 0}, {0.5f, 1, 0.25f}, {1e-12f, 1, 0}};
  for (const Mesh* mesh : {&spheres, &flat}) {
    const auto points = mesh == &flat ? on_flat : testing::points_around(*mesh, 40, 1.5f, 9);
    std::vector<float> numbers(points.size());
    Bvh(*mesh).winding_numbers(points, numbers);
    for (const float broken : {0.0f, 4e-6f, -0.5f, 1.0f, std::numeric_limits<float>::quiet_NaN()}) {
      PointRow row{};
      row.contender = "bvh";
      for (std::size_t i = 0; i < points.size(); ++i)
        row.judge_winding(numbers[i] + (i == points.size() / 2 ? broken : 0),
                          oracle::winding_sum(mesh->vertices, mesh->triangles, points[i]), 1.1e-6);
      EXPECT_TRUE(row.wrong == (broken != 0) && row.is_sound() == (broken == 0)) << broken;
      EXPECT_GE(row.judged, points.size() / 2);
      EXPECT_TRUE(broken == 0 || row.winding_error > 2e-6) << broken;
    }
  }
  PointRow row{};
  row.contender = "kdtree";
  row.judge_winding(7, oracle::winding_sum(flat.vertices, flat.triangles, {2, 0, 0}), 0);
  EXPECT_TRUE(row.judged == 0 && row.is_sound());
}

// The sum of all solid angles is ours within our accuracy and a rounding. Expansions have terms up to the third degree:
// what they leave out falls at least as β^-4 at each node.
TEST(FastWinding, sums_solid_angles_and_expands_them) {
  const Mesh whole = make_procedural_scene("spheres").mesh;
  for (const Mesh& mesh : {whole, with_holes(whole, 8)}) {
    testing::Random random(7);
    std::vector<Float3> points(40);
    for (Float3& point : points) point = random.point(1);
    const FastWinding rival(mesh);
    std::vector<double> sums(points.size()), coarse(points.size()), fine(points.size());
    rival.numbers(points, infinity, sums), rival.numbers(points, 2, coarse), rival.numbers(points, 8, fine);
    std::vector<float> ours(points.size());
    Bvh(mesh).winding_numbers(points, ours);
    double coarse_error = 0, fine_error = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(sums[i], static_cast<double>(ours[i]), 1e-6 + 0x1p-24 * std::abs(sums[i]) + 1e-9) << i;
      coarse_error = std::max(coarse_error, std::abs(coarse[i] - sums[i]));
      fine_error = std::max(fine_error, std::abs(fine[i] - sums[i]));
    }
    EXPECT_GT(coarse_error, 0);
    EXPECT_LT(fine_error, coarse_error / 64);
  }
}

}  // namespace
}  // namespace raylanes::bench
