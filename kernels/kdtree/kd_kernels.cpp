// The traversals of k-d trees of one path: compiled once per path with its flags and back end; the table is the only
// symbol that leaves the object. The walk of nodes is not even seen here.
#include "../triangle/all_tests.hpp"
#include "cell_walk.hpp"

namespace raylanes {
namespace {

constexpr KdKernels all_kernels() {
  KdKernels kernels{};
  put_rows<Grade::reproducible>(kernels.plain, TreeTests(), SingleRows<WalksCells, NoCounters>());
  if constexpr (RAYLANES_COUNTERS)
    put_rows<Grade::reproducible>(kernels.counted, TreeTests(), SingleRows<WalksCells, CountTests>());
  return kernels;
}

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const KdKernels kdtree;
constinit const KdKernels kdtree = all_kernels();

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes
