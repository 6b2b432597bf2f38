#include "leaves.hpp"

#include "../batch/in_parallel.hpp"
#include "../batch/sort_keys.hpp"
#include "box_of_lanes.hpp"

namespace raylanes {
namespace {

// Half the length of the cross product of two edges.
inline float area_of(const Float3 (&corners)[3]) {
  float ab[3], ac[3];
  for (std::size_t axis = 0; axis < 3; ++axis)
    ab[axis] = corners[1][axis] - corners[0][axis], ac[axis] = corners[2][axis] - corners[0][axis];
  const float x = ab[1] * ac[2] - ab[2] * ac[1], y = ab[2] * ac[0] - ab[0] * ac[2],
              z = ab[0] * ac[1] - ab[1] * ac[0];
  return 0.5f * std::sqrt(x * x + y * y + z * z);
}

// Fetches what leaves behind leaf i will be made of: first the indices, later the vertices. Leaves lie in another order
// than the mesh.
void fetch_ahead(const LeafSource& source, std::span<const LeafRange> ranges,
                 std::span<const std::uint32_t> order, std::size_t i) {
  constexpr std::size_t distance = 5;
  const auto primitives = [&](std::size_t leaf) {
    const LeafRange& range = ranges[std::min(leaf, ranges.size() - 1)];
    return order.subspan(range.begin, range.count);
  };
  for (const std::uint32_t primitive : primitives(i + 2 * distance))
    __builtin_prefetch(source.triangles.address(primitive));
  for (const std::uint32_t primitive : primitives(i + distance))
    for (const std::uint32_t vertex : source.triangles[primitive])
      __builtin_prefetch(source.vertices.address(vertex));
}

// The content of unused lanes. All bits are set, so that OR writes it.
const float unused_lane = std::bit_cast<float>(~0u);

// Four points as a register for each axis. Loads no more than their three floats, which may have any alignment.
struct FourPoints {
  FourFloats axis[3];

  explicit FourPoints(const std::byte* const (&points)[4]) {
    const FourFloats ab = interleave_low(x_y(points[0]), x_y(points[1]));
    const FourFloats cd = interleave_low(x_y(points[2]), x_y(points[3]));
    axis[0] = low_halves(ab, cd);
    axis[1] = high_halves(ab, cd);
    axis[2] =
        low_halves(interleave_low(z(points[0]), z(points[1])), interleave_low(z(points[2]), z(points[3])));
  }

 private:
  static FourFloats x_y(const std::byte* point) { return FourFloats::load_two(point); }
  static FourFloats z(const std::byte* point) { return FourFloats::load_one(point + 2 * sizeof(float)); }
};

}  // namespace

Leaves::Leaves(std::size_t count) : count_(count), lines_(count * lines_per_block) {}

float Leaves::fill(std::size_t index, VertexView vertices, IndexView triangles,
                   std::span<const std::uint32_t> primitives) {
  std::uint32_t names[tree_width];
  std::fill(std::copy(primitives.begin(), primitives.end(), names), names + tree_width, no_primitive);
  float* const numbers = block(index);
  std::fill(numbers, numbers + 9 * tree_width, unused_lane);
  std::memcpy(numbers + 9 * tree_width, names, sizeof names);
  float area = 0.0f;
  for (std::size_t lane = 0; lane < primitives.size(); ++lane) {
    const Index3 triangle = triangles[primitives[lane]];
    const Float3 corners[3] = {vertices[triangle[0]], vertices[triangle[1]], vertices[triangle[2]]};
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t axis = 0; axis < 3; ++axis)
        numbers[(3 * corner + axis) * tree_width + lane] = corners[corner][axis];
    area += area_of(corners);
  }
  return area;
}

std::uint32_t Leaves::strike(std::size_t index, std::uint32_t count, std::uint32_t first, std::uint32_t end) {
  auto& leaf = static_cast<LeafBlock<9>*>(blocks())[index];
  std::uint32_t left = 0;
  for (std::uint32_t lane = 0; lane < count; ++lane) {
    if (leaf.primitive[lane] >= first && leaf.primitive[lane] < end) continue;
    for (auto& row : leaf.number) row[left] = row[lane];
    leaf.primitive[left++] = leaf.primitive[lane];
  }
  for (std::uint32_t lane = left; lane < count; ++lane) {
    for (auto& row : leaf.number) row[lane] = unused_lane;
    leaf.primitive[lane] = no_primitive;
  }
  return left;
}

std::size_t Leaves::primitives(std::size_t index, std::uint32_t (&names)[tree_width]) const {
  std::memcpy(names, block(index) + 9 * tree_width, sizeof names);
  return static_cast<std::size_t>(std::find(names, names + tree_width, no_primitive) - names);
}

Triangle Leaves::triangle(std::uint64_t place) const {
  const std::size_t lane = place & 0xffffffffu;
  const LeafBlock<9>& leaf = static_cast<const LeafBlock<9>*>(blocks())[lane / tree_width];
  Triangle triangle;
  for (std::size_t k = 0; k < 9; ++k) triangle.corner[k / 3][k % 3] = leaf.number[k][lane % tree_width];
  return triangle;
}

std::vector<std::uint64_t> Leaves::places() const {
  static_assert(std::uint64_t{leaf_block_mask} * tree_width <= 0xffffffffu);
  std::vector<std::uint64_t> places;
  places.reserve(tree_width * count_);
  for (std::size_t index = 0; index < count_; ++index) {
    std::uint32_t names[tree_width];
    const std::size_t size = primitives(index, names);
    for (std::size_t lane = 0; lane < size; ++lane)
      places.push_back(std::uint64_t{names[lane]} << 32 | (tree_width * index + lane));
  }
  sort_keys(places);
  const auto is_same = [](std::uint64_t a, std::uint64_t b) { return a >> 32 == b >> 32; };
  places.erase(std::unique(places.begin(), places.end(), is_same), places.end());
  return places;
}

float Leaves::area(std::size_t index) const {
  std::uint32_t names[tree_width];
  const std::size_t size = primitives(index, names);
  float sum = 0.0f;
  for (std::size_t lane = 0; lane < size; ++lane) {
    Float3 corners[3];
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t axis = 0; axis < 3; ++axis)
        corners[corner][axis] = block(index)[(3 * corner + axis) * tree_width + lane];
    sum += area_of(corners);
  }
  return sum;
}

void* Leaves::grow(std::size_t blocks) {
  void* const first = raylanes::grow(lines_, blocks * lines_per_block);
  count_ += blocks;
  return first;
}

Box Leaves::refill(std::size_t index, std::size_t count, const VertexView& vertices,
                   const IndexView& triangles) {
  float* const numbers = block(index);
  std::uint32_t names[tree_width];
  std::memcpy(names, numbers + 9 * tree_width, sizeof names);
  BoxOfLanes box;
  bool has_collapsed = false;
  for (std::size_t first = 0; first < count; first += 4) {
    // Lanes without a triangle take the last one's corners: no branch, which would be guessed wrongly too often.
    const std::byte* points[3][4];  // by corner
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const Index3 triangle = triangles[names[std::min(first + lane, count - 1)]];
      for (std::size_t corner = 0; corner < 3; ++corner)
        points[corner][lane] = vertices.address(triangle[corner]);
    }
    const FourFloats unused = FourFloats::all_bits_from(count - first);
    const FourPoints four[3] = {FourPoints(points[0]), FourPoints(points[1]), FourPoints(points[2])};
    has_collapsed = has_collapsed || any_equal(four[0].axis, four[1].axis) ||
                    any_equal(four[1].axis, four[2].axis) || any_equal(four[2].axis, four[0].axis);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const FourFloats row = four[corner].axis[axis];
        box.extend(axis, row, row);
        (row | unused).store_aligned(numbers + (3 * corner + axis) * tree_width + first);
      }
    }
  }
  if (has_collapsed) [[unlikely]] {
    Box of_others = empty_box;
    LeafLanes<float>{numbers, tree_width}.refill(
        count, vertices, triangles, [&](const Float3& a, const Float3& b, const Float3& c) {
          extend(of_others, a), extend(of_others, b), extend(of_others, c);
        });
    return of_others;
  }
  return box.box();
}

WideNode empty_node() {
  WideNode node{};
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis)
    for (int slot = 0; slot < tree_width; ++slot)
      node.lo[axis][slot] = infinity, node.hi[axis][slot] = -infinity;
  for (TreeReference& child : node.child) child = empty_reference;
  return node;
}

Array<float> TreeLeaves::fill(const LeafSource& source, std::span<const LeafRange> ranges,
                              std::span<const std::uint32_t> order, const BuildRun& run, double share) {
  corners = Leaves(ranges.size());
  run.memory.hold(corners.bytes());
  Array<float> areas(ranges.size());
  constexpr std::size_t grain = 1 << 10;
  in_parallel(ranges.size(), grain, run.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t from = begin; from < end; from += grain) {
      const std::size_t to = std::min(end, from + grain);
      for (std::size_t i = from; i < to; ++i) {
        fetch_ahead(source, ranges, order, i);
        areas[i] = corners.fill(i, source.vertices, source.triangles,
                                order.subspan(ranges[i].begin, ranges[i].count));
      }
      run.progress.advance(share * static_cast<double>(to - from) / static_cast<double>(ranges.size()));
    }
  });
  return areas;
}

}  // namespace raylanes
