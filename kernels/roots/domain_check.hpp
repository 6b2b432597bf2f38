// Which values lie in the domain of a root's method, told lane by lane, or for a whole block by one or two operations
// per register and a branch.
#pragma once

#include <bit>

#include "method.hpp"

namespace raylanes {
namespace {

template <class M, class T>
inline constexpr bool tells_by_sentinel = has_bits_maximum && sizeof(T) == 4 && M::max_sentinel != 0;

// The method's answer, and a float that betrays an a outside the method's domain (see RootMethodBase); where the
// method has none, any.
template <class M, class Y = Estimates, class V>
inline V root_of(const V& a, V& sentinel) {
  if constexpr (M::takes_zeros)
    return M::template apply<Y>(a, sentinel);
  else if constexpr (requires { M::apply(a, sentinel); })
    return M::apply(a, sentinel);
  else
    return M::apply(sentinel = a);
}

template <class M, class V>
inline V root_of(const V& a) {
  V sentinel;
  return root_of<M>(a, sentinel);
}

template <class M, class V>
inline V magnitude_of(V a) {
  return M::either_sign ? abs(a) : a;
}

// Lanes in which a is at most `greatest`, the bits of a positive normal number, as an unsigned integer.
template <int N>
inline FloatMask<N> at_most(FloatBits<N> a, FloatBits<N> greatest) {
  return as<float>(max(a, greatest)) == as<float>(greatest);
}

// The lanes of a in the method's domain, by a and its sentinel.
template <class M, class T, int N>
inline Mask<T, N> in_domain(Lanes<T, N> a, Lanes<T, N> sentinel) {
  using V = Lanes<T, N>;
  if constexpr (tells_by_sentinel<M, T>) {
    return at_most<N>(as<std::uint32_t>(sentinel), M::max_sentinel);
  } else {
    const V size = magnitude_of<M>(a);
    return (size >= V(M::template least<T>)) & (size < V(M::template limit<T>));
  }
}

// The method in its domain, the hardware elsewhere: lane by lane, so that a value's result depends on nothing but the
// value. Roots for other kernels, and for arrays where they meet a special value or end.
template <class M, class T, int N>
inline Lanes<T, N> with_special_values(Lanes<T, N> a) {
  Lanes<T, N> sentinel;
  const Lanes<T, N> root = root_of<M>(a, sentinel);
  const Mask<T, N> served = in_domain<M>(a, sentinel);
  return all(served) ? root : select(served, root, M::exact(a));
}

// --- Blocks. Each test sees all values, then their sentinels, and is asked whether all lie in the domain.

// For methods that serve every value, or are unchecked.
template <class V>
struct NoTest {
  void see(V) {}
  void see_sentinel(V) {}
};

// By the greatest sentinel.
template <class M, class V>
class SentinelTest : public NoTest<V> {
  using Bits = BitsLike<V>;
  Bits max_ = M::max_sentinel;

 public:
  void see_sentinel(V sentinel) { max_ = max(as<std::uint32_t>(sentinel), max_); }
  bool all_in_domain() const { return all(as<float>(max_) == as<float>(Bits(M::max_sentinel))); }
};

// By the least value: of methods that serve infinity and NaN too, which a minimum passes over.
template <class M, class V>
class LeastTest : public NoTest<V> {
  static constexpr NumberOf<V> least = M::template least<NumberOf<V>>;
  V smallest_ = least;

 public:
  void see(V a) { smallest_ = min(magnitude_of<M>(a), smallest_); }
  bool all_in_domain() const { return all(smallest_ == V(least)); }
};

// By the greatest of bits − least bits: the bits of negative numbers and NaN are beyond all others.
template <class M, class V>
class BitsRangeTest : public NoTest<V> {
  using Bits = BitsLike<V>;
  static constexpr auto least = std::bit_cast<std::uint32_t>(M::template least<float>);
  static constexpr auto greatest = std::bit_cast<std::uint32_t>(M::template limit<float>) - least - 1;
  Bits max_ = greatest;

 public:
  void see(V a) { max_ = max(as<std::uint32_t>(magnitude_of<M>(a)) - Bits(least), max_); }
  bool all_in_domain() const { return all(as<float>(max_) == as<float>(Bits(greatest))); }
};

// By minimum and maximum, which pass over NaN: of methods that turn NaN into NaN by themselves.
template <class M, class V>
class ExtremesTest : public NoTest<V> {
  static constexpr NumberOf<V> least = M::template least<NumberOf<V>>;
  V smallest_ = least, largest_ = least;

 public:
  void see(V a) {
    const V size = magnitude_of<M>(a);
    smallest_ = min(size, smallest_);
    largest_ = max(size, largest_);
  }
  bool all_in_domain() const {
    return all((smallest_ == V(least)) & (largest_ < V(M::template limit<NumberOf<V>>)));
  }
};

// By comparing each.
template <class M, class V>
class ComparingTest : public NoTest<V> {
  static constexpr NumberOf<V> least = M::template least<NumberOf<V>>, limit = M::template limit<NumberOf<V>>;
  decltype(V() < V()) in_domain_ = V(least) < V(limit);

 public:
  void see(V a) {
    const V size = magnitude_of<M>(a);
    in_domain_ = in_domain_ & (size >= V(least)) & (size < V(limit));
  }
  bool all_in_domain() const { return all(in_domain_); }
};

// The cheapest that serves the method and the path.
template <class M, class V>
constexpr auto block_test() {
  using T = NumberOf<V>;
  if constexpr (tells_by_sentinel<M, T>)
    return SentinelTest<M, V>();
  else if constexpr (M::right_for_infinity)
    return LeastTest<M, V>();
  else if constexpr (M::keeps_nan)
    return ExtremesTest<M, V>();
  else if constexpr (has_bits_maximum && sizeof(T) == 4)
    return BitsRangeTest<M, V>();
  else
    return ComparingTest<M, V>();
}

}  // namespace
}  // namespace raylanes
