// A part in a place: its transform, the inverse, and where it may be hit.
#pragma once

#include <raylanes/scene.hpp>

namespace raylanes {

struct Instance {
  std::uint32_t geometry;
  std::uint32_t mask;
  Transform transform;
  double inverse[12];  // rows of four: to the part's space
  double doubt;  // by which share the inverse may be wrong; negative: nothing is hit, there is no inverse
  bool is_identity;

  Instance(std::uint32_t geometry_, const Transform& transform_, std::uint32_t mask_);
};

// Around all that is hit in an instance of a part with these bounds, by rays that are transformed as Scene says, when
// besides it is padded by a share of a ray's origin, at least `share`, and if its hits may be out of its bounds by
// `slack` of the origin in its own space. Empty where nothing is hit.
struct InstanceBounds {
  Box box;
  float share;
};
InstanceBounds bounds_of(const Instance& instance, const Box& part, float slack);

}  // namespace raylanes
