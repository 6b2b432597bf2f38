// The traversals of one path: compiled once per path with its flags and back end; the table is the only symbol that
// leaves the object.
#include "mode_rows.hpp"

namespace raylanes {
namespace {

constexpr TraversalKernels all_modes() {
  TraversalKernels kernels{};
  put_modes<NoCounters, BatchTests>(kernels, [](TraversalRows& rows, auto tests, auto make) {
    rows = rows_of<TraversalRows>(tests, make);
  });
  return kernels;
}

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const TraversalKernels traversal;
constinit const TraversalKernels traversal = all_modes();

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes
