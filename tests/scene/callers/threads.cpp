// Work spread over threads, whatever spreads it: each element once, exceptions, calls within calls.
#include <atomic>
#include <chrono>
#include <thread>

#include "../../../accel/batch/in_parallel.hpp"
#include "../../support/message_of.hpp"
#include "questions.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t sizes[] = {1, 2, 3, 100, 1000};

// How often each of n elements was in a part.
std::vector<int> visits(std::size_t n, std::size_t grain, int threads) {
  std::vector<std::atomic<int>> counts(n);
  in_parallel(n, grain, threads, [&](std::size_t begin, std::size_t end) {
    EXPECT_LT(begin, end);
    for (std::size_t i = begin; i < end; ++i) ++counts[i];
  });
  return {counts.begin(), counts.end()};
}

TEST(Threads, take_each_element_once) {
  for (const std::size_t n : sizes)
    for (const std::size_t grain : sizes)
      for (const int threads : {0, 1, 2, 3})
        EXPECT_EQ(visits(n, grain, threads), std::vector<int>(n, 1)) << n << ", " << grain << ", " << threads;
  for (int round = 0; round < 50; ++round) ASSERT_EQ(visits(20'000, 1, 2), std::vector<int>(20'000, 1));
}

TEST(Threads, are_as_many_as_there_are_at_most) {
  const int all = thread_count(0);
  EXPECT_GE(all, 1);
  EXPECT_EQ(thread_count(1), 1);
  EXPECT_EQ(thread_count(1'000'000), all);
  on_threads(1, [](int threads) { EXPECT_EQ(threads, 1); });
  on_threads(2, [&](int threads) {
    EXPECT_EQ(threads, 0);
    EXPECT_EQ(thread_count(0), std::min(all, 2));
    in_parallel(8, 1, 0, [&](std::size_t, std::size_t) { EXPECT_EQ(thread_count(0), std::min(all, 2)); });
  });
  in_arena(1, [] { EXPECT_EQ(thread_count(0), 1); });
  EXPECT_EQ(thread_count(0), all);
}

// Parts that wait for each other end if there are two cores.
TEST(Threads, work_at_the_same_time) {
  if (thread_count(0) < 2) GTEST_SKIP() << "SKIPPED: one core, or a build without threads";
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> waiting{2};
    const auto start = std::chrono::steady_clock::now();
    in_parallel(2, 1, 2, [&](std::size_t, std::size_t) {
      --waiting;
      while (waiting > 0 && std::chrono::steady_clock::now() - start < std::chrono::seconds(20))
        std::this_thread::yield();
    });
    ASSERT_EQ(waiting, 0);
    ASSERT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20)) << "one after the other";
  }
}

TEST(Threads, pass_on_an_exception_and_begin_no_more_parts) {
  for (const int threads : {0, 1, 2}) {
    std::atomic<std::size_t> begun{0};
    const std::string message = message_of<std::domain_error>([&] {
      in_parallel(100'000, 1, threads, [&](std::size_t begin, std::size_t) {
        ++begun;
        if (begin >= 10 || threads == 1) throw std::domain_error("of a part");
      });
    });
    EXPECT_EQ(message, "of a part") << threads;
    EXPECT_LT(begun, 50'000u) << threads;
    EXPECT_EQ(visits(100, 1, threads), std::vector<int>(100, 1)) << "after an exception";
  }
}

TEST(Threads, may_spread_work_within_work) {
  for (const int outer : {0, 2, 3})
    for (const int inner : {0, 1, 2}) {
      std::atomic<int> sum{0};
      in_parallel(20, 1, outer, [&](std::size_t from, std::size_t to) {
        in_parallel(10 * (to - from), 1, inner, [&](std::size_t first, std::size_t last) {
          in_parallel(5 * (last - first), 1, inner,
                      [&](std::size_t begin, std::size_t end) { sum += static_cast<int>(end - begin); });
        });
      });
      EXPECT_EQ(sum, 1000) << outer << ", " << inner;
      EXPECT_EQ(message_of<std::domain_error>([&] {
                  in_parallel(20, 1, outer, [&](std::size_t begin, std::size_t end) {
                    in_parallel(10, 1, inner, [&](std::size_t, std::size_t) {
                      if (begin <= 7 && 7 < end) throw std::domain_error("of an inner part");
                    });
                  });
                }),
                "of an inner part");
    }
}

TEST(Threads, end_before_the_call_within_a_call_does) {
  on_threads(2, [](int threads) {
    for (int round = 0; round < 20; ++round) {
      std::atomic<int> ended{0};
      in_parallel(4, 1, threads, [&](std::size_t begin, std::size_t end) {
        std::this_thread::sleep_for(std::chrono::milliseconds(begin % 2));
        ended += static_cast<int>(end - begin);
      });
      ASSERT_EQ(ended, 4);
    }
  });
}

// Filters that trace on threads of their own, from threads of a batch.
TEST(Threads, trace_within_calls_that_trace) {
  const Questions questions;
  std::atomic<int> wrong{0}, asked{0};
  std::vector<Hit> hits(questions.rays.size());
  questions.tree.closest(questions.rays, hits,
                         [&](std::span<const std::size_t>, std::span<const Hit>, std::span<std::uint8_t>) {
                           if (asked++ < 8 && !questions.are_right(asked % 3)) ++wrong;
                         },
                         {.threads = 0});
  EXPECT_GT(asked, 0);
  EXPECT_EQ(wrong, 0);
  EXPECT_TRUE(same_bytes(hits, questions.hits));
}

TEST(Threads, serve_callers_that_are_threads_themselves) {
  std::atomic<int> wrong{0};
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 6; ++caller)
    callers.emplace_back([&, caller] {
      for (int round = 0; round < 20; ++round)
        if (visits(1000, 7, caller % 3) != std::vector<int>(1000, 1)) ++wrong;
    });
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace raylanes::testing
