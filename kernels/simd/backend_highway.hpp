// The vocabulary implemented with Google Highway, as a static target: AVX2, AVX-512 and NEON. registers/highway_x86.hpp
// and registers/highway_neon.hpp have what Highway lacks or does differently on one of them.
#pragma once

#include <hwy/highway.h>

#include <type_traits>

#include "record_rows.hpp"

namespace raylanes {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

inline constexpr int native_lanes = HWY_MAX_BYTES / 4;
inline constexpr bool has_fma = true;

}  // namespace
}  // namespace raylanes

#if defined(__aarch64__)
#include "registers/highway_neon.hpp"
#else
#include "registers/highway_x86.hpp"
#endif

namespace raylanes {
namespace {

// The mask with these bits.
template <class Raw, class D>
inline Raw mask_of(D d, std::uint32_t lanes) {
#if defined(__AVX512F__)
  static_cast<void>(d);
  return Raw{static_cast<decltype(Raw::raw)>(lanes)};
#else
  const hn::RebindToUnsigned<D> words;
  using Word = hn::TFromD<decltype(words)>;
  return hn::RebindMask(
      d, hn::TestBit(hn::Set(words, static_cast<Word>(lanes)), hn::LoadU(words, bit_of_lane<Word>)));
#endif
}

template <class T, int N>
struct Mask {
  using D = hn::FixedTag<T, N>;
  using Raw = decltype(hn::FirstN(D(), 0));
  Raw raw;
  static Mask first(std::size_t count) { return {hn::FirstN(D(), count)}; }
  static Mask from_bits(std::uint32_t b) { return {mask_of<Raw>(D(), b)}; }
  friend Mask operator&(Mask a, Mask b) { return {hn::And(a.raw, b.raw)}; }
  friend Mask operator|(Mask a, Mask b) { return {hn::Or(a.raw, b.raw)}; }
  Mask operator~() const { return {hn::Not(raw)}; }
  friend bool any(Mask m) { return !hn::AllFalse(D(), m.raw); }
  friend bool all(Mask m) { return hn::AllTrue(D(), m.raw); }
  friend std::uint32_t bits(Mask m) {
    const std::uint32_t all_bits = register_bits(m.raw.raw);
    return N < 8 ? all_bits & ((1u << N) - 1u) : all_bits;  // a mask register of AVX-512 has 8 or more
  }
};

template <class T, int N>
struct Lanes {
  using D = hn::FixedTag<T, N>;
  using Raw = hn::VFromD<D>;
  using M = Mask<T, N>;
  Raw raw;

  Lanes() = default;
  Lanes(T x) : raw(hn::Set(D(), x)) {}
  explicit Lanes(Raw r) : raw(r) {}
  static Lanes load(const T* p) { return Lanes(hn::LoadU(D(), p)); }
  void store(T* p) const { hn::StoreU(raw, D(), p); }
  static Lanes load(const T* p, M m, Lanes filler) { return Lanes(masked_load(D(), p, m.raw, filler.raw)); }
  void store(T* p, M m) const { masked_store(D(), p, m.raw, raw); }
  static Lanes load(const T* p, std::size_t count, Lanes filler) { return load(p, M::first(count), filler); }
  void store(T* p, std::size_t count) const { store(p, M::first(count)); }

  friend Lanes operator+(Lanes a, Lanes b) { return Lanes(hn::Add(a.raw, b.raw)); }
  friend Lanes operator-(Lanes a, Lanes b) { return Lanes(hn::Sub(a.raw, b.raw)); }
  friend Lanes operator*(Lanes a, Lanes b) { return Lanes(hn::Mul(a.raw, b.raw)); }
  friend Lanes operator/(Lanes a, Lanes b) { return Lanes(hn::Div(a.raw, b.raw)); }
  // Not Neg, an exclusive or of intrinsics: the compiler folds this one into FMSUB and FNMADD.
  Lanes operator-() const {
    Raw negated;
    negated.raw = -raw.raw;
    return Lanes(negated);
  }
  friend Lanes operator&(Lanes a, Lanes b) { return Lanes(hn::And(a.raw, b.raw)); }
  friend Lanes operator|(Lanes a, Lanes b) { return Lanes(hn::Or(a.raw, b.raw)); }
  friend Lanes operator^(Lanes a, Lanes b) { return Lanes(hn::Xor(a.raw, b.raw)); }

  friend M operator<(Lanes a, Lanes b) { return {hn::Lt(a.raw, b.raw)}; }
  friend M operator<=(Lanes a, Lanes b) { return {hn::Le(a.raw, b.raw)}; }
  friend M operator>(Lanes a, Lanes b) { return {hn::Gt(a.raw, b.raw)}; }
  friend M operator>=(Lanes a, Lanes b) { return {hn::Ge(a.raw, b.raw)}; }
  friend M operator==(Lanes a, Lanes b) { return {hn::Eq(a.raw, b.raw)}; }

  friend Lanes min(Lanes a, Lanes b) { return Lanes(lesser(a.raw, b.raw)); }
  friend Lanes max(Lanes a, Lanes b) { return Lanes(greater(a.raw, b.raw)); }
  friend Lanes select(M m, Lanes a, Lanes b) { return Lanes(hn::IfThenElse(m.raw, a.raw, b.raw)); }
  friend Lanes select_negative(Lanes s, Lanes a, Lanes b) {
    return Lanes(hn::IfNegativeThenElse(s.raw, a.raw, b.raw));
  }
  friend Lanes sqrt(Lanes a) { return Lanes(hn::Sqrt(a.raw)); }
  friend Lanes abs(Lanes a) { return Lanes(hn::Abs(a.raw)); }
  friend Lanes rsqrt_estimate(Lanes a) { return Lanes(estimated_rsqrt(D(), a.raw)); }
  friend Lanes reciprocal_estimate(Lanes a) { return Lanes(estimated_reciprocal(D(), a.raw)); }
  friend Lanes fused(Lanes a, Lanes b, Lanes c) { return Lanes(hn::MulAdd(a.raw, b.raw, c.raw)); }
};

// The register that has the lanes.
template <class T, int N>
inline auto register_of(Lanes<T, N> a) {
  return a.raw.raw;
}

template <int half, int N>
inline Lanes<double, N / 2> to_doubles(Lanes<float, N> a) {
  const hn::FixedTag<double, N / 2> doubles;
  const hn::FixedTag<float, N / 2> floats;
  if constexpr (half == 0)
    return Lanes<double, N / 2>(hn::PromoteTo(doubles, hn::LowerHalf(floats, a.raw)));
  else
    return Lanes<double, N / 2>(hn::PromoteTo(doubles, hn::UpperHalf(floats, a.raw)));
}
template <int N>
inline Lanes<float, 2 * N> to_floats(Lanes<double, N> low, Lanes<double, N> high) {
  const hn::FixedTag<float, N> half;
  return Lanes<float, 2 * N>(
      hn::Combine(hn::FixedTag<float, 2 * N>(), hn::DemoteTo(half, high.raw), hn::DemoteTo(half, low.raw)));
}
template <class To, class From, int N>
inline Lanes<To, N> as(Lanes<From, N> a) {
  return Lanes<To, N>(hn::BitCast(hn::FixedTag<To, N>(), a.raw));
}
template <int K, class T, int N>
inline Lanes<T, N> shift_left(Lanes<T, N> a) {
  return Lanes<T, N>(hn::ShiftLeft<K>(a.raw));
}
template <int K, class T, int N>
inline Lanes<T, N> shift_right(Lanes<T, N> a) {
  return Lanes<T, N>(hn::ShiftRight<K>(a.raw));
}

template <int N, int columns>
inline void load_rows(const void* const (&rows)[N], Lanes<float, N> (&out)[columns]) {
  decltype(out[0].raw.raw) registers[columns];
  register_load_rows(rows, registers);
  for (int k = 0; k < columns; ++k) out[k].raw.raw = registers[k];
}
template <int N, int columns>
inline void load_rows(const void* const (&rows)[N], Lanes<double, N> (&out)[columns]) {
  decltype(Lanes<float, 2 * N>().raw.raw) registers[columns];
  register_load_double_rows(rows, registers);
  for (int k = 0; k < columns; ++k) __builtin_memcpy(&out[k].raw.raw, &registers[k], sizeof registers[k]);
}
template <int N, int columns>
inline void store_rows(void* const (&rows)[N], const Lanes<float, N> (&in)[columns]) {
  decltype(in[0].raw.raw) registers[columns];
  for (int k = 0; k < columns; ++k) registers[k] = in[k].raw.raw;
  register_store_rows(rows, registers);
}
template <int N>
inline void load_strips(const void* const (&strips)[N / 4], Lanes<float, N> (&out)[row_floats]) {
  decltype(out[0].raw.raw) registers[row_floats];
  register_load_strips(strips, registers);
  for (int k = 0; k < row_floats; ++k) out[k].raw.raw = registers[k];
}
template <int N>
inline void store_strips(void* const (&strips)[N / 4], const Lanes<float, N> (&in)[4]) {
  const decltype(in[0].raw.raw) registers[] = {in[0].raw.raw, in[1].raw.raw, in[2].raw.raw, in[3].raw.raw};
  register_store_strips(strips, registers);
}
template <int N>
inline int compress_store(std::uint32_t* p, Mask<float, N> m, Lanes<std::uint32_t, N> words) {
  return register_compress(p, bits(m), words.raw.raw);
}

}  // namespace
}  // namespace raylanes
