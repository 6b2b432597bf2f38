// The values of triangle tests; which of them have the same bits, the first of equal hits, and what is computed of a
// hit.
#include "../support/random_input.hpp"
#include "judge/triangle_answers.hpp"

namespace raylanes::testing {
namespace {

const Ray down = make_ray({1, 1, 2}, {0, 0, -1});

TEST(Triangles, values_of_a_plain_hit_and_of_a_miss) {
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    EXPECT_EQ(single(variant, down, floor_triangle), (TriangleResult{2, 0.25f, 0.25f, hit_flag}))
        << variant.name();
    EXPECT_EQ(single(variant, make_ray({3, 3, 2}, {0, 0, -1}), floor_triangle), triangle_missed)
        << variant.name();
  }
}

// --- Bits

constexpr Aim aims[] = {Aim::anywhere, Aim::edge, Aim::corner, Aim::off_edge, Aim::far};

// Integers, where nothing rounds: half of the rays meet an edge exactly.
TriangleScene integer_scene(Random& random) {
  const auto point = [&] {
    Float3 p;
    for (float& x : p) x = static_cast<float>(random.integer(-3, 3));
    return p;
  };
  TriangleScene scene;
  for (int i = 0; i < 17; ++i) scene.triangles.push_back(make_triangle(point(), point(), point()));
  for (int i = 0; i < 17; ++i) {
    Float3 d = point();
    d[random.index(3)] = random.chance(0.5) ? 4.0f : -4.0f;
    scene.rays.push_back(make_ray(point(), d, random.chance(0.5) ? 0.0f : -infinity));
  }
  return scene;
}

// By contract: from stored edges and with a prepared direction Möller and Trumbore's test has the same bits.
void expect_equal_bits_of_moller_trumbore(const TriangleScene& scene) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
      if (!is_moller_trumbore(variant.test)) continue;
      const TriangleVariant from_corners{variant.path, TriangleTest::moller_trumbore, variant.grade};
      ASSERT_EQ(answers(variant, scene.rays, scene.triangles),
                answers(from_corners, scene.rays, scene.triangles))
          << variant.name() << ' ' << name_of(mode);
    }
  }
}

TEST(Triangles, of_moller_and_trumbore_have_the_same_bits_from_corners_from_edges_and_with_a_direction) {
  Random random(101);
  for (int round = 0; round < by_level(1, 4, 12); ++round) {
    for (const Aim aim : aims) expect_equal_bits_of_moller_trumbore(scene_for_all_widths(aim, random));
    expect_equal_bits_of_moller_trumbore(integer_scene(random));
    if (HasFailure()) return;
  }
}

// Equal hits on both sides of a register's end: the first of them is in the last lane of any width.
TEST(Triangles, keep_the_first_of_equal_hits) {
  const Ray ray = make_ray({1, 1, 2}, {0, 0, -1});
  std::vector<Triangle> triangles(32, make_triangle({9, 9, 0}, {8, 9, 0}, {9, 8, 0}));
  triangles[15] = triangles[16] = floor_triangle;
  TriangleColumns columns(triangles);
  for (const TriangleVariant& variant : all_variants<TriangleTest>())
    EXPECT_EQ(closest_hit(ray, columns.arrays(), options_of(variant)).primitive, 15u) << variant.name();
}

// Whatever else is asked for, t and the decision have the same bits; what is not asked for is not written.
TEST(Triangles, compute_what_is_asked_for_and_nothing_else) {
  Random random(117);
  const TriangleScene scene = scene_for_all_widths(Aim::anywhere, random);
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    RayColumns rays(
        std::span(scene.rays).first(variant.test == TriangleTest::directional ? 1 : scene.rays.size()));
    for (const bool wants_u : {false, true})
      for (const bool wants_v : {false, true}) {
        TriangleHitColumns all(rays.size()), some(rays.size());
        const TriangleResult untouched = some[0];
        TriangleHits hits = some.hits();
        if (!wants_u) hits.u = {};
        if (!wants_v) hits.v = {};
        closest_hits(rays.arrays(), scene.triangles[0], all.hits(), options_of(variant));
        closest_hits(rays.arrays(), scene.triangles[0], hits, options_of(variant));
        for (std::size_t i = 0; i < rays.size(); ++i) {
          TriangleResult expected = all[i];
          if (!wants_u) expected.u = untouched.u;
          if (!wants_v) expected.v = untouched.v;
          ASSERT_EQ(some[i], expected) << variant.name() << wants_u << wants_v;
        }
      }
  }
}

TEST(Triangles, have_a_normal_of_their_own) {
  EXPECT_EQ(normal_of(floor_triangle), (Float3{0, 0, 16}));
  EXPECT_EQ(normal_of(make_triangle({0, 4, 1}, {4, 0, 1}, {0, 0, 1})), (Float3{0, 0, -16}));
  EXPECT_EQ(normal_of(make_triangle({1, 1, 1}, {2, 2, 2}, {3, 3, 3})), (Float3{0, 0, 0}));
}

}  // namespace
}  // namespace raylanes::testing
