// Null handles, null pointers, what is not supported: errors, but no crash. Ours alone; Embree ends programs for less.
#include <dlfcn.h>

#include <utility>

#include "calls.hpp"

void show(const char*, RTCScene, const RTCRayHit&) {}

namespace {

int failures = 0;
void expect(const char* what, RTCDevice of, RTCError code) {
  const RTCError found = rtcGetDeviceError(of);
  if (found == code) return;
  std::printf("%s: error %d, not %d\n", what, static_cast<int>(found), static_cast<int>(code));
  ++failures;
}

void null_handles() {
  const auto refused = [](const char* what, auto&& call) {
    call();
    expect(what, nullptr, RTC_ERROR_INVALID_ARGUMENT);
  };
  RTCRayHit ray = ray_of({}, {});
  refused("retain a device", [] { rtcRetainDevice(nullptr); });
  refused("release a device", [] { rtcReleaseDevice(nullptr); });
  refused("a property", [] { rtcGetDeviceProperty(nullptr, RTC_DEVICE_PROPERTY_VERSION); });
  refused("a buffer", [] { rtcNewBuffer(nullptr, 9); });
  refused("data", [] { rtcGetBufferData(nullptr); });
  refused("a geometry", [] { rtcNewGeometry(nullptr, RTC_GEOMETRY_TYPE_TRIANGLE); });
  refused("a commit of a geometry", [] { rtcCommitGeometry(nullptr); });
  refused("a mask", [] { rtcSetGeometryMask(nullptr, 1); });
  refused("a scene", [] { rtcNewScene(nullptr); });
  refused("to attach", [] { rtcAttachGeometry(nullptr, nullptr); });
  refused("a commit of a scene", [] { rtcCommitScene(nullptr); });
  refused("a ray", [&] { rtcIntersect1(nullptr, &context, &ray); });
  refused("a shadow", [&] { rtcOccluded1(nullptr, &context, &ray.ray); });
  refused("a packet", [] { rtcIntersect4(nullptr, nullptr, nullptr, nullptr); });
  refused("a point", [] { rtcPointQuery(nullptr, nullptr, nullptr, nullptr, nullptr); });
  refused("values", [] { rtcInterpolate(nullptr); });
  refused("more values", [] { rtcInterpolateN(nullptr); });
  refused("a filter", [] { rtcFilterIntersection(nullptr, nullptr); });
}

void null_pointers() {
  const auto refused = [](const char* what, auto&& call) {
    call();
    expect(what, device, RTC_ERROR_INVALID_ARGUMENT);
  };
  RTCScene scene = scene_of({});
  RTCGeometry mesh = triangles_of(unit_triangle),
              instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  RTCRayHit ray = ray_of({}, {});
  refused("no context", [&] { rtcIntersect1(scene, nullptr, &ray); });
  refused("no ray", [&] { rtcOccluded1(scene, &context, nullptr); });
  refused("no packet", [&] { rtcIntersect16(nullptr, scene, &context, nullptr); });
  refused("no stream", [&] { rtcOccluded1M(scene, &context, nullptr, 3, 64); });
  refused("no bounds", [&] { rtcGetSceneBounds(scene, nullptr); });
  refused("no query", [&] { rtcPointQuery(scene, nullptr, nullptr, nullptr, nullptr); });
  refused("no vertices", [&] {
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, nullptr, 0, 12, 3);
  });
  refused("no matrix", [&] { rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, nullptr); });
  refused("no rotation", [&] { rtcSetGeometryTransformQuaternion(instance, 0, nullptr); });
  refused("no scene to show", [&] { rtcSetGeometryInstancedScene(instance, nullptr); });
  refused("no geometry", [&] { rtcAttachGeometry(scene, nullptr); });
  refused("a type", [] { rtcNewGeometry(device, static_cast<RTCGeometryType>(99)); });
  refused("a property", [] { rtcGetDeviceProperty(device, static_cast<RTCDeviceProperty>(9)); });
  rtcNewBuffer(device, ~std::size_t{0});
  expect("too large a buffer", device, RTC_ERROR_OUT_OF_MEMORY);
  rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, std::size_t{1} << 40, 1u << 31);
  expect("too large vertices", device, RTC_ERROR_OUT_OF_MEMORY);
}

// Kinds that are not supported take their buffers, and say so at their commit.
void unsupported_kinds() {
  RTCGeometry curve = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE);
  fill(curve, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 16, std::vector<float>(16));
  fill(curve, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, 4, std::vector<unsigned>(1));
  expect("buffers of a curve", device, RTC_ERROR_NONE);
  RTCScene scene = scene_of({curve, triangles_of(unit_triangle)});
  expect("a curve", device, RTC_ERROR_INVALID_OPERATION);
  RTCRayHit ray = ray_of({.25f, .25f, 1}, {0, 0, -1});
  rtcIntersect1(scene, &context, &ray);
  if (ray.hit.geomID != 1) std::printf("a triangle beside a curve is missed\n"), ++failures;
  RTCGeometry moving = triangles_of(unit_triangle);
  rtcSetGeometryTimeStepCount(moving, 2);
  rtcCommitGeometry(moving);
  expect("motion blur", device, RTC_ERROR_INVALID_OPERATION);
  const float here[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  ray = ray_of({.25f, .25f, 1}, {0, 0, -1});
  rtcIntersect1(scene_of({instance_of(scene_of({instance_of(scene, here)}), here)}), &context, &ray);
  if (ray.hit.geomID != RTC_INVALID_GEOMETRY_ID)
    std::printf("an instance in an instance is hit\n"), ++failures;
  rtcCollide(scene, scene, nullptr, nullptr);
  expect("collisions", device, RTC_ERROR_INVALID_OPERATION);
}

// The error function hears of each error, and the memory monitor in the end of as much freed as taken.
void monitors() {
  struct Heard {
    long bytes = 0, most = 0;
    std::vector<int> errors;
  } heard;
  RTCDevice watched = rtcNewDevice("threads=2, verbose=0");
  rtcSetDeviceErrorFunction(
      watched, [](void* to, RTCError code, const char*) { static_cast<Heard*>(to)->errors.push_back(code); },
      &heard);
  rtcSetDeviceMemoryMonitorFunction(
      watched,
      [](void* to, ssize_t bytes, bool) {
        auto& all = *static_cast<Heard*>(to);
        all.bytes += bytes, all.most = std::max(all.most, all.bytes);
        return all.bytes < 100000;
      },
      &heard);
  RTCDevice other = std::exchange(device, watched);
  RTCScene scene =
      scene_of({triangles_of(unit_triangle), points_of(RTC_GEOMETRY_TYPE_SPHERE_POINT, {0, 0, 0, 1})});
  if (heard.most < 64) std::printf("a scene of %ld bytes\n", heard.most), ++failures;
  rtcNewBuffer(watched, 1000000);
  rtcDetachGeometry(scene, 9);
  if (heard.errors != std::vector<int>{RTC_ERROR_OUT_OF_MEMORY, RTC_ERROR_INVALID_OPERATION})
    std::printf("%zu errors heard\n", heard.errors.size()), ++failures;
  expect("the first error", watched, RTC_ERROR_OUT_OF_MEMORY);
  expect("no second error", watched, RTC_ERROR_NONE);
  rtcReleaseScene(scene);
  device = other;
  if (heard.bytes != 1000000) std::printf("%ld bytes are left\n", heard.bytes), ++failures;
  rtcReleaseDevice(watched);
}

}  // namespace

int main() {
  Dl_info library{};
  dladdr(reinterpret_cast<void*>(&rtcNewDevice), &library);
  std::printf("%s\n", library.dli_fname);
  if (std::strstr(library.dli_fname, "/embree/libembree3.so") == nullptr) return 1;
  null_handles();
  null_pointers();
  unsupported_kinds();
  monitors();
  std::printf("%d failures\n", failures);
  return failures == 0 ? 0 : 1;
}
