#include "table/triangles.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include <raylanes/triangles.hpp>

#include "bits.hpp"
#include "quiet_floats.hpp"
#include "selected_row.hpp"
#include "table/kernel_table.hpp"

namespace raylanes {
namespace {

const TriangleRow& row_of(const char* call, const TriangleOptions& options) {
  return selected_row(
      call, options, [](const KernelTable& table) -> const auto& { return table.triangles; });
}

// For options that were checked.
std::size_t floats_of(const TriangleOptions& options) {
  return static_cast<std::size_t>(triangle_tests[static_cast<std::size_t>(options.test)].floats);
}

// The numbers that the test reads of one triangle.
struct PreparedTriangle {
  float number[max_triangle_floats];
  PreparedTriangle(const TriangleRow& row, const TriangleOptions& options, const RayArrays& rays,
                   const Triangle& triangle) {
    Float3 direction{};
    for (std::size_t i = 0; i < rays.size; ++i)
      if (takes_part(options.active, i)) {
        for (std::size_t axis = 0; axis < 3; ++axis) direction[axis] = rays.direction[axis][i];
        break;
      }
    const float* corners[9];
    for (std::size_t k = 0; k < 9; ++k) corners[k] = &triangle.corner[k / 3][k % 3];
    float* out[max_triangle_floats];
    for (std::size_t k = 0; k < max_triangle_floats; ++k) out[k] = number + k;
    row.prepare(corners, 1, nullptr, direction.data(), out);
  }
};

// Room for what the test reads of n triangles.
std::vector<float> room_for(const char* call, const TriangleOptions& options, std::size_t n) {
  std::vector<float> numbers;
  const std::size_t floats = floats_of(options);
  if (n > numbers.max_size() / floats)
    throw std::invalid_argument(std::string(call) + ": " + std::to_string(n) +
                                " triangles do not fit into memory");
  numbers.resize(floats * n);
  return numbers;
}

// Writes the numbers that the test reads of the active ones of some triangles, array after array.
void prepare(const TriangleRow& row, const TriangleArrays& triangles, const TriangleOptions& options,
             const Float3& direction, std::vector<float>& numbers) {
  float* out[max_triangle_floats];
  for (std::size_t k = 0; k < floats_of(options); ++k) out[k] = numbers.data() + k * triangles.size;
  row.prepare(CornerArrays(triangles).array, triangles.size, options.active, direction.data(), out);
}

// One pointer per number of prepared triangles.
struct Pointers {
  const float* array[max_triangle_floats];
  Pointers(const std::vector<float>& numbers, std::size_t size, std::size_t floats) {
    for (std::size_t k = 0; k < floats; ++k) array[k] = numbers.data() + k * size;
  }
};

// The numbers that a call tests if its test does not read corners.
struct PreparedForCall {
  std::vector<float> numbers;
  Pointers pointers;
  PreparedForCall(const char* call, const TriangleRow& row, const TriangleArrays& triangles,
                  const TriangleOptions& options, const Float3& direction)
      : numbers(room_for(call, options, triangles.size)),
        pointers(numbers, triangles.size, floats_of(options)) {
    prepare(row, triangles, options, direction, numbers);
  }
};

}  // namespace

Hit closest_hit(const Ray& ray, const TriangleArrays& triangles, const TriangleOptions& options) {
  const TriangleRow& row = row_of("closest_hit", options);
  require_nameable("closest_hit", triangles.size, "triangles");
  Hit nearest;
  const QuietFloats quiet;
  const auto closest_of = [&](Soa arrays) {
    row.closest_of_triangles(ray, arrays, triangles.size, options.active, nearest);
  };
  if (reads_corners(options.test))
    closest_of(CornerArrays(triangles).array);
  else
    closest_of(PreparedForCall("closest_hit", row, triangles, options, ray.direction).pointers.array);
  return nearest;
}

void hit_mask(const Ray& ray, const TriangleArrays& triangles, std::span<std::uint8_t> bits,
              const TriangleOptions& options) {
  const TriangleRow& row = row_of("hit_mask", options);
  require_bits("hit_mask", bits.size(), triangles.size);
  const QuietFloats quiet;
  const auto any_of = [&](Soa arrays) {
    row.any_of_triangles(ray, arrays, triangles.size, options.active, bits.data());
  };
  if (reads_corners(options.test))
    any_of(CornerArrays(triangles).array);
  else
    any_of(PreparedForCall("hit_mask", row, triangles, options, ray.direction).pointers.array);
}

void closest_hits(const RayArrays& rays, const Triangle& triangle, const TriangleHits& hits,
                  const TriangleOptions& options) {
  const TriangleRow& row = row_of("closest_hits", options);
  require_bits("closest_hits", hits.bits.size(), rays.size);
  require_size("closest_hits", "t", hits.t.size(), "rays", rays.size);
  if (!hits.u.empty()) require_size("closest_hits", "u", hits.u.size(), "rays", rays.size);
  if (!hits.v.empty()) require_size("closest_hits", "v", hits.v.size(), "rays", rays.size);
  const QuietFloats quiet;
  row.closest_of_rays(rays, PreparedTriangle(row, options, rays, triangle).number, options.active,
                      hits.bits.data(), hits.t.data(), hits.u.empty() ? nullptr : hits.u.data(),
                      hits.v.empty() ? nullptr : hits.v.data());
}

void hit_mask(const RayArrays& rays, const Triangle& triangle, std::span<std::uint8_t> bits,
              const TriangleOptions& options) {
  const TriangleRow& row = row_of("hit_mask", options);
  require_bits("hit_mask", bits.size(), rays.size);
  const QuietFloats quiet;
  row.any_of_rays(rays, PreparedTriangle(row, options, rays, triangle).number, options.active, bits.data());
}

Float3 normal_of(const Triangle& triangle) {
  Float3 e1, e2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    e1[axis] = triangle.corner[1][axis] - triangle.corner[0][axis];
    e2[axis] = triangle.corner[2][axis] - triangle.corner[0][axis];
  }
  return {e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2], e1[0] * e2[1] - e1[1] * e2[0]};
}

PreparedTriangles::PreparedTriangles(const TriangleArrays& triangles, const TriangleOptions& options,
                                     const Float3& direction)
    : options_(options), size_(triangles.size) {
  const TriangleRow& row = row_of("PreparedTriangles", options);
  options_.active = nullptr;
  numbers_ = room_for("PreparedTriangles", options_, size_);
  if (options.test == TriangleTest::directional)
    for (const auto& corner : triangles.corner)
      for (const float* array : corner) corners_.insert(corners_.end(), array, array + size_);
  const QuietFloats quiet;
  raylanes::prepare(row, triangles, options_, direction, numbers_);
}

PreparedTriangles::PreparedTriangles(PreparedTriangles&& other) noexcept
    : options_(other.options_),
      size_(std::exchange(other.size_, 0)),
      numbers_(std::move(other.numbers_)),
      corners_(std::move(other.corners_)) {}

PreparedTriangles& PreparedTriangles::operator=(PreparedTriangles other) noexcept {
  options_ = other.options_, size_ = other.size_;
  numbers_.swap(other.numbers_), corners_.swap(other.corners_);
  return *this;
}

void PreparedTriangles::prepare(const Float3& direction) {
  if (options_.test != TriangleTest::directional) return;
  TriangleArrays triangles{};
  triangles.size = size_;
  for (std::size_t k = 0; k < 9; ++k) triangles.corner[k / 3][k % 3] = corners_.data() + k * size_;
  const QuietFloats quiet;
  raylanes::prepare(row_of("PreparedTriangles", options_), triangles, options_, direction, numbers_);
}

Hit closest_hit(const Ray& ray, const PreparedTriangles& triangles, LaneBits active) {
  require_nameable("closest_hit", triangles.size_, "triangles");
  Hit nearest;
  const Pointers numbers(triangles.numbers_, triangles.size_, floats_of(triangles.options_));
  const QuietFloats quiet;
  row_of("closest_hit", triangles.options_)
      .closest_of_triangles(ray, numbers.array, triangles.size_, active, nearest);
  return nearest;
}

void hit_mask(const Ray& ray, const PreparedTriangles& triangles, std::span<std::uint8_t> bits,
              LaneBits active) {
  require_bits("hit_mask", bits.size(), triangles.size_);
  const Pointers numbers(triangles.numbers_, triangles.size_, floats_of(triangles.options_));
  const QuietFloats quiet;
  row_of("hit_mask", triangles.options_)
      .any_of_triangles(ray, numbers.array, triangles.size_, active, bits.data());
}

}  // namespace raylanes
