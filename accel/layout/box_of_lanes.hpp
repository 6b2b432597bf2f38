// The box around what lies in the lanes of rows, as nodes and blocks have them. SSE2, which every x86-64 processor has.
#pragma once

#include <emmintrin.h>

#include <cstddef>

#include "../bounding_boxes.hpp"

namespace raylanes {

// Grows a box in each of four lanes by what they hold; what is NaN, as in lanes without a triangle, is in no box.
class BoxOfLanes {
 public:
  BoxOfLanes() {
    for (int axis = 0; axis < 3; ++axis) {
      lo_[axis] = _mm_set1_ps(empty_box.lo[0]);
      hi_[axis] = _mm_set1_ps(empty_box.hi[0]);
    }
  }
  // MINPS and MAXPS give their second operand where one is NaN.
  void extend(std::size_t axis, __m128 lo, __m128 hi) {
    lo_[axis] = _mm_min_ps(lo, lo_[axis]);
    hi_[axis] = _mm_max_ps(hi, hi_[axis]);
  }
  // Around all lanes.
  Box box() const {
    __m128 a = lo_[0], b = lo_[1], c = lo_[2], d = lo_[2];
    _MM_TRANSPOSE4_PS(a, b, c, d);
    const __m128 lo = _mm_min_ps(_mm_min_ps(a, b), _mm_min_ps(c, d));
    a = hi_[0], b = hi_[1], c = hi_[2], d = hi_[2];
    _MM_TRANSPOSE4_PS(a, b, c, d);
    const __m128 hi = _mm_max_ps(_mm_max_ps(a, b), _mm_max_ps(c, d));
    float corner[2][4];
    _mm_storeu_ps(corner[0], lo);
    _mm_storeu_ps(corner[1], hi);
    return {{corner[0][0], corner[0][1], corner[0][2]}, {corner[1][0], corner[1][1], corner[1][2]}};
  }

 private:
  __m128 lo_[3], hi_[3];
};

}  // namespace raylanes
