// Parts whose sizes follow the time that elements take, with a report between them.
#include <chrono>
#include <thread>

#include "in_parallel.hpp"

namespace raylanes {
namespace {

// The time that a part should take, the least time between two reports, and the time from which other threads are worth
// their start. A part is at most so many times as large as the one before, whose elements may have been the quick ones.
constexpr double seconds_of_part = 0.02, seconds_between_reports = 0.01, seconds_worth_threads = 1e-4;
constexpr std::size_t max_growth = 16, of_vectors = 16;

class Reporter {
 public:
  Reporter(std::size_t n, const PartSizes& sizes, const Progress& progress,
           const std::function<void(std::size_t, std::size_t)>& work)
      : n_(n), sizes_(sizes), progress_(progress), work_(work), size_(sizes.first) {}

  // Takes up to so many parts; any number of threads at a time, each of which is one of `threads`.
  void take_parts(std::size_t parts, std::size_t threads) {
    try {
      for (std::size_t begin = 0, end = 0; parts > 0 && claim(threads, begin, end); --parts) {
        const double start = seconds();
        work_(begin, end);
        learn(end - begin, seconds() - start);
        done_ += end - begin;
        if (std::this_thread::get_id() == caller_) report();
      }
    } catch (...) {
      next_ = n_;  // the others end, too
      throw;
    }
  }
  // The time that the elements left take one thread, if they are as slow as in the last part.
  double seconds_left() const { return seconds_of_element_ * static_cast<double>(n_ - next_); }

 private:
  // Near the end parts get smaller, so that threads end at about the same time.
  bool claim(std::size_t threads, std::size_t& begin, std::size_t& end) {
    begin = next_;
    do {
      if (begin >= n_) return false;
      const std::size_t left = n_ - begin, size = size_;
      const std::size_t near_end = std::max({left / (2 * threads), size / max_growth, sizes_.least});
      end = begin + std::min({left, size, threads > 1 ? near_end : size});
    } while (!next_.compare_exchange_weak(begin, end));
    return true;
  }
  void learn(std::size_t count, double time) {
    const auto elements = static_cast<double>(count);
    const double each = std::max(time, 1e-9) / elements;
    seconds_of_element_ = each;
    auto size = static_cast<std::size_t>(
        std::min(seconds_of_part / each, static_cast<double>(max_growth) * elements));
    if (size > of_vectors) size -= size % of_vectors;
    size_ = std::clamp(size, sizes_.least, sizes_.most);
  }
  void report() {
    const double now = seconds();
    if (done_ == n_ || now - reported_ < seconds_between_reports) return;
    // Should it wait for tasks of its own, it must not take up a part, which would report within the report.
    isolated([&] { progress_(static_cast<double>(done_) / static_cast<double>(n_)); });
    reported_ = seconds();
  }
  static double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  const std::size_t n_;
  const PartSizes sizes_;
  const Progress& progress_;
  const std::function<void(std::size_t, std::size_t)>& work_;
  const std::thread::id caller_ = std::this_thread::get_id();
  double reported_ = seconds();
  std::atomic<std::size_t> next_{0}, done_{0}, size_;
  std::atomic<double> seconds_of_element_{1.0};
};

}  // namespace

void in_reported_parts(std::size_t n, const PartSizes& sizes, int threads, const Progress& progress,
                       const std::function<void(std::size_t, std::size_t)>& work) {
  progress(0.0);
  Reporter reporter(n, sizes, progress, work);
  const auto all = static_cast<std::size_t>(thread_count(threads));
  const auto here = [&](std::size_t parts) {
    in_parallel(1, 1, 1, [&](std::size_t, std::size_t) { reporter.take_parts(parts, 1); });
  };
  if (sizes.first < sizes.most) here(1);
  if (all > 1 && reporter.seconds_left() > seconds_worth_threads)
    in_parallel(all, 1, threads, [&](std::size_t, std::size_t) { reporter.take_parts(n, all); });
  else
    here(n);
  progress(1.0);
}

}  // namespace raylanes
