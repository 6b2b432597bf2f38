// Triangle meshes as people have them, and what every builder asks of one.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <ranges>
#include <type_traits>
#include <utility>
#include <vector>

#include <raylanes/types.hpp>

namespace raylanes {

using Index3 = std::array<std::uint32_t, 3>;

// Triangle i has the corners vertices[triangles[i][0..2]]; i is the primitive number that hits report. Degenerate and
// duplicate triangles are allowed.
struct Mesh {
  std::vector<Float3> vertices;
  std::vector<Index3> triangles;
};

namespace detail {

// The type of the numbers that a T is, or of those that it holds, as far as they can be asked for: members x, y and z,
// or elements 0, 1 and 2. void of anything else.
template <class T>
auto number_in() {
  if constexpr (std::is_arithmetic_v<T>)
    return std::type_identity<T>();
  else if constexpr (requires(const T& t) { &t.x, &t.y, &t.z; })
    return std::type_identity<std::conditional_t<std::same_as<decltype(T::x), decltype(T::y)> &&
                                                     std::same_as<decltype(T::x), decltype(T::z)>,
                                                 std::remove_cv_t<decltype(T::x)>, void>>();
  else if constexpr (requires(const T& t) { &t[0]; })
    return std::type_identity<std::remove_cvref_t<decltype(std::declval<const T&>()[0])>>();
  else
    return std::type_identity<void>();
}
template <class T>
using NumberIn = typename decltype(number_in<T>())::type;

// One number of a flat array, or anything that holds three itself.
template <class T, class... Numbers>
concept HoldsNumbers =
    (std::same_as<NumberIn<T>, Numbers> || ...) &&
    (std::is_arithmetic_v<T> || sizeof(T) >= 3 * sizeof(float)) && std::is_trivially_destructible_v<T> &&
    !std::is_pointer_v<T> && !std::ranges::borrowed_range<T>;

template <class R, class... Numbers>
concept RangeOf = std::ranges::contiguous_range<R> && std::ranges::sized_range<R> &&
    HoldsNumbers<std::remove_cv_t<std::ranges::range_value_t<R>>, Numbers...>;

// The number of vertices or triangles in `numbers` flat numbers; throws std::invalid_argument where some are left over.
std::size_t count_threes(const char* what, std::size_t numbers);
// Throws std::invalid_argument unless three numbers lie one after the other within the `size` bytes of an element.
void require_three(const char* what, const void* element, std::size_t size, const void* const (&numbers)[3]);

template <class R>
std::size_t count_elements(const char* what, const R& range) {
  if constexpr (std::is_arithmetic_v<std::ranges::range_value_t<R>>)
    return count_threes(what, std::ranges::size(range));
  else
    return std::ranges::size(range);
}

// Where the numbers of the first element are; null if there is none.
template <class R>
const void* first_number(const char* what, const R& range) {
  using T = std::remove_cv_t<std::ranges::range_value_t<R>>;
  if (std::ranges::size(range) == 0) return nullptr;
  const T& t = *std::ranges::data(range);
  if constexpr (std::is_arithmetic_v<T>) {
    return &t;
  } else {
    const void* numbers[3];
    if constexpr (requires { &t.x, &t.y, &t.z; })
      numbers[0] = &t.x, numbers[1] = &t.y, numbers[2] = &t.z;
    else
      for (std::size_t k = 0; k < 3; ++k) numbers[k] = &t[k];
    require_three(what, &t, sizeof t, numbers);
    return numbers[0];
  }
}

template <class R>
constexpr std::size_t stride_of = std::is_arithmetic_v<std::ranges::range_value_t<R>>
                                      ? 3 * sizeof(std::ranges::range_value_t<R>)
                                      : sizeof(std::ranges::range_value_t<R>);

}  // namespace detail

// Three floats every `stride` bytes, of any alignment, owned by someone else. Made from a contiguous range of floats,
// or of arrays or classes that hold three one after the other, as members x, y and z or as elements 0 to 2 of []; or
// from where the first vertex's are, for anything else: VertexView(records[0].position, count, sizeof(Record)). Throws
// std::invalid_argument for classes whose numbers lie otherwise.
struct VertexView {
  const void* first = nullptr;  // null only with count = 0
  std::size_t count = 0;
  std::size_t stride = 3 * sizeof(float);

  VertexView() = default;
  VertexView(const void* vertices, std::size_t size, std::size_t bytes_apart = 3 * sizeof(float))
      : first(vertices), count(size), stride(bytes_apart) {}
  template <class R>
  requires detail::RangeOf<R, float> VertexView(const R& vertices)
      : first(detail::first_number("vertices", vertices)),
        count(detail::count_elements("vertices", vertices)),
        stride(detail::stride_of<R>) {}

  const std::byte* address(std::size_t i) const { return static_cast<const std::byte*>(first) + i * stride; }
  Float3 operator[](std::size_t i) const {
    Float3 vertex;
    std::memcpy(vertex.data(), address(i), sizeof vertex);
    return vertex;
  }
};

// The same of three indices of 32 bits, with or without a sign.
struct IndexView {
  const void* first = nullptr;
  std::size_t count = 0;
  std::size_t stride = 3 * sizeof(std::uint32_t);
  bool is_signed = false;

  IndexView() = default;
  IndexView(const std::uint32_t* triangles, std::size_t size,
            std::size_t bytes_apart = 3 * sizeof(std::uint32_t))
      : first(triangles), count(size), stride(bytes_apart) {}
  IndexView(const std::int32_t* triangles, std::size_t size,
            std::size_t bytes_apart = 3 * sizeof(std::int32_t))
      : first(triangles), count(size), stride(bytes_apart), is_signed(true) {}
  template <class R>
  requires detail::RangeOf<R, std::uint32_t, std::int32_t> IndexView(const R& triangles)
      : first(detail::first_number("triangles", triangles)),
        count(detail::count_elements("triangles", triangles)),
        stride(detail::stride_of<R>),
        is_signed(
            std::is_same_v<detail::NumberIn<std::remove_cv_t<std::ranges::range_value_t<R>>>, std::int32_t>) {
  }

  const std::byte* address(std::size_t i) const { return static_cast<const std::byte*>(first) + i * stride; }
  // A negative index becomes one of 2^31 or more.
  Index3 operator[](std::size_t i) const {
    Index3 triangle;
    std::memcpy(triangle.data(), address(i), sizeof triangle);
    return triangle;
  }
};

// Throws std::invalid_argument, naming the first offender, if an index is negative or not below the number of
// vertices, a coordinate of a vertex is NaN or infinite, or a view of something points to nothing. An empty mesh is
// valid: nothing hits it.
void validate_mesh(VertexView vertices, IndexView triangles);

}  // namespace raylanes
