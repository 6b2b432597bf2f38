// One ray through a built scene.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "scene.hpp"

namespace embree {

// Both return whether there is a hit. Sets ray.tfar and the hit if there is one; leaves both otherwise.
bool trace_closest(const Built& built, RTCIntersectContext* context, RTCRayHit& ray);
// May leave ray.tfar changed if there is a hit.
bool trace_occluded(const Built& built, RTCIntersectContext* context, RTCRay& ray);

// Embree's rays are open at tnear in fast scenes, and closed in robust ones; ours are closed at tmin. Callers may let
// the processor take subnormals for zeros, so the number after 0 is the least normal one.
[[gnu::always_inline]] inline float tmin_of(float tnear, bool is_robust) {
  if (is_robust) return tnear;
  if (tnear == 0) return std::numeric_limits<float>::min();
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(tnear) + (tnear > 0 ? 1u : ~0u));
}
[[gnu::always_inline]] inline raylanes::Ray ray_of(const RTCRay& r, bool is_robust) {
  return {{r.org_x, r.org_y, r.org_z}, tmin_of(r.tnear, is_robust), {r.dir_x, r.dir_y, r.dir_z}, r.tfar};
}

// Writes what a hit of a triangle is in Embree's terms.
[[gnu::always_inline]] inline void put_face(const Built& built, std::uint32_t primitive, float u, float v,
                                            unsigned instance, RTCHit& hit) {
  const Face& face = built.faces[primitive];
  if (face.half == Face::Half::second) u = 1 - u, v = 1 - v;
  if (face.width != 0) {
    u = (static_cast<float>(face.x) + u) / static_cast<float>(face.width);
    v = (static_cast<float>(face.y) + v) / static_cast<float>(face.height);
  }
  hit.Ng_x = face.normal[0], hit.Ng_y = face.normal[1], hit.Ng_z = face.normal[2];
  hit.u = u, hit.v = v;
  hit.primID = face.primitive, hit.geomID = built.parts[face.part].id, hit.instID[0] = instance;
}

// Writes a hit of one of the triangles and instances in built.placed. `own_instance` is of the meshes.
[[gnu::always_inline]] inline void put_placed(const Built& built, const raylanes::SceneHit& found,
                                              unsigned own_instance, RTCHit& hit) {
  const Placement& placement = built.placements[found.instance];
  put_face(*placement.of, found.primitive, found.u, found.v,
           placement.of == &built ? own_instance : placement.id, hit);
}

// Whether built.placed has all triangles that a call may hit, and no callback wants to know of them.
[[gnu::always_inline]] inline bool uses_placed(const Built& built, const RTCIntersectContext* context) {
  return built.is_plain_mesh && !(built.may_ask_context && context->filter != nullptr) &&
         !(built.has_placed_instances && context->instID[0] != RTC_INVALID_GEOMETRY_ID);
}

// Whether a scene has meshes alone, of one mask, and no callback wants to know of them.
[[gnu::always_inline]] inline bool is_mesh_alone(const Built& built, const RTCIntersectContext* context) {
  return built.has_mesh_alone && !(built.asks_context && context->filter != nullptr);
}

// The arguments of user callbacks, and what rtcFilterIntersection() and rtcFilterOcclusion() need besides.
template <class Arguments>
struct UserArguments : Arguments {
  const Geometry* geometry;
  bool asks_context;
};

}  // namespace embree
