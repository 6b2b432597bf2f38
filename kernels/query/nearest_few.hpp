// How far a ray goes whose nearest few hits are asked for.
#pragma once

#include <cstdint>

namespace raylanes {
namespace {

// The nearest of different hits so far, by upper bounds of their t: the last one says how far the ray goes.
template <class T>
class NearestFew {
 public:
  static constexpr std::uint32_t max_kept = 64;

  explicit NearestFew(std::uint32_t most) : max_(most <= max_kept ? most : 0) {}
  // Returns how far a ray goes that went to `tmax`.
  T keep(T t_hi, std::uint32_t primitive, T tmax) {
    if (max_ == 0 || t_hi > tmax) return tmax;
    for (std::uint32_t i = 0; i < count_; ++i)
      if (primitive_[i] == primitive) return tmax;
    std::uint32_t at = count_ < max_ ? count_++ : count_ - 1;
    for (; at > 0 && t_hi_[at - 1] > t_hi; --at)
      t_hi_[at] = t_hi_[at - 1], primitive_[at] = primitive_[at - 1];
    t_hi_[at] = t_hi, primitive_[at] = primitive;
    return count_ == max_ && t_hi_[max_ - 1] < tmax ? t_hi_[max_ - 1] : tmax;
  }

 private:
  std::uint32_t max_, count_ = 0;
  T t_hi_[max_kept];
  std::uint32_t primitive_[max_kept];
};

}  // namespace
}  // namespace raylanes
