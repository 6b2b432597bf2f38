
#include <raylanes/doubles.hpp>

#include "../../dispatch/checked.hpp"
#include "../../dispatch/quiet_floats.hpp"
#include "../batch/in_parallel.hpp"
#include "valid_mesh.hpp"

namespace raylanes {

std::size_t detail::count_threes(const char* what, std::size_t numbers) {
  if (numbers % 3 != 0)
    throw std::invalid_argument(std::string(what) + ": " + std::to_string(numbers) +
                                " numbers, they must be three each");
  return numbers / 3;
}

void detail::require_three(const char* what, const void* element, std::size_t size,
                           const void* const (&numbers)[3], std::size_t bytes) {
  const auto address = [](const void* p) { return reinterpret_cast<std::uintptr_t>(p); };
  const std::uintptr_t first = address(numbers[0]) - address(element);
  if (first > size - 3 * bytes || address(numbers[1]) != address(numbers[0]) + bytes ||
      address(numbers[2]) != address(numbers[1]) + bytes)
    throw std::invalid_argument(std::string(what) +
                                ": three numbers of an element must lie one after the other within it");
}

namespace {

// Whether any of some words, less the bits outside `mask`, is above `most`. No branch, for registers of words: most
// meshes are good.
template <class Word>
bool any_word_above(const std::byte* words, std::size_t count, Word mask, Word most) {
  Word any = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Word word;
    std::memcpy(&word, words + i * sizeof word, sizeof word);
    any |= (word & mask) > most ? 1u : 0u;
  }
  return any != 0;
}
// Whether one of the three words of any element is above `most`.
template <class View, class Word>
bool any_above(const View& view, int threads, Word mask, Word most) {
  constexpr std::size_t packed = 3 * sizeof(Word), grain = 1 << 16;
  std::atomic<bool> any = false;
  in_parallel(view.count, grain, threads, [&](std::size_t begin, std::size_t end) {
    bool mine = false;
    if (view.stride == packed)
      mine = any_word_above(view.address(begin), 3 * (end - begin), mask, most);
    else
      for (std::size_t i = begin; i < end; ++i) mine |= any_word_above(view.address(i), 3, mask, most);
    if (mine) any = true;
  });
  return any;
}

// By the bits of the largest number.
bool all_are_finite(const VertexView& vertices, int threads) {
  return !any_above(vertices, threads, 0x7fffffffu, 0x7f7fffffu);
}
bool all_are_finite(const VertexViewD& vertices, int threads) {
  return !any_above(vertices, threads, std::uint64_t{0x7fffffffffffffff}, std::uint64_t{0x7fefffffffffffff});
}
bool all_are_in_range(const IndexView& triangles, std::size_t vertices, int threads) {
  const std::size_t end = std::min(vertices, std::size_t{1} << (triangles.is_signed ? 31 : 32));
  if (end == 0) return triangles.count == 0;
  return !any_above(triangles, threads, ~0u, static_cast<std::uint32_t>(end - 1));
}

template <class Vertex>
bool is_finite(const Vertex& vertex) {
  return std::isfinite(vertex[0]) && std::isfinite(vertex[1]) && std::isfinite(vertex[2]);
}
// Refuses the first vertex that is not finite, if a triangle has it. The indices are in range.
template <class View>
void require_finite_corners(const View& vertices, const IndexView& triangles) {
  std::size_t first = vertices.count;
  for (std::size_t i = 0; i < triangles.count; ++i)
    for (const std::uint32_t index : triangles[i])
      if (index < first && !is_finite(vertices[index])) first = index;
  if (first == vertices.count) return;
  const auto vertex = vertices[first];
  const std::size_t axis = !std::isfinite(vertex[0]) ? 0 : !std::isfinite(vertex[1]) ? 1 : 2;
  throw std::invalid_argument("vertex " + std::to_string(first) + ": coordinate " + "xyz"[axis] + " is " +
                              text_of(vertex[axis]) + ", allowed are finite numbers");
}
[[noreturn]] void refuse_triangles(const IndexView& triangles, std::size_t vertices) {
  for (std::size_t i = 0; i < triangles.count; ++i)
    for (const std::uint32_t index : triangles[i]) {
      const bool is_negative = triangles.is_signed && index > 0x7fffffffu;
      if (is_negative || index >= vertices)
        throw std::invalid_argument(
            "triangle " + std::to_string(i) + ": index " +
            (is_negative ? std::to_string(static_cast<std::int32_t>(index)) : std::to_string(index)) +
            " is out of range, the mesh has " + std::to_string(vertices) + " vertices");
    }
  throw std::logic_error("mesh: triangles changed while they were read");
}

template <class View>
void validate(const View& vertices, const IndexView& triangles, int threads) {
  const QuietFloats quiet;
  if ((vertices.first == nullptr && vertices.count > 0) ||
      (triangles.first == nullptr && triangles.count > 0))
    throw std::invalid_argument("mesh: a view of vertices or triangles points to nothing");
  if (!all_are_in_range(triangles, vertices.count, threads)) refuse_triangles(triangles, vertices.count);
  if (!all_are_finite(vertices, threads)) require_finite_corners(vertices, triangles);
}

}  // namespace

void validate_mesh(VertexView vertices, IndexView triangles) {
  validate(vertices, triangles, 1);
}
void validate_mesh(VertexViewD vertices, IndexView triangles) {
  validate(vertices, triangles, 1);
}
void require_valid_mesh(VertexView vertices, IndexView triangles, int threads) {
  validate(vertices, triangles, threads);
}
void require_valid_mesh(VertexViewD vertices, IndexView triangles, int threads) {
  validate(vertices, triangles, threads);
}

}  // namespace raylanes
