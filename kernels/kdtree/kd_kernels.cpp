// The traversals of k-d trees of one path: compiled once per path with its flags and back end; the table is the only
// symbol that leaves the object. The walk of nodes is not even seen here.
#include "../exact/exact_test.hpp"
#include "cell_walk.hpp"

namespace raylanes {
namespace {

constexpr KdKernels all_kernels() {
  using Test = Exact<Grade::reproducible>;
  KdKernels kernels{};
  kernels.plain = SingleRows<WalksCells, NoCounters>().operator()<Test>();
  if constexpr (RAYLANES_COUNTERS) kernels.counted = SingleRows<WalksCells, CountTests>().operator()<Test>();
  return kernels;
}

}  // namespace

RAYLANES_UNIT_TABLE(KdKernels, kdtree, all_kernels())
}  // namespace raylanes
