// The part of the Highway back end in Arm's intrinsics: operations that Highway 1.0.3 lacks on NEON or gives another
// meaning than the vocabulary. backend_highway.hpp includes this file.
#pragma once

#include <arm_neon.h>

#include <cstddef>
#include <cstdint>
#include <iterator>

#include "one_estimate.hpp"

namespace raylanes {
namespace {

static_assert(HWY_STATIC_TARGET == HWY_NEON, "the flags of this path must make Highway choose NEON");

// Within 2^-15.9, see one_estimate.hpp; of doubles, too.
inline constexpr bool estimates_flush_subnormals = false;
inline constexpr bool estimates_span_doubles = true;

// Lane i of a mask register in bit i.
inline std::uint32_t register_bits(uint32x4_t m) {
  return vaddvq_u32(vandq_u32(m, vld1q_u32(bit_of_lane<std::uint32_t>)));
}
inline std::uint32_t register_bits(uint64x2_t m) {
  return static_cast<std::uint32_t>(vaddvq_u64(vandq_u64(m, vld1q_u64(bit_of_lane<std::uint64_t>))));
}

// One lane after the other: Highway loads and stores all of them.
template <class D, class T, class Raw, class M>
inline Raw masked_load(D d, const T* p, M m, Raw filler) {
  T copy[hn::MaxLanes(D())];
  hn::StoreU(filler, d, copy);
  const std::uint32_t lanes = register_bits(m.raw);
  for (std::size_t i = 0; i < std::size(copy); ++i)
    if ((lanes >> i & 1u) != 0) copy[i] = p[i];
  return hn::LoadU(d, copy);
}
template <class D, class T, class Raw, class M>
inline void masked_store(D d, T* p, M m, Raw a) {
  T copy[hn::MaxLanes(D())];
  hn::StoreU(a, d, copy);
  const std::uint32_t lanes = register_bits(m.raw);
  for (std::size_t i = 0; i < std::size(copy); ++i)
    if ((lanes >> i & 1u) != 0) p[i] = copy[i];
}

// By comparison: FMINNM and FMAXNM, Highway's, choose otherwise where an operand is NaN or both are zeros.
template <class Raw>
inline Raw lesser(Raw a, Raw b) {
  return hn::IfThenElse(hn::Lt(a, b), a, b);
}
template <class Raw>
inline Raw greater(Raw a, Raw b) {
  if constexpr (hwy::IsFloat<hn::TFromV<Raw>>())
    return hn::IfThenElse(hn::Gt(a, b), a, b);
  else
    return hn::Max(a, b);
}

template <class D, class Raw>
inline Raw estimated_rsqrt(D, Raw a) {
  return Raw(register_rsqrt(a.raw));
}
template <class D, class Raw>
inline Raw estimated_reciprocal(D, Raw a) {
  return Raw(register_reciprocal(a.raw));
}

}  // namespace
}  // namespace raylanes
