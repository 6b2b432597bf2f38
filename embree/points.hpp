// Spheres and discs.
#pragma once

#include "geometry.hpp"

namespace embree {

// The hits of a point in [tnear, tfar], in order: up to two of a sphere, one of a disc.
struct PointHits {
  struct {
    float t, normal[3];
  } hit[2];
  int count = 0;
};
PointHits hits_of_point(const Geometry& geometry, std::uint32_t primitive, const RTCRay& ray);

}  // namespace embree
