// The calls on spheres: what their options mean, what they refuse, and that nothing is written then.
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "../support/message_of.hpp"
#include "answers.hpp"

namespace raylanes::testing {
namespace {

// Two rays or spheres, and what all calls write to.
struct Calls {
  const Ray down = make_ray({0, 0, 5}, {0, 0, -1}), up = make_ray({0, 0, 5}, {0, 0, 1});
  const raylanes::Sphere unit{{0, 0, 0}, 1}, distant{{9, 9, 9}, -0.5f};
  RayColumns rays{std::vector<Ray>{up, down}};
  SphereColumns spheres{
      std::vector<oracle::Sphere>{ball(distant.centre, distant.radius), ball({0, 0, 0}, 1)}};
  std::vector<std::uint8_t> bits = std::vector<std::uint8_t>(1, 0xa5);
  std::vector<float> near = std::vector<float>(2, 7), far = std::vector<float>(2, 7);

  // check(name, call) for each.
  template <class Check>
  void each(const SphereOptions& options, Check check) {
    check("any_hits of spheres", [&] { any_hits(down, spheres.arrays(), bits, options); });
    check("any_hits of rays", [&] { any_hits(rays.arrays(), unit, bits, options); });
    check("distances of spheres", [&] { distances(down, spheres.arrays(), bits, near, far, options); });
    check("distances of rays", [&] { distances(rays.arrays(), unit, bits, near, far, options); });
    check("line_hits", [&] { line_hits(down, spheres.arrays(), bits, options); });
    check("closest_hit", [&] { closest_hit(down, spheres.arrays(), options); });
  }
  void expect_untouched() const {
    EXPECT_EQ(bits, std::vector<std::uint8_t>(bits.size(), 0xa5));
    for (const float x : near) EXPECT_EQ(x, 7);
    for (const float x : far) EXPECT_EQ(x, 7);
  }
};

TEST(SphereCalls, answer_as_their_options_say) {
  for (const SphereVariant& variant : all_variants<SphereTest>()) {
    SCOPED_TRACE(variant.name());
    const std::uint8_t first_alone = 0xfd;  // of two
    for (const LaneBits mask : {LaneBits(nullptr), LaneBits(&first_alone)}) {
      const SphereOptions options{variant.test, variant.grade, variant.path, mask};
      // The first is missed, the second is hit if it takes part; bits behind stay.
      const std::uint8_t expected = mask == nullptr ? 0xa6 : 0xa4;
      Calls calls;
      calls.each(options, [&](const char* name, auto call) {
        calls.bits[0] = 0xa5;
        calls.near = calls.far = {7, 7};
        call();
        if (name == std::string("closest_hit")) return;
        EXPECT_EQ(calls.bits[0], expected) << name;
        if (!std::string_view(name).starts_with("distances")) return;
        EXPECT_EQ(calls.near[0], infinity) << name;
        EXPECT_EQ(calls.far[0], -infinity) << name;
        EXPECT_EQ(calls.near[1], mask == nullptr ? 4 : 7) << name;
        EXPECT_EQ(calls.far[1], mask == nullptr ? 6 : 7) << name;
      });
      const Hit hit = closest_hit(calls.down, calls.spheres.arrays(), options);
      EXPECT_EQ(hit.primitive, mask == nullptr ? 1u : no_primitive);
      EXPECT_EQ(hit.t, mask == nullptr ? 4 : infinity);
    }
  }
}

TEST(SphereCalls, refuse_more_spheres_than_a_hit_can_name) {
  if (sizeof(std::size_t) == 4) GTEST_SKIP() << "there are no more";
  SphereArrays many{};
  many.size = static_cast<std::size_t>(no_primitive) + 1;
  const std::uint8_t unread = 0;
  EXPECT_NE(message_of([&] { closest_hit(Ray{}, many, {.active = &unread}); }).find("4294967296 spheres"),
            std::string::npos);
}

TEST(SphereCalls, refuse_enumerators_that_do_not_exist) {
  for (const int wrong : {2, 3, 100, 255}) {
    Calls calls;
    calls.each({.test = static_cast<SphereTest>(wrong)}, [&](const char* name, auto call) {
      if (name == std::string("line_hits")) return;  // a test of its own
      EXPECT_NE(message_of(call).find("test " + std::to_string(wrong)), std::string::npos) << name;
    });
    calls.each({.grade = static_cast<Grade>(wrong)}, [&](const char* name, auto call) {
      EXPECT_NE(message_of(call).find("grade " + std::to_string(wrong)), std::string::npos) << name;
    });
    calls.expect_untouched();
  }
}

TEST(SphereCalls, refuse_a_path_that_the_machine_lacks) {
  const Path* foreign = nullptr;
  for (const Path& path : paths())
    if (!supported(path)) foreign = &path;
  if (foreign == nullptr) GTEST_SKIP() << "this machine supports all paths";
  Calls calls;
  calls.each({.path = foreign},
             [](const char* name, auto call) { EXPECT_THROW(call(), std::invalid_argument) << name; });
  calls.expect_untouched();
}

TEST(SphereCalls, refuse_spans_of_other_sizes) {
  const auto refuse = [](const char* name, auto call) {
    EXPECT_THROW(call(), std::invalid_argument) << name;
  };
  for (const std::size_t bytes : {0u, 2u}) {
    Calls calls;
    calls.bits.assign(bytes, 0xa5);
    calls.each({}, [&](const char* name, auto call) {
      if (name != std::string("closest_hit")) refuse(name, call);
    });
    calls.expect_untouched();
  }
  for (const std::size_t floats : {0u, 1u, 3u}) {
    Calls calls;
    const auto distances_alone = [&](const char* name, auto call) {
      if (std::string_view(name).starts_with("distances")) refuse(name, call);
    };
    calls.near.assign(floats, 7);
    calls.each({}, distances_alone);
    calls.near.assign(2, 7), calls.far.assign(floats, 7);
    calls.each({}, distances_alone);
    calls.expect_untouched();
  }
}

TEST(SphereCalls, take_nothing_at_all) {
  const SphereArrays none{};
  const RayArrays no_rays{};
  const Ray ray = make_ray({0, 0, 0}, {0, 0, 1});
  any_hits(ray, none, {});
  any_hits(no_rays, raylanes::Sphere{}, {});
  line_hits(ray, none, {});
  distances(ray, none, {}, {}, {});
  distances(no_rays, raylanes::Sphere{}, {}, {}, {});
  EXPECT_FALSE(closest_hit(ray, none));
}

}  // namespace
}  // namespace raylanes::testing
