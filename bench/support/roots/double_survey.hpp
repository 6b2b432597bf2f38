// Roots of doubles judged over a sample, by pairs of extended numbers: nobody can try them all.
#pragma once

#include <raylanes/paths.hpp>

#include "../../../dispatch/table/roots.hpp"
#include "../std.hpp"

namespace raylanes::bench {

// The sum of both is the result within 2^-100.
struct ExactResult {
  long double value, rest;
};
using ExactRoot = ExactResult (*)(long double);

// A method of a function on a path, and what was found of it.
struct JudgedDoubleRoot {
  std::string function_name;
  const RootPromise* promise = nullptr;
  const Path* on_path = nullptr;
  ArrayFunction<double> kernel = nullptr;
  ExactRoot exact = nullptr;
  std::vector<Accuracy> served;

  double largest_ulp = 0.0, largest_ulp_at = 0.0, largest_relative_error = 0.0;
  std::size_t inputs = 0, rounded_correctly = 0;
  bool specials_ok = false;  // as IEEE 754 has zeros, infinities, NaN and a negative number

  const Path* path() const { return on_path; }
  const std::string& function() const { return function_name; }
  std::string_view method() const { return promise->name; }
  double max_ulp() const { return largest_ulp; }
  double max_relative_error() const { return largest_relative_error; }
  bool serves(Accuracy wanted) const;
  double max_ulp_promised() const {
    return on_path->has_fma() ? promise->max_ulp : promise->max_ulp_without_fma;
  }
  bool keeps_promise() const;
};

// Every method of every function on these paths, judged for so many random numbers from 2^-1000 to 2^1000, half of them
// from 1 to 4.
std::vector<JudgedDoubleRoot> judged_double_roots(std::span<const Path* const> paths, std::size_t count);

}  // namespace raylanes::bench
