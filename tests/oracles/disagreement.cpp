// How disagreements of two tracers are judged.
#include "../../bench/support/oracles/disagreement.hpp"

#include "../support/random_input.hpp"
#include "../traverse/reference/reference_tracer.hpp"

namespace raylanes::oracle {
namespace {

using namespace testing;

constexpr Hit miss = {infinity, 0, 0, no_primitive};

// Two floors, z = 0 and z = -1, and a copy of the first.
const std::vector<Float3> vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, -1}, {4, 0, -1}, {0, 4, -1}};
const std::vector<Index3> triangles = {{0, 1, 2}, {3, 4, 5}, {0, 1, 2}};

Explanation explain_floors(const Ray& ray, const Hit& ours, const Hit& theirs) {
  return explain(ray, vertices, triangles, ours, Form::sheared, theirs, Form::embree_fast);
}

TEST(Disagreement, is_about_hits_and_t_only) {
  EXPECT_FALSE(disagree(miss, miss));
  EXPECT_FALSE(disagree({2, 0.25f, 0.25f, 0}, {2, 0.25f, 0.25f, 2})) << "coincident triangles";
  EXPECT_FALSE(disagree({2, 0, 0, 0}, {2.0001f, 0, 0, 1}));
  EXPECT_TRUE(disagree({2, 0, 0, 0}, {2.001f, 0, 0, 0}));
  EXPECT_TRUE(disagree({2, 0, 0, 0}, miss));
  EXPECT_TRUE(disagree(miss, {2, 0, 0, 0}));
  EXPECT_TRUE(disagree({nan, 0, 0, 0}, {2, 0, 0, 0}));
  EXPECT_FALSE(disagree({0, 0, 0, 0}, {0, 0, 0, 1}));
}

// The ray of TriangleRegressions that passes between two triangles by Möller and Trumbore's test.
TEST(Disagreement, rounding_of_an_edge_is_an_excuse) {
  const Ray ray = make_ray({0, 0, 0}, {-0x1.2569cp-1f, 0x1.99509ep-2f, 0x1.b64bcap+0f});
  const std::vector<Float3> corners{{-0x1.9769dcp-1f, 0x1.70ab2cp-1f, 0x1.93d2d4p+0f},
                                    {0x1.3e1aap-4f, -0x1.12ade8p-1f, 0x1.0d85bep+1f},
                                    {0x1.dee458p-1f, 0x1.5e3d58p-1f, 0x1.8e7fdp+0f},
                                    {-0x1.80d8b6p-1f, -0x1.10c542p-1f, 0x1.8ef12ap+0f}};
  const std::vector<Index3> pair{{0, 1, 2}, {1, 0, 3}};
  const Hit hit = brute_force(corners, pair, {&ray, 1})[0];
  ASSERT_TRUE(hit);
  const auto explained = [&](float t) {
    return explain(ray, corners, pair, {t, hit.u, hit.v, hit.primitive}, Form::sheared, miss,
                   Form::moller_trumbore);
  };
  const Explanation why = explained(hit.t), late = explained(hit.t * 1.01f);
  EXPECT_EQ(why.excuse, Excuse::edge_rounding) << why.sentence;
  EXPECT_EQ(late.excuse, Excuse::ours_wrong) << late.sentence;
}

TEST(Disagreement, clear_errors_are_blamed_on_their_side) {
  const Ray ray = make_ray({1, 1, 2}, {0, 0, -1});
  const Hit good = {2, 0.25f, 0.25f, 0}, below = {3, 0.25f, 0.25f, 1};
  for (const Hit& bad : {miss, below, Hit{2.5f, 0, 0, 0}, Hit{nan, 0, 0, 0}, Hit{1, 0, 0, 1}}) {
    const Explanation theirs = explain_floors(ray, good, bad), ours = explain_floors(ray, bad, good);
    EXPECT_EQ(theirs.excuse, Excuse::theirs_wrong) << theirs.sentence;
    EXPECT_EQ(theirs.sentence.rfind("theirs ", 0), 0u) << theirs.sentence;
    EXPECT_EQ(ours.excuse, Excuse::ours_wrong) << ours.sentence;
    EXPECT_EQ(ours.sentence.rfind("ours ", 0), 0u) << ours.sentence;
  }
  const Ray beside = make_ray({3, 3, 2}, {0, 0, -1});
  EXPECT_EQ(explain_floors(beside, good, miss).excuse, Excuse::ours_wrong);
  EXPECT_EQ(explain_floors(ray, good, {2, 0.25f, 0.25f, 2}).excuse, Excuse::none_needed);
}

TEST(Disagreement, the_ends_of_the_segment_and_flat_views_are_excuses) {
  const Hit good = {2, 0.25f, 0.25f, 0};
  const Explanation end = explain_floors(make_ray({1, 1, 2}, {0, 0, -1}, 2, 2.5f), good, miss);
  EXPECT_EQ(end.excuse, Excuse::depth_rounding) << end.sentence;
  const Explanation flat = explain_floors(make_ray({-1, 1, 0}, {1, 0, 0}), miss, {1, 0, 0.25f, 0});
  EXPECT_EQ(flat.excuse, Excuse::degenerate_triangle) << flat.sentence;
}

TEST(Disagreement, a_primitive_out_of_range_is_an_error) {
  try {
    explain_floors(make_ray({1, 1, 2}, {0, 0, -1}), {2, 0, 0, 7}, miss);
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "hit: primitive 7 is out of range, the mesh has 3 triangles");
  }
}

}  // namespace
}  // namespace raylanes::oracle
