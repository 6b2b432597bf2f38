// Rows of the kernel table: a function for each test and grade.
#pragma once

#include <cstddef>

#include <raylanes/types.hpp>

namespace raylanes {

// Primitives as one array per number that a test reads of them.
using Soa = const float* const*;

// A row per test and grade: [enumerator][Grade].
template <class Row, std::size_t tests>
struct Rows {
  Row row[tests][grade_names.size()];
};

}  // namespace raylanes
