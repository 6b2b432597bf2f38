// A batch of rays of doubles.
#pragma once

#include "../batch/ray_source.hpp"
#include "double_tree.hpp"

namespace raylanes {

// Rays from one point to others.
struct DoubleSegments {
  Double3 from;
  VertexViewD points;
  SegmentEnds ends;

  RayD operator[](std::size_t i) const {
    RayD ray{from, static_cast<double>(ends.start), points[i], static_cast<double>(ends.end)};
    for (std::size_t axis = 0; axis < 3; ++axis) ray.direction[axis] -= from[axis];
    return ray;
  }
};

// Rays as records, or between points.
struct DoubleSource {
  using Ray = RayD;
  RayViewD records = {};
  const DoubleSegments* segments = nullptr;
  LaneBits active = nullptr;

  std::size_t size() const { return segments != nullptr ? segments->points.count : records.count; }
  bool takes_part(std::size_t i) const { return raylanes::takes_part(active, i); }
  RayD operator[](std::size_t i) const { return segments != nullptr ? (*segments)[i] : records[i]; }
  const RayD* in_place() const {
    const bool is_plain = segments == nullptr && active == nullptr && records.stride == sizeof(RayD) &&
                          reinterpret_cast<std::uintptr_t>(records.first) % alignof(RayD) == 0;
    return is_plain ? static_cast<const RayD*>(records.first) : nullptr;
  }
};

inline const DoubleTreeView no_double_tree{
    {nullptr, nullptr, empty_reference, empty_box}, nullptr, {}, empty_double_box};

}  // namespace raylanes
