// Work spread over threads by oneTBB.
#pragma once

#include <cstddef>
#include <functional>

namespace raylanes {

// How many threads work: `threads`, at most as many as there are cores; 0: those of the caller's arena.
int thread_count(int threads);

// As in_parallel and on_threads below, by oneTBB in any case: its headers are slow to compile, hence in one unit.
void spread(std::size_t n, std::size_t grain, int threads,
            const std::function<void(std::size_t, std::size_t)>& work);
void in_arena(int threads, const std::function<void()>& work);
// Work in which this thread takes up no other task.
void isolated(const std::function<void()>& work);

// work(begin, end) over parts of 0 … n−1, each of `grain` elements or a little less, on thread_count(threads) threads.
// One thread, or work for one part: the caller's alone.
template <class Work>
void in_parallel(std::size_t n, std::size_t grain, int threads, const Work& work) {
  if (threads == 1 || n <= grain) return work(std::size_t{0}, n);
  spread(n, grain, threads, std::cref(work));
}

// work(threads) where in_parallel with `threads`, 1 or 0, has thread_count(threads) threads: one arena for many calls.
template <class Work>
void on_threads(int threads, const Work& work) {
  if (threads <= 1) return work(threads);
  in_arena(threads, [&] { work(0); });
}

}  // namespace raylanes
