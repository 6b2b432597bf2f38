// The rows of every mode, counted or not.
#pragma once

#include "../../dispatch/table.hpp"
#include "../triangle/all_tests.hpp"
#include "large_packet/batch.hpp"
#include "single.hpp"
#include "streams.hpp"

namespace raylanes {
namespace {

// Large packets and streams have code of thousands of bytes a test, so only the tests that gain most by them are offered.
using BatchTests = TestList<Exact, Watertight, MollerTrumbore>;

constexpr std::size_t no_scratch(std::size_t) {
  return 0;
}

template <class Counters>
struct SingleRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_single<Test, Counters>, any_single<Test, Counters>, no_scratch};
  }
};
template <class Counters>
struct LargePacketRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_large_packet<Test, Counters>, any_large_packet<Test, Counters>,
            [](std::size_t) { return sizeof(LargePacketScratch<Test, SharedPoint::origin>); }};
  }
};
template <class Counters>
struct BundleRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {trace_bundles<Test, false, Counters>, trace_bundles<Test, true, Counters>,
            [](std::size_t) { return sizeof(LargePacketScratch<Test, SharedPoint::none>); }};
  }
};
template <class Counters>
struct StreamRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_stream<Test, Counters>, any_stream<Test, Counters>, OctantScratch::bytes};
  }
};

// put(rows, tests, make) fills the rows of a mode.
template <class Counters, class Put>
constexpr void put_modes(TraversalKernels& kernels, Put put) {
  const auto of = [&](TraversalMode mode) -> TraversalRows& {
    return kernels.mode[static_cast<std::size_t>(mode)];
  };
  put(of(TraversalMode::single), TriangleTests{}, SingleRows<Counters>());
  put(of(TraversalMode::large_packet), BatchTests{}, LargePacketRows<Counters>());
  put(of(TraversalMode::bundle), BatchTests{}, BundleRows<Counters>());
  put(of(TraversalMode::stream), BatchTests{}, StreamRows<Counters>());
}

}  // namespace
}  // namespace raylanes
