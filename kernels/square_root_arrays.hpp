// Roots over arrays. Full blocks take the short way: one test per block says that all its values are ones
// that the method is meant for, and several registers advance in lockstep. Where the method's arithmetic
// leaves the divider idle, some registers of the block go through it at the same time.
#pragma once

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

// Whether the method is meant for all values that its registers of the block get. Where the method turns NaN
// into NaN by itself two operations per register do: minimum and maximum pass over NaN.
template <class M, class T, Mix mix>
inline bool block_is_meant(const T* x) {
  using V = Lanes<T, width<T>>;
  const V least(M::template least<T>), limit(M::template limit<T>);
  const auto load = [&](int r, int k) {
    const V a = V::load(x + (r * mix.group() + k) * width<T>);
    if constexpr (takes_either_sign<M>)
      return abs(a);
    else
      return a;
  };
  if constexpr (M::keeps_nan) {
    V smallest = least, largest = least;
    for (int r = 0; r < mix.repeats; ++r)
      for (int k = 0; k < mix.together; ++k) {
        smallest = min(load(r, k), smallest);
        largest = max(load(r, k), largest);
      }
    return all((smallest >= least) & (largest < limit));
  } else {
    Mask<T, width<T>> meant = least < limit;
    for (int r = 0; r < mix.repeats; ++r)
      for (int k = 0; k < mix.together; ++k) meant = meant & (load(r, k) >= least) & (load(r, k) < limit);
    return all(meant);
  }
}

template <class M, class T, Mix mix>
inline void one_group(const T* x, T* y) {
  using V = Lanes<T, width<T>>;
  const auto load = [&](int i) { return V::load(x + i * width<T>); };
  const auto store = [&](V a, int i) { a.store(y + i * width<T>); };
  if constexpr (mix.beside > 0) {
    const auto exact = sqrt(lockstep_of<mix.beside>([&](int i) { return load(mix.together + i); }));
    const auto roots = M::apply(lockstep_of<mix.together>(load));
    for (int i = 0; i < mix.together; ++i) store(roots.part[i], i);
    for (int i = 0; i < mix.beside; ++i) store(exact.part[i], mix.together + i);
  } else {
    const auto roots = M::apply(lockstep_of<mix.together>(load));
    for (int i = 0; i < mix.together; ++i) store(roots.part[i], i);
  }
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
    if (block_is_meant<M, T, mix>(x + i)) [[likely]] {
      for (int r = 0; r < mix.repeats; ++r) {
        const std::size_t first = i + static_cast<std::size_t>(r) * mix.group() * lanes;
        one_group<M, T, mix>(x + first, y + first);
      }
    } else {
      for (std::size_t j = i; j < i + block; j += lanes) careful<M, T, mix>(V::load(x + j)).store(y + j);
    }
  }
  for (; i + lanes <= n; i += lanes) careful<M, T, mix>(V::load(x + i)).store(y + i);
  if (i < n)
    store_partial<T, width<T>>(careful<M, T, mix>(load_partial<T, width<T>>(x + i, n - i, T(1))), y + i,
                               n - i);
}

// The hardware's root needs no block and no test.
template <class M, class T>
[[gnu::flatten]] void plain_array_of(const T* x, T* y, std::size_t n) {
  using V = Lanes<T, width<T>>;
  constexpr std::size_t lanes = width<T>;
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) M::apply(V::load(x + i)).store(y + i);
  if (i < n)
    store_partial<T, width<T>>(M::apply(load_partial<T, width<T>>(x + i, n - i, T(1))), y + i, n - i);
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
