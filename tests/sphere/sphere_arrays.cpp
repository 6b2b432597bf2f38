// Spheres over arrays, and the calls on them.
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/spheres.hpp"
#include "../intervals/arrays.hpp"
#include "../intervals/calls.hpp"
#include "../support/same_bytes.hpp"
#include "sphere_answers.hpp"

namespace raylanes::testing {

template <>
SphereScene scene_of_many<SphereTest>(std::size_t count) {
  Random random(306);
  SphereScene scene;
  while (scene.rays.size() < count || scene.primitives.size() < count) {
    const SphereScene more = sphere_scene(3, random);
    scene.rays.insert(scene.rays.end(), more.rays.begin(), more.rays.end());
    scene.primitives.insert(scene.primitives.end(), more.primitives.begin(), more.primitives.end());
  }
  return scene;
}

// The first ray and the first sphere miss, the second ones meet each other.
template <>
struct Door<SphereTest> {
  using Options = SphereOptions;
  static SphereScene scene() {
    return {{make_ray({0, 0, 5}, {0, 0, -1}), make_ray({1, 0, 5}, {0, 0, -1})},
            {ball({2, 0, 0}, 1), ball({0, 0, 0}, 1)}};
  }
  static raylanes::Sphere one(const Sphere& sphere) {
    const auto& [x, y, z, square] = sphere.value;
    return {{x, y, z}, std::sqrt(square)};
  }
  template <class... Arguments>
  static void ends(Arguments&&... arguments) {
    distances(arguments...);
  }
};

INSTANTIATE_TYPED_TEST_SUITE_P(Spheres, IntervalArrays, SphereTest);
INSTANTIATE_TYPED_TEST_SUITE_P(Spheres, IntervalCalls, SphereTest);

namespace {

// The line test and the closest hit, which boxes do not have.
class SphereArraysOf : public ::testing::Test {
 protected:
  static constexpr std::size_t most = 40;

  void ask_one_by_one(const SphereVariant& variant) {
    singles_.clear(), by_line_.clear();
    for (std::size_t i = 0; i < most; ++i) {
      const std::span<const Sphere> sphere(&scene_.primitives[i], 1);
      by_line_.push_back(line_answers(*variant.path, variant.grade, {&scene_.rays[0], 1}, sphere)[0]);
      singles_.push_back(closest_answer(variant, scene_.rays[0], sphere));
    }
  }

  // Each answer as if asked alone, the nearest of what takes part; an invalid ray misses all of it.
  void check(const SphereVariant& variant, const SphereColumns& spheres, Place place, LaneBits active) {
    const std::size_t n = spheres.size();
    const std::string name = variant.name() + ", n = " + std::to_string(n) + (active ? ", masked" : "");
    const auto line_of_spheres =
        kernels_of(*variant.path).spheres.line_of_spheres[static_cast<std::size_t>(variant.grade)];
    IntervalColumns line(n, place), of_invalid(n, place), before(n);
    line_of_spheres(scene_.rays[0], spheres.soa(), n, active, line.bits());
    line_of_spheres(make_ray({0, 0, 0}, {0, 0, 0}), spheres.soa(), n, active, of_invalid.bits());
    Hit found, nearest;
    variant.kernels().closest_of_spheres(scene_.rays[0], spheres.soa(), n, active, found);
    for (std::size_t i = 0; i < n; ++i) {
      const bool takes_part = active == nullptr || is_set({active, (n + 7) / 8}, i);
      ASSERT_EQ(line.is_hit(i), takes_part ? by_line_[i] : before.is_hit(i)) << name << " sphere " << i;
      ASSERT_EQ(of_invalid.is_hit(i), takes_part ? false : before.is_hit(i)) << name << " sphere " << i;
      if (takes_part && singles_[i] && singles_[i].t < nearest.t)
        nearest = {singles_[i].t, 0, 0, static_cast<std::uint32_t>(i)};
    }
    ASSERT_TRUE(line.are_intact() && of_invalid.are_intact()) << name;
    ASSERT_TRUE(same_bytes(found, nearest)) << name;
  }

  SphereScene scene_ = scene_of_many<SphereTest>(most);
  std::vector<Hit> singles_;
  std::vector<bool> by_line_;
};

TEST_F(SphereArraysOf, lines_and_closest_hits_of_any_length_and_mask_are_as_if_one_by_one) {
  for (const SphereVariant& variant : all_variants<SphereTest>()) {
    ask_one_by_one(variant);
    for_all_masks(
        most,
        [&](std::size_t n, Place place) {
          return SphereColumns(std::span(scene_.primitives).first(n), place);
        },
        [&](const SphereColumns& spheres, Place place, LaneBits active) {
          check(variant, spheres, place, active);
        });
    if (HasFatalFailure()) return;
  }
}

// Blocks of eight registers and what is left of one.
TEST(SphereArrays, of_many_rays_are_as_if_one_by_one) {
  Random random(313);
  std::vector<Ray> rays;
  Sphere sphere;
  while (rays.size() < 300) {
    const SphereScene scene = sphere_scene(3, random);
    sphere = scene.primitives[0];
    rays.insert(rays.end(), scene.rays.begin(), scene.rays.end());
  }
  // Directions of all lengths: each ray has a scale of its own.
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (float& x : rays[i].direction)
      x *= std::bit_cast<float>(static_cast<std::uint32_t>(100 + i % 50) << 23);
  for (const SphereVariant& variant : all_variants<SphereTest>())
    for (const std::size_t n : {127u, 128u, 129u, 255u, 300u}) {
      const auto all = answers(variant, std::span(rays).first(n), {&sphere, 1});
      for (std::size_t i = 0; i < n; ++i)
        ASSERT_EQ(all[i], answers(variant, {&rays[i], 1}, {&sphere, 1})[0]) << variant.name() << " ray " << i;
    }
}

}  // namespace
}  // namespace raylanes::testing
