#include "root_judge.hpp"

// Compiled twice, for processors with and without AVX2; the results are the same. But not with ThreadSanitizer: g++
// has what chooses between the two call it while the program is loaded, before it is ready.
#if defined(__x86_64__) && defined(__ELF__) && !defined(__SANITIZE_THREAD__)
#define RAYLANES_WIDE_TOO [[gnu::target_clones("avx2", "default")]]
#else
#define RAYLANES_WIDE_TOO
#endif

namespace raylanes::bench {
namespace {

constexpr std::uint32_t first_normal = 0x00800000u;
constexpr std::uint32_t infinity_bits = 0x7f800000u;
constexpr std::uint32_t reciprocal_limit = 0x7e800000u;  // 2^126
constexpr std::uint32_t one_nan = 0x7fc00000u;

std::uint32_t normalised_bits(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return (bits & 0x7fffffffu) > infinity_bits ? one_nan : bits;
}

// Results for an input that is subnormal or special, or whose result is: correctly rounded, and the hardware's in
// float. They differ for reciprocal roots of subnormals.
float correct_result(RootFunction function, float x) {
  if (function == RootFunction::rsqrt) return static_cast<float>(1.0 / std::sqrt(static_cast<double>(x)));
  return function == RootFunction::sqrt ? std::sqrt(x) : 1.0f / x;
}
float hardware_result(RootFunction function, float x) {
  if (function == RootFunction::reciprocal) return 1.0f / x;
  return function == RootFunction::sqrt ? std::sqrt(x) : 1.0f / std::sqrt(x);
}

// The results, correct to 2^-52 or so.
RAYLANES_WIDE_TOO void exact_roots(const float* x, double* exact) {
  for (std::uint32_t i = 0; i < root_block_size; ++i) exact[i] = std::sqrt(static_cast<double>(x[i]));
}
RAYLANES_WIDE_TOO void inverses(const double* x, double* inverse) {
  for (std::uint32_t i = 0; i < root_block_size; ++i) inverse[i] = 1.0 / x[i];
}

// The nearest floats of normal results.
RAYLANES_WIDE_TOO void round_results(const double* exact, std::uint32_t* rounded) {
  for (std::uint32_t i = 0; i < root_block_size; ++i)
    rounded[i] = std::bit_cast<std::uint32_t>(static_cast<float>(exact[i]));
}

// 1 / ULP of a normal result, a power of two.
double per_ulp(double result) {
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(result) >> 52 & 0x7ffu;
  return std::bit_cast<double>((2u * 1023u + 23u - exponent) << 52);
}

struct Extremes {
  double ulp, least, greatest, squares;
};

// Lanes as the compiler's own vectors: it makes none of a loop with so many partial results.
using Floats [[gnu::vector_size(16)]] = float;
using Doubles [[gnu::vector_size(32)]] = double;

// By reference: in registers they would be passed differently with and without AVX.
template <class Vector>
void load(Vector& values, const void* from) {
  std::memcpy(&values, from, sizeof values);
}

// The results of a block lie in one binade, but for the first, which may be the power of two at its end.
RAYLANES_WIDE_TOO Extremes extremes_of(const float* y, const double* exact, const double* per_exact) {
  constexpr std::size_t lanes = sizeof(Doubles) / sizeof(double);
  constexpr std::size_t sets = 2;  // of partial results, which do not wait for each other
  Doubles ulp[sets] = {}, least[sets] = {}, greatest[sets] = {}, squares[sets] = {};
  const double rest = per_ulp(exact[1]);
  Doubles per_ulps[sets] = {{per_ulp(exact[0]), rest, rest, rest}, {rest, rest, rest, rest}};
  for (std::size_t i = 0; i < root_block_size; i += lanes * sets) {
    for (std::size_t set = 0; set < sets; ++set) {
      const std::size_t at = i + set * lanes;
      Floats root;
      Doubles result, inverse;
      load(root, y + at), load(result, exact + at), load(inverse, per_exact + at);
      const Doubles error = __builtin_convertvector(root, Doubles) - result;
      const Doubles relative = error * inverse;
      const Doubles size = error < 0.0 ? -error : error;
      const Doubles distance = size * per_ulps[set];
      ulp[set] = distance > ulp[set] ? distance : ulp[set];
      least[set] = relative < least[set] ? relative : least[set];
      greatest[set] = relative > greatest[set] ? relative : greatest[set];
      squares[set] += relative * relative;
    }
    per_ulps[0] = per_ulps[1];
  }
  Extremes all{};
  for (std::size_t set = 0; set < sets; ++set)
    for (std::size_t k = 0; k < lanes; ++k) {
      all.ulp = std::max(all.ulp, ulp[set][k]);
      all.least = std::min(all.least, least[set][k]);
      all.greatest = std::max(all.greatest, greatest[set][k]);
      all.squares += squares[set][k];
    }
  return all;
}

struct Counts {
  std::uint64_t right, hash;
  bool nan;  // any of them
};

// The hash: a sum of bits times odd numbers that depend on the place, so that its order is free.
RAYLANES_WIDE_TOO Counts compare_bits(const float* y, const std::uint32_t* rounded, std::uint32_t first) {
  std::uint32_t right = 0, nans = 0;
  std::uint64_t hash = 0;
  for (std::uint32_t i = 0; i < root_block_size; ++i) {
    std::uint32_t bits;
    std::memcpy(&bits, y + i, sizeof bits);
    const bool nan = (bits & 0x7fffffffu) > infinity_bits;
    bits = nan ? one_nan : bits;
    nans |= nan ? 1u : 0u;
    right += bits == rounded[i] ? 1u : 0u;
    const std::uint32_t place = (first + i) * 2654435761u | 1u;
    hash += static_cast<std::uint64_t>(bits ^ (place >> 7)) * place;
  }
  return {right, hash, nans != 0};
}

// Neighbours of which the second result is less.
RAYLANES_WIDE_TOO std::uint32_t descents(const float* y) {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i + 1 < root_block_size; ++i) count += y[i] > y[i + 1] ? 1u : 0u;
  return count;
}
RAYLANES_WIDE_TOO std::uint32_t ascents(const float* y) {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i + 1 < root_block_size; ++i) count += y[i] < y[i + 1] ? 1u : 0u;
  return count;
}

}  // namespace

void RootBlock::set(std::uint32_t number) {
  first_ = number * root_block_size;
  for (std::uint32_t i = 0; i < root_block_size; ++i) input_[i] = std::bit_cast<float>(first_ + i);
}

void RootBlock::expect(RootFunction function) {
  // Blocks do not straddle the borders of kinds of numbers: these are multiples of the block size.
  const std::uint32_t magnitude = first_ & 0x7fffffffu;
  const bool reciprocal = function == RootFunction::reciprocal;
  normal_ = reciprocal ? magnitude >= first_normal && magnitude < reciprocal_limit
                       : first_ >= first_normal && first_ < infinity_bits;
  // Negative inputs come in the order of their magnitude, and so do their reciprocals.
  falling_ = function != RootFunction::sqrt && first_ >> 31 == 0;
  if (!normal_) {
    for (std::uint32_t i = 0; i < root_block_size; ++i) {
      rounded_[i] = normalised_bits(correct_result(function, input_[i]));
      hardware_[i] = normalised_bits(hardware_result(function, input_[i]));
    }
    return;
  }
  std::vector<double>& root = function == RootFunction::sqrt ? exact_ : per_exact_;
  std::vector<double>& inverse = function == RootFunction::sqrt ? per_exact_ : exact_;
  if (reciprocal)
    std::copy(input_.begin(), input_.end(), per_exact_.begin());
  else
    exact_roots(input_.data(), root.data());
  inverses(root.data(), inverse.data());
  round_results(exact_.data(), rounded_.data());
}

RootAccuracy RootBlock::judge(const float* output) const {
  RootAccuracy a;
  const Counts counts = compare_bits(output, rounded_.data(), first_);
  a.inputs = root_block_size;
  a.correctly_rounded = counts.right;
  count_positive(a, output);
  a.hash = counts.hash;
  if (!normal_) {
    for (std::uint32_t i = 0; i < root_block_size; ++i) {
      const std::uint32_t bits = normalised_bits(output[i]);
      a.wrong_specials += bits != rounded_[i] && bits != hardware_[i] ? 1u : 0u;
    }
    return a;
  }
  const Extremes e = extremes_of(output, exact_.data(), per_exact_.data());
  a.normal_inputs = root_block_size;
  a.normal_correctly_rounded = counts.right;
  a.max_ulp = counts.nan ? std::numeric_limits<double>::infinity() : e.ulp;
  a.least_relative_error = e.least;
  a.greatest_relative_error = e.greatest;
  a.sum_of_squares = e.squares;
  a.monotony_violations = falling_ ? ascents(output) : descents(output);
  return a;
}

// Zero is the first of its block and infinity of the one behind the normal numbers, whose others are NaN.
void RootBlock::count_positive(RootAccuracy& a, const float* output) const {
  if (first_ > infinity_bits) return;
  const bool first_is_right = normalised_bits(output[0]) == rounded_[0];
  if (first_ == infinity_bits) {
    a.positive_inputs = 1;
    a.positive_correctly_rounded = first_is_right ? 1 : 0;
    return;
  }
  const std::uint64_t zeros = first_ == 0 ? 1 : 0;
  a.positive_inputs = a.inputs - zeros;
  a.positive_correctly_rounded = a.correctly_rounded - (first_is_right ? zeros : 0);
}

std::uint32_t RootBlock::where(const float* output, double ulp) const {
  for (std::uint32_t i = 0; i < root_block_size; ++i)
    if (!(std::fabs(static_cast<double>(output[i]) - exact_[i]) * per_ulp(exact_[i]) < ulp))
      return first_ + i;
  return first_;
}

}  // namespace raylanes::bench
