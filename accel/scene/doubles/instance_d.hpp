// A part of doubles in a place: its transform, the inverse in pairs of doubles, and where it may be hit.
#pragma once

#include <raylanes/scene_d.hpp>

#include "../instance.hpp"

namespace raylanes {

// The inverse of a matrix, as unevaluated sums of two doubles.
struct InverseD {
  double high[3][3] = {}, low[3][3] = {};
  double wrong = 0;     // what a row may be wrong by, summed
  bool exists = false;  // else nothing is hit

  InverseD() = default;
  explicit InverseD(const TransformD& transform);
};

struct InstanceD {
  TransformD transform;
  InverseD inverse;
  std::uint32_t geometry, mask;
  std::uint32_t placer = no_part;  // as in Instance
  bool is_identity;
  Standing standing = Standing::added;  // or apart: it is in no common tree

  InstanceD(std::uint32_t geometry_, const TransformD& transform_, std::uint32_t mask_);
};

// A point of the scene, and a ray, in the space of an instance, as SceneD says.
Double3 in_part(const InstanceD& instance, const Double3& point);
RayD in_part(const InstanceD& instance, const RayD& ray);
// A point of a part in the scene.
Double3 in_scene(const InstanceD& instance, const Double3& point);

// The bounds of an instance of a part: hits lie within the box, padded by `share` of the largest coordinate of a ray's
// origin. The box is empty if nothing is hit.
struct InstanceBoundsD {
  BoxD box;
  double share = 0;
};
InstanceBoundsD bounds_of(const InstanceD& instance, const BoxD& part);

// As SceneD::place() says.
TransformD composed(const TransformD& outer, const TransformD& inner);

}  // namespace raylanes
