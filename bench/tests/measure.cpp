// How the tool times and counts.
#include "../support/rulers/measure.hpp"

#include "../../tests/support/testing.hpp"
#include "../support/rulers/instruction_counter.hpp"

namespace raylanes::bench {
namespace {

TEST(TakeTurns, every_round_is_a_permutation_and_none_always_follows_the_same) {
  constexpr int count = 3, rounds = 40;
  std::vector<int> order;
  std::vector<std::function<void()>> contenders;
  for (int i = 0; i < count; ++i) contenders.push_back([&order, i] { order.push_back(i); });
  const std::vector<Timing> timings = take_turns(contenders, {0, rounds});
  for (const Timing& timing : timings) EXPECT_EQ(timing.seconds.size(), std::size_t{rounds});
  ASSERT_EQ(order.size(), std::size_t{count * (rounds + 1)});  // one to warm up
  std::map<std::pair<int, int>, int> follows;
  for (int round = 1; round <= rounds; ++round) {
    const auto begin = order.begin() + round * count;
    EXPECT_EQ(std::set<int>(begin, begin + count).size(), std::size_t{count}) << "round " << round;
    for (int turn = 1; turn < count; ++turn) ++follows[{begin[turn - 1], begin[turn]}];
  }
  // Each of the six pairs is expected in a third of the rounds.
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j)
      EXPECT_TRUE(i == j || follows[std::pair(i, j)] > rounds / 10) << i << " before " << j;
}

TEST(Quartiles, are_between_the_numbers_where_none_is_there) {
  const auto expect = [](const Quartiles& found, const Quartiles& expected) {
    EXPECT_TRUE(found.median == expected.median && found.first == expected.first &&
                found.third == expected.third);
  };
  expect(quartiles_of({4, 1, 3, 2}), {.median = 2.5, .first = 1.75, .third = 3.25});
  expect(quartiles_of({7}), {.median = 7, .first = 7, .third = 7});
  // A machine that becomes twice as slow half-way changes both medians, but no ratio of a round.
  const Quartiles ratio = speed_ratio({{1, 1, 2, 2, 2}, 0, 0}, {{3, 3, 6, 6, 6}, 0, 0});
  if (ratios_mean_something()) return expect(ratio, {.median = 3, .first = 3, .third = 3});
  EXPECT_TRUE(std::isnan(ratio.median)) << "a build without optimization has no ratios";
}

#if defined(__x86_64__)
// A loop whose instructions are known: 5 a turn, and 3 a call that must drop out.
void known_loop(std::size_t n) {
  asm volatile("nop\n nop\n nop\n1: nop\n nop\n nop\n dec %0\n jnz 1b\n" : "+r"(n) : : "cc");
}

TEST(InstructionCounter, counts_what_is_executed) {
  const auto counted = instructions_per_primitive(known_loop, 16);
  if (!counted) GTEST_SKIP() << "SKIPPED: ptrace is not permitted here";
  EXPECT_EQ(*counted, 5);
  EXPECT_EQ(instructions_per_primitive(known_loop, 100), 5.0);
}
#endif

}  // namespace
}  // namespace raylanes::bench
