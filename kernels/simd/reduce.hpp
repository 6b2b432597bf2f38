// The largest and the least lane of a register, and the sum of its lanes.
#pragma once

#include "vocabulary.hpp"

namespace raylanes {
namespace {

// By halves, the last few lanes one by one; none of them is NaN.
template <int N, class Choose>
inline float chosen_lane(Floats<N> a, Choose choose) {
  float x[N];
  a.store(x);
  if constexpr (N > 4) {
    return chosen_lane(choose(Floats<N / 2>::load(x), Floats<N / 2>::load(x + N / 2)), choose);
  } else {
    Floats<1> chosen(x[0]);
    for (int i = 1; i < N; ++i) chosen = choose(chosen, Floats<1>(x[i]));
    return chosen.raw;
  }
}
template <int N>
inline float largest_lane(Floats<N> a) {
  return chosen_lane(a, [](auto p, auto q) { return max(p, q); });
}
template <int N>
inline float min_lane(Floats<N> a) {
  return chosen_lane(a, [](auto p, auto q) { return min(p, q); });
}

template <int N>
inline float sum_of_lanes(Floats<N> a) {
  float x[N], sum = 0.0f;
  a.store(x);
  for (const float lane : x) sum += lane;
  return sum;
}

}  // namespace
}  // namespace raylanes
