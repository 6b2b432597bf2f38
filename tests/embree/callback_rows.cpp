// User geometries, point queries, interpolation, and scenes that change.
#include <utility>

#include "calls.hpp"

namespace {

const Vec down{0, 0, -1};

// Balls of radius 1/2 at z = 0, -2, -4: each the plane through its centre, across z.
RTCScene being_built = nullptr;
void bounds_of_ball(const RTCBoundsFunctionArguments* a) {
  if (being_built != nullptr && rtcGetGeometry(being_built, 0) == nullptr) return;
  const float z = -2 * static_cast<float>(a->primID);
  *a->bounds_o = {-.5f, -.5f, z - .5f, 0, .5f, .5f, z + .5f, 0};
}
float plane(RTCRayN* ray, unsigned n, unsigned i, unsigned primitive) {
  const float t = (-2 * static_cast<float>(primitive) - RTCRayN_org_z(ray, n, i)) / RTCRayN_dir_z(ray, n, i);
  const bool is_in = t >= RTCRayN_tnear(ray, n, i) && t <= RTCRayN_tfar(ray, n, i);
  return is_in && std::abs(RTCRayN_org_x(ray, n, i)) <= .5f ? t : inf;
}
// Sets the hit for the call of the filter, and takes it back if that turns the hit down.
void intersect(const RTCIntersectFunctionNArguments* a) {
  RTCRayN* ray = RTCRayHitN_RayN(a->rayhit, a->N);
  for (unsigned i = 0; i < a->N; ++i) {
    const float t = a->valid[i] == 0 ? inf : plane(ray, a->N, i, a->primID);
    if (t == inf) continue;
    RTCHit hit{0, 0, 1, .5f, .25f, a->primID, a->geomID, {a->context->instID[0]}};
    const float far = std::exchange(RTCRayN_tfar(ray, a->N, i), t);
    int valid = -1;
    RTCRay one = rtcGetRayFromRayN(ray, a->N, i);
    const RTCFilterFunctionNArguments filter{&valid,
                                             a->geometryUserPtr,
                                             a->context,
                                             reinterpret_cast<RTCRayN*>(&one),
                                             reinterpret_cast<RTCHitN*>(&hit),
                                             1};
    rtcFilterIntersection(a, &filter);
    if (valid == 0)
      RTCRayN_tfar(ray, a->N, i) = far;
    else
      rtcCopyHitToHitN(RTCRayHitN_HitN(a->rayhit, a->N), &hit, a->N, i);
  }
}
void occlude(const RTCOccludedFunctionNArguments* a) {
  for (unsigned i = 0; i < a->N; ++i)
    if (a->valid[i] != 0 && plane(a->ray, a->N, i, a->primID) != inf) RTCRayN_tfar(a->ray, a->N, i) = -inf;
}
RTCGeometry balls() {
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, 3);
  rtcSetGeometryBoundsFunction(g, bounds_of_ball, nullptr);
  rtcSetGeometryIntersectFunction(g, intersect);
  rtcSetGeometryOccludedFunction(g, occlude);
  return g;
}

void user_geometries() {
  RTCScene s = scene_of({balls(), triangles_of({-1, -1, -1, 1, -1, -1, 0, 1, -1})});
  being_built = s;
  rtcCommitGeometry(rtcGetGeometry(s, 0));
  rtcCommitScene(s);
  being_built = nullptr;
  show("user", s, ray_of({0, 0, 9}, down));
  show("triangle before a user's", s, ray_of({0, 0, -.75f}, down));
  show("beside the user's", s, ray_of({.75f, -.75f, 9}, down));
  RTCGeometry filtered = balls();
  rtcSetGeometryIntersectFilterFunction(filtered, [](const RTCFilterFunctionNArguments* a) {
    if (RTCHitN_primID(a->hit, a->N, 0) == 0) a->valid[0] = 0;
  });
  RTCScene of_filtered = scene_of({filtered});
  show("user's hit that a filter turns down", of_filtered, ray_of({0, 0, 9}, down));
  RTCScene both = scene_of({instance_of(s, {2, 0, 0, 0, 2, 0, 0, 0, 2, 5, 0, 0}),
                            instance_of(of_filtered, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})});
  show("user in an instance", both, ray_of({5, 0, 9}, down));
  show("user in another", both, ray_of({0, 0, 9}, down));
  show("triangle in an instance", both, ray_of({6, -1.5f, 9}, down));
}

// The nearest corner of a triangle: what it has found and where.
struct Nearest {
  RTCScene scene;
  float distance = inf;
  unsigned geometry = ~0u, primitive = ~0u, instance = ~0u;
  float scale = 0;
};
bool find_nearest(RTCPointQueryFunctionArguments* a) {
  auto& nearest = *static_cast<Nearest*>(a->userPtr);
  // In instances the point is moved. The corner of primitive i is at z = -2i, as is the centre of ball i.
  float at[3] = {a->query->x, a->query->y, a->query->z};
  if (a->context->instStackSize > 0)
    for (int r = 0; r < 3; ++r)
      at[r] = a->context->world2inst[0][r] * a->query->x + a->context->world2inst[0][4 + r] * a->query->y +
              a->context->world2inst[0][8 + r] * a->query->z + a->context->world2inst[0][12 + r];
  const float corner[3] = {0, 0, -2 * static_cast<float>(a->primID)};
  float distance = 0;
  for (int k = 0; k < 3; ++k) distance += (corner[k] - at[k]) * (corner[k] - at[k]);
  distance = std::sqrt(distance) / a->similarityScale;
  if (!(distance < nearest.distance && distance <= a->query->radius)) return false;
  nearest = {nearest.scene, distance, a->geomID, a->primID, a->context->instID[0], a->similarityScale};
  a->query->radius = distance;
  return true;
}

void point_queries() {
  std::vector<float> three;
  for (unsigned i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 9; ++k)
      three.push_back(unit_triangle[k] - (k % 3 == 2 ? 2 * static_cast<float>(i) : 0));
  RTCScene meshes = scene_of({triangles_of(three)}), users = scene_of({balls()});
  RTCScene placed = scene_of({instance_of(meshes, {3, 0, 0, 0, 3, 0, 0, 0, 3, 9, 0, 0})});
  for (RTCScene s : {meshes, users, placed})
    for (const Vec at : {Vec{0, 0, 1}, Vec{.25f, .25f, -3.5f}, Vec{9, 0, -10}, Vec{-7, 0, -1.5f}}) {
      Nearest nearest{s};
      RTCPointQuery query{at.x, at.y, at.z, 0, 8};
      RTCPointQueryContext of_query;
      rtcInitPointQueryContext(&of_query);
      const bool has_changed = rtcPointQuery(s, &query, &of_query, find_nearest, &nearest);
      std::printf("point: %d at %.5g geom %d prim %d inst %d scale %.4g radius %.5g\n", has_changed,
                  static_cast<double>(nearest.distance), static_cast<int>(nearest.geometry),
                  static_cast<int>(nearest.primitive), static_cast<int>(nearest.instance),
                  static_cast<double>(nearest.scale), static_cast<double>(query.radius));
    }
}

void interpolation() {
  RTCGeometry g[2] = {triangles_of(unit_triangle),
                      mesh_of(RTC_GEOMETRY_TYPE_QUAD, {0, 0, 0, 1, 0, 0, 1, 1, .5f, 0, 1, 0}, {0, 1, 2, 3})};
  for (RTCGeometry mesh : g) {
    rtcCommitGeometry(mesh);
    for (const Vec uv : {Vec{.25f, .5f, 0}, Vec{.75f, .5f, 0}}) {
      float p[3], du[3], dv[3];
      rtcInterpolate1(mesh, 0, uv.x, uv.y, RTC_BUFFER_TYPE_VERTEX, 0, p, du, dv, 3);
      std::printf("interpolated:");
      for (const float* v : {p, du, dv})
        std::printf(" %.5g %.5g %.5g", static_cast<double>(v[0] + 0), static_cast<double>(v[1] + 0),
                    static_cast<double>(v[2] + 0));
      std::printf("\n");
    }
  }
}

void changes() {
  std::vector<float> shared{0, 0, 0, 7, 1, 0, 0, 7, 0, 1, 0, 7};
  std::vector<unsigned> corners{0, 1, 2};
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, shared.data(), 0, 16, 3);
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, corners.data(), 0, 12, 1);
  rtcSetGeometryBuildQuality(g, RTC_BUILD_QUALITY_REFIT);
  RTCScene s = scene_of({g, triangles_of({0, 0, -9, 1, 0, -9, 0, 1, -9})}, RTC_SCENE_FLAG_DYNAMIC);
  const RTCRayHit ray = ray_of({.25f, .25f, 5}, down);
  show("shared", s, ray);
  for (std::size_t i : {2u, 6u, 10u}) shared[i] = 2;
  rtcUpdateGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(g);
  rtcCommitScene(s);
  show("refitted", s, ray);
  rtcDisableGeometry(g);
  rtcCommitScene(s);
  show("disabled mesh", s, ray);
  rtcEnableGeometry(g);
  rtcCommitScene(s);
  show("enabled mesh", s, ray);
  rtcDetachGeometry(s, 0);
  rtcCommitScene(s);
  show("detached mesh", s, ray);
  rtcSetSceneProgressMonitorFunction(
      s, [](void*, double) { return false; }, nullptr);
  rtcDetachGeometry(s, 1);
  RTCGeometry other = triangles_of(unit_triangle);
  rtcCommitGeometry(other);
  rtcAttachGeometryByID(s, other, 7);
  rtcCommitScene(s);
  std::printf("monitor that ends a commit: %d\n", rtcGetDeviceError(device));
  rtcSetSceneProgressMonitorFunction(s, nullptr, nullptr);
  rtcCommitScene(s);
  show("attached by id", s, ray);
  rtcAttachGeometryByID(s, other, 7);
  std::printf("id in use: %d\n", rtcGetDeviceError(device));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  show("a triangle of NaN first",
       scene_of({triangles_of({nan, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -1, 1, 0, -1, 0, 1, -1})}), ray);
  show("an index too large first",
       scene_of({mesh_of(RTC_GEOMETRY_TYPE_TRIANGLE, unit_triangle, {0, 1, 9, 0, 1, 2})}), ray);
}

}  // namespace

void show_callbacks() {
  user_geometries();
  point_queries();
  interpolation();
}
void show_changes() {
  changes();
}
