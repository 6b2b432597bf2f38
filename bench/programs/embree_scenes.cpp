#include "embree_scenes.hpp"

#include "../support/rays/aim.hpp"
#include "../support/scenes/splitmix.hpp"

namespace raylanes::bench {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

EmbreeScene new_scene(RTCDevice device, RTCSceneFlags flags = RTC_SCENE_FLAG_NONE) {
  const RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, flags);
  return {scene, rtcReleaseScene};
}

EmbreeScene scene_of(RTCDevice device, RTCGeometry geometry) {
  EmbreeScene scene = new_scene(device);
  attach(scene.get(), geometry);
  rtcCommitScene(scene.get());
  return scene;
}

void bounds_of_ball(const RTCBoundsFunctionArguments* a) {
  const auto& [x, y, z, r] = static_cast<const Balls*>(a->geometryUserPtr)->at(a->primID);
  *a->bounds_o = {x - r, y - r, z - r, 0, x + r, y + r, z + r, 0};
}

// The distance at which a ray enters a ball, or leaves it if it begins within; NaN beside it.
float distance_of(const RTCRay& ray, const std::array<float, 4>& ball) {
  const float x = ray.org_x - ball[0], y = ray.org_y - ball[1], z = ray.org_z - ball[2];
  const float a = ray.dir_x * ray.dir_x + ray.dir_y * ray.dir_y + ray.dir_z * ray.dir_z;
  const float b = x * ray.dir_x + y * ray.dir_y + z * ray.dir_z;
  const float root = std::sqrt(b * b - a * (x * x + y * y + z * z - ball[3] * ball[3]));
  const float t = (-b - root) / a;
  return t < ray.tnear ? (-b + root) / a : t;
}
bool is_within(const RTCRay& ray, float t) {
  return t > ray.tnear && t < ray.tfar;
}

void intersect_ball(const RTCIntersectFunctionNArguments* a) {
  auto& [ray, hit] = *reinterpret_cast<RTCRayHit*>(a->rayhit);
  const float t = distance_of(ray, static_cast<const Balls*>(a->geometryUserPtr)->at(a->primID));
  if (a->valid[0] == 0 || !is_within(ray, t)) return;
  ray.tfar = t;
  hit.geomID = a->geomID, hit.primID = a->primID, hit.instID[0] = a->context->instID[0];
}
void occlude_ball(const RTCOccludedFunctionNArguments* a) {
  auto& ray = *reinterpret_cast<RTCRay*>(a->ray);
  const float t = distance_of(ray, static_cast<const Balls*>(a->geometryUserPtr)->at(a->primID));
  if (a->valid[0] != 0 && is_within(ray, t)) ray.tfar = -infinity;
}

}  // namespace

SharedMesh::SharedMesh(const Mesh& mesh) : vertices(mesh.vertices), triangles(mesh.triangles) {
  vertices.push_back({});
}

RTCGeometry triangles_of(RTCDevice device, SharedMesh& mesh, std::size_t first, std::size_t count) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.vertices.data(), 0,
                             sizeof(Float3), mesh.vertices.size() - 1);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(),
                             first * sizeof(Index3), sizeof(Index3), count);
  return geometry;
}

void attach(RTCScene scene, RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

EmbreeScene scene_of_meshes(RTCDevice device, SharedMesh& mesh, std::size_t parts, RTCSceneFlags flags,
                            bool are_dynamic) {
  EmbreeScene scene = new_scene(device, flags);
  const std::size_t size = mesh.triangles.size();
  for (std::size_t i = 0; i < parts; ++i) {
    const std::size_t first = i * size / parts, end = (i + 1) * size / parts;
    const RTCGeometry geometry = triangles_of(device, mesh, first, end - first);
    if (are_dynamic) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
    attach(scene.get(), geometry);
  }
  rtcCommitScene(scene.get());
  return scene;
}

EmbreeScene scene_of_instances(RTCDevice device, RTCScene inner, const Box& bounds, std::size_t side) {
  EmbreeScene scene = new_scene(device);
  const float share = 1.0f / static_cast<float>(side);
  for (std::size_t i = 0; i < side * side * side; ++i) {
    const RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, inner);
    const std::size_t cell[3] = {i % side, i / side % side, i / side / side};
    float columns[12] = {share, 0, 0, 0, share, 0, 0, 0, share};
    for (std::size_t k = 0; k < 3; ++k)
      columns[9 + k] =
          bounds.lo[k] * (1 - share) + static_cast<float>(cell[k]) * share * (bounds.hi[k] - bounds.lo[k]);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    attach(scene.get(), instance);
  }
  rtcCommitScene(scene.get());
  return scene;
}

EmbreeScene scene_of_filter(RTCDevice device, SharedMesh& mesh, RTCFilterFunctionN filter) {
  const RTCGeometry geometry = triangles_of(device, mesh, 0, mesh.triangles.size());
  rtcSetGeometryIntersectFilterFunction(geometry, filter);
  rtcSetGeometryOccludedFilterFunction(geometry, filter);
  return scene_of(device, geometry);
}
void keep_all(const RTCFilterFunctionNArguments*) {}
void reject_odd(const RTCFilterFunctionNArguments* a) {
  for (unsigned i = 0; i < a->N; ++i)
    if (RTCHitN_primID(a->hit, a->N, i) % 2 == 1) a->valid[i] = 0;
}

Balls balls_in(const Box& bounds, std::size_t count) {
  constexpr std::uint64_t seed = 11;
  SplitMix random(seed);
  Balls balls(count + 1);  // one more than there are, as Embree reads beyond the last
  for (auto& ball : balls) {
    for (std::size_t k = 0; k < 3; ++k)
      ball[k] = static_cast<float>(between(random, bounds.lo[k], bounds.hi[k]));
    ball[3] = 0.01f * (bounds.hi[0] - bounds.lo[0]);
  }
  return balls;
}
EmbreeScene scene_of_spheres(RTCDevice device, Balls& balls) {
  const RTCGeometry spheres = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  rtcSetSharedGeometryBuffer(spheres, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, balls.data(), 0,
                             sizeof(balls[0]), balls.size() - 1);
  return scene_of(device, spheres);
}
EmbreeScene scene_of_user_balls(RTCDevice device, Balls& balls) {
  const RTCGeometry user = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(user, static_cast<unsigned>(balls.size() - 1));
  rtcSetGeometryUserData(user, &balls);
  rtcSetGeometryBoundsFunction(user, bounds_of_ball, nullptr);
  rtcSetGeometryIntersectFunction(user, intersect_ball);
  rtcSetGeometryOccludedFunction(user, occlude_ball);
  return scene_of(device, user);
}

}  // namespace raylanes::bench
