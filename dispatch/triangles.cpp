#include <limits>
#include <stdexcept>
#include <string>

#include <raylanes/triangles.hpp>

#include "chosen_row.hpp"

namespace raylanes {
namespace {

const TriangleRow& row_of(const char* call, const TriangleOptions& options) {
  return chosen_row(
      call, options, [](const KernelTable& table) -> const auto& { return table.triangles; });
}

// Of options that were checked.
std::size_t floats_of(const TriangleOptions& options) {
  return static_cast<std::size_t>(triangle_tests[static_cast<std::size_t>(options.test)].floats);
}

struct Corners {
  const float* array[9];
  explicit Corners(const TriangleArrays& triangles) {
    for (std::size_t k = 0; k < 9; ++k) array[k] = triangles.corner[k / 3][k % 3];
  }
};

// The numbers that the test reads of one triangle.
struct PreparedTriangle {
  float number[most_triangle_floats];
  PreparedTriangle(const TriangleRow& row, const TriangleOptions& options, const RayArrays& rays,
                   const Triangle& triangle) {
    Float3 direction{};
    for (std::size_t i = 0; i < rays.size; ++i)
      if (options.active == nullptr || (options.active[i / 8] >> i % 8 & 1u) != 0) {
        for (std::size_t axis = 0; axis < 3; ++axis) direction[axis] = rays.direction[axis][i];
        break;
      }
    const float* corners[9];
    for (std::size_t k = 0; k < 9; ++k) corners[k] = &triangle.corner[k / 3][k % 3];
    float* out[most_triangle_floats];
    for (std::size_t k = 0; k < most_triangle_floats; ++k) out[k] = number + k;
    row.prepare(corners, 1, direction.data(), out);
  }
};

// One pointer per number of prepared triangles.
struct Pointers {
  const float* array[most_triangle_floats];
  Pointers(const std::vector<float>& numbers, std::size_t size, std::size_t floats) {
    for (std::size_t k = 0; k < floats; ++k) array[k] = numbers.data() + k * size;
  }
};

}  // namespace

Hit closest_hit(const Ray& ray, const TriangleArrays& triangles, const TriangleOptions& options) {
  const TriangleRow& row = row_of("closest_hit", options);
  require_nameable(triangles.size, "triangles");
  if (!reads_corners(options.test))
    return closest_hit(ray, PreparedTriangles(triangles, options, ray.direction), options.active);
  Hit nearest;
  row.closest_of_triangles(ray, Corners(triangles).array, triangles.size, options.active, nearest);
  return nearest;
}

void any_hits(const Ray& ray, const TriangleArrays& triangles, std::span<std::uint8_t> bits,
              const TriangleOptions& options) {
  const TriangleRow& row = row_of("any_hits", options);
  require_bits("any_hits", bits.size(), triangles.size);
  if (!reads_corners(options.test))
    return any_hits(ray, PreparedTriangles(triangles, options, ray.direction), bits, options.active);
  row.any_of_triangles(ray, Corners(triangles).array, triangles.size, options.active, bits.data());
}

void closest_hits(const RayArrays& rays, const Triangle& triangle, const TriangleHits& hits,
                  const TriangleOptions& options) {
  const TriangleRow& row = row_of("closest_hits", options);
  require_bits("closest_hits", hits.bits.size(), rays.size);
  require_size("closest_hits", "t", hits.t.size(), "rays", rays.size);
  if (!hits.u.empty()) require_size("closest_hits", "u", hits.u.size(), "rays", rays.size);
  if (!hits.v.empty()) require_size("closest_hits", "v", hits.v.size(), "rays", rays.size);
  row.closest_of_rays(rays, PreparedTriangle(row, options, rays, triangle).number, options.active,
                      hits.bits.data(), hits.t.data(), hits.u.empty() ? nullptr : hits.u.data(),
                      hits.v.empty() ? nullptr : hits.v.data());
}

void any_hits(const RayArrays& rays, const Triangle& triangle, std::span<std::uint8_t> bits,
              const TriangleOptions& options) {
  const TriangleRow& row = row_of("any_hits", options);
  require_bits("any_hits", bits.size(), rays.size);
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
  row_of("PreparedTriangles", options);
  options_.active = nullptr;
  const std::size_t floats = floats_of(options);
  if (size_ > std::numeric_limits<std::size_t>::max() / sizeof(float) / floats)
    throw std::invalid_argument("PreparedTriangles: " + std::to_string(size_) +
                                " triangles do not fit into memory");
  numbers_.resize(floats * size_);
  if (options.test == TriangleTest::directional)
    for (const auto& corner : triangles.corner)
      for (const float* array : corner) corners_.insert(corners_.end(), array, array + size_);
  fill(triangles, direction);
}

void PreparedTriangles::prepare(const Float3& direction) {
  if (options_.test != TriangleTest::directional) return;
  TriangleArrays triangles{};
  triangles.size = size_;
  for (std::size_t k = 0; k < 9; ++k) triangles.corner[k / 3][k % 3] = corners_.data() + k * size_;
  fill(triangles, direction);
}

void PreparedTriangles::fill(const TriangleArrays& triangles, const Float3& direction) {
  float* out[most_triangle_floats];
  for (std::size_t k = 0; k < floats_of(options_); ++k) out[k] = numbers_.data() + k * size_;
  row_of("PreparedTriangles", options_).prepare(Corners(triangles).array, size_, direction.data(), out);
}

Hit closest_hit(const Ray& ray, const PreparedTriangles& triangles, LaneBits active) {
  require_nameable(triangles.size_, "triangles");
  Hit nearest;
  const Pointers numbers(triangles.numbers_, triangles.size_, floats_of(triangles.options_));
  row_of("closest_hit", triangles.options_)
      .closest_of_triangles(ray, numbers.array, triangles.size_, active, nearest);
  return nearest;
}

void any_hits(const Ray& ray, const PreparedTriangles& triangles, std::span<std::uint8_t> bits,
              LaneBits active) {
  require_bits("any_hits", bits.size(), triangles.size_);
  const Pointers numbers(triangles.numbers_, triangles.size_, floats_of(triangles.options_));
  row_of("any_hits", triangles.options_)
      .any_of_triangles(ray, numbers.array, triangles.size_, active, bits.data());
}

}  // namespace raylanes
