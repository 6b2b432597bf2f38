// Roots judged over every float.
#pragma once

#include <raylanes/bvh.hpp>
#include <raylanes/paths.hpp>

#include "../../../dispatch/table/roots.hpp"
#include "../std.hpp"

namespace raylanes::bench {

enum class RootFunction : std::uint8_t { sqrt, rsqrt, reciprocal };
inline constexpr std::array<std::string_view, 3> root_function_names{"sqrt", "rsqrt", "reciprocal"};
inline std::string name_of(RootFunction function) {
  return std::string(root_function_names[static_cast<std::size_t>(function)]);
}

// The methods of a function, in the order of its enumeration, and its method that serves an accuracy on a path.
std::size_t method_count(RootFunction function);
const RootPromise& promise_of(RootFunction function, std::size_t method);
std::size_t method_within(RootFunction function, Accuracy accuracy, const Path& path);

// One thing to judge.
struct RootRow {
  RootFunction function;
  std::size_t method;
  const Path* path;

  ArrayFunction<float> kernel() const;
  const RootPromise& promise() const { return promise_of(function, method); }
  bool serves(Accuracy accuracy) const { return method_within(function, accuracy, *path) == method; }
  double max_ulp_promised() const {
    return path->has_fma() ? promise().max_ulp : promise().max_ulp_without_fma;
  }
};

// Every method of every function on every path.
std::vector<RootRow> all_root_rows(std::span<const Path* const> paths);

// Errors are against the result in double; 1 ULP is the gap of floats in the binade of the result, so that a
// correctly rounded one has at most 0.5. They count the inputs that are meant: [FLT_MIN, FLT_MAX], and for
// the reciprocal 2^-126 <= |x| <= 2^126.
struct RootAccuracy {
  double max_ulp = 0.0;
  std::uint32_t max_ulp_at = 0;  // bits of the least input with that error
  double least_relative_error = 0.0, greatest_relative_error = 0.0;  // signed
  double sum_of_squares = 0.0;                                       // of relative errors
  std::uint64_t inputs = 0;
  std::uint64_t correctly_rounded = 0;  // among all inputs, with any NaN right where NaN is
  std::uint64_t positive_inputs = 0;    // 0 < x <= infinity
  std::uint64_t positive_correctly_rounded = 0;
  std::uint64_t normal_inputs = 0;
  std::uint64_t normal_correctly_rounded = 0;
  std::uint64_t wrong_specials = 0;       // other inputs whose results are neither the hardware's nor right
  std::uint64_t monotony_violations = 0;  // neighbours among normal inputs whose results are out of order
  std::uint64_t hash = 0;                 // of all results, NaN normalised: equal for equal results

  double max_relative_error() const;
  double root_mean_square() const;
};

// Judges rows[i] as result[i]. Rows of one function and method should be neighbours: they share a judgement where their
// bits are equal. The 2^32 inputs are blocks of 8,192 neighbours. Every `stride`-th block is judged, and always the
// blocks at the ends of the range; stride 1 judges all.
std::vector<RootAccuracy> survey_roots(std::span<const RootRow> rows, std::uint32_t stride,
                                       const Progress& progress);

}  // namespace raylanes::bench
