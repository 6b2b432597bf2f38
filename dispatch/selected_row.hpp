// The part that calls on arrays share: the row that the options name, and the sizes of the outputs.
#pragma once

#include "checked.hpp"
#include "table/kernel_table.hpp"

namespace raylanes {

// The row of options.test and options.grade in `family_of(table)`. Throws as checked_path and checked_index do.
template <class Options, class FamilyOf>
const auto& selected_row(const char* call, const Options& options, FamilyOf family_of) {
  const auto& rows = family_of(kernels_of(checked_path(options.path))).row;
  return checked_row(call, "grade", checked_row(call, "test", rows, options.test), options.grade);
}

inline void require_bits(const char* call, std::size_t bytes, std::size_t n) {
  require_size(call, "bits", bytes, "a bit for each", n / 8 + (n % 8 != 0));
}

// For two numbers each, and whether there are any.
inline void require_pairs(const char* call, std::size_t n, std::size_t bytes, const char* first,
                          std::size_t of_first, const char* second, std::size_t of_second) {
  require_bits(call, bytes, n);
  require_size(call, first, of_first, "the input", n);
  require_size(call, second, of_second, "the input", n);
}

inline void require_nameable(const char* call, std::size_t n, const char* primitives) {
  if (n > no_primitive)
    throw std::invalid_argument(std::string(call) + ": " + std::to_string(n) + ' ' + primitives +
                                "; an answer names one of at most 2^32 - 1");
}

// The nine arrays of triangles as kernels want them.
struct CornerArrays {
  const float* array[9];
  explicit CornerArrays(const TriangleArrays& triangles) {
    for (std::size_t k = 0; k < 9; ++k) array[k] = triangles.corner[k / 3][k % 3];
  }
};

}  // namespace raylanes
