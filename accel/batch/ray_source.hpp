// A batch of rays in any form, and where its answers go.
#pragma once

#include <cstdint>
#include <span>

#include <raylanes/mesh.hpp>
#include <raylanes/rays.hpp>

#include "../../dispatch/bits.hpp"

namespace raylanes {

// Rays from one point to others.
struct Segments {
  Float3 from;
  VertexView points;
  SegmentEnds ends;

  Ray operator[](std::size_t i) const {
    Ray ray{from, ends.start, points[i], ends.end};
    for (std::size_t axis = 0; axis < 3; ++axis) ray.direction[axis] -= from[axis];
    return ray;
  }
};

// Rays as records, or as an array for each number, or between points.
struct RaySource {
  RayView records = {};
  const RayArrays* arrays = nullptr;
  const Segments* segments = nullptr;
  LaneBits active = nullptr;

  std::size_t size() const {
    return arrays != nullptr ? arrays->size : segments != nullptr ? segments->points.count : records.count;
  }
  bool takes_part(std::size_t i) const { return raylanes::takes_part(active, i); }
  Ray operator[](std::size_t i) const {
    if (segments != nullptr) return (*segments)[i];
    if (arrays == nullptr) return records[i];
    return {{arrays->origin[0][i], arrays->origin[1][i], arrays->origin[2][i]},
            arrays->tmin[i],
            {arrays->direction[0][i], arrays->direction[1][i], arrays->direction[2][i]},
            arrays->tmax[i]};
  }
  // The rays where they lie, if kernels can read them there.
  const Ray* in_place() const {
    const bool is_plain = arrays == nullptr && segments == nullptr && active == nullptr &&
                          records.stride == sizeof(Ray) &&
                          reinterpret_cast<std::uintptr_t>(records.first) % alignof(Ray) == 0;
    return is_plain ? static_cast<const Ray*>(records.first) : nullptr;
  }
};

// Where hits go.
struct HitSink {
  HitView hits;
  using Answer = Hit;

  Hit* in_place() const {
    const bool is_plain =
        hits.stride == sizeof(Hit) && reinterpret_cast<std::uintptr_t>(hits.first) % alignof(Hit) == 0;
    return is_plain ? static_cast<Hit*>(hits.first) : nullptr;
  }
  void set(std::size_t i, const Hit& hit) const { hits.set(i, hit); }
};
// Where yes or no goes.
struct OcclusionSink {
  std::span<std::uint8_t> occluded;
  using Answer = std::uint8_t;

  std::uint8_t* in_place() const { return occluded.data(); }
  void set(std::size_t i, std::uint8_t answer) const { occluded[i] = answer; }
};

}  // namespace raylanes
