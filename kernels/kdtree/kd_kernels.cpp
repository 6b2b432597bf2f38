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

namespace detail::RAYLANES_PATH_NAME {

extern constinit const KdKernels kdtree;
constinit const KdKernels kdtree = all_kernels();

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes
