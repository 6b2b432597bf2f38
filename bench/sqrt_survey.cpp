#include "sqrt_survey.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "../dispatch/table.hpp"

namespace raylanes::bench {
namespace {

constexpr std::uint32_t block_size = 1u << 16;
constexpr std::uint32_t block_count = 1u << 16;
constexpr std::uint32_t first_normal = 0x00800000u;
constexpr std::uint32_t infinity_bits = 0x7f800000u;
constexpr std::uint32_t one_nan = 0x7fc00000u;

using Floats = std::vector<float>;

std::uint32_t normalised_bits(float x) {
  return std::isnan(x) ? one_nan : std::bit_cast<std::uint32_t>(x);
}

// What the table promises for inputs that are not positive normal numbers.
float expected_special(SqrtMethod method, float x) {
  if (method == SqrtMethod::correctly_rounded || x == 0.0f ||
      !(std::fabs(x) < std::numeric_limits<float>::min()))
    return std::sqrt(x);
  return std::copysign(0.0f, x);
}

struct Block {
  std::uint32_t first;
  Floats input = Floats(block_size);
  std::vector<double> root = std::vector<double>(block_size);  // exact to 2^-53

  explicit Block(std::uint32_t number) : first(number * block_size) {
    for (std::uint32_t i = 0; i < block_size; ++i) {
      input[i] = std::bit_cast<float>(first + i);
      root[i] = std::sqrt(static_cast<double>(input[i]));
    }
  }
  // Blocks do not straddle: 2^23 and the bits of infinity are multiples of the block size.
  bool normal() const { return first >= first_normal && first < infinity_bits; }
};

// 1 / ULP of a root, a power of two.
double per_ulp(double root) {
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(root) >> 52;
  return std::bit_cast<double>((2u * 1023u + 23u - exponent) << 52);
}

void judge_errors(const Block& block, const Floats& output, SqrtAccuracy& a) {
  double max_ulp = 0.0, max_relative = 0.0;
  for (std::uint32_t i = 0; i < block_size; ++i) {
    const double error = std::fabs(static_cast<double>(output[i]) - block.root[i]);
    const double ulp = error * per_ulp(block.root[i]);
    const double relative = error / block.root[i];
    max_ulp = ulp > max_ulp ? ulp : max_ulp;
    max_relative = relative > max_relative ? relative : max_relative;
  }
  a.max_relative_error = max_relative;
  a.max_ulp = max_ulp;
  for (std::uint32_t i = 0; i < block_size; ++i)
    if (std::fabs(static_cast<double>(output[i]) - block.root[i]) * per_ulp(block.root[i]) == max_ulp) {
      a.max_ulp_at = block.first + i;
      break;
    }
}

SqrtAccuracy judge_block(SqrtMethod method, const Block& block, const Floats& output) {
  SqrtAccuracy a;
  a.inputs = block_size;
  for (std::uint32_t i = 0; i < block_size; ++i) {
    const std::uint32_t bits = normalised_bits(output[i]);
    // Rounding the double root is correct: 53 bits are more than 2·24 + 2.
    a.correctly_rounded += bits == normalised_bits(static_cast<float>(block.root[i]));
    a.wrong_specials += !block.normal() && bits != normalised_bits(expected_special(method, block.input[i]));
    a.hash = (a.hash ^ bits) * 0x100000001b3u;
  }
  a.hash *= 2u * (block.first / block_size) + 1u;  // blocks are added in any order
  if (block.normal()) {
    a.normal_inputs = block_size;
    a.normal_correctly_rounded = a.correctly_rounded;
    judge_errors(block, output, a);
  }
  return a;
}

void add(SqrtAccuracy& sum, const SqrtAccuracy& a) {
  if (a.max_ulp > sum.max_ulp || (a.max_ulp == sum.max_ulp && a.max_ulp_at < sum.max_ulp_at)) {
    sum.max_ulp = a.max_ulp;
    sum.max_ulp_at = a.max_ulp_at;
  }
  sum.max_relative_error = std::max(sum.max_relative_error, a.max_relative_error);
  sum.inputs += a.inputs;
  sum.correctly_rounded += a.correctly_rounded;
  sum.normal_inputs += a.normal_inputs;
  sum.normal_correctly_rounded += a.normal_correctly_rounded;
  sum.wrong_specials += a.wrong_specials;
  sum.hash += a.hash;
}

using Sums = std::vector<SqrtAccuracy>;

void judge_all(const Block& block, std::span<const SqrtMethod> methods, std::span<const Path* const> paths,
               Sums& sums) {
  Floats first(block_size), output(block_size);
  for (std::size_t m = 0; m < methods.size(); ++m) {
    SqrtAccuracy of_first;
    for (std::size_t p = 0; p < paths.size(); ++p) {
      Floats& target = p == 0 ? first : output;
      paths[p]->table.sqrt[static_cast<std::size_t>(methods[m])](block.input.data(), target.data(),
                                                                 block_size);
      const bool same = p > 0 && std::memcmp(first.data(), output.data(), block_size * sizeof(float)) == 0;
      const SqrtAccuracy a = same ? of_first : judge_block(methods[m], block, target);
      if (p == 0) of_first = a;
      add(sums[m * paths.size() + p], a);
    }
  }
}

}  // namespace

std::vector<SqrtAccuracy> survey_square_roots(std::span<const SqrtMethod> methods,
                                              std::span<const Path* const> paths, std::uint32_t stride,
                                              const Progress& progress) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t n = 0; n < block_count; ++n) {
    constexpr std::uint32_t per_binade = first_normal / block_size;
    const bool edge = n == 0 || n + 1 == block_count || n == per_binade ||
                      n == infinity_bits / block_size - 1 || n == infinity_bits / block_size ||
                      n == block_count / 2;
    if (edge || n % stride == 0) numbers.push_back(n);
  }
  std::atomic<std::size_t> done = 0;
  const Sums nothing(methods.size() * paths.size());
  return oneapi::tbb::parallel_reduce(
      oneapi::tbb::blocked_range<std::size_t>(0, numbers.size()), nothing,
      [&](const auto& part, Sums sums) {
        for (std::size_t i = part.begin(); i != part.end(); ++i) {
          judge_all(Block(numbers[i]), methods, paths, sums);
          if (progress) progress(static_cast<double>(++done) / static_cast<double>(numbers.size()));
        }
        return sums;
      },
      [](Sums a, const Sums& b) {
        for (std::size_t i = 0; i < a.size(); ++i) add(a[i], b[i]);
        return a;
      });
}

}  // namespace raylanes::bench
