// Work spread over threads by oneTBB, by std::thread, or done by the calling thread: one of threads/, by -Dthreads.
#pragma once

#include <raylanes/progress.hpp>

#include "../../dispatch/quiet_floats.hpp"
#include "../standard.hpp"

namespace raylanes {

// The number of working threads: `threads`, at most as many as there are cores; 0: as many as the caller's arena has.
// With -Dthreads=none always 1.
int thread_count(int threads);

// The same as in_parallel and on_threads below, without inlining: the headers of oneTBB are slow to compile, so one
// translation unit includes them.
void spread(std::size_t n, std::size_t grain, int threads,
            const std::function<void(std::size_t, std::size_t)>& work);
void in_arena(int threads, const std::function<void()>& work);
// Work in which this thread takes up no other task.
void isolated(const std::function<void()>& work);

// work(begin, end) over parts of 0 … n−1, each of at most `grain` elements, on thread_count(threads) threads.
// With threads = 1, or if n <= grain, the calling thread does all of it in one part. Parts trap no floating-point
// exceptions.
template <class Work>
void in_parallel(std::size_t n, std::size_t grain, int threads, const Work& work) {
  const auto quietly = [&](std::size_t begin, std::size_t end) {
    const QuietFloats quiet;
    work(begin, end);
  };
  if (threads == 1 || n <= grain) return quietly(std::size_t{0}, n);
  spread(n, grain, threads, std::cref(quietly));
}

// How many elements a part has: all for one thread, else so many that each thread gets `parts`, within bounds.
inline std::size_t grain_of(std::size_t n, int threads, std::size_t parts, std::size_t least,
                            std::size_t most = std::numeric_limits<std::size_t>::max()) {
  if (threads == 1) return n;
  return std::clamp(n / (parts * static_cast<std::size_t>(thread_count(threads))), least, most);
}

// The sizes of parts: of the first one, and the bounds of all.
struct PartSizes {
  std::size_t first, least, most;
};

// The same work in parts that `progress` hears of, as its contract says. Parts are shared out as threads ask for them.
void in_reported_parts(std::size_t n, const PartSizes& sizes, int threads, const Progress& progress,
                       const std::function<void(std::size_t, std::size_t)>& work);

// Tells a call's Progress of one of its steps, which has the shares from `begin` to `end`.
class StepProgress {
 public:
  StepProgress(const Progress* whole, double begin, double end) {
    if (whole != nullptr && *whole)
      step_ = [=](double share) { (*whole)(share < 1.0 ? begin + share * (end - begin) : end); };
  }
  // For a step over some of n elements, from `first` on, or its part from share `from` to share `to`. A call of
  // no elements has one step.
  static StepProgress of(const Progress* whole, std::size_t first, std::size_t size, std::size_t n,
                         double from = 0.0, double to = 1.0) {
    const double all = n > 0 ? static_cast<double>(n) : 1.0, step = n > 0 ? static_cast<double>(size) : 1.0,
                 before = static_cast<double>(first);
    return {whole, (before + from * step) / all, (before + to * step) / all};
  }
  const Progress* get() const { return step_ ? &step_ : nullptr; }

 private:
  Progress step_;
};

// work(threads) where in_parallel with `threads`, 1 or 0, has thread_count(threads) threads: one arena for many calls.
template <class Work>
void on_threads(int threads, const Work& work) {
  if (threads <= 1) return work(threads);
  in_arena(threads, [&] { work(0); });
}

}  // namespace raylanes
