// Equality of bytes: of numbers and structs, and of what arrays hold.
#pragma once

#include <ranges>

#include "testing.hpp"

namespace raylanes::testing {

template <class T>
requires std::is_trivially_copyable_v<T> &&(!std::ranges::range<T>)bool same_bytes(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

// The same number of elements, each with the same bytes.
template <std::ranges::contiguous_range A, std::ranges::contiguous_range B>
requires std::is_same_v<std::ranges::range_value_t<A>, std::ranges::range_value_t<B>>
bool same_bytes(const A& a, const B& b) {
  const std::size_t size = std::ranges::size(a), bytes = size * sizeof(std::ranges::range_value_t<A>);
  // An empty array may have no address, which memcmp does not allow.
  return size == std::ranges::size(b) &&
         (bytes == 0 || std::memcmp(std::ranges::data(a), std::ranges::data(b), bytes) == 0);
}

}  // namespace raylanes::testing
