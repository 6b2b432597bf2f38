#include "leaves.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include <raylanes/paths.hpp>

#include "../../dispatch/table.hpp"

namespace raylanes {
namespace {

constexpr std::size_t floats_per_line = 16;

std::size_t floats_of(TriangleTest test) {
  return static_cast<std::size_t>(triangle_tests[static_cast<std::size_t>(test)].floats);
}

// Numbers and primitives in rows of eight, rounded up as LeafBlock is.
constexpr std::size_t lines_for(std::size_t floats) {
  return ((floats + 1) * tree_width + floats_per_line - 1) / floats_per_line;
}
static_assert(lines_for(9) * 64 == sizeof(LeafBlock<9>) && lines_for(12) * 64 == sizeof(LeafBlock<12>) &&
              lines_for(13) * 64 == sizeof(LeafBlock<13>));

// The corners of a few triangles as arrays.
struct Corners {
  float number[9][tree_width];
  const float* arrays[9];

  Corners(VertexView vertices, IndexView triangles, std::span<const std::uint32_t> primitives) {
    for (std::size_t lane = 0; lane < primitives.size(); ++lane)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const Float3 vertex = vertices[triangles[primitives[lane]][corner]];
        for (std::size_t axis = 0; axis < 3; ++axis) number[3 * corner + axis][lane] = vertex[axis];
      }
    for (std::size_t k = 0; k < 9; ++k) arrays[k] = number[k];
  }
};

}  // namespace

Leaves::Leaves(TriangleTest test, const Float3& direction, std::size_t count)
    : test_(test),
      direction_(direction),
      count_(count),
      lines_per_block_(lines_for(floats_of(test))),
      lines_(count * lines_per_block_) {}

void Leaves::fill(std::size_t index, VertexView vertices, IndexView triangles,
                  std::span<const std::uint32_t> primitives) {
  const std::size_t floats = floats_of(test_);
  float* const block = lines_[index * lines_per_block_].number;
  std::fill(block, block + floats * tree_width, std::numeric_limits<float>::quiet_NaN());
  float* rows[most_triangle_floats];
  for (std::size_t k = 0; k < floats; ++k) rows[k] = block + k * tree_width;
  const Corners corners(vertices, triangles, primitives);
  const auto& tests = active_path().kernels.triangles;
  tests.row[static_cast<std::size_t>(test_)][static_cast<std::size_t>(Grade::reproducible)].prepare(
      corners.arrays, primitives.size(), direction_.data(), rows);
  std::uint32_t numbers[tree_width];
  std::fill(std::copy(primitives.begin(), primitives.end(), numbers), numbers + tree_width, no_primitive);
  std::memcpy(block + floats * tree_width, numbers, sizeof numbers);
  std::fill(block + (floats + 1) * tree_width, block + lines_per_block_ * floats_per_line, 0.0f);
}

}  // namespace raylanes
