// The C functions of scenes.
#include <raylanes/raylanes.h>

#include <raylanes/scene.hpp>

namespace raylanes::c::of_scenes {

using Number = float;
using Tree = Scene;
using AnyClosestPoint = SceneClosestPoint;
using ClosestOptions = ClosestPointOptions;
using DistanceOptions = SignedDistanceOptions;
constexpr const char* kind = "scene";

}  // namespace raylanes::c::of_scenes

#define RAYLANES_HANDLE raylanes_scene
#define RAYLANES_CALL(of_floats, of_doubles, of_scene) of_scene
#define RAYLANES_RAY raylanes_ray
#define RAYLANES_HIT raylanes_scene_hit
#define RAYLANES_CLOSEST raylanes_scene_closest_point
#define RAYLANES_NUMBERS of_scenes
#include "object_calls.hpp"
#include "object_points.hpp"

namespace raylanes::c::of_scenes {
namespace {

Scene& changed(raylanes_scene* handle) {
  require_pointer("scene", handle);
  return *handle->object;
}

std::shared_ptr<const Bvh> shared_tree(const raylanes_bvh* tree) {
  require_pointer("tree", tree);
  return tree->object;
}

template <class Record>
std::span<const Record> copied(const char* what, const void* first, std::size_t count, std::size_t stride,
                               std::vector<Record>& records) {
  const RayRecords<Record> view(first, count, checked_stride(what, first, count, stride, sizeof(Record)));
  records.resize(count);
  for (std::size_t i = 0; i < count; ++i) view.copy(i, records[i]);
  return records;
}

SphereTree spheres_of(const void* spheres, std::size_t n, std::size_t stride,
                      const raylanes_build_options* options) {
  std::vector<Sphere> records;
  return SphereTree(copied("spheres", spheres, n, stride, records), bounded_build_options(options));
}

Transform transform_of(const float* numbers) {
  Transform transform;
  if (numbers != nullptr) std::memcpy(transform.row, numbers, sizeof transform.row);
  return transform;
}

// Writes what find() returns.
template <class T, class Find>
raylanes_status tell(const char* what, T* to, const Find& find) {
  return status_of([&] {
    require_pointer(what, to);
    *to = find();
  });
}

// The primitives and instances of hits in scenes. No hits may be NULL.
PrimitiveView named_by(const void* hits, std::size_t count, std::size_t stride) {
  const std::size_t apart = checked_stride("hits", hits, count, stride, sizeof(SceneHit));
  return SceneHitView(const_cast<void*>(hits), count, apart);
}

// Floats of records, side by side.
template <class Record>
std::span<Record> records_of(const char* what, float* first, std::size_t count) {
  checked_stride(what, first, count, 0, sizeof(Record));
  require_alignment(what, first, alignof(Record));
  return {reinterpret_cast<Record*>(first), count};
}

static_assert(sizeof(Sphere) == sizeof(raylanes_sphere) && sizeof(Box) == 6 * sizeof(float));
static_assert(sizeof(Transform) == 12 * sizeof(float));
static_assert(sizeof(SceneReport) == sizeof(raylanes_scene_report));
static_assert(sizeof(SceneCrossing) == sizeof(raylanes_scene_crossing));
static_assert(sizeof(SceneStretch) == sizeof(raylanes_scene_stretch));

}  // namespace

extern "C" {

raylanes_status raylanes_scene_create(raylanes_scene** scene) {
  return status_of([&] { make("scene", scene, [] { return handle_of(Scene()); }); });
}

raylanes_status raylanes_scene_copy(raylanes_scene** scene, const raylanes_scene* from) {
  return status_of([&] {
    make("scene", scene, [&] {
      require_pointer("from", from);
      return new raylanes_scene{std::make_shared<Scene>(*from->object), from->tests};
    });
  });
}

raylanes_status raylanes_scene_add_mesh(raylanes_scene* scene, const void* vertices, std::size_t vertex_count,
                                        std::size_t vertex_stride, const void* triangles,
                                        std::size_t triangle_count, std::size_t triangle_stride,
                                        const raylanes_build_options* options, std::uint32_t* geometry) {
  return tell("geometry", geometry, [&] {
    return changed(scene).add(vertices_of("vertices", vertices, vertex_count, vertex_stride),
                              triangles_of(triangles, triangle_count, triangle_stride),
                              build_options(options));
  });
}

raylanes_status raylanes_scene_add_tree(raylanes_scene* scene, const raylanes_bvh* tree,
                                        std::uint32_t* geometry) {
  return tell("geometry", geometry, [&] { return changed(scene).add(shared_tree(tree)); });
}

raylanes_status raylanes_scene_add_spheres(raylanes_scene* scene, const void* spheres, std::size_t n,
                                           std::size_t stride, const raylanes_build_options* options,
                                           std::uint32_t* geometry) {
  return tell("geometry", geometry,
              [&] { return changed(scene).add(spheres_of(spheres, n, stride, options)); });
}

raylanes_status raylanes_scene_add_primitives(raylanes_scene* scene, const void* boxes, std::size_t n,
                                              std::size_t stride, raylanes_primitive_test test, void* context,
                                              const raylanes_build_options* options,
                                              std::uint32_t* geometry) {
  return tell("geometry", geometry, [&] {
    Scene& to = changed(scene);
    if (test == nullptr) throw std::invalid_argument("test: it is NULL");
    std::vector<Box> records;
    BoundedTree tree(copied("boxes", boxes, n, stride, records), bounded_build_options(options));
    scene->tests.reserve(scene->tests.size() + 1);
    auto own = std::make_shared<OwnTest>(OwnTest{test, context});
    const std::uint32_t added = to.add(std::move(tree), *own);
    scene->tests.push_back(std::move(own));
    return added;
  });
}

raylanes_status raylanes_scene_add_scene(raylanes_scene* scene, const raylanes_scene* added,
                                         std::uint32_t* geometry) {
  return tell("geometry", geometry, [&] {
    Scene& to = changed(scene);
    const Scene& from = object_of(added);
    auto tests = scene->tests;
    if (added != scene) tests.insert(tests.end(), added->tests.begin(), added->tests.end());
    const std::uint32_t number = to.add(from);
    scene->tests = std::move(tests);
    return number;
  });
}

raylanes_status raylanes_scene_replace_tree(raylanes_scene* scene, std::uint32_t geometry,
                                            const raylanes_bvh* tree) {
  return status_of([&] { changed(scene).replace(geometry, shared_tree(tree)); });
}

raylanes_status raylanes_scene_replace_spheres(raylanes_scene* scene, std::uint32_t geometry,
                                               const void* spheres, std::size_t n, std::size_t stride,
                                               const raylanes_build_options* options) {
  return status_of([&] { changed(scene).replace(geometry, spheres_of(spheres, n, stride, options)); });
}

raylanes_status raylanes_scene_refit(raylanes_scene* scene, std::uint32_t geometry, const void* vertices,
                                     std::size_t vertex_count, std::size_t vertex_stride,
                                     const void* triangles, std::size_t triangle_count,
                                     std::size_t triangle_stride, std::int32_t threads) {
  return status_of([&] {
    changed(scene).refit(geometry, vertices_of("vertices", vertices, vertex_count, vertex_stride),
                         triangles_of(triangles, triangle_count, triangle_stride), threads);
  });
}

raylanes_status raylanes_scene_set_triangle_masks(raylanes_scene* scene, std::uint32_t geometry,
                                                  const std::uint32_t* masks, std::size_t n) {
  return status_of(
      [&] { changed(scene).set_triangle_masks(geometry, span_of<const std::uint32_t>("masks", masks, n)); });
}

raylanes_status raylanes_scene_place(raylanes_scene* scene, std::uint32_t geometry, const float* transform,
                                     std::uint32_t mask, std::uint32_t* instance) {
  return tell("instance", instance,
              [&] { return changed(scene).place(geometry, transform_of(transform), mask); });
}

raylanes_status raylanes_scene_move(raylanes_scene* scene, std::uint32_t instance, const float* transform) {
  return status_of([&] { changed(scene).move(instance, transform_of(transform)); });
}

raylanes_status raylanes_scene_set_mask(raylanes_scene* scene, std::uint32_t instance, std::uint32_t mask) {
  return status_of([&] { changed(scene).set_mask(instance, mask); });
}

raylanes_status raylanes_scene_set_moving(raylanes_scene* scene, std::uint32_t instance,
                                          std::int32_t moving) {
  return status_of([&] { changed(scene).set_moving(instance, moving != 0); });
}

raylanes_status raylanes_scene_update(raylanes_scene* scene, std::int32_t threads) {
  return status_of([&] { changed(scene).update(threads); });
}

std::size_t raylanes_scene_geometry_count(const raylanes_scene* scene) {
  return scene == nullptr ? 0 : scene->object->geometry_count();
}

std::size_t raylanes_scene_instance_count(const raylanes_scene* scene) {
  return scene == nullptr ? 0 : scene->object->instance_count();
}

std::size_t raylanes_scene_bytes(const raylanes_scene* scene) {
  return scene == nullptr ? 0 : scene->object->bytes();
}

raylanes_status raylanes_scene_geometry_of(const raylanes_scene* scene, std::uint32_t instance,
                                           std::uint32_t* geometry) {
  return tell("geometry", geometry, [&] { return object_of(scene).geometry_of(instance); });
}

raylanes_status raylanes_scene_transform_of(const raylanes_scene* scene, std::uint32_t instance,
                                            float* transform) {
  return status_of([&] {
    const Transform of_instance = object_of(scene).transform_of(instance);
    require_pointer("transform", transform);
    std::memcpy(transform, &of_instance, sizeof of_instance);
  });
}

raylanes_status raylanes_scene_mask_of(const raylanes_scene* scene, std::uint32_t instance,
                                       std::uint32_t* mask) {
  return tell("mask", mask, [&] { return object_of(scene).mask_of(instance); });
}

raylanes_status raylanes_scene_levels_of(const raylanes_scene* scene, std::uint32_t instance,
                                         raylanes_instance_level* levels, std::size_t capacity,
                                         std::size_t* count) {
  return status_of([&] {
    require_pointer("count", count);
    const auto to = span_of<InstanceLevel>("levels", levels, capacity);
    const std::vector<InstanceLevel> all = object_of(scene).levels_of(instance);
    *count = all.size();
    if (all.size() > capacity)
      throw SmallBuffer{capacity * sizeof(InstanceLevel), all.size() * sizeof(InstanceLevel)};
    std::ranges::copy(all, to.begin());
  });
}

raylanes_status raylanes_scene_describe(const raylanes_scene* scene, raylanes_scene_report* report,
                                        std::size_t size) {
  return status_of([&] {
    const SceneReport of_scene = object_of(scene).report();
    require_pointer("report", report);
    require_options_size(size, sizeof of_scene);
    std::memcpy(report, &of_scene, size);
  });
}

raylanes_status raylanes_scene_normals(const raylanes_scene* scene, const void* hits, std::size_t n,
                                       std::size_t hit_stride, float* normals, std::int32_t threads) {
  return status_of([&] {
    object_of(scene).normals(named_by(hits, n, hit_stride), records_of<Float3>("normals", normals, n),
                             threads);
  });
}

raylanes_status raylanes_scene_corners(const raylanes_scene* scene, const void* hits, std::size_t n,
                                       std::size_t hit_stride, float* corners, std::int32_t threads) {
  return status_of([&] {
    object_of(scene).corners(named_by(hits, n, hit_stride), records_of<Triangle>("corners", corners, n),
                             threads);
  });
}

raylanes_status raylanes_scene_innermost_parts(const raylanes_scene* scene, const void* points, std::size_t n,
                                               std::size_t stride, raylanes_containing_part* parts,
                                               const raylanes_point_options* options) {
  return status_of([&] {
    object_of(scene).innermost_parts(vertices_of("points", points, n, stride),
                                     span_of<ContainingPart>("parts", parts, n),
                                     *PointOptions<LocateOptions>(options));
  });
}

raylanes_status raylanes_scene_containing_parts(const raylanes_scene* scene, const void* points,
                                                std::size_t n, std::size_t stride, raylanes_lists** lists,
                                                const raylanes_point_options* options) {
  return status_of([&] {
    make("lists", lists, [&] {
      return lists_of(object_of(scene).containing_parts(vertices_of("points", points, n, stride),
                                                        *PointOptions<LocateOptions>(options)));
    });
  });
}

}  // extern "C"
}  // namespace raylanes::c::of_scenes
