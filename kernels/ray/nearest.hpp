// The nearest hit among the primitives of an array, kept per lane until the end of the loop.
#pragma once

#include <bit>
#include <limits>

#include "../simd/slices.hpp"

namespace raylanes {
namespace {

// The least float greater than x; +infinity for FLT_MAX and above.
inline float next_above(float x) {
  if (x == 0.0f) return std::bit_cast<float>(1u);
  const auto bits = std::bit_cast<std::int32_t>(x);
  return x < std::numeric_limits<float>::infinity() ? std::bit_cast<float>(x > 0.0f ? bits + 1 : bits - 1)
                                                    : x;
}

// Nearer wins; of equal t the smaller primitive.
template <class T, class AnyHit>
inline bool is_better(T t, std::uint32_t primitive, const AnyHit& best) {
  return t < best.t || (t == best.t && primitive < best.primitive);
}

template <int N>
inline FloatBits<N> select_bits(FloatMask<N> m, FloatBits<N> a, FloatBits<N> b) {
  return as<std::uint32_t>(select(m, as<float>(a), as<float>(b)));
}

// Best hits so far, one per lane; t begins one above tmax, so that a later hit must be strictly nearer and of equal
// ones the first stays.
struct LaneBests {
  float above;
  Floats<W> t, u, v;
  FloatBits<W> lanes, index;

  explicit LaneBests(float tmax) : above(next_above(tmax)), t(above), u(0.0f), v(0.0f), index(no_primitive) {
    std::uint32_t lane[W];
    for (int i = 0; i < W; ++i) lane[i] = static_cast<std::uint32_t>(i);
    lanes = FloatBits<W>::load(lane);
  }
  // Lanes with a hit that is nearer than theirs, in the registers of a slice.
  void keep(FloatMask<W> nearer, Floats<W> new_t, std::size_t first) {
    t = select(nearer, new_t, t);
    index = select_bits(nearer, lanes + FloatBits<W>(static_cast<std::uint32_t>(first)), index);
  }
  Hit nearest() const {
    Hit best;
    std::uint32_t found = bits(t < Floats<W>(above));
    if (found == 0) return best;
    float ts[W], us[W], vs[W];
    std::uint32_t indices[W];
    t.store(ts), u.store(us), v.store(vs), index.store(indices);
    for (; found != 0; found &= found - 1) {
      const int i = std::countr_zero(found);
      if (is_better(ts[i], indices[i], best)) best = {ts[i], us[i], vs[i], indices[i]};
    }
    return best;
  }
};

}  // namespace
}  // namespace raylanes
