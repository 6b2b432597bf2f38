// Which sides of triangles count: both, or one. The sign of the determinant is that of its three weights, so that the
// filter of one side asks for weights of one sign: what floats are certain of is of that side, too.
#pragma once

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

// Whether a side counts: -1 is the front, 1 the back.
inline bool counts(Facing facing, int side) {
  return facing == Facing::any || (facing == Facing::front) == (side < 0);
}
// Leaves the lanes whose side counts; the lanes of `front` come to the front.
inline std::uint32_t lanes_that_count(Facing facing, std::uint32_t lanes, std::uint32_t front) {
  return facing == Facing::any ? lanes : lanes & (facing == Facing::front ? front : ~front);
}

struct BothSides {
  static constexpr bool is_one = false;
  static constexpr Facing facing = Facing::any;
  BothSides() = default;
  template <class Batch>
  explicit BothSides(const Batch&) {}

  // Whether weights with errors of at most `within` certainly mean a miss. mirrored: whether positive weights mean the
  // back.
  template <class Edges, class V>
  static auto outside(const Edges& edges, V within, bool = false) {
    return edges.certainly_outside(within);
  }
  // The sign by which weights are positive in a triangle that is hit, from that of the determinant d · normal.
  template <class Sign>
  static Sign of_weights(Sign of_det) {
    return of_det;
  }
  template <class AnyHit, class Triangles, class AnyRay>
  static const AnyHit& counted(const AnyHit& hit, const Triangles&, const AnyRay&, std::uint32_t) {
    return hit;
  }
};

struct OneSide {
  static constexpr bool is_one = true;
  Facing facing;

  explicit OneSide(const TraceBatch& batch) : facing(batch.facing) {}
  bool is_front() const { return facing == Facing::front; }

  template <class Edges, class V>
  auto outside(const Edges& edges, V within, bool mirrored = false) const {
    return (is_front() != mirrored ? -edges.least : edges.largest) > within;
  }
  template <class Sign>
  Sign of_weights(Sign) const {
    return Sign(is_front() ? 0x80000000u : 0u);
  }
  template <class Triangles>
  Hit counted(const Hit& hit, const Triangles& triangles, const Ray& ray, std::uint32_t leaf_triangle) const {
    return hit && counts(facing, side_of(triangles, ray, leaf_triangle)) ? hit : Hit();
  }
};

// The rule by which only hits behind one count, of some sides.
template <class AnyHit>
struct HitsBehind {
  const AnyHit& last;
  Facing facing;

  template <class Triangles, class AnyRay>
  AnyHit counted(const AnyHit& hit, const Triangles& triangles, const AnyRay& ray,
                 std::uint32_t leaf_triangle) const {
    const bool is_behind = hit.t > last.t || (hit.t == last.t && hit.primitive > last.primitive);
    if (!hit || !is_behind) return {};
    return facing == Facing::any || counts(facing, side_of(triangles, ray, leaf_triangle)) ? hit : AnyHit();
  }
};

}  // namespace
}  // namespace raylanes
