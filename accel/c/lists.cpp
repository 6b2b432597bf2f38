#include "lists.hpp"

const std::size_t* raylanes_lists_offsets(const raylanes_lists* lists) {
  return lists == nullptr ? nullptr : lists->offsets;
}

const void* raylanes_lists_items(const raylanes_lists* lists) {
  return lists == nullptr ? nullptr : lists->items;
}

void raylanes_lists_destroy(raylanes_lists* lists) {
  delete lists;
}
