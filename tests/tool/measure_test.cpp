// How the tool times and counts.
#include "../../bench/rulers/measure.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "../../bench/rulers/instruction_counter.hpp"

namespace raylanes::bench {
namespace {

TEST(TakeTurns, EveryRoundBeginsWithAnotherContender) {
  std::vector<int> order;
  std::vector<std::function<void()>> contenders;
  for (int i = 0; i < 3; ++i) contenders.push_back([&order, i] { order.push_back(i); });
  const std::vector<Timing> timings = take_turns(contenders, {0, 4});
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, /* rounds: */ 0, 1, 2, 1, 2, 0, 2, 0, 1, 0, 1, 2}));
  for (const Timing& timing : timings) EXPECT_EQ(timing.seconds.size(), 4u);
}

TEST(TakeTurns, TheTimeDecidesTheRounds) {
  const std::vector<std::function<void()>> nothing{[] {}};
  EXPECT_GT(take_turns(nothing, {0.02, 1})[0].seconds.size(), 100u);
  EXPECT_EQ(take_turns(nothing, {0, 0})[0].seconds.size(), 1u);
  EXPECT_TRUE(take_turns({}, {1, 5}).empty());
}

// A machine that becomes twice as slow half-way changes both medians, but no ratio of a round.
TEST(SpeedRatio, IsOfTheSameRound) {
  const Timing ours{{1, 1, 2, 2, 2}, 0, 0}, theirs{{3, 3, 6, 6, 6}, 0, 0};
  const Quartiles ratio = speed_ratio(ours, theirs);
  EXPECT_EQ(ratio.median, 3);
  EXPECT_EQ(ratio.first, 3);
  EXPECT_EQ(ratio.third, 3);
}

TEST(Quartiles, AreBetweenTheNumbersWhereNoneIsThere) {
  const Quartiles four = quartiles_of({4, 1, 3, 2});
  EXPECT_EQ(four.median, 2.5);
  EXPECT_EQ(four.first, 1.75);
  EXPECT_EQ(four.third, 3.25);
  EXPECT_EQ(quartiles_of({7}).third, 7);
}

#if defined(__x86_64__)
// A loop whose instructions are known: 5 a turn, and 3 a call that must drop out.
void known_loop(std::size_t n) {
  asm volatile(
      "nop\n nop\n nop\n"
      "1: nop\n nop\n nop\n"
      "dec %0\n jnz 1b\n"
      : "+r"(n)
      :
      : "cc");
}

TEST(InstructionCounter, CountsWhatIsExecuted) {
  const auto counted = instructions_per_primitive(known_loop, 16);
  if (!counted) GTEST_SKIP() << "SKIPPED: ptrace is not permitted here";
  EXPECT_EQ(*counted, 5);
  EXPECT_EQ(instructions_per_primitive(known_loop, 100), 5.0);
  EXPECT_EQ(instructions_per_primitive([](std::size_t n) { known_loop(4 * n); }, 8), 20.0);
}

TEST(InstructionCounter, AChildThatDiesIsNoCount) {
  EXPECT_EQ(instructions_per_primitive([](std::size_t) { __builtin_trap(); }, 16), std::nullopt);
}
#endif

}  // namespace
}  // namespace raylanes::bench
