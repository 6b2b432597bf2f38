// The functions that trees and scenes share: queries of rays. A file that includes this defines before, and
// forgets after:
//   RAYLANES_HANDLE        what C holds: raylanes_bvh
//   RAYLANES_CALL(of_floats, of_doubles, of_scene, of_scene_d)  a function, one of these
//   RAYLANES_RAY           a ray of C: raylanes_ray
//   RAYLANES_HIT           a hit of C: raylanes_hit
//   RAYLANES_NUMBERS       a namespace in raylanes::c with the types Number and Tree, and `kind` for messages
#include <raylanes/numbers.hpp>

#include "call.hpp"
#include "handles.hpp"
#include "options.hpp"

namespace raylanes::c::RAYLANES_NUMBERS {
namespace {

using AnyHit = typename Tree::Hit;
using Rays = RayRecords<RayOf<Number>>;
using Hits = HitRecords<AnyHit>;
using Vertices = VertexRecords<Number>;
using TraceBy = RayOptions<typename Tree::Options, AnyHit>;
using ListBy = RayOptions<ListOptions, AnyHit>;
static_assert(sizeof(RayOf<Number>) == sizeof(RAYLANES_RAY));
static_assert(sizeof(AnyHit) == sizeof(RAYLANES_HIT));

const Tree& object_of(const RAYLANES_HANDLE* handle) {
  require_pointer(kind, handle);
  return *handle->object;
}

Vertices vertices_of(const char* what, const void* first, std::size_t count, std::size_t stride) {
  return {first, count, checked_stride(what, first, count, stride, 3 * sizeof(Number))};
}

IndexView triangles_of(const void* first, std::size_t count, std::size_t stride) {
  const std::size_t checked = checked_stride("triangles", first, count, stride, sizeof(Index3));
  return {static_cast<const std::uint32_t*>(first), count, checked};
}

Rays rays_of(const void* first, std::size_t count, std::size_t stride) {
  return {first, count, checked_stride("rays", first, count, stride, sizeof(RayOf<Number>))};
}

RayOf<Number> ray_of(const RAYLANES_RAY* ray) {
  require_pointer("ray", ray);
  return Rays(ray, 1)[0];
}

Hits hits_of(void* first, std::size_t count, std::size_t stride) {
  return {first, count, checked_stride("hits", first, count, stride, sizeof(AnyHit))};
}

PointOf<Number> point_of(const char* what, const Number* numbers) {
  require_pointer(what, numbers);
  PointOf<Number> point;
  std::memcpy(&point, numbers, sizeof point);
  return point;
}

RAYLANES_HANDLE* handle_of(Tree object) {
  return new RAYLANES_HANDLE{.object = std::make_shared<Tree>(std::move(object))};
}

template <class Item>
raylanes_lists* lists_of(RayLists<Item> lists) {
  return new Lists<Item>(std::move(lists));
}

}  // namespace

extern "C" {

void RAYLANES_CALL(raylanes_bvh_destroy, raylanes_bvhd_destroy, raylanes_scene_destroy,
                   raylanes_scene_d_destroy)(RAYLANES_HANDLE* handle) {
  delete handle;
}

raylanes_status RAYLANES_CALL(raylanes_bvh_bounds, raylanes_bvhd_bounds, raylanes_scene_bounds,
                              raylanes_scene_d_bounds)(const RAYLANES_HANDLE* handle, Number* lo,
                                                       Number* hi) {
  return status_of([&] {
    const auto box = object_of(handle).bounds();
    require_pointer("lo", lo);
    require_pointer("hi", hi);
    std::copy(box.lo.begin(), box.lo.end(), lo);
    std::copy(box.hi.begin(), box.hi.end(), hi);
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_closest, raylanes_bvhd_closest, raylanes_scene_closest,
                              raylanes_scene_d_closest)(const RAYLANES_HANDLE* handle, const void* rays,
                                                        std::size_t n, std::size_t stride, void* hits,
                                                        std::size_t hit_stride,
                                                        const raylanes_ray_options* options) {
  return status_of([&] {
    const Tree& asked = object_of(handle);
    const Rays from = rays_of(rays, n, stride);
    const Hits to = hits_of(hits, n, hit_stride);
    TraceBy(options, n).ask_batch([&](const auto& by, const auto&... filters) {
      asked.closest(from, to, filters..., by);
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_occluded, raylanes_bvhd_occluded, raylanes_scene_occluded,
                              raylanes_scene_d_occluded)(const RAYLANES_HANDLE* handle, const void* rays,
                                                         std::size_t n, std::size_t stride,
                                                         std::uint8_t* occluded,
                                                         const raylanes_ray_options* options) {
  return status_of([&] {
    const Tree& asked = object_of(handle);
    const Rays from = rays_of(rays, n, stride);
    const auto to = span_of<std::uint8_t>("occluded", occluded, n);
    TraceBy(options, n).ask_batch([&](const auto& by, const auto&... filters) {
      asked.occluded(from, to, filters..., by);
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_closest1, raylanes_bvhd_closest1, raylanes_scene_closest1,
                              raylanes_scene_d_closest1)(const RAYLANES_HANDLE* handle,
                                                         const RAYLANES_RAY* ray, RAYLANES_HIT* hit,
                                                         const raylanes_ray_options* options) {
  return status_of([&] {
    const Tree& asked = object_of(handle);
    const auto one = ray_of(ray);
    require_pointer("hit", hit);
    Hits(hit, 1).set(0, options == nullptr
                            ? asked.closest(one)
                            : TraceBy(options, 1).ask_one([&](const auto& by, const auto&... filters) {
                                return asked.closest(one, filters..., by);
                              }));
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_occluded1, raylanes_bvhd_occluded1, raylanes_scene_occluded1,
                              raylanes_scene_d_occluded1)(const RAYLANES_HANDLE* handle,
                                                          const RAYLANES_RAY* ray, std::uint8_t* occluded,
                                                          const raylanes_ray_options* options) {
  return status_of([&] {
    const Tree& asked = object_of(handle);
    const auto one = ray_of(ray);
    require_pointer("occluded", occluded);
    *occluded = options == nullptr ? asked.occluded(one)
                                   : TraceBy(options, 1).ask_one([&](const auto& by, const auto&... filters) {
                                       return asked.occluded(one, filters..., by);
                                     });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_occluded_from, raylanes_bvhd_occluded_from,
                              raylanes_scene_occluded_from, raylanes_scene_d_occluded_from)(
    const RAYLANES_HANDLE* handle, const Number* from, const void* points, std::size_t n, std::size_t stride,
    Number start, Number end, std::uint8_t* occluded, const raylanes_ray_options* options) {
  return status_of([&] {
    const Tree& asked = object_of(handle);
    const auto light = point_of("from", from);
    const Vertices to = vertices_of("points", points, n, stride);
    const auto dark = span_of<std::uint8_t>("occluded", occluded, n);
    const SegmentEndsOf<Number> ends{start, end};
    TraceBy(options, n).ask_batch([&](const auto& by, const auto&... filters) {
      asked.occluded_from(light, to, dark, filters..., ends, by);
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_occluded_towards, raylanes_bvhd_occluded_towards,
                              raylanes_scene_occluded_towards, raylanes_scene_d_occluded_towards)(
    const RAYLANES_HANDLE* handle, const Number* direction, const void* points, std::size_t n,
    std::size_t stride, std::uint8_t* occluded, const raylanes_ray_options* options) {
  return status_of([&] {
    const Tree& asked = object_of(handle);
    const auto sun = point_of("direction", direction);
    const Vertices to = vertices_of("points", points, n, stride);
    const auto dark = span_of<std::uint8_t>("occluded", occluded, n);
    TraceBy(options, n).ask_batch([&](const auto& by, const auto&... filters) {
      asked.occluded_towards(sun, to, dark, filters..., by);
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_closest_crossing, raylanes_bvhd_closest_crossing,
                              raylanes_scene_closest_crossing, raylanes_scene_d_closest_crossing)(
    const RAYLANES_HANDLE* handle, const void* rays, std::size_t n, std::size_t stride, void* hits,
    std::size_t hit_stride, const raylanes_ray_options* options) {
  return status_of([&] {
    object_of(handle).closest_crossing(rays_of(rays, n, stride), hits_of(hits, n, hit_stride),
                                       TraceBy(options, n).unfiltered());
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_closest_crossing1, raylanes_bvhd_closest_crossing1,
                              raylanes_scene_closest_crossing1,
                              raylanes_scene_d_closest_crossing1)(const RAYLANES_HANDLE* handle,
                                                                  const RAYLANES_RAY* ray, RAYLANES_HIT* hit,
                                                                  const raylanes_ray_options* options) {
  return status_of([&] {
    const Tree& asked = object_of(handle);
    const auto one = ray_of(ray);
    require_pointer("hit", hit);
    Hits(hit, 1).set(0, asked.closest_crossing(one, TraceBy(options, 1).unfiltered()));
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_all_hits, raylanes_bvhd_all_hits, raylanes_scene_all_hits,
                              raylanes_scene_d_all_hits)(const RAYLANES_HANDLE* handle, const void* rays,
                                                         std::size_t n, std::size_t stride,
                                                         raylanes_lists** lists,
                                                         const raylanes_ray_options* options) {
  return status_of([&] {
    make("lists", lists, [&] {
      return lists_of(object_of(handle).all_hits(rays_of(rays, n, stride), ListBy(options, n).unfiltered()));
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_crossings, raylanes_bvhd_crossings, raylanes_scene_crossings,
                              raylanes_scene_d_crossings)(const RAYLANES_HANDLE* handle, const void* rays,
                                                          std::size_t n, std::size_t stride,
                                                          raylanes_lists** lists,
                                                          const raylanes_ray_options* options) {
  return status_of([&] {
    make("lists", lists, [&] {
      return lists_of(object_of(handle).crossings(rays_of(rays, n, stride), ListBy(options, n).unfiltered()));
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_count_crossings, raylanes_bvhd_count_crossings,
                              raylanes_scene_count_crossings, raylanes_scene_d_count_crossings)(
    const RAYLANES_HANDLE* handle, const void* rays, std::size_t n, std::size_t stride,
    raylanes_crossing_count* counts, const raylanes_ray_options* options) {
  return status_of([&] {
    object_of(handle).count_crossings(rays_of(rays, n, stride), span_of<CrossingCount>("counts", counts, n),
                                      ListBy(options, n).unfiltered());
  });
}

}  // extern "C"
}  // namespace raylanes::c::RAYLANES_NUMBERS
