// The traversals of one path: compiled once per path with its flags and back end; the table is the only symbol that
// leaves the object. The build compiles this text a second time for those with counters, whose table is `counted`, so
// that those without stay as they are.
#include "../triangle/all_tests.hpp"
#include "instances.hpp"
#include "packet/packets.hpp"
#include "single.hpp"
#include "streams.hpp"

namespace raylanes {
namespace {

template <class Counters>
struct PacketRows {
  template <class Fast>
  static constexpr bool has_fast_code = (has_fma && !screens<Fast>) || may_take_planes<Fast>;
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {trace_packets<Test, false, Counters>, trace_packets<Test, true, Counters>, packet_bytes<Test>};
  }
};
template <class Counters>
struct StreamRows {
  // Fused, the watertight test gains 1 % in streams, in the middle of six scenes by three sets of rays; packets, 5 %.
  template <class Fast>
  static constexpr bool has_fast_code = has_fma && !screens<Fast> && Fast::id != TriangleTest::watertight;
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_stream<Test, Counters>, any_stream<Test, Counters>, OctantScratch::bytes};
  }
};

[[maybe_unused]] std::uint32_t nearest_triangle(const TreeView& tree, const Ray& ray) {
  return closest_candidate<WalksNodes, Exact<Grade::reproducible>, ClosestCandidate>(
      tree, ray, NoCounters(tree), NoRule());
}

// put(rows, tests, make) fills the rows of a mode; rays that are traced together by the tests of `Batch`.
template <class Counters, class Batch, class Put>
constexpr TraversalKernels all_modes(Put put) {
  TraversalKernels kernels{};
  const auto of = [&](TraversalMode mode) -> TraversalRows& {
    return kernels.mode[static_cast<std::size_t>(mode)];
  };
  put(of(TraversalMode::single), TreeTests{}, SingleRows<WalksNodes, Counters>());
  put(of(TraversalMode::packet), Batch{}, PacketRows<Counters>());
  put(of(TraversalMode::stream), Batch{}, StreamRows<Counters>());
  if constexpr (std::is_same_v<Counters, NoCounters>) {
    kernels.call = rows_of<CallKernels>(TreeTests(), CallRows());
    kernels.nearest_triangle = nearest_triangle;
    kernels.closest_in_scene = closest_in_scene;
    kernels.closest_of_instances = closest_of_instances;
    kernels.any_of_instances = any_of_instances;
  }
  return kernels;
}

// Counted in the reproducible grade; rays together by the exact test, as other tests meet the same nodes and leaves.
template <bool counts>
constexpr TraversalKernels all_kernels() {
  if constexpr (!counts)
    return all_modes<NoCounters, TreeTests>(
        [](TraversalRows& rows, auto tests, auto make) { rows = rows_of<TraversalRows>(tests, make); });
  else if constexpr (RAYLANES_COUNTERS)
    return all_modes<CountTests, TestList<Exact>>(
        [](TraversalRows& rows, auto tests, auto make) { put_rows<Grade::reproducible>(rows, tests, make); });
  else
    return {};
}

}  // namespace

RAYLANES_UNIT_TABLE(TraversalKernels, RAYLANES_TABLE, all_kernels<RAYLANES_COUNTS>())
}  // namespace raylanes
