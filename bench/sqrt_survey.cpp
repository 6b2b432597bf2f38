#include "sqrt_survey.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>

// The judge is compiled twice, for processors with and without AVX2; the results are the same.
#if defined(__x86_64__) && defined(__ELF__)
#define RAYLANES_WIDE_TOO [[gnu::target_clones("avx2", "default")]]
#else
#define RAYLANES_WIDE_TOO
#endif

namespace raylanes::bench {
namespace {

constexpr std::uint32_t block_size = 1u << 13;  // what a worker keeps of it fits the second-level cache
constexpr std::uint32_t block_count = 1u << 19;
constexpr std::uint32_t first_normal = 0x00800000u;
constexpr std::uint32_t infinity_bits = 0x7f800000u;
constexpr std::uint32_t reciprocal_limit = 0x7e800000u;  // 2^126
constexpr std::uint32_t one_nan = 0x7fc00000u;
constexpr std::size_t lanes = 8;  // partial results that a compiler can keep in registers

std::uint32_t normalised_bits(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return (bits & 0x7fffffffu) > infinity_bits ? one_nan : bits;
}

float hardware_result(RootFunction function, float x) {
  if (function == RootFunction::reciprocal) return 1.0f / x;
  return function == RootFunction::sqrt ? std::sqrt(x) : 1.0f / std::sqrt(x);
}

// Correct to 2^-52 or so.
double wide_result(RootFunction function, double x) {
  if (function == RootFunction::reciprocal) return 1.0 / x;
  return function == RootFunction::sqrt ? std::sqrt(x) : 1.0 / std::sqrt(x);
}

// 1 / ULP of a normal result, a power of two.
double per_ulp(double result) {
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(result) >> 52 & 0x7ffu;
  return std::bit_cast<double>((2u * 1023u + 23u - exponent) << 52);
}

// The inputs of one block and what is right for them under one function; allocated once per thread.
struct Block {
  std::uint32_t first = 0;
  bool normal = false;
  std::vector<float> input = std::vector<float>(block_size);
  std::vector<std::uint32_t> rounded = std::vector<std::uint32_t>(block_size);
  std::vector<double> exact = std::vector<double>(block_size);
  std::vector<double> per_exact = std::vector<double>(block_size);
  std::vector<double> ulps = std::vector<double>(block_size);  // 1 / ULP

  void set(std::uint32_t number) {
    first = number * block_size;
    for (std::uint32_t i = 0; i < block_size; ++i) input[i] = std::bit_cast<float>(first + i);
  }
  // Blocks do not straddle the borders: they are multiples of the block size.
  void set(RootFunction function) {
    const std::uint32_t magnitude = first & 0x7fffffffu;
    normal = function == RootFunction::reciprocal ? magnitude >= first_normal && magnitude < reciprocal_limit
                                                  : first >= first_normal && first < infinity_bits;
    for (std::uint32_t i = 0; i < block_size; ++i) {
      if (!normal) {
        rounded[i] = normalised_bits(hardware_result(function, input[i]));
        continue;
      }
      exact[i] = wide_result(function, static_cast<double>(input[i]));
      per_exact[i] = 1.0 / exact[i];
      ulps[i] = per_ulp(exact[i]);
      rounded[i] = std::bit_cast<std::uint32_t>(static_cast<float>(exact[i]));
    }
  }
};

struct Extremes {
  double ulp, least, greatest, squares;
};

RAYLANES_WIDE_TOO Extremes extremes_of(const float* y, const double* exact, const double* per_exact,
                                       const double* ulps) {
  double ulp[lanes] = {}, least[lanes] = {}, greatest[lanes] = {}, squares[lanes] = {};
  for (std::size_t i = 0; i < block_size; i += lanes)
    for (std::size_t k = 0; k < lanes; ++k) {
      const double error = static_cast<double>(y[i + k]) - exact[i + k];
      const double relative = error * per_exact[i + k];
      const double distance = std::fabs(error) * ulps[i + k];
      ulp[k] = distance > ulp[k] ? distance : ulp[k];
      least[k] = relative < least[k] ? relative : least[k];
      greatest[k] = relative > greatest[k] ? relative : greatest[k];
      squares[k] += relative * relative;
    }
  Extremes all{};
  for (std::size_t k = 0; k < lanes; ++k) {
    all.ulp = std::max(all.ulp, ulp[k]);
    all.least = std::min(all.least, least[k]);
    all.greatest = std::max(all.greatest, greatest[k]);
    all.squares += squares[k];
  }
  return all;
}

struct Counts {
  std::uint64_t right, hash;
};

// The hash: a sum of bits times odd numbers that depend on the place, so that its order is free.
RAYLANES_WIDE_TOO Counts compare_bits(const float* y, const std::uint32_t* rounded, std::uint32_t first) {
  std::uint32_t right = 0;
  std::uint64_t hash = 0;
  for (std::uint32_t i = 0; i < block_size; ++i) {
    std::uint32_t bits;
    std::memcpy(&bits, y + i, sizeof bits);
    bits = (bits & 0x7fffffffu) > infinity_bits ? one_nan : bits;
    right += bits == rounded[i] ? 1u : 0u;
    const std::uint32_t place = (first + i) * 2654435761u | 1u;
    hash += static_cast<std::uint64_t>(bits ^ (place >> 7)) * place;
  }
  return {right, hash};
}

// Results that a larger input should not lessen, or, where `falling`, not raise.
RAYLANES_WIDE_TOO std::uint64_t disorder(const float* y, bool falling) {
  std::uint32_t up = 0, down = 0;
  for (std::uint32_t i = 0; i + 1 < block_size; ++i) {
    up += y[i] < y[i + 1] ? 1u : 0u;
    down += y[i] > y[i + 1] ? 1u : 0u;
  }
  return falling ? up : down;
}

RootAccuracy judge_block(const RootRow& row, const Block& block, const float* output) {
  RootAccuracy a;
  const Counts counts = compare_bits(output, block.rounded.data(), block.first);
  a.inputs = block_size;
  a.correctly_rounded = counts.right;
  a.hash = counts.hash;
  if (!block.normal) {
    a.wrong_specials = block_size - counts.right;
    return a;
  }
  const Extremes e = extremes_of(output, block.exact.data(), block.per_exact.data(), block.ulps.data());
  a.normal_inputs = block_size;
  a.normal_correctly_rounded = counts.right;
  a.max_ulp = e.ulp;
  a.least_relative_error = e.least;
  a.greatest_relative_error = e.greatest;
  a.sum_of_squares = e.squares;
  // Negative inputs come in the order of their magnitude, and so do negative reciprocals.
  const bool negative = block.first >> 31 != 0;
  a.monotony_violations = disorder(output, row.function != RootFunction::sqrt && !negative);
  for (std::uint32_t i = 0; i < block_size; ++i)
    if (std::fabs(static_cast<double>(output[i]) - block.exact[i]) * block.ulps[i] == e.ulp) {
      a.max_ulp_at = block.first + i;
      break;
    }
  return a;
}

void add(RootAccuracy& sum, const RootAccuracy& a) {
  if (a.max_ulp > sum.max_ulp || (a.max_ulp == sum.max_ulp && a.max_ulp_at < sum.max_ulp_at)) {
    sum.max_ulp = a.max_ulp;
    sum.max_ulp_at = a.max_ulp_at;
  }
  sum.least_relative_error = std::min(sum.least_relative_error, a.least_relative_error);
  sum.greatest_relative_error = std::max(sum.greatest_relative_error, a.greatest_relative_error);
  sum.sum_of_squares += a.sum_of_squares;
  sum.inputs += a.inputs;
  sum.correctly_rounded += a.correctly_rounded;
  sum.normal_inputs += a.normal_inputs;
  sum.normal_correctly_rounded += a.normal_correctly_rounded;
  sum.wrong_specials += a.wrong_specials;
  sum.monotony_violations += a.monotony_violations;
  sum.hash += a.hash;
}

// What one thread works with.
struct Worker {
  Block block;
  std::vector<std::vector<float>> outputs;  // of the rows of one method so far, where they differ
  std::vector<RootAccuracy> judgements;     // of these
  std::vector<RootAccuracy> sums;

  explicit Worker(std::size_t rows) : sums(rows) {}

  void judge(std::span<const RootRow> rows, std::uint32_t number) {
    block.set(number);
    std::size_t known = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool new_function = i == 0 || rows[i].function != rows[i - 1].function;
      if (new_function) block.set(rows[i].function);
      if (new_function || rows[i].method != rows[i - 1].method) known = 0;
      add(sums[i], judge_row(rows[i], known));
    }
  }

  const RootAccuracy& judge_row(const RootRow& row, std::size_t& known) {
    if (outputs.size() == known) outputs.emplace_back(block_size), judgements.emplace_back();
    float* output = outputs[known].data();
    row.kernel()(block.input.data(), output, block_size);
    for (std::size_t k = 0; k < known; ++k)
      if (std::memcmp(outputs[k].data(), output, block_size * sizeof(float)) == 0) return judgements[k];
    judgements[known] = judge_block(row, block, output);
    return judgements[known++];
  }
};

std::vector<std::uint32_t> chosen_blocks(std::uint32_t stride) {
  constexpr std::uint32_t per_binade = first_normal / block_size, infinite = infinity_bits / block_size;
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t n = 0; n < block_count; ++n) {
    const std::uint32_t magnitude = n % (block_count / 2);
    const bool edge = magnitude == 0 || magnitude == per_binade || magnitude + 1 == infinite ||
                      magnitude == infinite || n + 1 == block_count;
    // One of each group of `stride`, at varying places: a fixed one would meet the same significands again.
    const std::uint32_t group = n / stride;
    if (edge || n % stride == group * 2654435761u % 4294967291u % stride) numbers.push_back(n);
  }
  return numbers;
}

}  // namespace

std::span<const RootMethod> methods_of(RootFunction function) {
  if (function == RootFunction::sqrt) return sqrt_methods;
  if (function == RootFunction::rsqrt) return rsqrt_methods;
  return reciprocal_methods;
}

FloatArrayFunction RootRow::kernel() const {
  const SquareRootKernels& roots = path->table.roots;
  if (function == RootFunction::sqrt) return roots.sqrt[method];
  return function == RootFunction::rsqrt ? roots.rsqrt[method] : roots.reciprocal[method];
}

double RootAccuracy::max_relative_error() const {
  return std::max(-least_relative_error, greatest_relative_error);
}

double RootAccuracy::root_mean_square() const {
  return normal_inputs == 0 ? 0.0 : std::sqrt(sum_of_squares / static_cast<double>(normal_inputs));
}

std::vector<RootAccuracy> survey_roots(std::span<const RootRow> rows, std::uint32_t stride,
                                       const Progress& progress) {
  const std::vector<std::uint32_t> numbers = chosen_blocks(stride);
  oneapi::tbb::enumerable_thread_specific<Worker> workers(rows.size());
  std::atomic<std::size_t> done = 0;
  oneapi::tbb::parallel_for(std::size_t{0}, numbers.size(), [&](std::size_t i) {
    workers.local().judge(rows, numbers[i]);
    if (progress) progress(static_cast<double>(++done) / static_cast<double>(numbers.size()));
  });
  std::vector<RootAccuracy> sums(rows.size());
  for (const Worker& worker : workers)
    for (std::size_t i = 0; i < sums.size(); ++i) add(sums[i], worker.sums[i]);
  return sums;
}

}  // namespace raylanes::bench
