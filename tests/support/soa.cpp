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

namespace {

// kernel(rays, n, shape, out) for each shape.
template <class HitColumns, class Result, class Kernel, class Shape>
std::vector<Result> for_each_shape(Kernel kernel, std::span<const Ray> rays, std::span<const Shape> shapes,
                                   Place place) {
  RayColumns columns(rays, place);
  HitColumns out(rays.size(), place);
  std::vector<Result> results;
  for (const Shape& shape : shapes) {
    kernel(columns.arrays(), rays.size(), shape, out.arrays());
    for (std::size_t i = 0; i < rays.size(); ++i) results.push_back(out[i]);
  }
  EXPECT_TRUE(out.are_intact()) << "written outside the outputs of " << rays.size() << " rays";
  return results;
}

// kernel(ray, shapes, n, out) for each ray, transposed.
template <class HitColumns, class Result, class Kernel, class Columns>
std::vector<Result> for_each_ray(Kernel kernel, std::span<const Ray> rays, Columns& shapes, Place place) {
  HitColumns out(shapes.size(), place);
  std::vector<Result> results(rays.size() * shapes.size());
  for (std::size_t r = 0; r < rays.size(); ++r) {
    kernel(rays[r], shapes.arrays(), shapes.size(), out.arrays());
    for (std::size_t s = 0; s < shapes.size(); ++s) results[s * rays.size() + r] = out[s];
  }
  EXPECT_TRUE(out.are_intact()) << "written outside the outputs of " << shapes.size() << " shapes";
  return results;
}

}  // namespace

std::vector<BoxResult> many_rays(const BoxKernels& kernels, std::span<const Ray> rays,
                                 std::span<const Box> boxes, Place place) {
  return for_each_shape<BoxHitColumns, BoxResult>(kernels.rays_box, rays, boxes, place);
}

std::vector<BoxResult> many_boxes(const BoxKernels& kernels, std::span<const Ray> rays,
                                  std::span<const Box> boxes, Place place) {
  BoxColumns columns(boxes, place);
  return for_each_ray<BoxHitColumns, BoxResult>(kernels.ray_boxes, rays, columns, place);
}

}  // namespace raylanes::testing
