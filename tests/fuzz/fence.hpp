// Memory that ends at a page nobody may touch, mapped once and used again and again: what GuardedArray is to a
// test that runs a few thousand times, for one that runs millions of times.
#pragma once

#include "../support/system/guard_pages.hpp"
#include "targets.hpp"

namespace raylanes::testing {

class Fence {
 public:
  explicit Fence(std::size_t capacity)
      : page_(page_size()), bytes_((capacity / page_ + 2) * page_), memory_(bytes_ + page_) {
    memory_.forbid(bytes_, page_);
  }

  // `count` elements whose last one ends at the forbidden page, with canaries before the first. For types of
  // alignment 64 the count must fill whole cache lines.
  template <class T>
  T* last(std::size_t count) {
    first_ = memory_.data() + bytes_ - count * sizeof(T);
    std::memset(first_ - margin, canary, margin);
    return reinterpret_cast<T*>(first_);
  }
  // Fails if what is before the elements was written to.
  void expect_intact(const char* what) const {
    for (const unsigned char* p = first_ - margin; p != first_; ++p)
      if (*p != canary) fail(std::string("written before ") + what);
  }

 private:
  static constexpr unsigned char canary = 0xa5;
  static constexpr std::size_t margin = 64;
  std::size_t page_, bytes_;
  Pages memory_;
  unsigned char* first_ = nullptr;
};

}  // namespace raylanes::testing
