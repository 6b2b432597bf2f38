// Roots over arrays. Full blocks take the short way: one test per block says that all its values are ones
// that the method is meant for, and several registers advance in lockstep. Where the method's arithmetic
// leaves the divider idle, some registers of the block go through it at the same time.
#pragma once

#include <bit>

#include "method_support.hpp"
#include "square_root.hpp"

namespace raylanes {
namespace {

template <class T>
inline constexpr int width = native_lanes * 4 / static_cast<int>(sizeof(T)) > 0
                                 ? native_lanes * 4 / static_cast<int>(sizeof(T))
                                 : 1;

// How a block is made: `repeats` times `together` registers in lockstep and `beside` in the divider.
struct Mix {
  int together, beside, repeats;
  constexpr int group() const { return together + beside; }
  constexpr int registers() const { return group() * repeats; }
};

// Whether the greatest of bits − least_bits is that of a number in [least, limit): negative numbers and NaN,
// as unsigned integers, are beyond all others.
template <class T>
inline bool is_below(Lanes<std::uint32_t, width<T>> greatest, T least, T limit) {
  using Bits = Lanes<std::uint32_t, width<T>>;
  constexpr std::uint32_t sign = 0x80000000u;
  const std::uint32_t span = std::bit_cast<std::uint32_t>(limit) - std::bit_cast<std::uint32_t>(least);
  const Bits beyond = ((greatest + Bits(sign - span)) | greatest) & Bits(sign);
  const Lanes<T, width<T>> one(1.0f);
  return all(as<T>(beyond | as<std::uint32_t>(one)) > Lanes<T, width<T>>(0.0f));
}

// Whether the method is meant for all values that its registers of the block get: two operations per
// register, on bits where a maximum of bits exists, else by minimum and maximum, which pass over NaN and so
// serve only methods that turn NaN into NaN by themselves.
template <class M, class T, Mix mix>
inline bool block_is_meant(const T* x) {
  using V = Lanes<T, width<T>>;
  const V least(M::template least<T>), limit(M::template limit<T>);
  const auto for_each_register = [&](auto use) {
    for (int r = 0; r < mix.repeats; ++r)
      for (int k = 0; k < mix.together; ++k) {
        const V a = V::load(x + (r * mix.group() + k) * width<T>);
        use(takes_either_sign<M> ? abs(a) : a);
      }
  };
  if constexpr (M::keeps_nan) {
    V smallest = least, largest = least;
    for_each_register([&](V a) {
      smallest = min(a, smallest);
      largest = max(a, largest);
    });
    return all((smallest >= least) & (largest < limit));
  } else if constexpr (has_bits_maximum && sizeof(T) == 4) {
    const auto least_bits = as<std::uint32_t>(least);
    auto greatest = least_bits - least_bits;
    for_each_register([&](V a) { greatest = max(as<std::uint32_t>(a) - least_bits, greatest); });
    return is_below<T>(greatest, M::template least<T>, M::template limit<T>);
  } else {
    Mask<T, width<T>> meant = least < limit;
    for_each_register([&](V a) { meant = meant & (a >= least) & (a < limit); });
    return all(meant);
  }
}

// The roots of one group while they are in registers.
template <class T, Mix mix>
struct GroupRoots {
  using V = Lanes<T, width<T>>;
  Lockstep<V, mix.together> together;
  Lockstep<V, mix.beside> beside;
  void store(T* y) const {
    for (int i = 0; i < mix.together; ++i) together.part[i].store(y + i * width<T>);
    if constexpr (mix.beside > 0)
      for (int i = 0; i < mix.beside; ++i) beside.part[i].store(y + (mix.together + i) * width<T>);
  }
};
template <class M, class T, Mix mix>
inline GroupRoots<T, mix> roots_of_group(const T* x) {
  const auto load = [&](int i) { return Lanes<T, width<T>>::load(x + i * width<T>); };
  if constexpr (mix.beside > 0) {
    const auto exact = sqrt(lockstep_of<mix.beside>([&](int i) { return load(mix.together + i); }));
    return {M::apply(lockstep_of<mix.together>(load)), exact};
  } else {
    return {M::apply(lockstep_of<mix.together>(load)), {}};
  }
}

// Stores the roots of a block unless one of its values is none that the method is meant for. Nothing is
// stored before that is known: y may be x.
template <class M, class T, Mix mix>
inline bool store_block(const T* x, T* y) {
  if (!block_is_meant<M, T, mix>(x)) [[unlikely]]
    return false;
  for (int r = 0; r < mix.repeats; ++r) {
    const int first = r * mix.group() * width<T>;
    roots_of_group<M, T, mix>(x + first).store(y + first);
  }
  return true;
}

template <class M, class T, Mix mix>
inline Lanes<T, width<T>> careful(Lanes<T, width<T>> a) {
  if constexpr (mix.beside > 0)
    return sqrt(a);
  else
    return with_special_values<M>(a);
}

template <class M, class T, Mix mix>
[[gnu::flatten]] void array_of(const T* x, T* y, std::size_t n) {
  using V = Lanes<T, width<T>>;
  constexpr std::size_t lanes = width<T>;
  constexpr std::size_t block = lanes * mix.registers();
  std::size_t i = 0;
  for (; i + block <= n; i += block) {
    if (store_block<M, T, mix>(x + i, y + i)) [[likely]]
      continue;
    for (std::size_t j = i; j < i + block; j += lanes) careful<M, T, mix>(V::load(x + j)).store(y + j);
  }
  for (; i + lanes <= n; i += lanes) careful<M, T, mix>(V::load(x + i)).store(y + i);
  if (i < n)
    store_partial<T, width<T>>(careful<M, T, mix>(load_partial<T, width<T>>(x + i, n - i, T(1))), y + i,
                               n - i);
}

// Without a test: the hardware's root needs none, and an unchecked method is asked for what it is meant for.
template <class M, class T, int together = 1>
[[gnu::flatten]] void plain_array_of(const T* x, T* y, std::size_t n) {
  constexpr Mix mix{together, 0, 1};
  constexpr std::size_t lanes = width<T>, block = lanes * together;
  std::size_t i = 0;
  for (; i + block <= n; i += block) roots_of_group<M, T, mix>(x + i).store(y + i);
  for (; i < n; i += lanes) {
    const std::size_t count = n - i < lanes ? n - i : lanes;
    store_partial<T, width<T>>(M::apply(load_partial<T, width<T>>(x + i, count, T(1))), y + i, count);
  }
}

// --- The other forms of the course report, with one lane. An empty statement that claims to change the value
// --- keeps a compiler from making vectors of what is to be one value at a time.
inline float kept_single(float x) {
#if defined(__SSE2__)
  __asm__ volatile("" : "+x"(x));
#else
  __asm__ volatile("" : "+m"(x));
#endif
  return x;
}

template <int Steps>
inline float classic_root_of_one(float x) {
  return with_special_values<Classic<Steps>>(Lanes<float, 1>(x)).raw;
}

template <int Steps>
[[gnu::flatten]] void one_at_a_time(const float* x, float* y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) y[i] = classic_root_of_one<Steps>(kept_single(x[i]));
}

template <int Steps>
[[gnu::flatten]] void four_a_loop(const float* x, float* y, std::size_t n) {
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    y[i] = classic_root_of_one<Steps>(kept_single(x[i]));
    y[i + 1] = classic_root_of_one<Steps>(kept_single(x[i + 1]));
    y[i + 2] = classic_root_of_one<Steps>(kept_single(x[i + 2]));
    y[i + 3] = classic_root_of_one<Steps>(kept_single(x[i + 3]));
  }
  for (; i < n; ++i) y[i] = classic_root_of_one<Steps>(kept_single(x[i]));
}

// Left to the compiler, which makes vectors of it or not.
template <int Steps>
[[gnu::flatten]] void arrays_of_four(const float* x, float* y, std::size_t n) {
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    float a[4], s[4];
    for (int k = 0; k < 4; ++k) a[k] = x[i + static_cast<std::size_t>(k)];
    for (int k = 0; k < 4; ++k) s[k] = classic_root_of_one<Steps>(a[k]);
    for (int k = 0; k < 4; ++k) y[i + static_cast<std::size_t>(k)] = s[k];
  }
  for (; i < n; ++i) y[i] = classic_root_of_one<Steps>(x[i]);
}

}  // namespace
}  // namespace raylanes
