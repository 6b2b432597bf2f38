// The part of the Highway back end in intrinsics of x86, on AVX2 and AVX-512: bits of a mask, and the names of
// Highway's operations in the vocabulary. backend_highway.hpp includes this file.
#pragma once

#include <immintrin.h>

namespace raylanes {
namespace {

#if defined(__AVX512F__)
static_assert(HWY_STATIC_TARGET == HWY_AVX3, "the flags of this path must make Highway choose AVX-512");
#else
static_assert(HWY_STATIC_TARGET == HWY_AVX2, "the flags of this path must make Highway choose AVX2");
#endif

inline constexpr bool estimates_flush_subnormals = native_lanes < 16;  // rsqrtps, not rsqrt14ps
inline constexpr bool estimates_span_doubles = false;                  // they go by way of float

// Lane i of a mask register in bit i: StoreMaskBits goes through memory, a byte at a time.
#if defined(__AVX512F__)
inline std::uint32_t register_bits(__mmask16 m) {
  return m;
}
inline std::uint32_t register_bits(__mmask8 m) {
  return m;
}
#else
inline std::uint32_t register_bits(__m128 m) {
  return static_cast<std::uint32_t>(_mm_movemask_ps(m));
}
inline std::uint32_t register_bits(__m128d m) {
  return static_cast<std::uint32_t>(_mm_movemask_pd(m));
}
inline std::uint32_t register_bits(__m256 m) {
  return static_cast<std::uint32_t>(_mm256_movemask_ps(m));
}
inline std::uint32_t register_bits(__m256d m) {
  return static_cast<std::uint32_t>(_mm256_movemask_pd(m));
}
#endif

template <class D, class T, class Raw, class M>
inline Raw masked_load(D d, const T* p, M m, Raw filler) {
  return hn::IfThenElse(m, hn::MaskedLoad(m, d, p), filler);
}
template <class D, class T, class Raw, class M>
inline void masked_store(D d, T* p, M m, Raw a) {
  hn::BlendedStore(a, m, d, p);
}

template <class Raw>
inline Raw lesser(Raw a, Raw b) {
  return hn::Min(a, b);
}
template <class Raw>
inline Raw greater(Raw a, Raw b) {
  return hn::Max(a, b);
}

template <class D, class Raw, class Estimate>
inline Raw by_way_of_float(D d, Raw a, Estimate estimate) {
  if constexpr (sizeof(hn::TFromD<D>) == 4)
    return estimate(a);
  else
    return hn::PromoteTo(d, estimate(hn::DemoteTo(hn::Rebind<float, D>(), a)));
}
template <class D, class Raw>
inline Raw estimated_rsqrt(D d, Raw a) {
  return by_way_of_float(d, a, [](auto x) { return hn::ApproximateReciprocalSqrt(x); });
}
template <class D, class Raw>
inline Raw estimated_reciprocal(D d, Raw a) {
  return by_way_of_float(d, a, [](auto x) { return hn::ApproximateReciprocal(x); });
}

}  // namespace
}  // namespace raylanes
