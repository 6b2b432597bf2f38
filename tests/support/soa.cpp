#include "soa.hpp"

#include <gtest/gtest.h>

namespace raylanes::testing {

FloatColumns::FloatColumns(std::size_t columns, std::size_t rows, Place place) {
  for (std::size_t i = 0; i < columns; ++i) columns_.emplace_back(rows, place);
}

bool FloatColumns::are_intact() {
  bool intact = true;
  for (GuardedArray<float>& column : columns_) intact = column.is_intact() && intact;
  return intact;
}

RayColumns::RayColumns(std::span<const Ray> rays, Place place)
    : size_(rays.size()), columns_(8, rays.size(), place) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns_[axis][i] = rays[i].origin[axis];
      columns_[3 + axis][i] = rays[i].direction[axis];
    }
    columns_[6][i] = rays[i].tmin;
    columns_[7][i] = rays[i].tmax;
  }
}

RayArrays RayColumns::arrays() {
  return {{columns_[0], columns_[1], columns_[2]},
          {columns_[3], columns_[4], columns_[5]},
          columns_[6],
          columns_[7],
          size_};
}

TriangleColumns::TriangleColumns(std::span<const Triangle> triangles, Place place)
    : size_(triangles.size()), columns_(9, triangles.size(), place) {
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t axis = 0; axis < 3; ++axis)
        columns_[3 * corner + axis][i] = triangles[i].corner[corner][axis];
}

TriangleArrays TriangleColumns::arrays() {
  TriangleArrays all;
  all.size = size_;
  for (std::size_t corner = 0; corner < 3; ++corner)
    for (std::size_t axis = 0; axis < 3; ++axis) all.corner[corner][axis] = columns_[3 * corner + axis];
  return all;
}

BoxColumns::BoxColumns(std::span<const Box> boxes, Place place)
    : size_(boxes.size()), columns_(6, boxes.size(), place) {
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns_[axis][i] = boxes[i].lo[axis];
      columns_[3 + axis][i] = boxes[i].hi[axis];
    }
}

BoxArrays BoxColumns::arrays() {
  return {{columns_[0], columns_[1], columns_[2]}, {columns_[3], columns_[4], columns_[5]}, size_};
}

bool IntervalColumns::are_intact() {
  IntervalColumns untouched(rows_);
  bool intact = floats_.are_intact() && bits_.is_intact();
  for (std::size_t i = rows_; i < 8 * bits_.size(); ++i) intact = intact && is_hit(i) == untouched.is_hit(i);
  return intact;
}

}  // namespace raylanes::testing
