#include <algorithm>

#include "sort_keys.hpp"

namespace raylanes {

void sort_keys(std::span<std::uint64_t> keys) {
  std::sort(keys.begin(), keys.end());
}

}  // namespace raylanes
