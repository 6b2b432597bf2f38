// Shared by all functions of the C interface: statuses, and checks of what C cannot state.
#pragma once

#include <raylanes/raylanes.h>

#include <raylanes/queries.hpp>

#include "../../dispatch/checked.hpp"
#include "../standard.hpp"

// Lists as C holds them, of items of any type.
struct raylanes_lists {
  virtual ~raylanes_lists() = default;
  const std::size_t* offsets = nullptr;
  const void* items = nullptr;
};

namespace raylanes::c {

// Keeps the message of the exception that is being handled, and returns its status.
raylanes_status status_of_exception() noexcept;

// Runs a call; what it throws becomes a status.
template <class Call>
raylanes_status status_of(const Call& call) noexcept {
  try {
    call();
    return RAYLANES_OK;
  } catch (...) {
    return status_of_exception();
  }
}

// A buffer of the caller that holds less than a result.
struct SmallBuffer {
  std::size_t capacity, size;
};
// A function of the caller that ended a call.
struct Cancelled {};

// Throws std::invalid_argument if a pointer is null.
void require_pointer(const char* what, const void* pointer);

// Elements of `size` bytes as C gives them, `stride` bytes apart or side by side. Returns the stride. Throws
// std::invalid_argument if there are some and first is null, they overlap, or they do not fit into the address space.
std::size_t checked_stride(const char* what, const void* first, std::size_t count, std::size_t stride,
                           std::size_t size);

// Throws std::invalid_argument if an address is not a multiple of an alignment.
void require_alignment(const char* what, const void* first, std::size_t alignment);

// An array without a stride. T has the layout of a C.
template <class T, class C>
std::span<T> span_of(const char* what, C* first, std::size_t count) {
  static_assert(sizeof(T) == sizeof(C) && alignof(T) == alignof(C));
  checked_stride(what, first, count, 0, sizeof(T));
  require_alignment(what, first, alignof(T));
  return {reinterpret_cast<T*>(first), count};
}

// The enumerator with a value, one of `count`.
template <class Enumerator>
Enumerator enumerator_of(const char* what, std::int32_t value, std::size_t count) {
  const auto index = static_cast<std::uint32_t>(value);
  if (index >= count) refuse_index("options", what, index, count);
  return static_cast<Enumerator>(index);
}

// The path with a name; null if there is no name.
inline const Path* path_of(const char* name) {
  return name == nullptr ? nullptr : &find_path(name);
}

template <class Item>
struct Lists final : raylanes_lists {
  explicit Lists(RayLists<Item> made) : lists(std::move(made)) {
    offsets = lists.offsets.data();
    items = lists.items.empty() ? nullptr : lists.items.data();
  }
  RayLists<Item> lists;
};

// Gives the caller what `call` makes, at *made, which is null if that throws.
template <class Made, class Make>
void make(const char* what, Made** made, const Make& call) {
  require_pointer(what, made);
  *made = nullptr;
  *made = call();
}

}  // namespace raylanes::c
