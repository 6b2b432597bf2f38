// The functions of one kind of tree. A file that includes this defines before, and forgets after:
//   RAYLANES_HANDLE        what C holds: raylanes_bvh
//   RAYLANES_CALL(name)    a function: raylanes_bvh_closest
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
struct RAYLANES_CALL(calls) {
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

const auto& calls_of(const RAYLANES_CALL(calls) * handle) {
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

raylanes_status RAYLANES_CALL(create)(RAYLANES_HANDLE** tree, const void* vertices, std::size_t vertex_count,
                                      std::size_t vertex_stride, const void* triangles,
                                      std::size_t triangle_count, std::size_t triangle_stride,
                                      const raylanes_build_options* options) {
  return status_of([&] {
    make("tree", tree, [&] {
      return handle_of(Tree(vertices_of("vertices", vertices, vertex_count, vertex_stride),
                            triangles_of(triangles, triangle_count, triangle_stride),
                            build_options(options)));
    });
  });
}

raylanes_status RAYLANES_CALL(refit)(RAYLANES_HANDLE* tree, const void* vertices, std::size_t vertex_count,
                                     std::size_t vertex_stride, const void* triangles,
                                     std::size_t triangle_count, std::size_t triangle_stride,
                                     std::int32_t threads) {
  return status_of([&] {
    require_pointer("tree", tree);
    tree->tree.refit(vertices_of("vertices", vertices, vertex_count, vertex_stride),
                     triangles_of(triangles, triangle_count, triangle_stride), threads);
  });
}

void RAYLANES_CALL(destroy)(RAYLANES_HANDLE* tree) {
  delete tree;
}

raylanes_status RAYLANES_CALL(save)(const RAYLANES_HANDLE* tree, void* buffer, std::size_t capacity,
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

raylanes_status RAYLANES_CALL(save_file)(const RAYLANES_HANDLE* tree, const char* file) {
  return status_of([&] {
    const Tree& saved = tree_of(tree);
    with_file<std::ofstream>(file, [&](std::ostream& stream) { saved.save(stream); });
  });
}

raylanes_status RAYLANES_CALL(load)(RAYLANES_HANDLE** tree, const void* bytes, std::size_t size) {
  return status_of([&] {
    make("tree", tree, [&] {
      checked_stride("bytes", bytes, size, 1, 1);
      BufferInput input(bytes, size);
      std::istream stream(&input);
      return handle_of(Tree::load(stream));
    });
  });
}

raylanes_status RAYLANES_CALL(load_file)(RAYLANES_HANDLE** tree, const char* file) {
  return status_of([&] {
    make("tree", tree, [&] {
      return with_file<std::ifstream>(file,
                                      [](std::istream& stream) { return handle_of(Tree::load(stream)); });
    });
  });
}

raylanes_status RAYLANES_CALL(closest)(const RAYLANES_HANDLE* tree, const void* rays, std::size_t n,
                                       std::size_t stride, void* hits, std::size_t hit_stride,
                                       const raylanes_ray_options* options) {
  return status_of([&] {
    tree_of(tree).closest(rays_of(rays, n, stride), hits_of(hits, n, hit_stride),
                          ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, n));
  });
}

raylanes_status RAYLANES_CALL(occluded)(const RAYLANES_HANDLE* tree, const void* rays, std::size_t n,
                                        std::size_t stride, std::uint8_t* occluded,
                                        const raylanes_ray_options* options) {
  return status_of([&] {
    tree_of(tree).occluded(rays_of(rays, n, stride), span_of<std::uint8_t>("occluded", occluded, n),
                           ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, n));
  });
}

raylanes_status RAYLANES_CALL(closest1)(const RAYLANES_HANDLE* tree, const RAYLANES_RECORD(ray) * ray,
                                        RAYLANES_RECORD(hit) * hit, const raylanes_ray_options* options) {
  return find_one(ray, hit, options, [&](const auto&... asked) { return tree_of(tree).closest(asked...); });
}

raylanes_status RAYLANES_CALL(occluded1)(const RAYLANES_HANDLE* tree, const RAYLANES_RECORD(ray) * ray,
                                         std::uint8_t* occluded, const raylanes_ray_options* options) {
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

raylanes_status RAYLANES_CALL(calls_create)(RAYLANES_CALL(calls) * *calls, const RAYLANES_HANDLE* tree,
                                            const raylanes_ray_options* options) {
  return status_of([&] {
    make("calls", calls, [&] {
      return new RAYLANES_CALL(calls){
          tree_of(tree).calls(ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, 1))};
    });
  });
}

void RAYLANES_CALL(calls_destroy)(RAYLANES_CALL(calls) * calls) {
  delete calls;
}

raylanes_status RAYLANES_CALL(calls_closest)(const RAYLANES_CALL(calls) * calls,
                                             const RAYLANES_RECORD(ray) * ray, RAYLANES_RECORD(hit) * hit) {
  return find_one(ray, hit, nullptr,
                  [&](const auto& one, const auto&...) { return calls_of(calls).closest(one); });
}

raylanes_status RAYLANES_CALL(calls_occluded)(const RAYLANES_CALL(calls) * calls,
                                              const RAYLANES_RECORD(ray) * ray, std::uint8_t* occluded) {
  return status_of([&] {
    require_pointer("ray", ray);
    const auto one = Rays(ray, 1)[0];
    require_pointer("occluded", occluded);
    *occluded = calls_of(calls).occluded(one);
  });
}

raylanes_status RAYLANES_CALL(occluded_from)(const RAYLANES_HANDLE* tree, const Number* from,
                                             const void* points, std::size_t n, std::size_t stride,
                                             Number start, Number end, std::uint8_t* occluded,
                                             const raylanes_ray_options* options) {
  return status_of([&] {
    const SegmentEndsOf<Number> ends{start, end};
    tree_of(tree).occluded_from(point_of("from", from), vertices_of("points", points, n, stride),
                                span_of<std::uint8_t>("occluded", occluded, n), ends,
                                ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, n));
  });
}

raylanes_status RAYLANES_CALL(occluded_towards)(const RAYLANES_HANDLE* tree, const Number* direction,
                                                const void* points, std::size_t n, std::size_t stride,
                                                std::uint8_t* occluded, const raylanes_ray_options* options) {
  return status_of([&] {
    tree_of(tree).occluded_towards(point_of("direction", direction), vertices_of("points", points, n, stride),
                                   span_of<std::uint8_t>("occluded", occluded, n),
                                   ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, n));
  });
}

raylanes_status RAYLANES_CALL(closest_crossing)(const RAYLANES_HANDLE* tree, const void* rays, std::size_t n,
                                                std::size_t stride, void* hits, std::size_t hit_stride,
                                                const raylanes_ray_options* options) {
  return status_of([&] {
    tree_of(tree).closest_crossing(rays_of(rays, n, stride), hits_of(hits, n, hit_stride),
                                   ray_options<RAYLANES_OPTIONS(TraceOptions)>(options, n));
  });
}

raylanes_status RAYLANES_CALL(closest_crossing1)(const RAYLANES_HANDLE* tree,
                                                 const RAYLANES_RECORD(ray) * ray, RAYLANES_RECORD(hit) * hit,
                                                 const raylanes_ray_options* options) {
  return find_one(ray, hit, options,
                  [&](const auto&... asked) { return tree_of(tree).closest_crossing(asked...); });
}

raylanes_status RAYLANES_CALL(all_hits)(const RAYLANES_HANDLE* tree, const void* rays, std::size_t n,
                                        std::size_t stride, raylanes_lists** lists,
                                        const raylanes_ray_options* options) {
  return status_of([&] {
    make("lists", lists, [&] {
      return lists_of(tree_of(tree).all_hits(rays_of(rays, n, stride), ray_options<ListOptions>(options, n)));
    });
  });
}

raylanes_status RAYLANES_CALL(crossings)(const RAYLANES_HANDLE* tree, const void* rays, std::size_t n,
                                         std::size_t stride, raylanes_lists** lists,
                                         const raylanes_ray_options* options) {
  return status_of([&] {
    make("lists", lists, [&] {
      return lists_of(
          tree_of(tree).crossings(rays_of(rays, n, stride), ray_options<ListOptions>(options, n)));
    });
  });
}

raylanes_status RAYLANES_CALL(count_crossings)(const RAYLANES_HANDLE* tree, const void* rays, std::size_t n,
                                               std::size_t stride, raylanes_crossing_count* counts,
                                               const raylanes_ray_options* options) {
  return status_of([&] {
    tree_of(tree).count_crossings(rays_of(rays, n, stride), span_of<CrossingCount>("counts", counts, n),
                                  ray_options<ListOptions>(options, n));
  });
}

raylanes_status RAYLANES_CALL(corners)(const RAYLANES_HANDLE* tree, const void* primitives, std::size_t n,
                                       std::size_t stride, Number* corners) {
  return status_of([&] {
    const Tree& asked = tree_of(tree);
    const std::size_t apart = checked_stride("primitives", primitives, n, stride, sizeof(std::uint32_t));
    checked_stride("corners", corners, n, 0, sizeof(CornersOfTriangle));
    require_alignment("corners", corners, alignof(CornersOfTriangle));
    asked.corners({primitives, n, apart}, {reinterpret_cast<CornersOfTriangle*>(corners), n});
  });
}

raylanes_status RAYLANES_CALL(bounds)(const RAYLANES_HANDLE* tree, Number* lo, Number* hi) {
  return status_of([&] {
    const auto box = tree_of(tree).bounds();
    require_pointer("lo", lo);
    require_pointer("hi", hi);
    std::copy(box.lo.begin(), box.lo.end(), lo);
    std::copy(box.hi.begin(), box.hi.end(), hi);
  });
}

raylanes_status RAYLANES_CALL(locate)(const RAYLANES_HANDLE* tree, const void* points, std::size_t n,
                                      std::size_t stride, std::uint8_t* locations,
                                      const raylanes_point_options* options) {
  return status_of([&] {
    tree_of(tree).locate(vertices_of("points", points, n, stride),
                         span_of<Location>("locations", locations, n), point_options<LocateOptions>(options));
  });
}

raylanes_status RAYLANES_CALL(closest_points)(const RAYLANES_HANDLE* tree, const void* points, std::size_t n,
                                              std::size_t stride, RAYLANES_RECORD(closest_point) * closest,
                                              const raylanes_point_options* options) {
  return status_of([&] {
    tree_of(tree).closest_points(vertices_of("points", points, n, stride),
                                 span_of<ClosestPointOf<Number>>("closest", closest, n),
                                 point_options<RAYLANES_OPTIONS(ClosestPointOptions)>(options));
  });
}

raylanes_status RAYLANES_CALL(signed_distances)(const RAYLANES_HANDLE* tree, const void* points,
                                                std::size_t n, std::size_t stride, Number* distances,
                                                const raylanes_point_options* options) {
  return status_of([&] {
    tree_of(tree).signed_distances(vertices_of("points", points, n, stride),
                                   span_of<Number>("distances", distances, n),
                                   point_options<RAYLANES_OPTIONS(SignedDistanceOptions)>(options));
  });
}

raylanes_status RAYLANES_CALL(winding_numbers)(const RAYLANES_HANDLE* tree, const void* points, std::size_t n,
                                               std::size_t stride, Number* numbers,
                                               const raylanes_point_options* options) {
  return status_of([&] {
    tree_of(tree).winding_numbers(vertices_of("points", points, n, stride),
                                  span_of<Number>("numbers", numbers, n),
                                  point_options<WindingOptions>(options));
  });
}

}  // extern "C"
}  // namespace raylanes::c::RAYLANES_NUMBERS
