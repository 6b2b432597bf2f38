// Square roots of floats by the public calls: shares of zeros and of subnormal numbers, and lengths from one number to
// arrays in memory.
#include <benchmark/benchmark.h>

#include <random>

#include <raylanes/roots.hpp>

#include "benchmark_roots.hpp"

namespace raylanes::bench {
namespace {

using Roots = void (*)(std::span<const float>, std::span<float>);
using Way = std::pair<const char*, Roots>;

template <Accuracy accuracy>
void within(std::span<const float> x, std::span<float> y) {
  sqrt(x, y, accuracy);
}

constexpr std::array<Way, 5> square_roots{
    {{"instruction", [](std::span<const float> x, std::span<float> y) { sqrt(x, y, SqrtMethod::hardware); }},
     {"correctly_rounded", within<Accuracy::correctly_rounded>},
     {"within_1_ulp", within<Accuracy::within_1_ulp>},
     {"within_2^-22", within<Accuracy::within_2_to_minus_22>},
     {"within_2^-11", within<Accuracy::within_2_to_minus_11>}}};

// Numbers from 2^-20 to 2^20, a share of them `special`.
void take_roots(benchmark::State& state, Roots roots, std::size_t n, double share, float special) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exponent(-20, 20), unit(0, 1);
  const AlignedArrays<float> arrays(n);
  const std::span<float> x(arrays.in, n), y(arrays.out, n);
  for (float& number : x)
    number = unit(random) < share ? special : static_cast<float>(std::exp2(exponent(random)));
  roots(x, y);
  time_calls(state, n, [&] { roots(x, y); });
}

}  // namespace

std::vector<BenchmarkCase> root_cliffs() {
  std::vector<Way> ways(square_roots.begin(), square_roots.end());
  ways.push_back({"reciprocal_root", [](std::span<const float> x, std::span<float> y) { rsqrt(x, y); }});
  std::vector<BenchmarkCase> cases;
  for (const auto& [name, way] : ways)
    for (const auto& [special, number] : {std::pair{"zeros", 0.0f}, std::pair{"subnormals", 1e-40f}})
      for (const double share : {0.0, 1e-4, 1e-3, 0.01, 0.05, 0.2, 1.0})
        cases.push_back({std::string("cliff/roots/") + name + '/' + special + '/' + std::to_string(share),
                         [=, way = way, number = number](benchmark::State& state) {
                           take_roots(state, way, first_level_roots, share, number);
                         }});
  return cases;
}

std::vector<BenchmarkCase> root_lengths() {
  std::vector<BenchmarkCase> cases;
  const auto add = [&](const std::string& name, Roots way, std::size_t n) {
    cases.push_back(
        {name + '/' + std::to_string(n), [=](benchmark::State& state) { take_roots(state, way, n, 0, 0); }});
  };
  for (const auto& [name, way] : square_roots)
    for (const std::size_t n :
         {3072u, 10'000u, 30'000u, 100'000u, 300'000u, 1'000'000u, 4'000'000u, 16'000'000u})
      add(std::string("length/") + name, way, n);
  // Calls that take few numbers inline, beside loops of the same program.
  const Way short_ways[] = {{"std",
                             [](std::span<const float> x, std::span<float> y) {
                               for (std::size_t i = 0; i < x.size(); ++i) y[i] = std::sqrt(x[i]);
                             }},
                            {"raylanes", [](std::span<const float> x, std::span<float> y) { sqrt(x, y); }},
                            {"std_reciprocal_root",
                             [](std::span<const float> x, std::span<float> y) {
                               for (std::size_t i = 0; i < x.size(); ++i) y[i] = 1 / std::sqrt(x[i]);
                             }},
                            {"reciprocal_root", [](std::span<const float> x, std::span<float> y) {
                               rsqrt(x, y, Accuracy::within_2_ulp);
                             }}};
  for (const auto& [name, way] : short_ways)
    for (const std::size_t n : {1u,  2u,  3u,  4u,  6u,  8u,   12u,  15u,  16u,  17u,  24u,   31u,   32u,
                                33u, 48u, 64u, 65u, 96u, 128u, 192u, 256u, 512u, 700u, 1024u, 2048u, 4096u})
      add(std::string("short/") + name, way, n);
  return cases;
}

}  // namespace raylanes::bench
