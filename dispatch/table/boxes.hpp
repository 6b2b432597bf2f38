// Kernels for boxes in arrays, any number of them, the active ones or all. Contracts: <raylanes/boxes.hpp>;
// kernel_table.hpp has what all kernels have in common.
#pragma once

#include <iterator>

#include <raylanes/boxes.hpp>
#include <raylanes/prepared_ray.hpp>

#include "rows.hpp"

namespace raylanes {

// box: lo and hi.
struct BoxRow {
  void (*any_of_boxes)(const Ray& ray, Soa boxes, std::size_t n, LaneBits active, std::uint8_t* bits);
  void (*any_of_rays)(const RayArrays& rays, const float* box, LaneBits active, std::uint8_t* bits);
  void (*intervals_of_boxes)(const Ray& ray, Soa boxes, std::size_t n, LaneBits active, std::uint8_t* bits,
                             float* entry, float* exit);
  void (*intervals_of_rays)(const RayArrays& rays, const float* box, LaneBits active, std::uint8_t* bits,
                            float* entry, float* exit);
};
struct BoxKernels : Rows<BoxRow, std::size(box_tests)> {
  // For PreparedRay, by the test conservative.
  detail::HitsAmong hits;
};

}  // namespace raylanes
