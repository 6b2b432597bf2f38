// The rows of roots in raylanes_bench.
// sqrt/METHOD/PATH/SIZE, rsqrt/… and so on are throughput, sqrt_latency/METHOD/PATH is latency.
// sqrt/classic_N_FORM/PATH/SIZE has the forms of the course report. sqrt/LIBRARY_OPERATION/PATH/SIZE has other
// libraries with the instructions of PATH.
#pragma once

#include <benchmark/benchmark.h>

#include <span>

#include <raylanes/paths.hpp>

namespace raylanes::bench {

void register_root_rows(std::span<const Path* const> paths);

// Times a call over so many items.
template <class Call>
void time_calls(benchmark::State& state, std::size_t items, const Call& call) {
  for (auto _ : state) {
    call();
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(items));
}

}  // namespace raylanes::bench
