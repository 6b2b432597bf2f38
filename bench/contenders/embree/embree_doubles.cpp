#include <embree3/rtcore.h>

#include "../rivals.hpp"
#include "plain_scene.hpp"

namespace raylanes::bench {
namespace {

using oracle::DoubleMesh;

Double3 minus(const Double3& a, const Double3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const Double3& a, const Double3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// On which side of an edge the line is: of both triangles there with the same roundings.
double edge_side(const Double3& direction, const Double3& p, const Double3& q) {
  return p < q ? dot(direction, cross(p, q)) : -dot(direction, cross(q, p));
}

// The ray that Embree is given, with that of doubles behind it.
struct Query {
  RTCRayHit floats;
  const RayD* ray;
  HitD best;
};
Query query_of(const RayD& ray) {
  Query query{{}, &ray, {}};
  RTCRay& of_floats = query.floats.ray;
  const auto round = [](double x) { return static_cast<float>(x); };
  of_floats.org_x = round(ray.origin[0]), of_floats.org_y = round(ray.origin[1]);
  of_floats.org_z = round(ray.origin[2]), of_floats.tnear = 0;
  of_floats.dir_x = round(ray.direction[0]), of_floats.dir_y = round(ray.direction[1]);
  of_floats.dir_z = round(ray.direction[2]), of_floats.mask = ~0u;
  of_floats.tfar = std::nextafter(round(ray.tmax), std::numeric_limits<float>::infinity());
  query.floats.hit.geomID = query.floats.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  query.best.t = ray.tmax;
  return query;
}

HitD hit_of(const RayD& ray, const DoubleMesh& mesh, std::uint32_t triangle) {
  const Index3& corners = mesh.triangles[triangle];
  Double3 at[3];
  for (std::size_t k = 0; k < 3; ++k) at[k] = minus(mesh.vertices[corners[k]], ray.origin);
  const double u = edge_side(ray.direction, at[2], at[0]), v = edge_side(ray.direction, at[0], at[1]),
               w = edge_side(ray.direction, at[1], at[2]), sum = u + v + w;
  if (((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) || sum == 0) return {};
  const Double3 normal = cross(minus(at[1], at[0]), minus(at[2], at[0]));
  return {dot(normal, at[0]) / dot(normal, ray.direction), u / sum, v / sum, triangle, 0};
}

// rtcOccluded1 passes a ray, rtcIntersect1 a ray and a hit; the ray comes first in both.
Query& query_after(RTCRayN* ray) {
  return *reinterpret_cast<Query*>(ray);
}
void keep_nearest(const RTCIntersectFunctionNArguments* arguments) {
  Query& query = query_after(reinterpret_cast<RTCRayN*>(arguments->rayhit));
  const auto& mesh = *static_cast<const DoubleMesh*>(arguments->geometryUserPtr);
  const HitD hit = hit_of(*query.ray, mesh, arguments->primID);
  if (!hit || !(hit.t >= query.ray->tmin && hit.t <= query.best.t)) return;
  query.best = hit;
  query.floats.ray.tfar = std::nextafter(static_cast<float>(hit.t), std::numeric_limits<float>::infinity());
  query.floats.hit.geomID = arguments->geomID, query.floats.hit.primID = arguments->primID;
}
void find_any(const RTCOccludedFunctionNArguments* arguments) {
  Query& query = query_after(arguments->ray);
  const auto& mesh = *static_cast<const DoubleMesh*>(arguments->geometryUserPtr);
  const HitD hit = hit_of(*query.ray, mesh, arguments->primID);
  if (hit && hit.t >= query.ray->tmin && hit.t <= query.ray->tmax)
    query.floats.ray.tfar = -std::numeric_limits<float>::infinity();
}

void box_of(const RTCBoundsFunctionArguments* arguments) {
  const auto& mesh = *static_cast<const DoubleMesh*>(arguments->geometryUserPtr);
  double largest = 0;
  for (const std::uint32_t corner : mesh.triangles[arguments->primID])
    for (const double x : mesh.vertices[corner]) largest = std::max(largest, std::fabs(x));
  const double wider = 0x1p-22 * largest;
  float lo[3], hi[3];
  for (std::size_t k = 0; k < 3; ++k) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const std::uint32_t corner : mesh.triangles[arguments->primID]) {
      least = std::min(least, mesh.vertices[corner][k]), most = std::max(most, mesh.vertices[corner][k]);
    }
    lo[k] = static_cast<float>(least - wider), hi[k] = static_cast<float>(most + wider);
  }
  RTCBounds& box = *arguments->bounds_o;
  box.lower_x = lo[0], box.lower_y = lo[1], box.lower_z = lo[2];
  box.upper_x = hi[0], box.upper_y = hi[1], box.upper_z = hi[2];
}

}  // namespace

struct EmbreeDoubles::Scene {
  PlainScene scene;

  explicit Scene(const DoubleMesh& mesh)
      : scene(
            [&](RTCDevice device) {
              const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
              rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(mesh.triangles.size()));
              rtcSetGeometryUserData(geometry, const_cast<DoubleMesh*>(&mesh));
              rtcSetGeometryBoundsFunction(geometry, box_of, nullptr);
              rtcSetGeometryIntersectFunction(geometry, keep_nearest);
              rtcSetGeometryOccludedFunction(geometry, find_any);
              return geometry;
            },
            RTC_SCENE_FLAG_ROBUST) {}
};

EmbreeDoubles::EmbreeDoubles(const DoubleMesh& mesh) : scene_(std::make_unique<Scene>(mesh)) {}
EmbreeDoubles::~EmbreeDoubles() = default;

void EmbreeDoubles::closest(std::span<const RayD> rays, std::span<HitD> hits) const {
  const SubnormalsAreZero subnormals;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    Query query = query_of(rays[i]);
    rtcIntersect1(scene_->scene.get(), &context, &query.floats);
    hits[i] = query.best ? query.best : HitD{};
  }
}
void EmbreeDoubles::occluded(std::span<const RayD> rays, std::span<std::uint8_t> occluded) const {
  const SubnormalsAreZero subnormals;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    Query query = query_of(rays[i]);
    rtcOccluded1(scene_->scene.get(), &context, &query.floats.ray);
    occluded[i] = query.floats.ray.tfar < 0 ? 1 : 0;
  }
}

}  // namespace raylanes::bench
