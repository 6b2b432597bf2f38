// Roots over arrays. Full blocks take the short way: several registers advance in lockstep, one test per block says
// that all its values lie in the method's domain, and only then they are stored. If the method's arithmetic leaves the
// divider idle, some vectors of the block go through it at the same time.
#pragma once

#include <algorithm>

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

template <class M, class T, Mix mix, class Y = Estimates, class Test>
inline GroupRoots<T, mix> roots_of_group(const T* x, Test& test) {
  using V = Lanes<T, width<T>>;
  const auto load = [&](int i) { return V::load(x + i * width<T>); };
  GroupRoots<T, mix> roots;
  const auto start_divider = [&] {
    if constexpr (mix.beside > 0)
      roots.beside = sqrt(lockstep_of<mix.beside>([&](int i) { return load(mix.together + i); }));
  };
  if (divider_first) start_divider();
  const auto a = lockstep_of<mix.together>(load);
  for (int i = 0; i < mix.together; ++i)
    test.see(Y::serve_zeros ? EstimatesOrOne::or_one(a.part[i], a.part[i]) : a.part[i]);
  auto sentinel = a;
  roots.together = root_of<M, Y>(a, sentinel);
  if constexpr (Y::serve_zeros)
    for (int i = 0; i < mix.together; ++i)
      roots.together.part[i] = M::root_at_zeros(a.part[i], roots.together.part[i]);
  for (int i = 0; i < mix.together; ++i) test.see_sentinel(sentinel.part[i]);
  if (!divider_first) start_divider();
  return roots;
}

// Stores the roots of a block unless one of its values lies outside the domain. Nothing is stored before that is
// known: y may be x.
template <class M, class T, Mix mix, class Y = Estimates>
inline bool store_block(const T* x, T* y) {
  constexpr int group = mix.group() * width<T>;
  auto test = block_test<M, Lanes<T, width<T>>>();
  GroupRoots<T, mix> roots[mix.repeats];
  for (int r = 0; r < mix.repeats; ++r) roots[r] = roots_of_group<M, T, mix, Y>(x + r * group, test);
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

// Register by register, whatever the values are: the end of an array, and blocks with special values.
template <class M, class T, Mix mix>
[[gnu::flatten, gnu::noinline]] void careful_array(const T* x, T* y, std::size_t n) {
  using V = Lanes<T, width<T>>;
  constexpr std::size_t lanes = width<T>;
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) careful<M, T, mix>(V::load(x + i)).store(y + i);
  if (i < n) careful<M, T, mix>(V::load(x + i, n - i, T(1))).store(y + i, n - i);
}

// Whether blocks with zeros have a way of their own: in the rows that serve accuracies.
template <class M, Mix mix>
inline constexpr bool serves_zeros = native_lanes > 1 &&
                                     (mix.beside > 0 ? M::takes_zeros : M::gives_zeros_infinity);

// How many blocks in a row are taken register by register at first, and at last.
inline constexpr std::size_t min_patience = 2, max_patience = 64;

// From a block on that holds a value outside the domain: some blocks in which zeros are taken as they come, and where
// that fails, more and more at a time register by register. Returns how many values are done.
template <class M, class T, Mix mix>
[[gnu::flatten, gnu::noinline]] std::size_t careful_blocks(const T* x, T* y, std::size_t n,
                                                           std::size_t& patience) {
  constexpr std::size_t block = width<T> * mix.registers();
  const std::size_t last = std::min(n / block, max_patience) * block;
  std::size_t i = 0;
  if constexpr (serves_zeros<M, mix>) {
    while (i < last && store_block<M, T, mix, EstimatesOrOne>(x + i, y + i)) i += block;
    if (i == last) return i;
  }
  const std::size_t end = std::min(n / block, i / block + patience) * block;
  careful_array<M, T, mix>(x + i, y + i, end - i);
  patience = std::min(4 * patience, max_patience);
  return end;
}

template <class M, class T, Mix mix>
[[gnu::flatten]] void array_of(const T* x, T* y, std::size_t n) {
  constexpr std::size_t block = width<T> * mix.registers();
  std::size_t i = 0, patience = min_patience;
  while (n - i >= block) {
    const std::size_t first = i;
    while (n - i >= block && store_block<M, T, mix>(x + i, y + i)) i += block;
    if (n - i < block) break;
    patience = std::max(patience >> std::min<std::size_t>((i - first) / block, 5), min_patience);
    i += careful_blocks<M, T, mix>(x + i, y + i, n - i, patience);
  }
  careful_array<M, T, mix>(x + i, y + i, n - i);
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
