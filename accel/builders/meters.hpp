// Reports of a build while it runs, from any thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <mutex>
#include <utility>

#include <raylanes/bvh.hpp>

#include "../batch/in_parallel.hpp"

namespace raylanes {

// Calls a Progress, one thread at a time, with shares that never fall. After an exception it is called no more.
class ProgressMeter {
 public:
  explicit ProgressMeter(const Progress& progress) : progress_(progress) {}

  // Adds to the share of work done, up to the end of the phase.
  void advance(double share) { report_at(share, 0.0); }
  // The phase is over: what it was to add is done.
  void finish_phase() { report_at(0.0, end_of_phase_); }
  // Begins the next phase. Must not be called while other threads advance.
  void begin_phase(double end) { end_of_phase_ = end; }

 private:
  void report_at(double more, double at_least) {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    if (given_up_) return;
    done_ = std::max(at_least, std::min(done_ + more, end_of_phase_));
    given_up_ = true;
    // Should it wait for tasks of its own, it must not take up one of the build's, which would come back here.
    isolated([&] { progress_(done_); });
    given_up_ = false;
  }

  const Progress& progress_;
  std::mutex mutex_;
  double done_ = 0.0, end_of_phase_ = 0.0;
  bool given_up_ = false;
};

// Bytes that a build holds in its arrays, and the most that it held at a time.
class MemoryMeter {
 public:
  void hold(std::size_t bytes) {
    const std::size_t now = now_ += bytes;
    std::size_t peak = peak_;
    while (now > peak && !peak_.compare_exchange_weak(peak, now)) {
    }
  }
  void release(std::size_t bytes) { now_ -= bytes; }
  std::size_t peak() const { return peak_; }

 private:
  std::atomic<std::size_t> now_{0}, peak_{0};
};

// Holds for as long as it lives.
class HeldMemory {
 public:
  HeldMemory(MemoryMeter& meter, std::size_t bytes) : meter_(meter), bytes_(bytes) { meter_.hold(bytes_); }
  ~HeldMemory() { release(); }
  HeldMemory(const HeldMemory&) = delete;
  HeldMemory& operator=(const HeldMemory&) = delete;
  // Ends before its time.
  void release() { meter_.release(std::exchange(bytes_, 0)); }

 private:
  MemoryMeter& meter_;
  std::size_t bytes_;
};

// The threads of a build and the recipient of its progress. `threads` is 1, or 0 for the threads of the caller's arena.
struct BuildRun {
  int threads;
  ProgressMeter& progress;
  MemoryMeter& memory;
};

}  // namespace raylanes
