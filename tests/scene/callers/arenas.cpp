// Calls within task arenas of oneTBB, which spreads the work of this build.
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <thread>

#include "../../../accel/batch/in_parallel.hpp"
#include "questions.hpp"

namespace raylanes::testing {
namespace {

// threads = 0 takes the threads of the arena; other numbers make an arena of their own in it.
TEST(Callers, ask_within_an_arena_of_their_own) {
  const Questions questions;
  for (const int size : {1, 2}) {
    tbb::task_arena arena(size);
    for (const int threads : {0, 1, 2})
      arena.execute([&] { EXPECT_TRUE(questions.are_right(threads)) << size << ", " << threads; });
  }
}

TEST(Callers, get_the_threads_of_their_arena_or_as_many_as_they_ask_for_and_there_are) {
  const int cores = tbb::info::default_concurrency();
  EXPECT_EQ(thread_count(1), 1);
  EXPECT_EQ(thread_count(cores + 1), cores);
  EXPECT_EQ(thread_count(0), cores);
  tbb::task_arena(1).execute([&] {
    EXPECT_EQ(thread_count(0), 1);
    EXPECT_EQ(thread_count(cores + 1), cores);
  });
}

// The second of two places that are both for callers: an arena of the call's own would have the caller in its first.
TEST(Callers, keep_work_within_their_arena) {
  constexpr auto place = tbb::this_task_arena::current_thread_index;
  std::atomic<int> parts{0}, elsewhere{0};
  const auto ask = [&] {
    ASSERT_EQ(place(), 1);
    in_parallel(200, 1, 0, [&](std::size_t, std::size_t) {
      ++parts;
      if (place() != 1) ++elsewhere;
    });
  };
  tbb::task_arena arena(2, 2);
  arena.execute([&] {
    if (place() == 1)
      ask();
    else
      std::thread([&] { arena.execute(ask); }).join();
  });
  EXPECT_GT(parts, 1);
  EXPECT_EQ(elsewhere, 0);
}

}  // namespace
}  // namespace raylanes::testing
