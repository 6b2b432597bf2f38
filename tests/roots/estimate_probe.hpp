// The view that the test of estimates has of a path: its methods that rest on an estimate as functions of the number
// and of the estimates that a processor may have for it. Compiled into the objects of the paths too: plain C types
// only.
#pragma once

#include <cstddef>

namespace raylanes {

// The least and the greatest result for x, whose estimate is each float from `low` to `high` in turn.
struct Extent {
  float least, greatest;
};
using EstimateSweep = Extent (*)(float x, float low, float high);

struct SweptMethod {
  enum Function { square_root, reciprocal_root, reciprocal } function;
  std::size_t method;  // its enumerator
  EstimateSweep sweep;
};

struct EstimateTable {
  const SweptMethod* methods;
  std::size_t count;
  double error;  // largest relative error that the path's instruction set documents
  bool has_fma;
};

}  // namespace raylanes
