#include "roots.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "../../dispatch/table.hpp"
#include "root_probe.hpp"

namespace raylanes {

// Defined in the objects of root_probe.cpp; the build lists the paths.
namespace detail {
#define RAYLANES_DECLARE(path) extern const bench::RootProbe path##_roots;
RAYLANES_EACH_PATH(RAYLANES_DECLARE)
}  // namespace detail

namespace bench {
namespace {

#define RAYLANES_PROBE(path) &detail::path##_roots,
const RootProbe* const all_probes[] = {RAYLANES_EACH_PATH(RAYLANES_PROBE)};

const RootProbe& probe_of(const Path& path) {
  std::string name = path.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return **std::find_if(std::begin(all_probes), std::end(all_probes),
                        [&](const RootProbe* probe) { return name == probe->path; });
}

struct Subject {
  FloatArrayFunction function;
  double (*exact)(double);
  double max_ulp;
};

// In and out in one block, so that their distance does not depend on the allocator.
void run_row(benchmark::State& state, const Subject& subject, std::size_t n) {
  std::vector<float> buffer(2 * n + 1024);
  void* aligned = buffer.data();
  std::size_t space = buffer.size() * sizeof(float);
  float* const x = static_cast<float*>(std::align(64, 2 * n * sizeof(float), aligned, space));
  float* const y = x + n + 512;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(1e-3f, 1e3f);
  for (std::size_t i = 0; i < n; ++i) x[i] = uniform(random);
  subject.function(x, y, n);
  // The bound in ULP, as a relative error: an ULP is at most 2^-23 of the result.
  const double bound = subject.max_ulp * 0x1p-23;
  for (std::size_t i = 0; i < n; ++i) {
    const double exact = subject.exact(static_cast<double>(x[i]));
    if (!(std::fabs(static_cast<double>(y[i]) - exact) <= bound * exact))
      return state.SkipWithError("wrong result");
  }
  for (auto _ : state) {
    subject.function(x, y, n);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}

void run_latency(benchmark::State& state, const RootChain& chain) {
  constexpr std::size_t length = 4096;
  // The fixed point of x = sqrt(x) + 1.
  if (std::fabs(chain.run(2.0f, length) - 2.618034f) > 0.2f) return state.SkipWithError("wrong root");
  float x = 2.0f;
  for (auto _ : state) benchmark::DoNotOptimize(x = chain.run(2.0f, length));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(length));
}

void add_row(const std::string& name, const Subject& subject) {
  // In and out: first-level cache, second, third, memory.
  for (const std::size_t n :
       {std::size_t{3072}, std::size_t{1} << 15, std::size_t{1} << 20, std::size_t{1} << 24})
    benchmark::RegisterBenchmark((name + '/' + std::to_string(n)).c_str(),
                                 [subject, n](benchmark::State& state) { run_row(state, subject, n); });
}

template <class Methods, class Functions>
void add_methods(const char* function, const Path& path, const Methods& methods, const Functions& functions,
                 double (*exact)(double)) {
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const double bound = path.has_fma() ? methods[m].max_ulp : methods[m].max_ulp_without_fma;
    add_row(std::string(function) + '/' + std::string(methods[m].name) + '/' + path.name,
            {functions[m], exact, bound});
  }
}

}  // namespace

void register_root_rows(const Path& path) {
  const SquareRootKernels& roots = path.kernels.roots;
  constexpr auto root = [](double a) { return std::sqrt(a); };
  add_methods("sqrt", path, sqrt_methods, roots.sqrt, root);
  add_methods("rsqrt", path, rsqrt_methods, roots.rsqrt, [](double a) { return 1.0 / std::sqrt(a); });
  add_methods("reciprocal", path, reciprocal_methods, roots.reciprocal, [](double a) { return 1.0 / a; });
  const RootProbe& probe = probe_of(path);
  for (std::size_t i = 0; i < probe.contender_count; ++i)
    add_row(std::string("sqrt/") + probe.contenders[i].name + '/' + path.name,
            {probe.contenders[i].run, root, probe.contenders[i].max_ulp});
  for (std::size_t i = 0; i < probe.chain_count; ++i)
    benchmark::RegisterBenchmark(
        (std::string("sqrt_latency/") + probe.chains[i].method + '/' + path.name).c_str(),
        [&chain = probe.chains[i]](benchmark::State& state) { run_latency(state, chain); });
}

}  // namespace bench
}  // namespace raylanes
