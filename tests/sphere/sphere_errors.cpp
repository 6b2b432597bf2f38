// The calls that only spheres have: what their options mean and what they refuse.
#include "../support/message_of.hpp"
#include "sphere_answers.hpp"

namespace raylanes::testing {
namespace {

struct Calls {
  const Ray down = make_ray({0, 0, 5}, {0, 0, -1});
  SphereColumns spheres{std::vector<Sphere>{ball({9, 9, 9}, -0.5f), ball({0, 0, 0}, 1)}};
  std::vector<std::uint8_t> bits = std::vector<std::uint8_t>(1, 0xa5);

  void line(const SphereOptions& options) { line_hits(down, spheres.arrays(), bits, options); }
  Hit closest(const SphereOptions& options) const { return closest_hit(down, spheres.arrays(), options); }
};

TEST(SphereCalls, of_lines_and_closest_hits_answer_as_their_options_say) {
  for (const SphereVariant& variant : all_variants<SphereTest>()) {
    SCOPED_TRACE(variant.name());
    const std::uint8_t first_alone = 0xfd;  // of two
    for (const LaneBits mask : {LaneBits(nullptr), LaneBits(&first_alone)}) {
      const SphereOptions options{variant.test, variant.grade, variant.path, mask};
      Calls calls;
      calls.line(options);
      EXPECT_EQ(calls.bits[0], mask == nullptr ? 0xa6 : 0xa4) << "bits behind the last stay";
      const Hit hit = calls.closest(options);
      EXPECT_EQ(hit.primitive, mask == nullptr ? 1u : no_primitive);
      EXPECT_EQ(hit.t, mask == nullptr ? 4 : infinity);
    }
  }
}

TEST(SphereCalls, of_lines_and_closest_hits_refuse_options_that_do_not_exist) {
  Calls calls;
  const auto closest = [&](const SphereOptions& options, auto check) {
    check("closest_hit", [&] { calls.closest(options); });
  };
  // Lines do not look at the test.
  const auto line = [&](const SphereOptions& options, auto check) {
    if (options.test == SphereTest{}) check("line_hits", [&] { calls.line(options); });
  };
  expect_wrong_enumerators_refused<SphereOptions>(2, closest);
  expect_wrong_enumerators_refused<SphereOptions>(2, line);
  EXPECT_EQ(calls.bits[0], 0xa5);
}

TEST(SphereCalls, of_lines_and_closest_hits_refuse_a_path_that_the_machine_lacks) {
  Calls calls;
  expect_foreign_path_refused<SphereOptions>([&](const SphereOptions& options, auto check) {
    check("closest_hit", [&] { calls.closest(options); });
    check("line_hits", [&] { calls.line(options); });
  });
  EXPECT_EQ(calls.bits[0], 0xa5);
}

TEST(SphereCalls, of_lines_refuse_spans_of_other_sizes) {
  Calls calls;
  for (const std::size_t bytes : {0u, 2u}) {
    calls.bits.assign(bytes, 0xa5);
    EXPECT_THROW(calls.line({}), std::invalid_argument);
    EXPECT_EQ(calls.bits, std::vector<std::uint8_t>(bytes, 0xa5));
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

TEST(SphereCalls, of_lines_and_closest_hits_take_nothing_at_all) {
  line_hits(make_ray({0, 0, 0}, {0, 0, 1}), SphereArrays{}, {});
  EXPECT_FALSE(closest_hit(make_ray({0, 0, 0}, {0, 0, 1}), SphereArrays{}));
}

}  // namespace
}  // namespace raylanes::testing
