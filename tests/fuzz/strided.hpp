// Views whose elements lie apart, as memory for fuzz targets.
#pragma once

#include "fence.hpp"
#include "support.hpp"

namespace raylanes::testing {

inline constexpr std::size_t max_gap = 12;  // bytes between elements of a view

// Elements of a view before a forbidden page, with bytes between them that nobody may write.
template <class T, std::size_t capacity>
struct Strided {
  static constexpr unsigned char between = 0x5a;
  Fence fence{capacity * (sizeof(T) + max_gap)};
  unsigned char* first = nullptr;
  std::size_t count = 0, stride = 0;

  void take(std::size_t n, std::size_t gap) {
    count = n, stride = sizeof(T) + gap;
    const std::size_t size = n > 0 ? n * stride - gap : 0;
    first = fence.last<unsigned char>(size);
    std::memset(first, between, size);
  }
  void put(const std::vector<T>& all) const {
    for (std::size_t i = 0; i < count; ++i) std::memcpy(first + i * stride, &all[i], sizeof(T));
  }
  std::vector<T> get() const {
    std::vector<T> all(count);
    for (std::size_t i = 0; i < count; ++i) std::memcpy(&all[i], first + i * stride, sizeof(T));
    return all;
  }
  void expect_intact(const char* what) const {
    fence.expect_intact(what);
    for (std::size_t i = 0; i + 1 < count; ++i)
      for (std::size_t k = sizeof(T); k < stride; ++k)
        if (first[i * stride + k] != between) fail(std::string("written between ") + what);
  }
};

}  // namespace raylanes::testing
