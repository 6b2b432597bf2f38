// The state of a vector of rays under a filtered test: the segments, and for the nearest hit the candidate of each ray.
// Streams and packets load a state, each from memory of its own, test triangles, and store it; the state of a single
// ray is a Candidate. Any hit ends a ray: then the state is the segment.
#pragma once

#include "ranges.hpp"

namespace raylanes {
namespace {

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

}  // namespace
}  // namespace raylanes
