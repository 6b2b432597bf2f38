// Triangle meshes, and views of meshes in other layouts.
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

/// The indices of a triangle's three vertices.
using Index3 = std::array<std::uint32_t, 3>;

/// A triangle mesh. Triangle i has the corners vertices[triangles[i][0..2]]; i is the primitive index in hits.
/// Degenerate and duplicate triangles are allowed.
struct Mesh {
  std::vector<Float3> vertices;
  std::vector<Index3> triangles;
};

namespace detail {

// Whether an argument R&& is a temporary range that owns its elements: a vector is one, a span and an lvalue are not.
template <class R>
concept OwningTemporary = std::ranges::range<R> && !std::ranges::borrowed_range<R>;

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
concept HoldsNumbers = ((std::same_as<NumberIn<T>, Numbers> &&
                         (std::is_arithmetic_v<T> || sizeof(T) >= 3 * sizeof(Numbers))) ||
                        ...) &&
                       std::is_trivially_destructible_v<T> && !std::is_pointer_v<T> &&
                       !std::ranges::borrowed_range<T>;

template <class R, class... Numbers>
concept RangeOf = std::ranges::contiguous_range<R> && std::ranges::sized_range<R> &&
    HoldsNumbers<std::remove_cv_t<std::ranges::range_value_t<R>>, Numbers...>;

// The number of vertices or triangles in `numbers` flat numbers; throws std::invalid_argument where some are left over.
std::size_t count_threes(const char* what, std::size_t numbers);
// Throws std::invalid_argument unless three numbers of so many `bytes` lie one after the other within the `size` bytes
// of an element.
void require_three(const char* what, const void* element, std::size_t size, const void* const (&numbers)[3],
                   std::size_t bytes);

template <class R>
std::size_t count_elements(const char* what, const R& range) {
  if constexpr (std::is_arithmetic_v<std::ranges::range_value_t<R>>)
    return count_threes(what, std::ranges::size(range));
  else
    return std::ranges::size(range);
}

// The address of the numbers of the first element; null if there is none.
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
    require_three(what, &t, sizeof t, numbers, sizeof(NumberIn<T>));
    return numbers[0];
  }
}

template <class R>
constexpr std::size_t stride_of = std::is_arithmetic_v<std::ranges::range_value_t<R>>
                                      ? 3 * sizeof(std::ranges::range_value_t<R>)
                                      : sizeof(std::ranges::range_value_t<R>);

}  // namespace detail

/// A view of vertices: three numbers every `stride` bytes, of any alignment. It owns nothing.
/// It converts from a contiguous range of numbers; and from a contiguous range of arrays or classes that hold three
/// consecutive numbers, as members x, y and z or as elements 0 to 2. For any other layout, give the address of the
/// first vertex: VertexView(records[0].position, count, sizeof(Record)).
template <class Number>
struct VertexRecords {
  const void* first = nullptr;              ///< the first vertex; null only if count = 0
  std::size_t count = 0;                    ///< the number of vertices
  std::size_t stride = 3 * sizeof(Number);  ///< bytes from one vertex to the next

  /// Makes a view of no vertices.
  VertexRecords() = default;
  /// Makes a view of `size` vertices, `bytes_apart` bytes from one to the next.
  VertexRecords(const void* vertices, std::size_t size, std::size_t bytes_apart = 3 * sizeof(Number))
      : first(vertices), count(size), stride(bytes_apart) {}
  /// Makes a view of a range. Throws std::invalid_argument if the number of numbers is not divisible by 3, or the three
  /// numbers of an element are not consecutive.
  template <class R>
  requires detail::RangeOf<R, Number> VertexRecords(const R& vertices)
      : first(detail::first_number("vertices", vertices)),
        count(detail::count_elements("vertices", vertices)),
        stride(detail::stride_of<R>) {}
  /// Makes a view of a temporary range, valid until the end of the full expression.
  template <detail::OwningTemporary R>
  requires detail::RangeOf<R, Number> VertexRecords(const R&& vertices RAYLANES_LIFETIMEBOUND)
      : VertexRecords(vertices) {}

  /// Returns the address of element i.
  const std::byte* address(std::size_t i) const { return static_cast<const std::byte*>(first) + i * stride; }
  /// Returns a copy of vertex i.
  std::array<Number, 3> operator[](std::size_t i) const {
    std::array<Number, 3> vertex;
    std::memcpy(vertex.data(), address(i), sizeof vertex);
    return vertex;
  }
};
/// A view of vertices of floats.
using VertexView = VertexRecords<float>;

namespace detail {
template <class R>
concept VerticesOfDoubles = RangeOf<R, double> || std::same_as<R, VertexRecords<double>>;
}  // namespace detail

/// A view of triangles: three 32-bit indices, signed or unsigned, every `stride` bytes, of any alignment. It owns
/// nothing.
/// It converts from the ranges that VertexView converts from, with indices in place of floats.
struct IndexView {
  const void* first = nullptr;                     ///< the first triangle; null only if count = 0
  std::size_t count = 0;                           ///< the number of triangles
  std::size_t stride = 3 * sizeof(std::uint32_t);  ///< bytes from one triangle to the next
  bool is_signed = false;                          ///< whether indices are std::int32_t

  /// Makes a view of no triangles.
  IndexView() = default;
  /// Makes a view of `size` triangles, `bytes_apart` bytes from one to the next.
  IndexView(const std::uint32_t* triangles, std::size_t size,
            std::size_t bytes_apart = 3 * sizeof(std::uint32_t))
      : first(triangles), count(size), stride(bytes_apart) {}
  /// Makes a view of `size` triangles with signed indices.
  IndexView(const std::int32_t* triangles, std::size_t size,
            std::size_t bytes_apart = 3 * sizeof(std::int32_t))
      : first(triangles), count(size), stride(bytes_apart), is_signed(true) {}
  /// Makes a view of a range. Throws std::invalid_argument if the number of indices is not divisible by 3, or the three
  /// indices of an element are not consecutive.
  template <class R>
  requires detail::RangeOf<R, std::uint32_t, std::int32_t> IndexView(const R& triangles)
      : first(detail::first_number("triangles", triangles)),
        count(detail::count_elements("triangles", triangles)),
        stride(detail::stride_of<R>),
        is_signed(
            std::is_same_v<detail::NumberIn<std::remove_cv_t<std::ranges::range_value_t<R>>>, std::int32_t>) {
  }
  /// Makes a view of a temporary range, valid until the end of the full expression.
  template <detail::OwningTemporary R>
  requires detail::RangeOf<R, std::uint32_t, std::int32_t> IndexView(
      const R&& triangles RAYLANES_LIFETIMEBOUND)
      : IndexView(triangles) {}

  /// Returns the address of element i.
  const std::byte* address(std::size_t i) const { return static_cast<const std::byte*>(first) + i * stride; }
  /// Returns a copy of triangle i; a negative index becomes one of 2^31 or more.
  Index3 operator[](std::size_t i) const {
    Index3 triangle;
    std::memcpy(triangle.data(), address(i), sizeof triangle);
    return triangle;
  }
};

/// Checks a mesh. Throws std::invalid_argument that names the first offender: an index that is negative or not below
/// the number of vertices, a triangle's vertex that is not finite, a view of some elements that is null. An empty mesh
/// is valid. Vertices that no triangle has may be anything.
void validate_mesh(VertexView vertices, IndexView triangles);

}  // namespace raylanes
