// One ray through a built scene: triangles, then user primitives, spheres, discs and instances.
#include "trace.hpp"

#include "points.hpp"

namespace embree {
namespace {

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
bool find_filtered(const Built& built, RTCIntersectContext* context, RTCRay& ray, RTCHit& hit) {
  const raylanes::Ray whole = ray_of(ray, built.is_robust);
  const float far = ray.tfar;
  float kept = far;
  const auto rejects = [&](const raylanes::Hit& found) {
    RTCHit candidate;
    put_face(built, found.primitive, found.u, found.v, context->instID[0], candidate);
    const Geometry& geometry = *built.parts[built.faces[found.primitive].part].geometry;
    const bool is_kept = keeps<nearest>(built, geometry, context, ray, found.t, candidate);
    if (is_kept) kept = std::exchange(ray.tfar, far), hit = candidate;
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

// Traces in the space of an instance, which ray and context are in meanwhile.
template <class Inner>
void within(const Built& built, const Thing& thing, RTCIntersectContext* context, RTCRay& ray,
            Inner&& inner) {
  if (context->instID[0] != RTC_INVALID_GEOMETRY_ID) return;  // one level
  const Part& part = built.parts[thing.part];
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
  inner(*thing.instanced);
  context->instID[0] = RTC_INVALID_GEOMETRY_ID;
  ray.org_x = outside.org_x, ray.org_y = outside.org_y, ray.org_z = outside.org_z;
  ray.dir_x = outside.dir_x, ray.dir_y = outside.dir_y, ray.dir_z = outside.dir_z;
}

template <bool nearest>
bool find_point(const Built& built, const Thing& thing, RTCIntersectContext* context, RTCRay& ray,
                RTCHit& hit) {
  const Part& part = built.parts[thing.part];
  const PointHits hits = hits_of_point(*part.geometry, thing.primitive, ray);
  for (int k = 0; k < hits.count; ++k) {
    const auto& [t, n] = hits.hit[k];
    RTCHit candidate{n[0], n[1], n[2], 0, 0, thing.primitive, part.id, {context->instID[0]}};
    if (!keeps<nearest>(built, *part.geometry, context, ray, t, candidate)) continue;
    hit = candidate;
    return true;
  }
  return false;
}

void visit(const Built& built, const Thing& thing, RTCIntersectContext* context, RTCRayHit& ray) {
  const Part& part = built.parts[thing.part];
  const Geometry& geometry = *part.geometry;
  if ((geometry.mask & ray.ray.mask) == 0) return;
  if (thing.instanced != nullptr)
    return within(built, thing, context, ray.ray,
                  [&](const Built& inner) { trace_closest(inner, context, ray); });
  if (!geometry.is_user()) {
    find_point<true>(built, thing, context, ray.ray, ray.hit);
    return;
  }
  if (geometry.intersect == nullptr) return;
  int valid = -1;
  const UserArguments<RTCIntersectFunctionNArguments> arguments{
      {&valid, geometry.user, thing.primitive, context, reinterpret_cast<RTCRayHitN*>(&ray), 1, part.id},
      &geometry,
      built.asks_context};
  geometry.intersect(&arguments);
}

bool visit_any(const Built& built, const Thing& thing, RTCIntersectContext* context, RTCRay& ray) {
  const Part& part = built.parts[thing.part];
  const Geometry& geometry = *part.geometry;
  if ((geometry.mask & ray.mask) == 0) return false;
  bool is_hit = false;
  if (thing.instanced != nullptr) {
    within(built, thing, context, ray,
           [&](const Built& inner) { is_hit = trace_occluded(inner, context, ray); });
  } else if (!geometry.is_user()) {
    RTCHit hit;
    is_hit = find_point<false>(built, thing, context, ray, hit);
  } else if (geometry.occluded != nullptr) {
    int valid = -1;
    const UserArguments<RTCOccludedFunctionNArguments> arguments{
        {&valid, geometry.user, thing.primitive, context, reinterpret_cast<RTCRayN*>(&ray), 1, part.id},
        &geometry,
        built.asks_context};
    geometry.occluded(&arguments);
    is_hit = ray.tfar < 0;
  }
  return is_hit;
}

[[gnu::noinline]] void visit_things(const Built& built, const raylanes::BoundedTree& tree,
                                    RTCIntersectContext* context, RTCRayHit& ray) {
  tree.closest(ray_of(ray.ray, true), [&](const raylanes::LeafVisit& leaf) {
    for (const std::uint32_t primitive : leaf.primitives) {
      const float far = ray.ray.tfar;
      visit(built, built.things[primitive], context, ray);
      if (ray.ray.tfar < far) leaf.keep(leaf.rays[0], {ray.ray.tfar, 0, 0, primitive});
    }
  });
}
[[gnu::noinline]] bool visit_any_thing(const Built& built, const raylanes::BoundedTree& tree,
                                       RTCIntersectContext* context, RTCRay& ray) {
  return tree.occluded(ray_of(ray, true), [&](const raylanes::LeafVisit& leaf) {
    for (const std::uint32_t primitive : leaf.primitives)
      if (leaf.occluded[leaf.rays[0]] == 0 && visit_any(built, built.things[primitive], context, ray))
        leaf.keep(leaf.rays[0], {0, 0, 0, primitive});
  });
}

// Traces what a scene has besides meshes that no callback wants to know of.
[[gnu::noinline]] void trace_parts(const Built& built, RTCIntersectContext* context, RTCRayHit& ray) {
  if (!uses_placed(built, context)) {
    if (!built.faces.empty()) find_filtered<true>(built, context, ray.ray, ray.hit);
    if (!built.things.empty()) visit_things(built, built.tree_of_all(), context, ray);
    return;
  }
  const raylanes::Ray whole = ray_of(ray.ray, built.is_robust);
  if (const raylanes::SceneHit found = built.is_unmasked && ray.ray.mask != 0
                                           ? built.placed.closest(whole)
                                           : built.placed.closest(whole, {}, ray.ray.mask)) {
    ray.ray.tfar = found.t;
    put_placed(built, found, context->instID[0], ray.hit);
  }
  if (built.other_count != 0) visit_things(built, built.others, context, ray);
}
[[gnu::noinline]] bool trace_any_part(const Built& built, RTCIntersectContext* context, RTCRay& ray) {
  if (!uses_placed(built, context)) {
    RTCHit hit;
    return (!built.faces.empty() && find_filtered<false>(built, context, ray, hit)) ||
           (!built.things.empty() && visit_any_thing(built, built.tree_of_all(), context, ray));
  }
  const raylanes::Ray whole = ray_of(ray, built.is_robust);
  return (built.is_unmasked && ray.mask != 0 ? built.placed.occluded(whole)
                                             : built.placed.occluded(whole, {}, ray.mask)) ||
         (built.other_count != 0 && visit_any_thing(built, built.others, context, ray));
}

}  // namespace

void trace_closest(const Built& built, RTCIntersectContext* context, RTCRayHit& ray) {
  if (!is_mesh_alone(built, context)) return trace_parts(built, context, ray);
  if ((built.mesh_mask & ray.ray.mask) == 0) return;
  if (const raylanes::Hit found = built.calls->closest(ray_of(ray.ray, built.is_robust))) {
    ray.ray.tfar = found.t;
    put_face(built, found.primitive, found.u, found.v, context->instID[0], ray.hit);
  }
}
bool trace_occluded(const Built& built, RTCIntersectContext* context, RTCRay& ray) {
  if (!is_mesh_alone(built, context)) return trace_any_part(built, context, ray);
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
