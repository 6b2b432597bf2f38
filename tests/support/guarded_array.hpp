// An array that notices when a kernel touches what is not its own.
#pragma once

#include <new>

#include "testing.hpp"
#include "system/guard_pages.hpp"

namespace raylanes::testing {

// The place of the array. `unguarded`: on the heap between canaries, cheap. The others: between two pages that
// may not be touched, and the rest between holds canaries. Flush with the end, reading or writing one byte
// behind the last element is a fault. One element behind the front guard, the array is aligned to no vector.
enum class Place { unguarded, before_guard, after_guard };

// Whole pages between two that may not be touched, of no object with static lifetime. A thread keeps them for its next
// ones of this size: the system takes longer to give them than a kernel to use them.
class PagesBetweenGuards {
 public:
  explicit PagesBetweenGuards(std::size_t bytes) : bytes_(bytes) {
    if (Kept& kept = kept_of(bytes); !kept.empty()) {
      pages_ = std::move(kept.back()), kept.pop_back();
      return;
    }
    const std::size_t page = page_size();
    pages_ = std::make_unique<Pages>(bytes + 2 * page);
    pages_->forbid(0, page), pages_->forbid(page + bytes, page);
  }
  ~PagesBetweenGuards() { kept_of(bytes_).push_back(std::move(pages_)); }
  PagesBetweenGuards(const PagesBetweenGuards&) = delete;
  PagesBetweenGuards& operator=(const PagesBetweenGuards&) = delete;

  unsigned char* data() const { return pages_->data() + page_size(); }

 private:
  using Kept = std::vector<std::unique_ptr<Pages>>;
  static Kept& kept_of(std::size_t bytes) {
    thread_local std::map<std::size_t, Kept> kept;
    return kept[bytes];
  }

  std::size_t bytes_;
  std::unique_ptr<Pages> pages_;
};

// `size` elements of T, at first canaries. T is trivially copyable.
template <class T>
class GuardedArray {
 public:
  explicit GuardedArray(std::size_t size, Place place = Place::unguarded) : size_(size) {
    const std::size_t bytes = size * sizeof(T);
    if (place == Place::unguarded) {
      inner_bytes_ = bytes + 2 * heap_margin;
      inner_ = static_cast<unsigned char*>(::operator new(inner_bytes_));
    } else {
      const std::size_t page = page_size();
      inner_bytes_ = ((bytes + sizeof(T)) / page + 1) * page;
      inner_ = pages_.emplace(inner_bytes_).data();
    }
    std::memset(inner_, canary, inner_bytes_);
    first_ = place == Place::unguarded ? heap_margin
                                       : (place == Place::before_guard ? inner_bytes_ - bytes : sizeof(T));
  }
  ~GuardedArray() {
    if (!pages_) ::operator delete(inner_);
  }
  GuardedArray(const GuardedArray&) = delete;
  GuardedArray& operator=(const GuardedArray&) = delete;

  T* data() { return reinterpret_cast<T*>(inner_ + first_); }
  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) { return data()[i]; }
  void fill(std::span<const T> values) { std::copy(values.begin(), values.end(), data()); }
  // Bit by bit. An empty span may have no address, which memcmp does not allow.
  bool holds(std::span<const T> values) {
    return values.size() == size_ &&
           (size_ == 0 || std::memcmp(data(), values.data(), values.size_bytes()) == 0);
  }

  // True while no byte before or behind the elements has changed.
  bool is_intact() {
    const std::size_t end = first_ + size_ * sizeof(T);
    return are_canaries(inner_, first_) && are_canaries(inner_ + end, inner_bytes_ - end);
  }

 private:
  static constexpr unsigned char canary = 0xa5;
  static constexpr std::size_t heap_margin = 64;

  static bool are_canaries(const unsigned char* p, std::size_t bytes) {
    return bytes == 0 || (p[0] == canary && std::memcmp(p, p + 1, bytes - 1) == 0);
  }

  std::size_t size_, inner_bytes_ = 0, first_ = 0;
  std::optional<PagesBetweenGuards> pages_;  // none: on the heap
  unsigned char* inner_ = nullptr;
};

}  // namespace raylanes::testing
