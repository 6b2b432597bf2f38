// Which triangles count: all, or those that a caller chooses. The sign of the determinant is that of its three weights,
// so that the screen of one side asks for weights of one sign: what floats are certain of is of that side, too.
#pragma once

#include <bit>

#include "../../dispatch/table/traversal.hpp"
#include "../simd/vocabulary.hpp"
#include "predicate.hpp"

namespace raylanes {
namespace {

// The sign of d · (v1 − v0) × (v2 − v0), exactly: negative where the ray comes to the front.
template <class Triangles, class AnyRay>
[[gnu::noinline]] int side_of(const Triangles& triangles, const AnyRay& ray, std::uint32_t leaf_triangle) {
  using T = typename decltype(ray.direction)::value_type;
  T corners[9];
  for (int k = 0; k < 9; ++k) corners[k] = triangles.number(k, leaf_triangle);
  const T direction[3] = {ray.direction[0], ray.direction[1], ray.direction[2]};
  return detail::side_exactly(direction, corners);
}

// Whether a side is admitted: -1 is the front, 1 the back.
inline bool admits(Facing facing, int side) {
  return facing == Facing::any || (facing == Facing::front) == (side < 0);
}
// Leaves the lanes whose side counts; the lanes of `front` come to the front.
inline std::uint32_t admitted_lanes(Facing facing, std::uint32_t lanes, std::uint32_t front) {
  return facing == Facing::any ? lanes : lanes & (facing == Facing::front ? front : ~front);
}

// The primitive that ray i of a batch skips.
template <class Batch>
inline std::uint32_t skipped_by(const Batch& batch, std::size_t i) {
  return batch.skip != nullptr ? batch.skip[i] : no_primitive;
}
// Leaves the lanes of triangles that the masks see, but for the skipped one; they begin with `first`.
// no_primitive: none is skipped. Out of line, as it would be much code.
template <class Triangles>
[[gnu::noinline]] std::uint32_t lanes_left(std::uint32_t skipped, std::uint32_t lanes,
                                           const Triangles& triangles, std::uint32_t first) {
  const TriangleMasks& masks = triangles.masks();
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    const std::uint32_t primitive = triangles.primitive(first + static_cast<std::uint32_t>(lane));
    if (primitive == skipped || !masks.see(primitive)) lanes &= ~(1u << lane);
  }
  return lanes;
}
template <class Triangles>
inline std::uint32_t lanes_but(std::uint32_t skipped, std::uint32_t lanes, const Triangles& triangles,
                               std::uint32_t first) {
  if (skipped == no_primitive && triangles.masks().see_all()) return lanes;
  return lanes_left(skipped, lanes, triangles, first);
}

struct NoRule {
  static constexpr bool chooses = false;
  static constexpr Facing facing = Facing::any;
  NoRule() = default;
  template <class Batch>
  explicit NoRule(const Batch&, std::size_t = 0) {}

  template <class Triangles>
  static std::uint32_t admitted(std::uint32_t lanes, const Triangles&, std::uint32_t) {
    return lanes;
  }

  // By how much weights have a sign that means a miss: beyond the bound of their errors it is certain.
  // mirrored: whether positive weights mean the back.
  template <class Edges>
  static auto outside_by(const Edges& edges, bool = false) {
    return edges.outside_by();
  }
  // The sign by which weights are positive in a triangle that is hit, from that of the determinant d · normal.
  template <class Sign>
  static Sign of_weights(Sign of_det) {
    return of_det;
  }
  template <class AnyHit, class Triangles, class AnyRay>
  static const AnyHit& admitted_hit(const AnyHit& hit, const Triangles&, const AnyRay&, std::uint32_t) {
    return hit;
  }
};

// Triangles of one side, or both, that the masks see, but for the one that the ray skips.
struct HitRule {
  static constexpr bool chooses = true;
  Facing facing;
  std::uint32_t skipped = no_primitive;

  // For all rays of a batch, which skip nothing yet; for one.
  explicit HitRule(const TraceBatch& batch) : facing(batch.facing) {}
  HitRule(Facing side, std::uint32_t primitive) : facing(side), skipped(primitive) {}
  template <class T>
  HitRule(const TraceBatchOf<T>& batch, std::size_t ray)
      : facing(batch.facing), skipped(skipped_by(batch, ray)) {}
  bool is_front() const { return facing == Facing::front; }

  // Lanes of triangles that begin with `first`.
  template <class Triangles>
  std::uint32_t admitted(std::uint32_t lanes, const Triangles& triangles, std::uint32_t first) const {
    return lanes_but(skipped, lanes, triangles, first);
  }

  template <class Edges>
  auto outside_by(const Edges& edges, bool mirrored = false) const {
    if (facing == Facing::any) return edges.outside_by();
    return is_front() != mirrored ? -edges.least : edges.largest;
  }
  template <class Sign>
  Sign of_weights(Sign of_det) const {
    if (facing == Facing::any) return of_det;
    using Word = typename NumberOf<Sign>::type;
    return Sign(is_front() ? ~(~Word{0} >> 1) : Word{0});
  }
  // For a triangle that is not skipped.
  template <class AnyHit, class Triangles, class AnyRay>
  AnyHit admitted_hit(const AnyHit& hit, const Triangles& triangles, const AnyRay& ray,
                      std::uint32_t leaf_triangle) const {
    if (!hit || facing == Facing::any) return hit;
    return admits(facing, side_of(triangles, ray, leaf_triangle)) ? hit : AnyHit();
  }
};

// Whether a hit comes after another one; null: after none.
template <class AnyHit>
inline bool is_after(const AnyHit& hit, const AnyHit* after) {
  return after == nullptr || hit.t > after->t || (hit.t == after->t && hit.primitive > after->primitive);
}

// The rule by which only hits after one count, of triangles that the caller chooses.
template <class AnyHit>
struct HitsAfter {
  const AnyHit& after;
  Facing facing;
  std::uint32_t skipped = no_primitive;

  // Lanes that floats are certain of, by their determinants; triangles begin with `first`.
  template <class V, class Triangles>
  std::uint32_t admitted(std::uint32_t lanes, V det, const Triangles& triangles, std::uint32_t first) const {
    return lanes_but(skipped, admitted_lanes(facing, lanes, bits(det > V(0.0f))), triangles, first);
  }

  template <class Triangles, class AnyRay>
  AnyHit admitted_hit(const AnyHit& hit, const Triangles& triangles, const AnyRay& ray,
                      std::uint32_t leaf_triangle) const {
    if (!hit || !is_after(hit, &after) || hit.primitive == skipped || !triangles.masks().see(hit.primitive))
      return {};
    return facing == Facing::any || admits(facing, side_of(triangles, ray, leaf_triangle)) ? hit : AnyHit();
  }
};

}  // namespace
}  // namespace raylanes
