// Rays that are known to have been answered wrongly, somewhere: inputs found by search, to the bit.
#include "../support/random_input.hpp"
#include "../support/system/fused.hpp"
#include "../traverse/reference/reference_tracer.hpp"
#include "judge/triangle_answers.hpp"
#include "judge/triangle_judge.hpp"

namespace raylanes::testing {
namespace {

struct SharedEdge {
  Ray ray;
  Triangle left, right;
};

SharedEdge shared_edge(Float3 o, Float3 d, Float3 p, Float3 q, Float3 s, Float3 w) {
  return {make_ray(o, d), make_triangle(p, q, s), make_triangle(q, p, w)};
}

bool is_stopped(const TriangleVariant& variant, const SharedEdge& edge) {
  return single(variant, edge.ray, edge.left).hit != 0 || single(variant, edge.ray, edge.right).hit != 0;
}

// The ray meets one of the two triangles exactly, and no test may say what its bound forbids.
void expect_right_within_bounds(const SharedEdge& edge) {
  EXPECT_TRUE(oracle::exact_triangle(edge.ray, edge.left).hit ||
              oracle::exact_triangle(edge.ray, edge.right).hit);
  for (const TriangleVariant& variant : all_variants<TriangleTest>())
    for (const Triangle& triangle : {edge.left, edge.right})
      EXPECT_EQ(fault(single(variant, edge.ray, triangle), edge.ray, judge(variant.test, edge.ray, triangle)),
                "")
          << variant.name();
}

TEST(TriangleRegressions, moller_trumbore_misses_both_triangles_at_an_edge) {
  const SharedEdge edge = shared_edge(
      {0, 0, 0}, {-0x1.2569cp-1f, 0x1.99509ep-2f, 0x1.b64bcap+0f},
      {-0x1.9769dcp-1f, 0x1.70ab2cp-1f, 0x1.93d2d4p+0f}, {0x1.3e1aap-4f, -0x1.12ade8p-1f, 0x1.0d85bep+1f},
      {0x1.dee458p-1f, 0x1.5e3d58p-1f, 0x1.8e7fdp+0f}, {-0x1.80d8b6p-1f, -0x1.10c542p-1f, 0x1.8ef12ap+0f});
  expect_right_within_bounds(edge);
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    if (never_leaks(variant.test)) {
      EXPECT_TRUE(is_stopped(variant, edge)) << variant.name();
    }
    if (is_moller_trumbore(variant.test) && !variant.is_fused()) {
      EXPECT_FALSE(is_stopped(variant, edge)) << variant.name();
    }
  }
}

// The result of p.x·q.y − p.y·q.x if the compiler may fuse.
float contracted_edge(float px, float py, float qx, float qy) {
  return fused_multiply_add(px, qy, -(py * qx));
}

// The sheared test with all of it so contracted.
bool contracted_hit(const Ray& ray, const Triangle& triangle) {
  const ShearedTriangle s = shear_triangle(ray, triangle, true);
  const auto edge = [&](std::size_t p, std::size_t q) {
    return contracted_edge(s.x[p], s.y[p], s.x[q], s.y[q]);
  };
  const float u = edge(2, 1), v = edge(0, 2), w = edge(1, 0);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

TEST(TriangleRegressions, contracted_edges_of_a_sheared_test_miss_both_triangles) {
  const SharedEdge edge =
      shared_edge({-0x1.cp-4f, 0x1.cp-4f, 0x1.ep-3f}, {0x1.4245cp-1f, -0x1.29c144p-2f, 0x1.70f1c2p-1f},
                  {-0x1p-6f, -0x1.f8p-1f, 0x1.f6p-1f}, {0x1.cp-2f, -0x1.cp-4f, 0x1.aep-1f},
                  {-0x1.2p-3f, 0x1.ep-1f, 0x1.06p+0f}, {0x1.b8p-1f, -0x1.a8p-1f, 0x1.33p+0f});
  expect_right_within_bounds(edge);
  EXPECT_FALSE(contracted_hit(edge.ray, edge.left) || contracted_hit(edge.ray, edge.right))
      << "the case no longer bites";
  for (const TriangleVariant& variant : all_variants<TriangleTest>())
    if (never_leaks(variant.test)) {
      EXPECT_TRUE(is_stopped(variant, edge)) << variant.name();
    }
}

// The grades differ where they may: multiply and add hits, multiply-add misses, and exactly it is a tie.
TEST(TriangleRegressions, multiply_and_add_hits_what_multiply_add_misses) {
  const Ray ray = make_ray({0x1.6p-3f, 0, 0x1.cp-3f}, {0x1.f24224p-3f, 0x1.20d156p-2f, 0x1.db2812p-1f});
  const Triangle triangle =
      make_triangle({0x1.18p-1f, 0x1.cp-3f, 0x1.2fp+0f}, {-0x1.8p-5f, 0x1.3p-1f, 0x1.36p+0f},
                    {-0x1.8p-1f, 0x1.2p-3f, 0x1.9p-1f});
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    const TriangleResult result = single(variant, ray, triangle);
    EXPECT_EQ(fault(result, ray, judge(variant.test, ray, triangle)), "") << variant.name();
    if (is_moller_trumbore(variant.test)) {
      EXPECT_EQ(result.hit != 0, !variant.is_fused()) << variant.name();
    }
  }
}

// det = −7, U = −6, V = −1, all exact: on the edge u + v = 1. Quotients rounded before the comparison sum to
// more than one.
TEST(TriangleRegressions, an_exact_edge_hit_survives_the_division) {
  const Triangle triangle = make_triangle({3, -1, -4}, {3, 4, -3}, {0, -1, 3});
  const Ray ray = make_ray({2, 3, -1}, {2, 1, -4});
  EXPECT_EQ(oracle::exact_triangle(ray, triangle).det, -7);
  EXPECT_GT(6.0f * (1 / 7.0f) + 1.0f * (1 / 7.0f), 1) << "the classic comparison would do here";
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    const TriangleResult result = single(variant, ray, triangle);
    if (is_moller_trumbore(variant.test)) {
      EXPECT_EQ(result, (TriangleResult{2.0f / 7, 6.0f / 7, 1.0f / 7, hit_flag})) << variant.name();
    }
    EXPECT_EQ(fault(result, ray, judge(variant.test, ray, triangle)), "") << variant.name();
  }
}

// Two corners whose contracted edge function has the same sign from both sides. Seen along z, which shears
// nothing, the triangles to either side of the edge must disagree: one is hit, the other is not.
TEST(TriangleRegressions, an_edge_has_opposite_signs_from_its_two_sides) {
  constexpr float p[2] = {0x1.a9a80ep-3f, 0x1.0179a6p-2f}, q[2] = {-0x1.91f296p-2f, -0x1.e64494p-2f};
  EXPECT_LT(contracted_edge(p[0], p[1], q[0], q[1]), 0);
  EXPECT_LT(contracted_edge(q[0], q[1], p[0], p[1]), 0);
  const SharedEdge edge =
      shared_edge({0, 0, 0}, {0, 0, 1}, {p[0], p[1], 1}, {q[0], q[1], 1}, {-1, 1, 1}, {1, -1, 1});
  const bool left = oracle::exact_triangle(edge.ray, edge.left).hit;
  EXPECT_NE(left, oracle::exact_triangle(edge.ray, edge.right).hit);
  expect_right_within_bounds(edge);
  for (const TriangleVariant& variant : all_variants<TriangleTest>())
    if (never_leaks(variant.test)) {
      EXPECT_EQ(single(variant, edge.ray, edge.left).hit != 0, left) << variant.name();
      EXPECT_EQ(single(variant, edge.ray, edge.right).hit != 0, !left) << variant.name();
    }
}

// A sun straight above a flat quad of two triangles, on its outline, its diagonal and inside.
TEST(TriangleRegressions, a_sun_along_an_axis_meets_a_flat_quad) {
  const Triangle quad[2] = {make_triangle({-2, 1, -2}, {2, 1, -2}, {2, 1, 2}),
                            make_triangle({-2, 1, -2}, {2, 1, 2}, {-2, 1, 2})};
  for (const TriangleVariant& variant : all_variants<TriangleTest>())
    for (float x = -2; x <= 2; x += 0.5f)
      for (float z = -2; z <= 2; z += 0.5f)
        for (const float zero : {0.0f, -0.0f}) {
          const Ray ray = make_ray({x, 9, z}, {zero, -1, zero});
          EXPECT_TRUE(single(variant, ray, quad[0]).hit != 0 || single(variant, ray, quad[1]).hit != 0)
              << variant.name() << " at " << x << ", " << z;
        }
}

}  // namespace
}  // namespace raylanes::testing
