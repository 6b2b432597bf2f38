#include <embree3/rtcore.h>

#include "../rivals.hpp"
#include "embree_layouts.hpp"
#include "plain_scene.hpp"

namespace raylanes::bench {
namespace {

void bound(const RTCBoundsFunctionArguments* a) {
  const Sphere& sphere = static_cast<const Sphere*>(a->geometryUserPtr)[a->primID];
  RTCBounds& box = *a->bounds_o;
  float* const lo = &box.lower_x;
  float* const hi = &box.upper_x;
  for (std::size_t axis = 0; axis < 3; ++axis)
    lo[axis] = sphere.centre[axis] - sphere.radius, hi[axis] = sphere.centre[axis] + sphere.radius;
}
Ray ray_of(const RTCRay& ray) {
  return {{ray.org_x, ray.org_y, ray.org_z}, ray.tnear, {ray.dir_x, ray.dir_y, ray.dir_z}, ray.tfar};
}
void find_nearest(const RTCIntersectFunctionNArguments* a) {
  auto& query = *reinterpret_cast<RTCRayHit*>(a->rayhit);
  Hit hit;
  if (a->valid[0] == 0 ||
      !meets(static_cast<const Sphere*>(a->geometryUserPtr)[a->primID], ray_of(query.ray), hit))
    return;
  query.ray.tfar = hit.t;
  query.hit.geomID = a->geomID, query.hit.primID = a->primID;
}
void find_any(const RTCOccludedFunctionNArguments* a) {
  auto& ray = *reinterpret_cast<RTCRay*>(a->ray);
  Hit hit;
  if (a->valid[0] != 0 && meets(static_cast<const Sphere*>(a->geometryUserPtr)[a->primID], ray_of(ray), hit))
    ray.tfar = -infinity;
}

RTCGeometry sphere_points(RTCDevice device, std::span<const Sphere> spheres) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  static_assert(sizeof(Sphere) == 4 * sizeof(float));
  void* const buffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                               sizeof(Sphere), spheres.size());
  if (buffer != nullptr) std::memcpy(buffer, spheres.data(), spheres.size_bytes());
  return geometry;
}
RTCGeometry own_spheres(RTCDevice device, std::span<const Sphere> spheres) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(spheres.size()));
  rtcSetGeometryUserData(geometry, const_cast<Sphere*>(spheres.data()));
  rtcSetGeometryBoundsFunction(geometry, bound, nullptr);
  rtcSetGeometryIntersectFunction(geometry, find_nearest);
  rtcSetGeometryOccludedFunction(geometry, find_any);
  return geometry;
}

template <class Packet, std::size_t lanes, class Result>
void trace_by(RTCScene scene, std::span<const Ray> rays, std::span<Result> results) {
  const SubnormalsAreZero subnormals;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for_each_packet<lanes>(rays, results, [&](const Ray* some, Result* out) {
    Packet packet;
    packet.lay_out(some), packet.trace(scene, context), packet.write(out);
  });
}

}  // namespace

struct EmbreeSpheres::Scene {
  PlainScene plain;

  Scene(std::span<const Sphere> spheres, bool are_own)
      : plain([&](RTCDevice device) {
          return are_own ? own_spheres(device, spheres) : sphere_points(device, spheres);
        }) {}
};

EmbreeSpheres::EmbreeSpheres(std::span<const Sphere> spheres, bool are_own)
    : scene_(std::make_unique<Scene>(spheres, are_own)) {}
EmbreeSpheres::~EmbreeSpheres() = default;

void EmbreeSpheres::closest(std::span<const Ray> rays, std::span<Hit> hits, bool in_packets) const {
  in_packets ? trace_by<ClosestPacket<Width16>, 16>(scene_->plain.get(), rays, hits)
             : trace_by<ClosestRay, 1>(scene_->plain.get(), rays, hits);
}
void EmbreeSpheres::occluded(std::span<const Ray> rays, std::span<std::uint8_t> flags,
                             bool in_packets) const {
  in_packets ? trace_by<AnyPacket<Width16>, 16>(scene_->plain.get(), rays, flags)
             : trace_by<AnyRay, 1>(scene_->plain.get(), rays, flags);
}

}  // namespace raylanes::bench
