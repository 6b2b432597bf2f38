// An array without initialisation, for large data that is written once.
#pragma once

#include <new>

#include "../standard.hpp"

namespace raylanes {

// Memory for what is large and read all over, as trees are: in pages of 2 MiB where the system gives them, for the
// processor knows the places of few pages by heart. Each system has its file: large_memory_posix.cpp, …_windows.cpp.
// At least `bytes`, with the alignment of a line of the caches; to be freed by FreeMemory. Throws std::bad_alloc.
void* allocate_large(std::size_t bytes);

struct FreeMemory {
  void operator()(void* memory) const noexcept;
};

// Requests huge pages for memory that is about to be written for the first time.
void wish_for_huge_pages(void* first, std::size_t bytes);

template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T> && alignof(T) <= 64);

 public:
  Array() = default;
  explicit Array(std::size_t size) : first_(static_cast<T*>(memory_of(size))), size_(size) {}
  Array(const Array& other) : Array(other.size_) { std::copy_n(other.data(), size_, data()); }
  Array& operator=(const Array&) = delete;
  Array(Array&& other) noexcept : first_(std::move(other.first_)), size_(std::exchange(other.size_, 0)) {}
  Array& operator=(Array&& other) noexcept {
    first_ = std::move(other.first_);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }

  T& operator[](std::size_t i) { return first_[i]; }
  const T& operator[](std::size_t i) const { return first_[i]; }
  T* data() { return first_.get(); }
  const T* data() const { return first_.get(); }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }
  std::span<T> part(std::size_t begin, std::size_t count) { return {data() + begin, count}; }
  std::span<const T> part(std::size_t begin, std::size_t count) const { return {data() + begin, count}; }
  // Forgets what lies behind; the memory stays.
  void shorten(std::size_t size) { size_ = size; }

 private:
  static void* memory_of(std::size_t size) {
    if (size > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
    return allocate_large(size * sizeof(T));
  }

  std::unique_ptr<T[], FreeMemory> first_;
  std::size_t size_ = 0;
};

// `count` more, to be filled; returns where they are.
template <class T>
T* grow(Array<T>& array, std::size_t count) {
  const std::size_t before = array.size();
  Array<T> grown(before + count);
  std::copy_n(array.data(), before, grown.data());
  array = std::move(grown);
  return array.data() + before;
}

// A vector for what is large and written after it has grown: in memory of allocate_large(), and resize() gives its
// elements no value.
template <class T>
class LargeAllocator {
  static_assert(alignof(T) <= 64);

 public:
  using value_type = T;
  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) {}

  T* allocate(std::size_t count) {
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocate_large(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t) { FreeMemory()(memory); }

  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Values>
  void construct(U* at, Values&&... values) {
    ::new (static_cast<void*>(at)) U(std::forward<Values>(values)...);
  }
  friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }
};

template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace raylanes
