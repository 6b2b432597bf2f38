// The traversals of one path with counters: the same text, in an object of its own, so that those without stay as they
// are. In the reproducible grade; rays together by the exact test, as other tests meet the same nodes and leaves.
#include "mode_rows.hpp"

namespace raylanes {
namespace {

constexpr TraversalKernels all_modes() {
  TraversalKernels kernels{};
  if constexpr (RAYLANES_COUNTERS)
    put_modes<CountTests, TestList<Exact>>(kernels, [](TraversalRows& rows, auto tests, auto make) {
      put_rows<Grade::reproducible>(rows, tests, make);
    });
  return kernels;
}

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const TraversalKernels counted;
constinit const TraversalKernels counted = all_modes();

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes
