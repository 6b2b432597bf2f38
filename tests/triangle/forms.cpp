// All triangle forms on every path: those that must equal the table's kernels bit for bit, equal bits on all
// paths, the first of equal hits, and what is computed of a hit.
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "../support/random_input.hpp"
#include "answers.hpp"
#include "scenes.hpp"

namespace raylanes::testing {
namespace {

using Results = std::vector<TriangleResult>;

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
    d[static_cast<std::size_t>(random.integer(0, 2))] = random.chance(0.5) ? 4.0f : -4.0f;
    scene.rays.push_back(make_ray(point(), d, random.chance(0.5) ? 0.0f : -infinity));
  }
  return scene;
}

// The kernels of the table that a form must equal, if there are any.
const TriangleKernels* twin_of(const FormVariant& variant) {
  const bool watertight = variant.test == TriangleForm::watertight;
  const bool moller_trumbore = variant.test == TriangleForm::moller_trumbore ||
                               variant.test == TriangleForm::moller_trumbore_edges ||
                               variant.test == TriangleForm::directional;
  if (!watertight && !moller_trumbore) return nullptr;
  const TriangleTest test = watertight ? TriangleTest::watertight : TriangleTest::moller_trumbore;
  return &KernelVariant{variant.path, test, variant.grade}.kernels();
}

void check_against_twin(const TriangleScene& scene) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    for (const FormVariant& variant : all_variants<TriangleForm>())
      if (const TriangleKernels* twin = twin_of(variant)) {
        ASSERT_EQ(answers(variant, scene.rays, scene.triangles),
                  many_rays(*twin, scene.rays, scene.triangles))
            << variant.name() << ' ' << name_of(mode);
      }
  }
}

TEST(TriangleForms, equal_the_kernels_of_the_table_bit_for_bit) {
  Random random(101);
  for (int round = 0; round < (quick() ? 1 : 12); ++round) {
    for (const Aim aim : aims) check_against_twin(scene_for_all_widths(aim, random));
    check_against_twin(integer_scene(random));
    if (HasFailure()) return;
  }
}

TEST(TriangleForms, have_the_same_bits_on_every_path_in_the_reproducible_grade) {
  Random random(102);
  for (int round = 0; round < (quick() ? 1 : 8); ++round)
    for (const Aim aim : aims) {
      const TriangleScene scene = scene_for_all_widths(aim, random);
      std::map<TriangleForm, Results> first;
      for (const FormVariant& variant : all_variants<TriangleForm>()) {
        if (variant.grade != Grade::reproducible) continue;
        const Results results = answers(variant, scene.rays, scene.triangles);
        const auto [kept, is_new] = first.emplace(variant.test, results);
        ASSERT_TRUE(is_new || kept->second == results) << variant.name();
      }
    }
}

// Equal hits on both sides of a register's end: the first of them is in the last lane of any width.
TEST(TriangleForms, keep_the_first_of_equal_hits) {
  const Ray ray = make_ray({1, 1, 2}, {0, 0, -1});
  std::vector<Triangle> triangles(32, make_triangle({9, 9, 0}, {8, 9, 0}, {9, 8, 0}));
  triangles[15] = triangles[16] = floor_triangle;
  for (const FormVariant& variant : all_variants<TriangleForm>()) {
    const PreparedTriangles prepared(variant, triangles, ray.direction.data());
    for (const Wanted wanted : {Wanted::distance, Wanted::weights})
      EXPECT_EQ(closest_hit(variant.kernels(), wanted, ray, prepared.columns(), columns_of(variant.test), 32)
                    .hit.primitive,
                15u)
          << variant.name();
  }
}

TEST(TriangleForms, compute_what_is_wanted_and_nothing_else) {
  const Ray ray = make_ray({1, 1, 2}, {0, 0, -1});
  const Triangle triangles[2] = {make_triangle({0, 4, 1}, {4, 0, 1}, {0, 0, 1}), floor_triangle};
  for (const FormVariant& variant : all_variants<TriangleForm>()) {
    const PreparedTriangles prepared(variant, triangles, ray.direction.data());
    for (const Wanted wanted : {Wanted::distance, Wanted::weights, Wanted::weights_and_normal}) {
      const NearestHit found =
          closest_hit(variant.kernels(), wanted, ray, prepared.columns(), columns_of(variant.test), 2);
      EXPECT_EQ(found.hit.primitive, 0u) << variant.name();
      EXPECT_EQ(found.hit.t, 1) << variant.name();
      const bool weights = wanted != Wanted::distance, normal = wanted == Wanted::weights_and_normal;
      EXPECT_FLOAT_EQ(found.hit.u, weights ? 0.25f : 0) << variant.name();
      EXPECT_FLOAT_EQ(found.hit.v, weights ? 0.5f : 0) << variant.name();
      EXPECT_EQ(found.normal[0], 0) << variant.name();
      EXPECT_EQ(found.normal[2], normal ? -16 : 0) << variant.name();
      RayColumns rays({&ray, 1});
      float t, u, v, n[3];
      std::uint32_t hit;
      closest_hits(variant.kernels(), Wanted::weights_and_normal, rays.arrays(), 1, prepared.one(1).data(),
                   {&t, &hit, &u, &v, {&n[0], &n[1], &n[2]}});
      EXPECT_EQ(n[2], 16) << variant.name();
      EXPECT_EQ(t, 2) << variant.name();
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
