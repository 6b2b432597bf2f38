// Situations around calls: many threads of their own, and other roundings.
#include <cfenv>
#include <thread>

#include "../../support/supported_paths.hpp"
#include "questions.hpp"

namespace raylanes::testing {
namespace {

TEST(Callers, ask_one_tree_from_many_threads) {
  const Questions questions;
  std::vector<std::uint8_t> right(8, 0);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < right.size(); ++i)
    threads.emplace_back([&, i] { right[i] = questions.are_right(i % 2 == 0 ? 1 : 2) ? 1 : 0; });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::ranges::count(right, 1), 8);
}

// Decisions are exact for round to nearest only. In other roundings calls end, hits are of triangles that exist, and
// nearly all are the same.
TEST(Callers, round_otherwise) {
  const Questions questions;
  for (const Path* path : supported_paths())
    for (const int rounding : {FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO}) {
      std::vector<Hit> found(questions.rays.size());
      std::fesetround(rounding);
      questions.tree.closest(questions.rays, found, {.path = path});
      std::fesetround(FE_TONEAREST);
      std::size_t others = 0;
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_TRUE(!found[i] || found[i].primitive < questions.mesh.triangles.size());
        others += found[i].primitive != questions.hits[i].primitive ? 1 : 0;
      }
      EXPECT_LE(others, found.size() / 100) << path->name << ", rounding " << rounding;
    }
}

}  // namespace
}  // namespace raylanes::testing
