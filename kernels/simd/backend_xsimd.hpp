// The vocabulary spelt with xsimd batches: SSE2, AVX, AVX2 with FMA, AVX-512.
// Filled here because xsimd 8.1.0 lacks or breaks it: bits of a mask, abs and negation that only touch the
// sign bit, and fused multiply-add, which its SSE2 and AVX-512 batches round twice.
#pragma once

#include <bit>
#include <type_traits>

#include <xsimd/xsimd.hpp>

#include "backend_xsimd_registers.hpp"
#include "record_rows.hpp"

namespace raylanes {
namespace {

#if defined(__AVX512F__)
inline constexpr int native_bytes = 64;
#elif defined(__AVX__)
inline constexpr int native_bytes = 32;
#else
inline constexpr int native_bytes = 16;
#endif
inline constexpr int native_lanes = native_bytes / 4;
// Without AVX2 g++ 12 makes a branch a lane of AVX's blend.
#if defined(__AVX__) && !defined(__AVX2__)
inline constexpr bool blends_lane_by_lane = true;
#else
inline constexpr bool blends_lane_by_lane = false;
#endif
#if defined(__FMA__)
inline constexpr bool has_fma = true;
#else
inline constexpr bool has_fma = false;
#endif

template <int Bytes>
struct ArchOfBytes;  // a width that the path lacks does not compile
template <>
struct ArchOfBytes<16> {
  using type = xsimd::sse2;
};
#if defined(__AVX2__)
template <>
struct ArchOfBytes<32> {
  using type = xsimd::fma3<xsimd::avx2>;
};
#elif defined(__AVX__)
template <>
struct ArchOfBytes<32> {
  using type = xsimd::avx;
};
#endif
#if defined(__AVX512F__)
template <>
struct ArchOfBytes<64> {
  using type = xsimd::avx512bw;
};
#endif
template <class T, int N>
using Arch = typename ArchOfBytes<static_cast<int>(sizeof(T)) * N>::type;

template <class T, int N>
struct Mask {
  using Raw = xsimd::batch_bool<T, Arch<T, N>>;
  Raw raw;
  static constexpr bool has_register = sizeof(T) * N == 64;  // of its own, a bit a lane
  static Mask first(std::size_t count) {
    if constexpr (has_register) return from_bits((1u << count) - 1u);
    Mask mask;
    __builtin_memcpy(&mask.raw.data, ones_then_zeros + 8 - count * sizeof(T) / 4, sizeof mask.raw.data);
    return mask;
  }
  static Mask from_bits(std::uint32_t b) {
    Mask mask;
    if constexpr (has_register) {
      mask.raw.data = static_cast<decltype(Raw::data)>(b);
    } else {
      using Word = typename BitsOf<T>::type;
      using Words = xsimd::batch<Word, Arch<Word, N>>;
      const Words bit = Words::load_unaligned(bit_of_lane<Word>);
      const auto lanes = (Words(static_cast<Word>(b)) & bit) == bit;
      __builtin_memcpy(&mask.raw.data, &lanes.data, sizeof mask.raw.data);
    }
    return mask;
  }
  friend Mask operator&(Mask a, Mask b) { return {a.raw & b.raw}; }
  friend Mask operator|(Mask a, Mask b) { return {a.raw | b.raw}; }
  Mask operator~() const { return {~raw}; }
  friend bool any(Mask m) { return bits(m) != 0; }
  friend bool all(Mask m) { return bits(m) == (1u << N) - 1u; }
  friend std::uint32_t bits(Mask m) { return register_bits(m.raw.data); }
};

template <class T, int N>
struct Lanes {
  using Raw = xsimd::batch<T, Arch<T, N>>;
  using M = Mask<T, N>;
  Raw raw;

  Lanes() = default;
  Lanes(T x) : raw(x) {}
  explicit Lanes(Raw r) : raw(r) {}
  static Lanes load(const T* p) { return Lanes(Raw::load_unaligned(p)); }
  void store(T* p) const { raw.store_unaligned(p); }
  static Lanes load(const T* p, M m, Lanes filler) {
    return Lanes(Raw(masked_load(p, m.raw.data, filler.raw.data)));
  }
  void store(T* p, M m) const { masked_store(p, m.raw.data, raw.data); }
  static Lanes load(const T* p, std::size_t count, Lanes filler) { return load(p, M::first(count), filler); }
  void store(T* p, std::size_t count) const { store(p, M::first(count)); }

  friend Lanes operator+(Lanes a, Lanes b) { return Lanes(a.raw + b.raw); }
  friend Lanes operator-(Lanes a, Lanes b) { return Lanes(a.raw - b.raw); }
  friend Lanes operator*(Lanes a, Lanes b) { return Lanes(a.raw * b.raw); }
  friend Lanes operator/(Lanes a, Lanes b) { return Lanes(a.raw / b.raw); }
  // Not an exclusive or of intrinsics: the compiler folds this one into FMSUB and FNMADD.
  Lanes operator-() const { return Lanes(Raw(-raw.data)); }
  friend Lanes operator&(Lanes a, Lanes b) { return Lanes(a.raw & b.raw); }
  friend Lanes operator|(Lanes a, Lanes b) { return Lanes(a.raw | b.raw); }
  friend Lanes operator^(Lanes a, Lanes b) { return Lanes(a.raw ^ b.raw); }

  friend M operator<(Lanes a, Lanes b) { return {a.raw < b.raw}; }
  friend M operator<=(Lanes a, Lanes b) { return {a.raw <= b.raw}; }
  friend M operator>(Lanes a, Lanes b) { return {a.raw > b.raw}; }
  friend M operator>=(Lanes a, Lanes b) { return {a.raw >= b.raw}; }
  friend M operator==(Lanes a, Lanes b) { return {a.raw == b.raw}; }

  friend Lanes min(Lanes a, Lanes b) { return Lanes(xsimd::min(a.raw, b.raw)); }
  friend Lanes max(Lanes a, Lanes b) { return Lanes(xsimd::max(a.raw, b.raw)); }
  friend Lanes select(M m, Lanes a, Lanes b) {
    if constexpr (blends_lane_by_lane && sizeof(Raw) == 32)
      return Lanes(((a.raw ^ b.raw) & Raw(m.raw.data)) ^ b.raw);
    else
      return Lanes(xsimd::select(m.raw, a.raw, b.raw));
  }
  friend Lanes select_negative(Lanes s, Lanes a, Lanes b) {
    return Lanes(Raw(register_select_negative(s.raw.data, a.raw.data, b.raw.data)));
  }
  friend Lanes sqrt(Lanes a) { return Lanes(xsimd::sqrt(a.raw)); }
  friend Lanes abs(Lanes a) {
    using Bits = typename BitsOf<T>::type;
    return Lanes(a.raw & Raw(std::bit_cast<T>(static_cast<Bits>(~Bits{0} >> 1))));
  }
  friend Lanes rsqrt_estimate(Lanes a) { return Lanes(Raw(register_rsqrt(a.raw.data))); }
  friend Lanes reciprocal_estimate(Lanes a) { return Lanes(Raw(register_reciprocal(a.raw.data))); }
#if defined(__FMA__)
  friend Lanes fused(Lanes a, Lanes b, Lanes c) {
    return Lanes(Raw(register_fused(a.raw.data, b.raw.data, c.raw.data)));
  }
#endif
};

// The register that has the lanes.
template <class T, int N>
inline auto register_of(Lanes<T, N> a) {
  return a.raw.data;
}

template <int half, int N>
inline Lanes<double, N / 2> to_doubles(Lanes<float, N> a) {
  return Lanes<double, N / 2>(typename Lanes<double, N / 2>::Raw(register_to_doubles<half>(a.raw.data)));
}
template <int N>
inline Lanes<float, 2 * N> to_floats(Lanes<double, N> low, Lanes<double, N> high) {
  return Lanes<float, 2 * N>(
      typename Lanes<float, 2 * N>::Raw(register_to_floats(low.raw.data, high.raw.data)));
}
template <class To, class From, int N>
inline Lanes<To, N> as(Lanes<From, N> a) {
  return Lanes<To, N>(xsimd::bitwise_cast<typename Lanes<To, N>::Raw>(a.raw));
}
template <int K, class T, int N>
inline Lanes<T, N> shift_left(Lanes<T, N> a) {
  return Lanes<T, N>(a.raw << K);
}
template <int K, class T, int N>
inline Lanes<T, N> shift_right(Lanes<T, N> a) {
  return Lanes<T, N>(a.raw >> K);
}

template <int N, int columns>
inline void load_rows(const void* const (&rows)[N], Lanes<float, N> (&out)[columns]) {
  decltype(out[0].raw.data) registers[columns];
  register_load_rows(rows, registers);
  for (int k = 0; k < columns; ++k) out[k].raw.data = registers[k];
}
template <int N, int columns>
inline void load_rows(const void* const (&rows)[N], Lanes<double, N> (&out)[columns]) {
  decltype(Lanes<float, 2 * N>().raw.data) registers[columns];
  register_load_double_rows(rows, registers);
  for (int k = 0; k < columns; ++k) __builtin_memcpy(&out[k].raw.data, &registers[k], sizeof registers[k]);
}
template <int N, int columns>
inline void store_rows(void* const (&rows)[N], const Lanes<float, N> (&in)[columns]) {
  decltype(in[0].raw.data) registers[columns];
  for (int k = 0; k < columns; ++k) registers[k] = in[k].raw.data;
  register_store_rows(rows, registers);
}
template <int N>
inline void load_strips(const void* const (&strips)[N / 4], Lanes<float, N> (&out)[row_floats]) {
  decltype(out[0].raw.data) registers[row_floats];
  register_load_strips(strips, registers);
  for (int k = 0; k < row_floats; ++k) out[k].raw.data = registers[k];
}
template <int N>
inline void store_strips(void* const (&strips)[N / 4], const Lanes<float, N> (&in)[4]) {
  const decltype(in[0].raw.data) registers[] = {in[0].raw.data, in[1].raw.data, in[2].raw.data,
                                                in[3].raw.data};
  register_store_strips(strips, registers);
}
template <int N>
inline int compress_store(std::uint32_t* p, Mask<float, N> m, Lanes<std::uint32_t, N> words) {
  return register_compress(p, bits(m), words.raw.data);
}

}  // namespace
}  // namespace raylanes
