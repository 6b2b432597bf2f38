// The functions of one kind of tree: its handle, rays. A file that includes this defines before, and forgets after:
//   RAYLANES_HANDLE        what C holds: raylanes_bvh
//   RAYLANES_CALLS         the handle of prepared calls: raylanes_bvh_calls
//   RAYLANES_CALL(of_floats, of_doubles)  a function, one of these
//   RAYLANES_RECORD(name)  a record: raylanes_hit
//   RAYLANES_OPTIONS(name) a type of C++: TraceOptions
//   RAYLANES_NUMBERS       a namespace in raylanes::c with the types Number and Tree: float and Bvh
#include <fstream>
#include <istream>
#include <ostream>

#include <raylanes/numbers.hpp>

#include "call.hpp"
#include "options.hpp"
#include "stream.hpp"

struct RAYLANES_HANDLE {
  raylanes::c::RAYLANES_NUMBERS::Tree tree;
};
struct RAYLANES_CALLS {
  decltype(std::declval<raylanes::c::RAYLANES_NUMBERS::Tree&>().calls()) calls;
};

namespace raylanes::c::RAYLANES_NUMBERS {
namespace {

using Rays = RayRecords<RayOf<Number>>;
using Hits = HitRecords<HitOf<Number>>;
using Vertices = VertexRecords<Number>;
using CornersOfTriangle = RAYLANES_OPTIONS(Triangle);
static_assert(sizeof(CornersOfTriangle) == 9 * sizeof(Number));
static_assert(sizeof(RayOf<Number>) == sizeof(RAYLANES_RECORD(ray)));
static_assert(sizeof(HitOf<Number>) == sizeof(RAYLANES_RECORD(hit)));

const Tree& tree_of(const RAYLANES_HANDLE* handle) {
  require_pointer("tree", handle);
  return handle->tree;
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

Hits hits_of(void* first, std::size_t count, std::size_t stride) {
  return {first, count, checked_stride("hits", first, count, stride, sizeof(HitOf<Number>))};
}

PointOf<Number> point_of(const char* what, const Number* numbers) {
  require_pointer(what, numbers);
  PointOf<Number> point;
  std::memcpy(&point, numbers, sizeof point);
  return point;
}

RAYLANES_HANDLE* handle_of(Tree tree) {
  return new RAYLANES_HANDLE{std::move(tree)};
}

const auto& calls_of(const RAYLANES_CALLS* handle) {
  require_pointer("calls", handle);
  return handle->calls;
}

// The hit of one ray, by find(ray) or find(ray, options).
template <class Find>
raylanes_status find_one(const RAYLANES_RECORD(ray) * ray, RAYLANES_RECORD(hit) * hit,
                         const raylanes_ray_options* options, const Find& find) {
  return status_of([&] {
    require_pointer("ray", ray);
    require_pointer("hit", hit);
    const auto one = Rays(ray, 1)[0];
    const Hits found(hit, 1);
    if (options == nullptr)
      found.set(0, find(one));
    else
      found.set(0, find(one, ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, 1)));
  });
}

template <class Item>
raylanes_lists* lists_of(RayLists<Item> lists) {
  return new Lists<Item>(std::move(lists));
}

}  // namespace

extern "C" {

raylanes_status RAYLANES_CALL(raylanes_bvh_create,
                              raylanes_bvhd_create)(RAYLANES_HANDLE** tree, const void* vertices,
                                                    std::size_t vertex_count, std::size_t vertex_stride,
                                                    const void* triangles, std::size_t triangle_count,
                                                    std::size_t triangle_stride,
                                                    const raylanes_build_options* options) {
  return status_of([&] {
    make("tree", tree, [&] {
      return handle_of(Tree(vertices_of("vertices", vertices, vertex_count, vertex_stride),
                            triangles_of(triangles, triangle_count, triangle_stride),
                            build_options(options)));
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_refit,
                              raylanes_bvhd_refit)(RAYLANES_HANDLE* tree, const void* vertices,
                                                   std::size_t vertex_count, std::size_t vertex_stride,
                                                   const void* triangles, std::size_t triangle_count,
                                                   std::size_t triangle_stride, std::int32_t threads) {
  return status_of([&] {
    require_pointer("tree", tree);
    tree->tree.refit(vertices_of("vertices", vertices, vertex_count, vertex_stride),
                     triangles_of(triangles, triangle_count, triangle_stride), threads);
  });
}

void RAYLANES_CALL(raylanes_bvh_destroy, raylanes_bvhd_destroy)(RAYLANES_HANDLE* tree) {
  delete tree;
}

raylanes_status RAYLANES_CALL(raylanes_bvh_save, raylanes_bvhd_save)(const RAYLANES_HANDLE* tree,
                                                                     void* buffer, std::size_t capacity,
                                                                     std::size_t* size) {
  return status_of([&] {
    require_pointer("size", size);
    checked_stride("buffer", buffer, capacity, 1, 1);
    BufferOutput output(buffer, capacity);
    std::ostream stream(&output);
    tree_of(tree).save(stream);
    *size = output.size();
    if (*size > capacity) throw SmallBuffer{capacity, *size};
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_save_file, raylanes_bvhd_save_file)(const RAYLANES_HANDLE* tree,
                                                                               const char* file) {
  return status_of([&] {
    const Tree& saved = tree_of(tree);
    with_file<std::ofstream>(file, [&](std::ostream& stream) { saved.save(stream); });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_load, raylanes_bvhd_load)(RAYLANES_HANDLE** tree,
                                                                     const void* bytes, std::size_t size) {
  return status_of([&] {
    make("tree", tree, [&] {
      checked_stride("bytes", bytes, size, 1, 1);
      BufferInput input(bytes, size);
      std::istream stream(&input);
      return handle_of(Tree::load(stream));
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_load_file, raylanes_bvhd_load_file)(RAYLANES_HANDLE** tree,
                                                                               const char* file) {
  return status_of([&] {
    make("tree", tree, [&] {
      return with_file<std::ifstream>(file,
                                      [](std::istream& stream) { return handle_of(Tree::load(stream)); });
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_closest,
                              raylanes_bvhd_closest)(const RAYLANES_HANDLE* tree, const void* rays,
                                                     std::size_t n, std::size_t stride, void* hits,
                                                     std::size_t hit_stride,
                                                     const raylanes_ray_options* options) {
  return status_of([&] {
    tree_of(tree).closest(rays_of(rays, n, stride), hits_of(hits, n, hit_stride),
                          ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, n));
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_occluded,
                              raylanes_bvhd_occluded)(const RAYLANES_HANDLE* tree, const void* rays,
                                                      std::size_t n, std::size_t stride,
                                                      std::uint8_t* occluded,
                                                      const raylanes_ray_options* options) {
  return status_of([&] {
    tree_of(tree).occluded(rays_of(rays, n, stride), span_of<std::uint8_t>("occluded", occluded, n),
                           ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, n));
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_closest1,
                              raylanes_bvhd_closest1)(const RAYLANES_HANDLE* tree,
                                                      const RAYLANES_RECORD(ray) * ray,
                                                      RAYLANES_RECORD(hit) * hit,
                                                      const raylanes_ray_options* options) {
  return find_one(ray, hit, options, [&](const auto&... asked) { return tree_of(tree).closest(asked...); });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_occluded1,
                              raylanes_bvhd_occluded1)(const RAYLANES_HANDLE* tree,
                                                       const RAYLANES_RECORD(ray) * ray,
                                                       std::uint8_t* occluded,
                                                       const raylanes_ray_options* options) {
  return status_of([&] {
    require_pointer("ray", ray);
    const auto one = Rays(ray, 1)[0];
    require_pointer("occluded", occluded);
    if (options == nullptr)
      *occluded = tree_of(tree).occluded(one);
    else
      *occluded = tree_of(tree).occluded(one, ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, 1));
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_calls_create,
                              raylanes_bvhd_calls_create)(RAYLANES_CALLS** calls, const RAYLANES_HANDLE* tree,
                                                          const raylanes_ray_options* options) {
  return status_of([&] {
    make("calls", calls, [&] {
      return new RAYLANES_CALLS{tree_of(tree).calls(ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, 1))};
    });
  });
}

void RAYLANES_CALL(raylanes_bvh_calls_destroy, raylanes_bvhd_calls_destroy)(RAYLANES_CALLS* calls) {
  delete calls;
}

raylanes_status RAYLANES_CALL(raylanes_bvh_calls_closest,
                              raylanes_bvhd_calls_closest)(const RAYLANES_CALLS* calls,
                                                           const RAYLANES_RECORD(ray) * ray,
                                                           RAYLANES_RECORD(hit) * hit) {
  return find_one(ray, hit, nullptr,
                  [&](const auto& one, const auto&...) { return calls_of(calls).closest(one); });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_calls_occluded,
                              raylanes_bvhd_calls_occluded)(const RAYLANES_CALLS* calls,
                                                            const RAYLANES_RECORD(ray) * ray,
                                                            std::uint8_t* occluded) {
  return status_of([&] {
    require_pointer("ray", ray);
    const auto one = Rays(ray, 1)[0];
    require_pointer("occluded", occluded);
    *occluded = calls_of(calls).occluded(one);
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_occluded_from, raylanes_bvhd_occluded_from)(
    const RAYLANES_HANDLE* tree, const Number* from, const void* points, std::size_t n, std::size_t stride,
    Number start, Number end, std::uint8_t* occluded, const raylanes_ray_options* options) {
  return status_of([&] {
    const SegmentEndsOf<Number> ends{start, end};
    tree_of(tree).occluded_from(point_of("from", from), vertices_of("points", points, n, stride),
                                span_of<std::uint8_t>("occluded", occluded, n), ends,
                                ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, n));
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_occluded_towards, raylanes_bvhd_occluded_towards)(
    const RAYLANES_HANDLE* tree, const Number* direction, const void* points, std::size_t n,
    std::size_t stride, std::uint8_t* occluded, const raylanes_ray_options* options) {
  return status_of([&] {
    tree_of(tree).occluded_towards(point_of("direction", direction), vertices_of("points", points, n, stride),
                                   span_of<std::uint8_t>("occluded", occluded, n),
                                   ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, n));
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_closest_crossing,
                              raylanes_bvhd_closest_crossing)(const RAYLANES_HANDLE* tree, const void* rays,
                                                              std::size_t n, std::size_t stride, void* hits,
                                                              std::size_t hit_stride,
                                                              const raylanes_ray_options* options) {
  return status_of([&] {
    tree_of(tree).closest_crossing(rays_of(rays, n, stride), hits_of(hits, n, hit_stride),
                                   ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, n));
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_closest_crossing1,
                              raylanes_bvhd_closest_crossing1)(const RAYLANES_HANDLE* tree,
                                                               const RAYLANES_RECORD(ray) * ray,
                                                               RAYLANES_RECORD(hit) * hit,
                                                               const raylanes_ray_options* options) {
  return find_one(ray, hit, options,
                  [&](const auto&... asked) { return tree_of(tree).closest_crossing(asked...); });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_all_hits,
                              raylanes_bvhd_all_hits)(const RAYLANES_HANDLE* tree, const void* rays,
                                                      std::size_t n, std::size_t stride,
                                                      raylanes_lists** lists,
                                                      const raylanes_ray_options* options) {
  return status_of([&] {
    make("lists", lists, [&] {
      return lists_of(tree_of(tree).all_hits(rays_of(rays, n, stride), ray_options<ListOptions>(options, n)));
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_crossings,
                              raylanes_bvhd_crossings)(const RAYLANES_HANDLE* tree, const void* rays,
                                                       std::size_t n, std::size_t stride,
                                                       raylanes_lists** lists,
                                                       const raylanes_ray_options* options) {
  return status_of([&] {
    make("lists", lists, [&] {
      return lists_of(
          tree_of(tree).crossings(rays_of(rays, n, stride), ray_options<ListOptions>(options, n)));
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_count_crossings,
                              raylanes_bvhd_count_crossings)(const RAYLANES_HANDLE* tree, const void* rays,
                                                             std::size_t n, std::size_t stride,
                                                             raylanes_crossing_count* counts,
                                                             const raylanes_ray_options* options) {
  return status_of([&] {
    tree_of(tree).count_crossings(rays_of(rays, n, stride), span_of<CrossingCount>("counts", counts, n),
                                  ray_options<ListOptions>(options, n));
  });
}

}  // extern "C"
}  // namespace raylanes::c::RAYLANES_NUMBERS
