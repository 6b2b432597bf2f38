// Tests of the public calls on boxes and on spheres: that they ask the rows that the options name, what they refuse,
// and that nothing is written then.
#pragma once

#include "../support/message_of.hpp"
#include "interval_answers.hpp"

namespace raylanes::testing {

// A call of a door and what it has to do with.
struct Call {
  std::string name;
  bool of_rays = false;   // many rays, else many primitives
  bool has_ends = false;  // and where rays enter and leave
};

// The part that a kind of test adds: its options, two rays and two primitives, one of them as users write it, and the
// call for where rays enter and leave.
template <class Kind>
struct Door;

template <class Kind>
struct Calls {
  IntervalScene<PrimitiveOf<Kind>> scene = Door<Kind>::scene();
  RayColumns rays{scene.rays};
  Columns<PrimitiveOf<Kind>> primitives{scene.primitives};
  std::vector<std::uint8_t> bits = std::vector<std::uint8_t>(1, 0xa5);
  std::vector<float> from = std::vector<float>(2, 7), to = std::vector<float>(2, 7);

  // check(call, function) for each.
  template <class Check>
  void each(const typename Door<Kind>::Options& options, Check check) {
    const Ray& ray = scene.rays[0];
    const auto one = Door<Kind>::one(scene.primitives[0]);
    check(Call{"hit_mask of primitives"}, [&] { hit_mask(ray, primitives.arrays(), bits, options); });
    check(Call{"hit_mask of rays", true}, [&] { hit_mask(rays.arrays(), one, bits, options); });
    check(Call{"ends of primitives", false, true},
          [&] { Door<Kind>::ends(ray, primitives.arrays(), bits, from, to, options); });
    check(Call{"ends of rays", true, true},
          [&] { Door<Kind>::ends(rays.arrays(), one, bits, from, to, options); });
  }
  template <class Check>
  void each_by_name(const typename Door<Kind>::Options& options, Check check) {
    each(options, [&](const Call& call, auto function) { check(call.name, function); });
  }
  void expect_untouched() const {
    EXPECT_EQ(bits, std::vector<std::uint8_t>(bits.size(), 0xa5));
    EXPECT_EQ(from, std::vector<float>(from.size(), 7));
    EXPECT_EQ(to, std::vector<float>(to.size(), 7));
  }
};

template <class Kind>
class IntervalCalls : public ::testing::Test {};
TYPED_TEST_SUITE_P(IntervalCalls);

TYPED_TEST_P(IntervalCalls, answer_as_the_rows_that_their_options_name) {
  for (const Variant<TypeParam>& variant : all_variants<TypeParam>()) {
    const std::uint8_t second_alone = 0xfe;  // of two
    for (const LaneBits mask : {LaneBits(nullptr), LaneBits(&second_alone)}) {
      Calls<TypeParam> calls;
      const auto expected = answers(variant, calls.scene.rays, calls.scene.primitives);
      calls.each({variant.test, variant.grade, variant.path, mask}, [&](const Call& call, auto function) {
        for (const std::uint8_t before : {std::uint8_t{0xa5}, std::uint8_t{0x5a}}) {
          calls.bits[0] = before, calls.from = calls.to = {7, 7};
          function();
          for (std::size_t i = 0; i < 2; ++i) {
            const IntervalResult& right = expected[call.of_rays ? i : 2 * i];
            const bool takes_part = mask == nullptr || i == 1, writes_ends = call.has_ends && takes_part;
            EXPECT_EQ(is_set(calls.bits, i), takes_part ? right.hit != 0 : (before >> i & 1) != 0)
                << call.name;
            EXPECT_EQ(calls.from[i], writes_ends ? right.from : 7) << variant.name() << ' ' << call.name;
            EXPECT_EQ(calls.to[i], writes_ends ? right.to : 7) << variant.name() << ' ' << call.name;
          }
          EXPECT_EQ(calls.bits[0] >> 2, before >> 2)
              << variant.name() << ' ' << call.name << ": behind the last";
        }
      });
    }
  }
}

TYPED_TEST_P(IntervalCalls, refuse_enumerators_that_do_not_exist) {
  using Options = typename Door<TypeParam>::Options;
  Calls<TypeParam> calls;
  expect_wrong_enumerators_refused<Options>(
      static_cast<int>(names_of(TypeParam{}).size()),
      [&](const Options& options, auto check) { calls.each_by_name(options, check); });
  calls.expect_untouched();
}

TYPED_TEST_P(IntervalCalls, refuse_a_path_that_the_machine_lacks) {
  using Options = typename Door<TypeParam>::Options;
  Calls<TypeParam> calls;
  expect_foreign_path_refused<Options>(
      [&](const Options& options, auto check) { calls.each_by_name(options, check); });
  calls.expect_untouched();
}

TYPED_TEST_P(IntervalCalls, refuse_spans_of_other_sizes) {
  Calls<TypeParam> calls;
  const auto expect_refused = [&](bool all) {
    calls.each({}, [&](const Call& call, auto function) {
      if (all || call.has_ends) {
        EXPECT_THROW(function(), std::invalid_argument) << call.name;
      }
    });
    calls.expect_untouched();
  };
  for (const std::size_t bytes : {0u, 2u}) {
    calls.bits.assign(bytes, 0xa5);
    expect_refused(true);
  }
  calls.bits.assign(1, 0xa5);
  for (const std::size_t floats : {0u, 1u, 3u}) {
    calls.from.assign(floats, 7), calls.to.assign(2, 7);
    expect_refused(false);
    calls.from.assign(2, 7), calls.to.assign(floats, 7);
    expect_refused(false);
  }
}

TYPED_TEST_P(IntervalCalls, take_nothing_at_all) {
  const Ray ray = make_ray({0, 0, 0}, {0, 0, 1});
  const RayArrays no_rays{};
  const decltype(Columns<PrimitiveOf<TypeParam>>({}).arrays()) none{};
  const decltype(Door<TypeParam>::one({})) one{};
  hit_mask(ray, none, {});
  hit_mask(no_rays, one, {});
  const std::span<std::uint8_t> bits;
  const std::span<float> ends;
  const typename Door<TypeParam>::Options options;
  Door<TypeParam>::ends(ray, none, bits, ends, ends, options);
  Door<TypeParam>::ends(no_rays, one, bits, ends, ends, options);
}

REGISTER_TYPED_TEST_SUITE_P(IntervalCalls, answer_as_the_rows_that_their_options_name,
                            refuse_enumerators_that_do_not_exist, refuse_a_path_that_the_machine_lacks,
                            refuse_spans_of_other_sizes, take_nothing_at_all);

}  // namespace raylanes::testing
