// Reports of a build while it runs, from any thread, and its memory.
#pragma once

#include <raylanes/bvh.hpp>

#include "array.hpp"
#include "in_parallel.hpp"

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

// Arrays of sizes that threads learn one after the other, kept in few large blocks of memory. An allocation for each
// array would touch more pages.
class KeptParts {
 public:
  explicit KeptParts(MemoryMeter& memory) : memory_(memory) {}
  ~KeptParts() { clear(); }
  KeptParts(const KeptParts&) = delete;
  KeptParts& operator=(const KeptParts&) = delete;

  // A copy of the elements, which stays until clear(). Many threads may call this.
  template <class T>
  std::span<T> keep(std::span<const T> elements) {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= alignof(Line));
    T* const first = static_cast<T*>(room_for(elements.size_bytes()));
    std::copy_n(elements.data(), elements.size(), first);
    return {first, elements.size()};
  }
  // Frees all copies.
  void clear() {
    memory_.release(kept_);
    blocks_.clear();
    used_ = kept_ = 0;
  }

 private:
  struct alignas(64) Line {
    std::byte byte[64];
  };
  static constexpr std::size_t least_block = 1 << 10, most_block = 1 << 19;  // lines

  // Blocks are as large as all before them, within limits, so that little memory waits for use.
  void* room_for(std::size_t bytes) {
    const std::size_t lines = (bytes + sizeof(Line) - 1) / sizeof(Line);
    const std::lock_guard lock(mutex_);
    if (blocks_.empty() || blocks_.back().size() - used_ < lines) {
      const std::size_t wanted = std::clamp(kept_ / sizeof(Line), least_block, most_block);
      blocks_.emplace_back(std::max(lines, wanted));
      used_ = 0;
    }
    void* const here = blocks_.back().data() + used_;
    used_ += lines;
    kept_ += lines * sizeof(Line);
    memory_.hold(lines * sizeof(Line));
    return here;
  }

  MemoryMeter& memory_;
  std::mutex mutex_;
  std::vector<Array<Line>> blocks_;
  std::size_t used_ = 0, kept_ = 0;  // lines of the last block, bytes of all
};

// The threads of a build and the recipient of its progress. `threads` is 1, or 0 for the threads of the caller's arena.
struct BuildRun {
  int threads;
  ProgressMeter& progress;
  MemoryMeter& memory;
};

}  // namespace raylanes
