#include <hwy/contrib/sort/vqsort.h>

#include "sort_keys.hpp"

namespace raylanes {

void sort_keys(std::span<std::uint64_t> keys) {
  static thread_local hwy::Sorter sorter;  // holds memory, too slow to allocate for each node of a tree
  sorter(keys.data(), keys.size(), hwy::SortAscending());
}

}  // namespace raylanes
