// oneTBB's library is not instrumented for ThreadSanitizer, which therefore does not see that tasks begin after their
// start and end before a wait for them returns. These annotations tell it.
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "../in_parallel.hpp"

#ifdef RAYLANES_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace raylanes {
namespace {

#ifdef RAYLANES_THREAD_SANITIZER
void everything_before(void* moment) {
  __tsan_release(moment);
}
void everything_after(void* moment) {
  __tsan_acquire(moment);
}
#else
void everything_before(void*) {}
void everything_after(void*) {}
#endif

// At the end of a scope, also where an exception ends it.
struct EverythingBefore {
  void* moment;
  ~EverythingBefore() { everything_before(moment); }
};
struct EverythingAfter {
  void* moment;
  ~EverythingAfter() { everything_after(moment); }
};

}  // namespace

int thread_count(int threads) {
  const int most = tbb::info::default_concurrency();
  if (threads == 0) return tbb::this_task_arena::max_concurrency();
  return threads > most ? most : threads;
}

void spread(std::size_t n, std::size_t grain, int threads,
            const std::function<void(std::size_t, std::size_t)>& work) {
  char start = 0, end = 0;  // moments
  const auto all = [&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain),
                      [&](const tbb::blocked_range<std::size_t>& part) {
                        everything_after(&start);
                        const EverythingBefore ended{&end};
                        work(part.begin(), part.end());
                      });
  };
  const EverythingAfter all_ended{&end};
  everything_before(&start);
  if (threads == 0)
    all();
  else
    tbb::task_arena(thread_count(threads)).execute(all);
}

void in_arena(int threads, const std::function<void()>& work) {
  char start = 0, end = 0;  // moments
  const EverythingAfter all_ended{&end};
  everything_before(&start);
  tbb::task_arena(thread_count(threads)).execute([&] {
    everything_after(&start);
    const EverythingBefore ended{&end};
    work();
  });
}

void isolated(const std::function<void()>& work) {
  tbb::this_task_arena::isolate(work);
}

}  // namespace raylanes
