// A part in a place: its transform, the inverse, and where it may be hit.
#pragma once

#include <raylanes/scene.hpp>

#include "../../dispatch/table/instances.hpp"

namespace raylanes {

// The place of an instance in its scene: added since the last update(); in the common tree; waiting until enough others
// wait to build that again; apart from it.
enum class Standing : std::uint8_t { added, common, waiting, apart };
// The standing of an instance that has changed.
constexpr Standing left(Standing standing) {
  return standing == Standing::added ? Standing::added : Standing::apart;
}

struct Instance : PlacedTree {
  Transform transform;
  double doubt;  // by which share the inverse may be wrong; negative: nothing is hit, there is no inverse
  Standing standing = Standing::added;

  Instance(std::uint32_t geometry_, const Transform& transform_, std::uint32_t mask_);
};

// The padding of boxes: a share of the largest coordinate of a ray's origin, and a distance.
struct BoxPadding {
  float share = 0.0f, distance = 0.0f;
};
// The bounds of an instance of a part, for rays that are transformed as Scene says. The box contains all hits if it is
// padded by `share` of a ray's origin. Hits may lie outside the part's bounds by `slack` of the origin in the part's
// space. Triangle tests whose numbers are rounded need the padding `rounded` as well. The box is empty if nothing is
// hit.
struct InstanceBounds {
  Box box;
  float share = 0.0f;
  BoxPadding rounded = {};
};
InstanceBounds bounds_of(const Instance& instance, const Box& part, float slack);

}  // namespace raylanes
