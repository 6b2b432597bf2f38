// Roots over arrays. Full blocks take the short way: several registers advance in lockstep, one test per block says
// that all its values lie in the method's domain, and only then they are stored. If the method's arithmetic leaves the
// divider idle, some vectors of the block go through it at the same time.
#pragma once

#include "domain_check.hpp"
#include "sqrt_methods.hpp"

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

// The order in which a group's instructions are issued, by measurement.
inline constexpr bool divider_first = has_fma;

template <class M, class T, Mix mix, class Test>
inline GroupRoots<T, mix> roots_of_group(const T* x, Test& test) {
  const auto load = [&](int i) { return Lanes<T, width<T>>::load(x + i * width<T>); };
  GroupRoots<T, mix> roots;
  const auto start_divider = [&] {
    if constexpr (mix.beside > 0)
      roots.beside = sqrt(lockstep_of<mix.beside>([&](int i) { return load(mix.together + i); }));
  };
  if (divider_first) start_divider();
  const auto a = lockstep_of<mix.together>(load);
  for (int i = 0; i < mix.together; ++i) test.see(a.part[i]);
  auto sentinel = a;
  roots.together = root_of<M>(a, sentinel);
  for (int i = 0; i < mix.together; ++i) test.see_sentinel(sentinel.part[i]);
  if (!divider_first) start_divider();
  return roots;
}

// Stores the roots of a block unless one of its values lies outside the domain. Nothing is stored before that is
// known: y may be x.
template <class M, class T, Mix mix>
inline bool store_block(const T* x, T* y) {
  constexpr int group = mix.group() * width<T>;
  auto test = block_test<M, Lanes<T, width<T>>>();
  GroupRoots<T, mix> roots[mix.repeats];
  for (int r = 0; r < mix.repeats; ++r) roots[r] = roots_of_group<M, T, mix>(x + r * group, test);
  if (!test.all_in_domain()) [[unlikely]]
    return false;
  for (int r = 0; r < mix.repeats; ++r) roots[r].store(y + r * group);
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
  if (i < n) careful<M, T, mix>(V::load(x + i, n - i, T(1))).store(y + i, n - i);
}

// Without a test: what the hardware computes needs none, and an unchecked method is asked for its domain alone.
template <class M, class T, int together = 1>
[[gnu::flatten]] void plain_array_of(const T* x, T* y, std::size_t n) {
  using V = Lanes<T, width<T>>;
  constexpr Mix mix{together, 0, 1};
  constexpr std::size_t lanes = width<T>, block = lanes * together;
  std::size_t i = 0;
  NoTest<V> test;
  for (; i + block <= n; i += block) roots_of_group<M, T, mix>(x + i, test).store(y + i);
  for (; i + lanes <= n; i += lanes) root_of<M>(V::load(x + i)).store(y + i);
  if (i < n) root_of<M>(V::load(x + i, n - i, T(1))).store(y + i, n - i);
}

}  // namespace
}  // namespace raylanes
