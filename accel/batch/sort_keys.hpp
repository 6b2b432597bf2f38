// Sorting by Highway's VQSort or, with -Dsort=std, by the C++ library.
#pragma once

#include <cstdint>
#include <span>

namespace raylanes {

// Sorts keys in ascending order. Trees have the same bytes by either sort, because all keys of a call differ.
void sort_keys(std::span<std::uint64_t> keys);

}  // namespace raylanes
