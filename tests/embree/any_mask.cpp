// Preloaded before Open3D, whose rays have the mask 0, which hits nothing: gives them all bits.
#include <dlfcn.h>
#include <embree3/rtcore.h>

namespace {

// The function of the Embree that the program has loaded, by any module.
template <class Function>
Function* original(const char* name, Function*) {
  return reinterpret_cast<Function*>(dlsym(dlopen("libembree3.so.3", RTLD_LAZY), name));
}
template <class Ray>
Ray& ray_at(Ray* first, unsigned i, size_t stride) {
  return *reinterpret_cast<Ray*>(reinterpret_cast<char*>(first) + i * stride);
}

}  // namespace

RTC_API void rtcIntersect1M(RTCScene scene, RTCIntersectContext* context, RTCRayHit* rays, unsigned count,
                            size_t stride) {
  static auto* const intersect = original("rtcIntersect1M", &rtcIntersect1M);
  for (unsigned i = 0; i < count; ++i) ray_at(rays, i, stride).ray.mask = ~0u;
  intersect(scene, context, rays, count, stride);
}
RTC_API void rtcOccluded1M(RTCScene scene, RTCIntersectContext* context, RTCRay* rays, unsigned count,
                           size_t stride) {
  static auto* const occluded = original("rtcOccluded1M", &rtcOccluded1M);
  for (unsigned i = 0; i < count; ++i) ray_at(rays, i, stride).mask = ~0u;
  occluded(scene, context, rays, count, stride);
}
