// Functions that raylanes has nothing for. Each reports RTC_ERROR_INVALID_OPERATION and returns nothing.
#include "geometry.hpp"
#include "scene.hpp"

namespace embree {
namespace {

// Geometries that are refused when they are committed take these settings.
void ignore_setting(RTCGeometry handle) {
  on(handle, [](Geometry& geometry) {
    require_allowed(!geometry.is_supported(), "subdivision surfaces are not supported");
  });
}
unsigned no_half_edge(RTCGeometry handle) {
  on(handle, [](Geometry&) { require_allowed(false, "subdivision surfaces are not supported"); });
  return RTC_INVALID_GEOMETRY_ID;
}
void no_builder() {
  report(nullptr, RTC_ERROR_INVALID_OPERATION, "trees of the caller's own are not supported");
}

}  // namespace
}  // namespace embree

using namespace embree;

RTC_API void rtcSetGeometryTessellationRate(RTCGeometry handle, float) {
  ignore_setting(handle);
}
RTC_API void rtcSetGeometryTopologyCount(RTCGeometry handle, unsigned) {
  ignore_setting(handle);
}
RTC_API void rtcSetGeometrySubdivisionMode(RTCGeometry handle, unsigned, RTCSubdivisionMode) {
  ignore_setting(handle);
}
RTC_API void rtcSetGeometryVertexAttributeTopology(RTCGeometry handle, unsigned, unsigned) {
  ignore_setting(handle);
}
RTC_API void rtcSetGeometryDisplacementFunction(RTCGeometry handle, RTCDisplacementFunctionN) {
  ignore_setting(handle);
}
RTC_API unsigned rtcGetGeometryFirstHalfEdge(RTCGeometry handle, unsigned) {
  return no_half_edge(handle);
}
RTC_API unsigned rtcGetGeometryFace(RTCGeometry handle, unsigned) {
  return no_half_edge(handle);
}
RTC_API unsigned rtcGetGeometryNextHalfEdge(RTCGeometry handle, unsigned) {
  return no_half_edge(handle);
}
RTC_API unsigned rtcGetGeometryPreviousHalfEdge(RTCGeometry handle, unsigned) {
  return no_half_edge(handle);
}
RTC_API unsigned rtcGetGeometryOppositeHalfEdge(RTCGeometry handle, unsigned, unsigned) {
  return no_half_edge(handle);
}
RTC_API void rtcCollide(RTCScene handle, RTCScene, RTCCollideFunc, void*) {
  on(handle, [](Scene&) { require_allowed(false, "rtcCollide is not supported"); });
}
RTC_API RTCBVH rtcNewBVH(RTCDevice handle) {
  on(handle, [](Device&) { require_allowed(false, "trees of the caller's own are not supported"); });
  return nullptr;
}
RTC_API void* rtcBuildBVH(const RTCBuildArguments*) {
  no_builder();
  return nullptr;
}
RTC_API void* rtcThreadLocalAlloc(RTCThreadLocalAllocator, size_t, size_t) {
  no_builder();
  return nullptr;
}
RTC_API void rtcRetainBVH(RTCBVH) {
  no_builder();
}
RTC_API void rtcReleaseBVH(RTCBVH) {
  no_builder();
}
// Embree exports this, too, but declares it nowhere.
RTC_API void rtcMakeStaticBVH(RTCBVH) {
  no_builder();
}
