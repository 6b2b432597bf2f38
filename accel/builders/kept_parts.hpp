// Arrays that threads make one after the other, each of a size that is known when it is made: kept in few large blocks
// of memory, whose pages cost less than those of an allocation for each array.
#pragma once

#include <algorithm>
#include <mutex>
#include <span>
#include <vector>

#include "../batch/array.hpp"
#include "meters.hpp"

namespace raylanes {

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

}  // namespace raylanes
