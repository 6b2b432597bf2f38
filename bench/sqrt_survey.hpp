// Square roots judged over every float.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "../accel/binary_tree.hpp"
#include "../dispatch/paths.hpp"
#include "../dispatch/table.hpp"

namespace raylanes::bench {

// Errors are against the exact root, in double; 1 ULP is the gap of floats in the root's binade, so that a
// correctly rounded result has at most 0.5. They count inputs in [FLT_MIN, FLT_MAX].
struct SqrtAccuracy {
  double max_ulp = 0.0;
  std::uint32_t max_ulp_at = 0;  // bits of an input with that error
  double max_relative_error = 0.0;
  std::uint64_t inputs = 0;
  std::uint64_t correctly_rounded = 0;  // among all inputs, with any NaN right where NaN is
  std::uint64_t normal_inputs = 0;
  std::uint64_t normal_correctly_rounded = 0;
  std::uint64_t wrong_specials = 0;  // inputs outside [FLT_MIN, FLT_MAX] that break the method's contract
  std::uint64_t hash = 0;            // of all results, NaN normalised: equal for equal results
};

// Judges methods[m] on paths[p] as result[m * paths.size() + p]. Of the 2^32 inputs, taken as blocks of
// 65,536 neighbours, every `stride`-th block is judged and always those at the ends of the range; stride 1 is
// all.
std::vector<SqrtAccuracy> survey_square_roots(std::span<const SqrtMethod> methods,
                                              std::span<const Path* const> paths, std::uint32_t stride,
                                              const Progress& progress);

}  // namespace raylanes::bench
