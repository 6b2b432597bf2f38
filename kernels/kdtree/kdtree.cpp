// The traversals of k-d trees of one path: compiled once per path with its flags and back end; the table is the only
// symbol that leaves the object.
#include "../traverse/mode_rows.hpp"
#include "single.hpp"

namespace raylanes {
namespace {

// The rows of a test whose triangles are in cells.
template <class Rows>
struct RowsInCells {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return Rows().template operator()<InCells<Test>>();
  }
};

template <class Counters, class Put>
constexpr void put_kd_modes(TraversalKernels& kernels, Put put) {
  put(kernels.mode[static_cast<std::size_t>(TraversalMode::single)], TriangleTests{},
      RowsInCells<SingleRows<Counters>>());
}

constexpr KdKernels all_kernels() {
  KdKernels kernels{};
  put_kd_modes<NoCounters>(kernels.plain, [](TraversalRows& rows, auto tests, auto make) {
    rows = rows_of<TraversalRows>(tests, make);
  });
  put_kd_modes<CountTests>(kernels.counted, [](TraversalRows& rows, auto tests, auto make) {
    put_rows<Grade::reproducible>(rows, tests, make);
  });
  return kernels;
}

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const KdKernels kdtree;
constinit const KdKernels kdtree = all_kernels();

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes
