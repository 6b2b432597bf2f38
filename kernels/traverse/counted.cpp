// The traversals of one path with counters: the same text, in an object of its own, so that those without stay as they
// are. In the reproducible grade.
#include "mode_rows.hpp"

namespace raylanes {
namespace {

template <bool front_to_back, bool culls>
struct ExperimentRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    using Query = Without<ClosestOf<Test>, front_to_back, culls>;
    return {closest_single<WalksNodes, Test, CountTests, Query>, any_single<WalksNodes, Test, CountTests>,
            no_scratch};
  }
};

constexpr CountedKernels all_modes() {
  CountedKernels kernels{};
  const auto put = [](TraversalRows& rows, auto tests, auto make) {
    put_rows<Grade::reproducible>(rows, tests, make);
  };
  if constexpr (builds_counters) {
    put_modes<CountTests>(kernels, put);
    put(kernels.experiment[0][0], BatchTests{}, ExperimentRows<false, false>());
    put(kernels.experiment[0][1], BatchTests{}, ExperimentRows<false, true>());
    put(kernels.experiment[1][0], BatchTests{}, ExperimentRows<true, false>());
    kernels.experiment[1][1] = kernels.mode[static_cast<std::size_t>(TraversalMode::single)];
  }
  return kernels;
}

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const CountedKernels counted;
constinit const CountedKernels counted = all_modes();

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes
