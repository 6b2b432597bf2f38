// The rows of roots in raylanes_bench, and of what is hardest: cliff/CASE/… Each is named in the tables of
// benchmark_cliffs.cpp and benchmark_root_cliffs.cpp. Rows length/ACCURACY/N are square roots of arrays of N floats,
// rows short/WAY/N roots of few.
// sqrt/METHOD/PATH/SIZE, rsqrt/… and so on are throughput.
// sqrt/classic_2_FORM/PATH/SIZE has the forms of the course report. sqrt/LIBRARY_OPERATION/PATH/SIZE has other
// libraries with the instructions of PATH.
#pragma once

#include <benchmark/benchmark.h>

#include <raylanes/paths.hpp>

#include "../../support/std.hpp"

namespace raylanes::bench {

void register_root_rows(std::span<const Path* const> paths);

// So many floats that arrays in and out fill less than the first-level cache.
constexpr std::size_t first_level_roots = 3072;

// Arrays of n numbers for a function's arguments and results, aligned to lines of the cache. Both lie in one block, so
// that their distance does not depend on the allocator.
template <class T>
class AlignedArrays {
  std::vector<T> buffer_;

 public:
  explicit AlignedArrays(std::size_t n) : buffer_(2 * n + 1024) {
    void* aligned = buffer_.data();
    std::size_t space = buffer_.size() * sizeof(T);
    in = static_cast<T*>(std::align(64, 2 * n * sizeof(T), aligned, space));
    out = in + (n + 15) / 16 * 16 + 512;
  }
  AlignedArrays(const AlignedArrays&) = delete;
  AlignedArrays& operator=(const AlignedArrays&) = delete;

  T *in, *out;
};

// Times a call over so many items.
template <class Call>
void time_calls(benchmark::State& state, std::size_t items, const Call& call) {
  for (auto _ : state) {
    call();
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(items));
}

// On the active ISA path, on one thread.
void register_cliff_rows();

struct BenchmarkCase {
  std::string name;
  std::function<void(benchmark::State&)> run;
};
std::vector<BenchmarkCase> root_cliffs();
std::vector<BenchmarkCase> root_lengths();

}  // namespace raylanes::bench
