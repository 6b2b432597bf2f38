// Lists as C holds them, of items of any type.
#pragma once

#include <raylanes/raylanes.h>

#include <cstddef>
#include <utility>

#include <raylanes/queries.hpp>

struct raylanes_lists {
  virtual ~raylanes_lists() = default;
  const std::size_t* offsets = nullptr;
  const void* items = nullptr;
};

namespace raylanes::c {

template <class Item>
struct Lists final : raylanes_lists {
  explicit Lists(RayLists<Item> made) : lists(std::move(made)) {
    offsets = lists.offsets.data();
    items = lists.items.empty() ? nullptr : lists.items.data();
  }
  RayLists<Item> lists;
};

}  // namespace raylanes::c
