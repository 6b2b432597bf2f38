// The C functions of scenes of floats.
#include <raylanes/raylanes.h>

#include <raylanes/scene.hpp>

namespace raylanes::c::of_scenes {

using Number = float;
using Tree = Scene;
using PartTree = Bvh;
using AnyTransform = Transform;
using AnyClosestPoint = SceneClosestPoint;
using ClosestOptions = ClosestPointOptions;
using DistanceOptions = SignedDistanceOptions;
using CornersOfTriangle = Triangle;
constexpr const char* kind = "scene";

}  // namespace raylanes::c::of_scenes

#define RAYLANES_HANDLE raylanes_scene
#define RAYLANES_CALL(of_floats, of_doubles, of_scene, of_scene_d) of_scene
#define RAYLANES_SCENE_CALL(of_floats, of_doubles) of_floats
#define RAYLANES_PART raylanes_bvh
#define RAYLANES_RAY raylanes_ray
#define RAYLANES_HIT raylanes_scene_hit
#define RAYLANES_CLOSEST raylanes_scene_closest_point
#define RAYLANES_CROSSING raylanes_scene_crossing
#define RAYLANES_NUMBERS of_scenes
#include "object_calls.hpp"
#include "object_files.hpp"
#include "object_points.hpp"
#include "object_stretches.hpp"
#include "scene_calls.hpp"

namespace raylanes::c::of_scenes {
namespace {

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

static_assert(sizeof(Sphere) == sizeof(raylanes_sphere) && sizeof(Box) == 6 * sizeof(float));
static_assert(sizeof(SceneStretch) == sizeof(raylanes_scene_stretch));

}  // namespace

extern "C" {

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

raylanes_status raylanes_scene_replace_spheres(raylanes_scene* scene, std::uint32_t geometry,
                                               const void* spheres, std::size_t n, std::size_t stride,
                                               const raylanes_build_options* options) {
  return status_of([&] { changed(scene).replace(geometry, spheres_of(spheres, n, stride, options)); });
}

}  // extern "C"
}  // namespace raylanes::c::of_scenes
