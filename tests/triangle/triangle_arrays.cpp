// All triangle tests over arrays: any length, alignment and mask, and bad numbers in one lane.
#include "../../dispatch/table/triangles.hpp"
#include "../support/float_modes.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "judge/triangle_answers.hpp"

namespace raylanes::testing {
namespace {

const Ray down = make_ray({1, 1, 2}, {0, 0, -1});

// Rays and triangles for all tests alike: `directional` wants one direction, so all rays get that of the first and
// start so that they reach what they were aimed at.
TriangleScene scene_for(const TriangleVariant& variant, std::uint64_t seed, std::size_t size) {
  Random random(seed);
  TriangleScene scene = aimed_scene(Aim::anywhere, size, size, random);
  for (Ray& ray : scene.rays) {
    ray.tmin = -infinity;
    if (variant.test != TriangleTest::directional) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ray.origin[axis] += ray.direction[axis] - scene.rays[0].direction[axis];
      ray.direction[axis] = scene.rays[0].direction[axis];
    }
  }
  return scene;
}

// Arrays of any length up to 40 and any mask, between guard pages, in either place: nothing is read or written that
// does not take part.
class TriangleArraysOf : public ::testing::TestWithParam<TriangleTest> {
 protected:
  static constexpr std::size_t most = 40;

  // n elements in their guards.
  struct Inputs {
    std::size_t n;
    Place place;
    GuardedNumbers triangles;
    RayColumns rays;
    std::vector<float> target;
  };
  Inputs inputs(const TriangleVariant& variant, std::size_t n, Place place) const {
    return {n, place, GuardedNumbers(variant, std::span(scene_.triangles).first(n), direction_, place),
            RayColumns(std::span(scene_.rays).first(n), place),
            GuardedNumbers(variant, std::span(scene_.triangles).first(1), direction_).one(0)};
  }

  void check(const TriangleVariant& variant, Inputs& in, LaneBits active) {
    const std::size_t n = in.n;
    const auto is_active = [&](std::size_t i) {
      return active == nullptr || (active[i / 8] >> i % 8 & 1u) != 0;
    };
    const auto tell = [&] { return variant.name() + " n " + std::to_string(n) + (active ? " masked" : ""); };
    const TriangleRow& row = variant.kernels();
    GuardedArray<std::uint8_t> bits((n + 7) / 8, in.place), any((n + 7) / 8, in.place);
    TriangleHitColumns out(n, in.place), before(n);
    const std::vector<std::uint8_t> old(bits.data(), bits.data() + bits.size());
    row.any_of_triangles(scene_.rays[0], in.triangles.arrays(), n, active, bits.data());
    const TriangleHits to = out.hits();
    row.closest_of_rays(in.rays.arrays(), in.target.data(), active, to.bits.data(), to.t.data(), to.u.data(),
                        to.v.data());
    row.any_of_rays(in.rays.arrays(), in.target.data(), active, any.data());
    Hit nearest, found;
    row.closest_of_triangles(scene_.rays[0], in.triangles.arrays(), n, active, found);
    for (std::size_t i = 0; i < n; ++i) {
      const TriangleResult& hit = by_triangle_[i];
      ASSERT_EQ(is_set({bits.data(), bits.size()}, i), is_active(i) ? hit.hit != 0 : is_set(old, i))
          << tell() << i;
      ASSERT_EQ(out[i], is_active(i) ? by_ray_[i] : before[i]) << tell() << " ray " << i;
      ASSERT_EQ(is_set({any.data(), any.size()}, i), out[i].hit != 0) << tell() << " ray " << i;
      if (is_active(i) && hit.hit != 0 && hit.t < nearest.t)
        nearest = {hit.t, hit.u, hit.v, static_cast<std::uint32_t>(i)};
    }
    for (std::size_t i = n; i < 8 * bits.size(); ++i)
      ASSERT_TRUE(is_set({bits.data(), bits.size()}, i) == is_set(old, i) &&
                  is_set({any.data(), any.size()}, i) == is_set(old, i))
          << tell() << " bit " << i;
    ASSERT_TRUE(same_bytes(found, nearest)) << tell();
    ASSERT_TRUE(out.are_intact() && bits.is_intact() && any.is_intact()) << tell();
  }

  // Rays and triangles, and each answer by a call of its own.
  void make_scene(const TriangleVariant& variant) {
    scene_ = scene_for(variant, 106, most);
    direction_ = scene_.rays[0].direction.data();
    by_ray_.clear(), by_triangle_.clear();
    for (std::size_t i = 0; i < most; ++i) {
      by_ray_.push_back(single(variant, scene_.rays[i], scene_.triangles[0]));
      by_triangle_.push_back(single(variant, scene_.rays[0], scene_.triangles[i]));
    }
  }

  TriangleScene scene_;
  const float* direction_ = nullptr;
  Results by_ray_, by_triangle_;
};

TEST_P(TriangleArraysOf, any_length_alignment_and_mask_are_as_if_one_by_one) {
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    if (variant.test != GetParam()) continue;
    make_scene(variant);
    for_all_masks(
        most, [&](std::size_t n, Place place) { return inputs(variant, n, place); },
        [&](Inputs& in, Place, LaneBits active) {
          if (!quick() || in.n <= 9 || in.n == 15 || in.n == 17) check(variant, in, active);
        });
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Tests, TriangleArraysOf, ::testing::ValuesIn(all_triangle_tests),
                         [](const auto& each) { return name_of(each.param); });

TEST(TriangleArrays, what_takes_no_part_may_hold_anything) {
  Random random(107);
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    const TriangleScene scene = scene_for(variant, 107, 19);
    const Results whole = answers(variant, scene.rays, scene.triangles);
    std::uint8_t active[3] = {};
    // The first ray's direction must not count for the others that share one.
    const bool first = variant.test != TriangleTest::directional;
    for (std::size_t i = 0; i < 19; ++i)
      if (i == 0 ? first : random.chance(0.5))
        active[i / 8] = static_cast<std::uint8_t>(active[i / 8] | 1u << (i % 8));
    TriangleScene spoiled = scene;
    for (std::size_t i = 0; i < 19; ++i)
      if (!is_set(active, i)) {
        spoiled.rays[i] = make_ray({nan, nan, nan}, {nan, nan, nan}, nan, nan);
        spoiled.triangles[i] = make_triangle({nan, nan, nan}, {nan, nan, nan}, {nan, nan, nan});
      }
    TriangleColumns triangles(spoiled.triangles);
    RayColumns rays(spoiled.rays);
    TriangleHitColumns out(19);
    const TriangleResult before = out[0];
    std::uint8_t bits[3] = {0x5a, 0xa5, 0x5a};
    constexpr std::uint8_t old[3] = {0x5a, 0xa5, 0x5a};
    hit_mask(scene.rays[0], triangles.arrays(), bits, options_of(variant, active));
    closest_hits(rays.arrays(), scene.triangles[0], out.hits(), options_of(variant, active));
    Hit nearest;
    for (std::uint32_t i = 0; i < 19; ++i) {
      const TriangleResult& result = whole[i * 19];
      ASSERT_EQ(is_set(bits, i), is_set(active, i) ? result.hit != 0 : is_set(old, i)) << variant.name();
      TriangleResult untouched = before;
      untouched.hit = out[i].hit;  // a bit of its own, see above
      ASSERT_EQ(out[i], is_set(active, i) ? whole[i] : untouched) << variant.name();
      if (is_set(active, i) && result.hit != 0 && result.t < nearest.t)
        nearest = {result.t, result.u, result.v, i};
    }
    const Hit found = closest_hit(scene.rays[0], triangles.arrays(), options_of(variant, active));
    EXPECT_TRUE(same_bytes(found, nearest)) << variant.name();
  }
}

// Inactive triangles need not be there: more than a register of them lie on a page that may not be touched.
TEST(TriangleArrays, inactive_triangles_may_be_nowhere) {
  constexpr std::size_t n = 19, more = 40;
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    const TriangleScene scene = scene_for(variant, 109, n);
    const TriangleColumns triangles(scene.triangles, Place::before_guard);
    TriangleArrays arrays = triangles.arrays();
    std::uint8_t bits[3], of_more[(n + more + 7) / 8];
    const Hit nearest = closest_hit(scene.rays[0], arrays, options_of(variant));
    hit_mask(scene.rays[0], arrays, bits, options_of(variant));
    arrays.size += more;
    const std::uint8_t active[sizeof of_more] = {0xff, 0xff, 0x07};
    const Hit found = closest_hit(scene.rays[0], arrays, options_of(variant, active));
    hit_mask(scene.rays[0], arrays, of_more, options_of(variant, active));
    EXPECT_TRUE(same_bytes(found, nearest)) << variant.name();
    for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(is_set(of_more, i), is_set(bits, i)) << variant.name();
  }
}

constexpr float bad_values[] = {nan, -nan, infinity, -infinity};

// Input k of 15: origin, direction, corners.
void spoil(Ray& ray, Triangle& triangle, std::size_t k, float value) {
  if (k < 3)
    ray.origin[k] = value;
  else if (k < 6)
    ray.direction[k - 3] = value;
  else
    triangle.corner[(k - 6) / 3][k % 3] = value;
}

TEST(TriangleArrays, a_bad_number_in_any_input_is_a_miss_and_disturbs_no_other_lane) {
  constexpr std::size_t n = 19;
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
      const TriangleResult good = single(variant, down, floor_triangle);
      for (std::size_t k = 0; k < 15; ++k)
        for (const float value : bad_values) {
          SCOPED_TRACE(variant.name() + " input " + std::to_string(k) + " = " + std::to_string(value));
          Ray ray = down;
          Triangle triangle = floor_triangle;
          spoil(ray, triangle, k, value);
          EXPECT_EQ(single(variant, ray, triangle), triangle_missed);
          const std::size_t lane = (k * 3) % n;
          std::vector<Ray> rays(k < 6 ? n : 1, down);
          std::vector<Triangle> triangles(k < 6 ? 1 : n, floor_triangle);
          (k < 6 ? rays[lane] : rays[0]) = ray, (k < 6 ? triangles[0] : triangles[lane]) = triangle;
          Results expected(n, good);
          expected[lane] = triangle_missed;
          EXPECT_EQ(answers(variant, rays, triangles), expected);
        }
    }
  }
}

// The mask keeps it from being the nearest, not its content.
TEST(TriangleArrays, an_inactive_triangle_is_not_the_nearest_of_prepared_ones) {
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    const TriangleScene scene = scene_for(variant, 108, 19);
    const TriangleColumns triangles(scene.triangles);
    std::size_t rays_of_two = 0;
    for (const Ray& ray : scene.rays) {
      const PreparedTriangles prepared(triangles.arrays(), options_of(variant), ray.direction);
      const Hit first = closest_hit(ray, prepared);
      if (!first) continue;
      std::uint8_t active[3] = {0xff, 0xff, 0xff};
      active[first.primitive / 8] = static_cast<std::uint8_t>(0xff ^ 1u << first.primitive % 8);
      const Hit second = closest_hit(ray, triangles.arrays(), options_of(variant, active));
      if (second) ++rays_of_two;
      const Hit found = closest_hit(ray, prepared, active);
      EXPECT_TRUE(same_bytes(found, second)) << variant.name();
    }
    EXPECT_GT(rays_of_two, 0u) << variant.name();
  }
}

}  // namespace
}  // namespace raylanes::testing
