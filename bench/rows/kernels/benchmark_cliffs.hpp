// Rows of raylanes_bench for what is hardest: cliff/CASE/… Each is named in the tables of benchmark_cliffs.cpp and
// benchmark_root_cliffs.cpp. Rows length/ACCURACY/N are square roots of arrays of N floats.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

namespace raylanes::bench {

// On the active ISA path, on one thread.
void register_cliff_rows();

struct BenchmarkCase {
  std::string name;
  std::function<void(benchmark::State&)> run;
};
std::vector<BenchmarkCase> root_cliffs();
std::vector<BenchmarkCase> root_lengths();

}  // namespace raylanes::bench
