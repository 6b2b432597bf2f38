// An array whose elements nobody sets before they are used: for what is large and written once.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

namespace raylanes {

template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Array() = default;
  explicit Array(std::size_t size) : first_(std::make_unique_for_overwrite<T[]>(size)), size_(size) {}
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
  std::unique_ptr<T[]> first_;
  std::size_t size_ = 0;
};

}  // namespace raylanes
