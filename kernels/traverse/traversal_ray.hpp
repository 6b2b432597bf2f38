// What a ray needs to walk a tree: the padded slabs, the shear, and the tie rule.
#pragma once

#include <limits>

#include "../../dispatch/table.hpp"
#include "../box/slabs.hpp"
#include "../triangle/ray_triangle.hpp"

namespace raylanes {
namespace {

inline constexpr float infinity = std::numeric_limits<float>::infinity();

// How far, as a share of the largest |bound − origin|, a node's slabs are widened in space.
// The canonical test moves a corner by at most 6u·D sideways (three subtractions and two products of terms
// up to D, u = 2^-24) and rounds t by at most 8u·t; the slab distance itself rounds by 3u·t. All are
// below 20u·D once multiplied out; 48u leaves room for weights of slivers. So no box is skipped that holds
// a triangle whose hit counts, and results do not depend on the tree.
inline constexpr float slab_pad = 48.0f / 16777216.0f;

// The largest distance along an axis between the ray's origin and the tree's bounds.
inline float reach(const Ray& ray, const TreeView& tree) {
  float largest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float below = ray.origin[axis] - tree.lo[axis], above = tree.hi[axis] - ray.origin[axis];
    largest = below > largest ? below : largest;
    largest = above > largest ? above : largest;
  }
  return largest;
}

// How far to move the coordinate x so that it moves by `pad` at least: an ULP of x more than pad, which would
// otherwise be lost where x is large.
inline float padding_at(float x, float pad) {
  const float magnitude = x < 0.0f ? -x : x;
  return pad + magnitude * 2.0f * std::numeric_limits<float>::epsilon();
}

inline bool is_finite(float x) {
  return x - x == 0.0f;
}

inline bool is_traceable(const Ray& ray) {
  bool finite = true, moves = false;
  for (int axis = 0; axis < 3; ++axis) {
    finite = finite && is_finite(ray.origin[axis]) && is_finite(ray.direction[axis]);
    moves = moves || ray.direction[axis] != 0.0f;
  }
  return finite && moves && ray.tmin <= ray.tmax;
}

// The largest t that counts: at an infinite distance there is no hit, whatever tmax says.
inline float last_t(const Ray& ray) {
  constexpr float largest = std::numeric_limits<float>::max();
  return ray.tmax < largest ? ray.tmax : largest;
}

// One ray's constants for the padded slab test, per axis; `negative` by the sign bit, so −0 counts.
// The reciprocal of a component below 2^-128 in size is infinite, as that of zero, but the ray may yet enter or
// leave the slab, in its own time: NaN for a reciprocal clips nothing.
struct PaddedSlab {
  float near_origin[3];
  float far_origin[3];
  float inverse[3];
  bool negative[3];
};

inline float reciprocal_or_nan(float x) {
  const float inverse = 1.0f / x;
  return x != 0.0f && !is_finite(inverse) ? std::numeric_limits<float>::quiet_NaN() : inverse;
}

inline PaddedSlab padded_slab(const Ray& ray, const TreeView& tree) {
  PaddedSlab s;
  const float pad = slab_pad * reach(ray, tree);
  for (int axis = 0; axis < 3; ++axis) {
    s.inverse[axis] = reciprocal_or_nan(ray.direction[axis]);
    s.negative[axis] = __builtin_signbit(ray.direction[axis]) != 0;
    const float by = padding_at(ray.origin[axis], pad);
    const float forward = s.negative[axis] ? -by : by;
    s.near_origin[axis] = ray.origin[axis] + forward;
    s.far_origin[axis] = ray.origin[axis] - forward;
  }
  return s;
}

// Nearer wins; of equal t the smaller primitive.
inline bool is_better(float t, std::uint32_t primitive, float best_t, std::uint32_t best_primitive) {
  return t < best_t || (t == best_t && primitive < best_primitive);
}

inline Hit miss() {
  return {infinity, 0.0f, 0.0f, no_primitive};
}

}  // namespace
}  // namespace raylanes
