// The rows of every mode, counted or not.
#pragma once

#include "../triangle/all_tests.hpp"
#include "packet/packets.hpp"
#include "single.hpp"
#include "streams.hpp"

namespace raylanes {
namespace {

template <class Counters>
struct PacketRows {
  template <class Fast>
  static constexpr bool has_fast_code = (has_fma && !is_filtered<Fast>) || may_take_planes<Fast>;
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {trace_packets<Test, false, Counters>, trace_packets<Test, true, Counters>, packet_bytes<Test>};
  }
};
template <class Counters>
struct StreamRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_stream<Test, Counters>, any_stream<Test, Counters>, OctantScratch::bytes};
  }
};

// put(rows, tests, make) fills the rows of a mode; rays that are traced together by the tests of `Batch`.
template <class Counters, class Batch, class Put>
constexpr void put_modes(TraversalKernels& kernels, Put put) {
  const auto of = [&](TraversalMode mode) -> TraversalRows& {
    return kernels.mode[static_cast<std::size_t>(mode)];
  };
  put(of(TraversalMode::single), TreeTests{}, SingleRows<WalksNodes, Counters>());
  put(of(TraversalMode::packet), Batch{}, PacketRows<Counters>());
  put(of(TraversalMode::stream), Batch{}, StreamRows<Counters>());
}

}  // namespace
}  // namespace raylanes
