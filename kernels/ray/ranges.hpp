// Which t count. A test hands its decision on the triangle and a way to get t to `accept`; `holds` alone is
// for tests that know t first. Comparisons are such that NaN fails them, and the ends are finite: a hit's t is
// finite, and a det of zero, which makes t infinite or NaN, needs no comparison of its own.
#pragma once

#include <limits>

#include "../simd/vocabulary.hpp"

namespace raylanes {
namespace {

template <class V>
using MaskOf = decltype(V() < V());

inline constexpr float largest_t = std::numeric_limits<float>::max();
inline constexpr double largest_double = std::numeric_limits<double>::max();

// The ends of a segment, for one ray or in lanes: t never is infinite. NaN stays NaN.
inline float finite_tmin(float tmin) {
  return tmin < -largest_t ? -largest_t : tmin;
}
inline float finite_tmax(float tmax) {
  return tmax > largest_t ? largest_t : tmax;
}
inline double finite_tmin(double tmin) {
  return tmin < -largest_double ? -largest_double : tmin;
}
inline double finite_tmax(double tmax) {
  return tmax > largest_double ? largest_double : tmax;
}
template <class T, int N>
inline Lanes<T, N> finite_tmin(Lanes<T, N> tmin) {
  return max(Lanes<T, N>(-largest_t), tmin);
}
template <class T, int N>
inline Lanes<T, N> finite_tmax(Lanes<T, N> tmax) {
  return min(Lanes<T, N>(largest_t), tmax);
}

// From tmin to tmax, both finite. A test that screens calls:
//   only_decides     whether hits are all that is wanted, not their numbers
//   accept_below()   a hit whose upper bound of t is below this is nearer than the best one
template <class V, bool only_decides_ = false>
struct Segment {
  static constexpr bool only_decides = only_decides_;
  V tmin, tmax;
  V accept_below() const { return tmax; }
  MaskOf<V> holds(V t) const { return (t >= tmin) & (t <= tmax); }
  // One after the other: where masks have registers of their own, a comparison takes the mask before it along.
  template <class T>
  MaskOf<V> accept(MaskOf<V> inside, T t) const {
    V distance = t();
    return inside & (distance >= tmin) & (distance <= tmax);
  }
};

// To the best hit so far, of which two bounds are known: one before the first is nearer.
template <class V>
struct SegmentToHit : Segment<V> {
  V t_lo;
  V accept_below() const { return t_lo; }
};

// The state of a vector of rays under a test that screens. Any hit ends a ray: then the state is the segment. For the
// nearest hit it has the candidate of each ray, too. Streams and packets load a state, each from memory of its own,
// test triangles, and store it.
template <class V, bool only_decides>
struct RayState : Segment<V, true> {};

template <class V>
struct RayState<V, false> : SegmentToHit<V> {
  V leaf_triangle;  // the candidates', as bits

  // Replaces the candidates of some lanes.
  void keep(MaskOf<V> lanes, V new_t_lo, V t_hi, V new_leaf_triangle) {
    this->t_lo = select(lanes, new_t_lo, this->t_lo);
    this->tmax = select(lanes, t_hi, this->tmax);
    leaf_triangle = select(lanes, new_leaf_triangle, leaf_triangle);
  }
};

// A segment where most vectors hold nothing that the ray passes through, as in the leaves of a tree: those
// cost no division.
template <class V>
struct LeafSegment : Segment<V> {
  template <class T>
  MaskOf<V> accept(MaskOf<V> inside, T t) const {
    return any(inside) ? inside & this->holds(t()) : inside;
  }
};

// From a finite tmin to what is strictly nearer than the best so far, which begins one float above tmax.
template <class V>
struct Nearer {
  V tmin, best;
  MaskOf<V> holds(V t) const { return (t >= tmin) & (t < best); }
  template <class T>
  MaskOf<V> accept(MaskOf<V> inside, T t) const {
    V distance = t();
    return inside & (distance >= tmin) & (distance < best);
  }
};

}  // namespace
}  // namespace raylanes
