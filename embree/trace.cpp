// One ray through a built scene: triangles, then user primitives, spheres, discs and instances.
#include "trace.hpp"

#include "points.hpp"

namespace embree {
namespace {

// A ray as its caller passes it: with a hit where the nearest one is asked for.
template <bool nearest>
using Traced = std::conditional_t<nearest, RTCRayHit, RTCRay>;
RTCRay& ray_in(RTCRayHit& both) {
  return both.ray;
}
RTCRay& ray_in(RTCRay& ray) {
  return ray;
}
// In the space of an instance, which ray and context are in meanwhile.
template <bool nearest>
bool trace_instance(const Built& built, const Thing& thing, RTCIntersectContext* context,
                    Traced<nearest>& both);

// Calls the filters of geometry and context, which may change ray and hit.
bool passes(RTCFilterFunctionN own, void* user, bool asks_context, RTCIntersectContext* context, RTCRay& ray,
            RTCHit& hit) {
  int valid = -1;
  const RTCFilterFunctionNArguments arguments{
      &valid, user, context, reinterpret_cast<RTCRayN*>(&ray), reinterpret_cast<RTCHitN*>(&hit), 1};
  if (own != nullptr) own(&arguments);
  if (valid != 0 && asks_context && context->filter != nullptr) context->filter(&arguments);
  return valid != 0;
}

// Whether mask and filters keep a hit at `t`, to which ray.tfar is set if they do. Filters may change both.
template <bool nearest>
bool keeps(const Built& built, const Geometry& geometry, RTCIntersectContext* context, RTCRay& ray, float t,
           RTCHit& hit) {
  if ((geometry.mask & ray.mask) == 0) return false;
  const RTCFilterFunctionN own = nearest ? geometry.intersect_filter : geometry.occluded_filter;
  const float far = std::exchange(ray.tfar, t);
  if (passes(own, geometry.user, built.asks_context, context, ray, hit)) return true;
  ray.tfar = far;
  return false;
}

// Asks masks and filters about triangles in the walk, each of which would be the nearest so far.
template <bool nearest>
bool find_filtered(const Built& built, RTCIntersectContext* context, Traced<nearest>& both) {
  RTCRay& ray = ray_in(both);
  const raylanes::Ray whole = ray_of(ray, built.is_robust);
  const float far = ray.tfar;
  float kept = far;
  const auto rejects = [&](const raylanes::Hit& found) {
    RTCHit candidate;
    put_face(built, found.primitive, found.u, found.v, context->instID[0], candidate);
    const Geometry& geometry = *built.parts[built.faces[found.primitive].part].geometry;
    const bool is_kept = keeps<nearest>(built, geometry, context, ray, found.t, candidate);
    if (is_kept) kept = std::exchange(ray.tfar, far);
    if constexpr (nearest)
      if (is_kept) both.hit = candidate;
    return !is_kept;
  };
  bool is_hit;
  if constexpr (nearest)
    is_hit = static_cast<bool>(built.mesh->closest(whole, rejects));
  else
    is_hit = built.mesh->occluded(whole, rejects);
  ray.tfar = kept;
  return is_hit;
}

template <bool nearest>
bool find_point(const Built& built, const Thing& thing, RTCIntersectContext* context, Traced<nearest>& both) {
  const Part& part = built.parts[thing.part];
  const PointHits hits = hits_of_point(*part.geometry, thing.primitive, ray_in(both));
  for (int k = 0; k < hits.count; ++k) {
    const auto& [t, n] = hits.hit[k];
    RTCHit candidate{n[0], n[1], n[2], 0, 0, thing.primitive, part.id, {context->instID[0]}};
    if (!keeps<nearest>(built, *part.geometry, context, ray_in(both), t, candidate)) continue;
    if constexpr (nearest) both.hit = candidate;
    return true;
  }
  return false;
}

// Asks a function of a user geometry, which sets tfar and the hit if there is one.
template <class RaysN, class Arguments, class Both>
bool ask_user(void (*function)(const Arguments*), const Built& built, const Thing& thing,
              RTCIntersectContext* context, Both& both) {
  if (function == nullptr) return false;
  const Part& part = built.parts[thing.part];
  const float far = ray_in(both).tfar;
  int valid = -1;
  const UserArguments<Arguments> arguments{
      {&valid, part.geometry->user, thing.primitive, context, reinterpret_cast<RaysN*>(&both), 1, part.id},
      part.geometry.get(),
      built.asks_context};
  function(&arguments);
  return ray_in(both).tfar < (std::is_same_v<Both, RTCRay> ? 0 : far);
}

template <bool nearest>
bool visit(const Built& built, const Thing& thing, RTCIntersectContext* context, Traced<nearest>& both) {
  const Geometry& geometry = *built.parts[thing.part].geometry;
  if ((geometry.mask & ray_in(both).mask) == 0) return false;
  if (thing.instanced != nullptr) return trace_instance<nearest>(built, thing, context, both);
  if (!geometry.is_user()) return find_point<nearest>(built, thing, context, both);
  if constexpr (nearest)
    return ask_user<RTCRayHitN>(geometry.intersect, built, thing, context, both);
  else
    return ask_user<RTCRayN>(geometry.occluded, built, thing, context, both);
}

template <bool nearest>
[[gnu::noinline]] bool visit_things(const Built& built, const raylanes::BoundedTree& tree,
                                    RTCIntersectContext* context, Traced<nearest>& both) {
  const auto test = [&](const raylanes::LeafVisit& leaf) {
    const std::uint32_t primitive = leaf.primitives[0];  // the only one
    if (visit<nearest>(built, built.things[primitive], context, both))
      leaf.keep(leaf.rays[0], {ray_in(both).tfar, 0, 0, primitive});
  };
  const raylanes::Ray whole = ray_of(ray_in(both), true);
  if constexpr (nearest)
    return static_cast<bool>(tree.closest(whole, test));
  else
    return tree.occluded(whole, test);
}

template <bool nearest>
bool find_placed(const Built& built, RTCIntersectContext* context, Traced<nearest>& both) {
  if (built.placements.empty()) return false;
  RTCRay& ray = ray_in(both);
  const raylanes::Ray whole = ray_of(ray, built.is_robust);
  const bool has_all = built.is_unmasked && ray.mask != 0;
  if constexpr (nearest) {
    const raylanes::SceneHit found =
        has_all ? built.placed.closest(whole) : built.placed.closest(whole, {.mask = ray.mask});
    if (!found) return false;
    ray.tfar = found.t;
    put_placed(built, found, context->instID[0], both.hit);
    return true;
  } else {
    return has_all ? built.placed.occluded(whole) : built.placed.occluded(whole, {.mask = ray.mask});
  }
}

// Traces what a scene has besides meshes that no callback wants to know of.
template <bool nearest>
[[gnu::noinline]] bool trace_parts(const Built& built, RTCIntersectContext* context, Traced<nearest>& both) {
  const bool is_placed = uses_placed(built, context);
  const raylanes::BoundedTree& rest = is_placed ? built.others : built.tree_of_all();
  bool is_hit = false;
  if (is_placed)
    is_hit = find_placed<nearest>(built, context, both);
  else if (!built.faces.empty())
    is_hit = find_filtered<nearest>(built, context, both);
  if (is_hit && !nearest) return true;
  return (rest.size() != 0 && visit_things<nearest>(built, rest, context, both)) || is_hit;
}

template <bool nearest>
bool trace_instance(const Built& built, const Thing& thing, RTCIntersectContext* context,
                    Traced<nearest>& both) {
  if (context->instID[0] != RTC_INVALID_GEOMETRY_ID) return false;  // one level
  const Part& part = built.parts[thing.part];
  RTCRay& ray = ray_in(both);
  const RTCRay outside = ray;
  const double origin[3] = {ray.org_x, ray.org_y, ray.org_z},
               direction[3] = {ray.dir_x, ray.dir_y, ray.dir_z};
  double o[3], d[3];
  part.geometry->to_local.move_point(origin, o);
  part.geometry->to_local.turn(direction, d);
  ray.org_x = static_cast<float>(o[0]), ray.org_y = static_cast<float>(o[1]),
  ray.org_z = static_cast<float>(o[2]);
  ray.dir_x = static_cast<float>(d[0]), ray.dir_y = static_cast<float>(d[1]),
  ray.dir_z = static_cast<float>(d[2]);
  context->instID[0] = part.id;
  bool is_hit;
  if constexpr (nearest)
    is_hit = trace_closest(*thing.instanced, context, both);
  else
    is_hit = trace_occluded(*thing.instanced, context, both);
  context->instID[0] = RTC_INVALID_GEOMETRY_ID;
  ray.org_x = outside.org_x, ray.org_y = outside.org_y, ray.org_z = outside.org_z;
  ray.dir_x = outside.dir_x, ray.dir_y = outside.dir_y, ray.dir_z = outside.dir_z;
  return is_hit;
}

}  // namespace

bool trace_closest(const Built& built, RTCIntersectContext* context, RTCRayHit& ray) {
  if (!is_mesh_alone(built, context)) return trace_parts<true>(built, context, ray);
  if ((built.mesh_mask & ray.ray.mask) == 0) return false;
  const raylanes::Hit found = built.calls->closest(ray_of(ray.ray, built.is_robust));
  if (!found) return false;
  ray.ray.tfar = found.t;
  put_face(built, found.primitive, found.u, found.v, context->instID[0], ray.hit);
  return true;
}
bool trace_occluded(const Built& built, RTCIntersectContext* context, RTCRay& ray) {
  if (!is_mesh_alone(built, context)) return trace_parts<false>(built, context, ray);
  return (built.mesh_mask & ray.mask) != 0 && built.calls->occluded(ray_of(ray, built.is_robust));
}

}  // namespace embree

using namespace embree;

namespace {

template <class Own, class Arguments>
void filter_user_hit(const Arguments* arguments, const RTCFilterFunctionNArguments* filter, Own own) {
  guarded(nullptr, [&] {
    require_some(arguments, filter);
    const auto& whole = *static_cast<const UserArguments<Arguments>*>(arguments);
    const RTCFilterFunctionN function = own(*whole.geometry);
    if (function != nullptr) function(filter);
    if (whole.asks_context && whole.context->filter != nullptr && filter->valid[0] != 0)
      whole.context->filter(filter);
  });
}

}  // namespace

RTC_API void rtcFilterIntersection(const RTCIntersectFunctionNArguments* arguments,
                                   const RTCFilterFunctionNArguments* filter) {
  filter_user_hit(arguments, filter, [](const Geometry& geometry) { return geometry.intersect_filter; });
}
RTC_API void rtcFilterOcclusion(const RTCOccludedFunctionNArguments* arguments,
                                const RTCFilterFunctionNArguments* filter) {
  filter_user_hit(arguments, filter, [](const Geometry& geometry) { return geometry.occluded_filter; });
}
