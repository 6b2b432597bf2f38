// Work spread over threads by oneTBB. Its library is not instrumented for ThreadSanitizer, which therefore does not
// see that tasks begin after what started them and end before what waits for them: here it is told.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

#ifdef RAYLANES_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace raylanes {

#ifdef RAYLANES_THREAD_SANITIZER
inline void everything_before(void* moment) {
  __tsan_release(moment);
}
inline void everything_after(void* moment) {
  __tsan_acquire(moment);
}
#else
inline void everything_before(void*) {}
inline void everything_after(void*) {}
#endif

// How many threads work: `threads`, at most as many as there are cores; 0: those of the caller's arena.
inline int thread_count(int threads) {
  const int most = tbb::info::default_concurrency();
  if (threads == 0) return tbb::this_task_arena::max_concurrency();
  return threads > most ? most : threads;
}

// work(begin, end) over parts of 0 … n−1, each of `grain` elements or a little less, on thread_count(threads) threads.
// One thread, or work for one part: the caller's alone.
template <class Work>
void in_parallel(std::size_t n, std::size_t grain, int threads, const Work& work) {
  if (threads == 1 || n <= grain) return work(std::size_t{0}, n);
  char start = 0, end = 0;  // moments
  const auto all = [&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain),
                      [&](const tbb::blocked_range<std::size_t>& part) {
                        everything_after(&start);
                        work(part.begin(), part.end());
                        everything_before(&end);
                      });
  };
  everything_before(&start);
  if (threads == 0) {
    all();
  } else {
    tbb::task_arena arena(thread_count(threads));
    arena.execute(all);
  }
  everything_after(&end);
}

// work(threads) where in_parallel with `threads`, 1 or 0, has thread_count(threads) threads: one arena for many calls.
template <class Work>
void on_threads(int threads, const Work& work) {
  if (threads <= 1) return work(threads);
  char start = 0, end = 0;  // moments
  tbb::task_arena arena(thread_count(threads));
  everything_before(&start);
  arena.execute([&] {
    everything_after(&start);
    work(0);
    everything_before(&end);
  });
  everything_after(&end);
}

}  // namespace raylanes
