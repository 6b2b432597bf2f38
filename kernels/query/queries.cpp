// Questions beyond the nearest hit, of one path: compiled once per path with its flags and back end; the table is the
// only symbol that leaves the object.
#include "../triangle/all_tests.hpp"
#include "axis_ray.hpp"
#include "list_streams.hpp"
#include "lists.hpp"
#include "next.hpp"

namespace raylanes {
namespace {

template <class Counters>
constexpr QueryKernels kernels_with() {
  return {list_all<WalksNodes, Counters>, list_all<WalksAlongAxes, Counters>, list_together<Counters>,
          list_scratch_bytes, next_hits<Counters>};
}

constexpr AllQueryKernels all_queries() {
  AllQueryKernels kernels{};
  kernels.plain = kernels_with<NoCounters>();
  if constexpr (RAYLANES_COUNTERS) kernels.counted = kernels_with<CountTests>();
  return kernels;
}

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const AllQueryKernels queries;
constinit const AllQueryKernels queries = all_queries();

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes
