// The calls on boxes: that they ask the rows that the options name, what they refuse, and that nothing is written then.
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "../support/message_of.hpp"
#include "answers.hpp"

namespace raylanes::testing {
namespace {

// Two rays or boxes, and what all calls write to.
struct Calls {
  Random random{207};
  BoxScene scene = scene_around_one_box(2, random);
  RayColumns rays{scene.rays};
  BoxColumns boxes{scene.boxes};
  std::vector<std::uint8_t> bits = std::vector<std::uint8_t>(1, 0xa5);
  std::vector<float> entry = std::vector<float>(2, 7), exit = std::vector<float>(2, 7);

  // check(name, call) for each.
  template <class Check>
  void each(const BoxOptions& options, Check check) {
    check("any_hits of boxes", [&] { any_hits(scene.rays[0], boxes.arrays(), bits, options); });
    check("any_hits of rays", [&] { any_hits(rays.arrays(), scene.boxes[0], bits, options); });
    check("intervals of boxes",
          [&] { intervals(scene.rays[0], boxes.arrays(), bits, entry, exit, options); });
    check("intervals of rays", [&] { intervals(rays.arrays(), scene.boxes[0], bits, entry, exit, options); });
  }
  void expect_untouched() const {
    EXPECT_EQ(bits, std::vector<std::uint8_t>(bits.size(), 0xa5));
    for (const float x : entry) EXPECT_EQ(x, 7);
    for (const float x : exit) EXPECT_EQ(x, 7);
  }
};

TEST(BoxCalls, answer_as_the_rows_that_their_options_name) {
  for (const BoxVariant& variant : all_variants<BoxTest>()) {
    Calls calls;
    const std::uint8_t active = 0x02;
    for (const LaneBits mask : {LaneBits(nullptr), LaneBits(&active)}) {
      const BoxOptions options{variant.test, variant.grade, variant.path, mask};
      const auto expected = answers(variant, calls.scene.rays, calls.scene.boxes);
      for (const bool of_rays : {false, true}) {
        if (of_rays)
          intervals(calls.rays.arrays(), calls.scene.boxes[0], calls.bits, calls.entry, calls.exit, options);
        else
          intervals(calls.scene.rays[0], calls.boxes.arrays(), calls.bits, calls.entry, calls.exit, options);
        const BoxResult& e = expected[of_rays ? 1 : 2];
        EXPECT_EQ((BoxResult{calls.entry[1], calls.exit[1], is_set(calls.bits, 1) ? hit_flag : 0}), e)
            << variant.name();
        std::vector<std::uint8_t> bits(1, static_cast<std::uint8_t>(~calls.bits[0]));
        if (of_rays)
          any_hits(calls.rays.arrays(), calls.scene.boxes[0], bits, options);
        else
          any_hits(calls.scene.rays[0], calls.boxes.arrays(), bits, options);
        EXPECT_EQ(is_set(bits, 1), e.hit != 0) << variant.name();
        EXPECT_EQ(is_set(bits, 0) == is_set(calls.bits, 0), mask == nullptr) << variant.name();
        EXPECT_NE(is_set(bits, 2), is_set(calls.bits, 2)) << variant.name() << ": a bit behind the last";
      }
    }
  }
}

TEST(BoxCalls, refuse_enumerators_that_do_not_exist) {
  for (const int wrong : {3, 4, 100, 255}) {
    Calls calls;
    calls.each({.test = static_cast<BoxTest>(wrong)}, [&](const char* name, auto call) {
      EXPECT_NE(message_of(call).find("test " + std::to_string(wrong)), std::string::npos) << name;
    });
    calls.each({.grade = static_cast<Grade>(wrong)}, [&](const char* name, auto call) {
      EXPECT_NE(message_of(call).find("grade " + std::to_string(wrong)), std::string::npos) << name;
    });
    calls.expect_untouched();
  }
}

TEST(BoxCalls, refuse_a_path_that_the_machine_lacks) {
  const Path* foreign = nullptr;
  for (const Path& path : paths())
    if (!supported(path)) foreign = &path;
  if (foreign == nullptr) GTEST_SKIP() << "this machine supports all paths";
  Calls calls;
  calls.each({.path = foreign},
             [](const char* name, auto call) { EXPECT_THROW(call(), std::invalid_argument) << name; });
  calls.expect_untouched();
}

TEST(BoxCalls, refuse_spans_of_other_sizes) {
  const auto refuse = [](const char* name, auto call) {
    EXPECT_THROW(call(), std::invalid_argument) << name;
  };
  for (const std::size_t bytes : {0u, 2u}) {
    Calls calls;
    calls.bits.assign(bytes, 0xa5);
    calls.each({}, refuse);
    calls.expect_untouched();
  }
  for (const std::size_t floats : {0u, 1u, 3u}) {
    Calls calls;
    const auto intervals_alone = [&](const char* name, auto call) {
      if (std::string_view(name).starts_with("intervals")) refuse(name, call);
    };
    calls.entry.assign(floats, 7);
    calls.each({}, intervals_alone);
    calls.entry.assign(2, 7), calls.exit.assign(floats, 7);
    calls.each({}, intervals_alone);
    calls.expect_untouched();
  }
}

TEST(BoxCalls, take_nothing_at_all) {
  const BoxArrays none{};
  const RayArrays no_rays{};
  any_hits(make_ray({0, 0, 0}, {0, 0, 1}), none, {});
  any_hits(no_rays, Box{}, {});
  intervals(make_ray({0, 0, 0}, {0, 0, 1}), none, {}, {}, {});
  intervals(no_rays, Box{}, {}, {}, {});
}

}  // namespace
}  // namespace raylanes::testing
