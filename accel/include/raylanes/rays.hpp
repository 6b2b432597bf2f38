// Batches of rays and their hits as people have them.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstring>
#include <ranges>
#include <type_traits>

#include <raylanes/types.hpp>

namespace raylanes {

namespace detail {

template <class R, class T>
concept RangeOfRecords = std::ranges::contiguous_range<R> && std::ranges::sized_range<R> &&
    std::convertible_to<std::add_pointer_t<std::ranges::range_reference_t<R>>, T*>;

// Where the T of the first element is, which need not begin with it; null if there is none.
template <class T, class R>
T* first_of(R& range) {
  return std::ranges::size(range) == 0 ? nullptr : static_cast<T*>(std::ranges::data(range));
}

}  // namespace detail

// A Ray every `stride` bytes, of any alignment, owned by someone else. Made from a contiguous range of rays, or of a
// class derived from Ray, wherever in it that lies; or member by member, from where the numbers of the first ray are.
struct RayView {
  const void* first = nullptr;  // null only with count = 0
  std::size_t count = 0;
  std::size_t stride = sizeof(Ray);

  RayView() = default;
  RayView(const void* rays, std::size_t size, std::size_t bytes_apart = sizeof(Ray))
      : first(rays), count(size), stride(bytes_apart) {}
  template <class R>
  requires detail::RangeOfRecords<const R, const Ray> RayView(const R& rays)
      : first(detail::first_of<const Ray>(rays)),
        count(std::ranges::size(rays)),
        stride(sizeof(std::ranges::range_value_t<R>)) {}

  Ray operator[](std::size_t i) const {
    Ray ray;
    std::memcpy(&ray, static_cast<const std::byte*>(first) + i * stride, sizeof ray);
    return ray;
  }
};

// Which part of a segment counts, as shares of its length from the shared point to the other one: by default not what
// is next to that, where the surface is that it lies on.
struct SegmentEnds {
  float start = 0.0f, end = 1.0f - 0x1p-12f;
};

// Room for a hit every `stride` bytes, likewise. Bytes between hits are left alone.
template <class Record>
struct HitRecords {
  void* first = nullptr;  // null only with count = 0
  std::size_t count = 0;
  std::size_t stride = sizeof(Record);

  HitRecords() = default;
  HitRecords(void* hits, std::size_t size, std::size_t bytes_apart = sizeof(Record))
      : first(hits), count(size), stride(bytes_apart) {}
  template <class R>
  requires detail::RangeOfRecords<R, Record> HitRecords(R&& hits)
      : first(detail::first_of<Record>(hits)),
        count(std::ranges::size(hits)),
        stride(sizeof(std::ranges::range_value_t<R>)) {}

  Record operator[](std::size_t i) const {
    Record hit;
    std::memcpy(static_cast<void*>(&hit), static_cast<const std::byte*>(first) + i * stride, sizeof hit);
    return hit;
  }
  void set(std::size_t i, const Record& hit) const {
    std::memcpy(static_cast<std::byte*>(first) + i * stride, &hit, sizeof hit);
  }
};
using HitView = HitRecords<Hit>;

}  // namespace raylanes
