// Geometries: kinds, commits, callbacks.
#include "geometry.hpp"

#include <algorithm>
#include <array>

#include "scene.hpp"

namespace embree {

Geometry::Geometry(Device& of_device, RTCGeometryType of_type) : device(&of_device), type(of_type) {}
Geometry::~Geometry() = default;

std::uint32_t Geometry::primitive_count() const {
  if (is_user()) return user_count;
  if (is_instance()) return 1;
  const BufferView* items = nullptr;
  if (is_points())
    items = find(RTC_BUFFER_TYPE_VERTEX);
  else if (is_mesh())
    items = find(type == RTC_GEOMETRY_TYPE_GRID ? RTC_BUFFER_TYPE_GRID : RTC_BUFFER_TYPE_INDEX);
  return items == nullptr ? 0 : static_cast<std::uint32_t>(items->count);
}

namespace {

constexpr std::array curves{15, 16, 17, 24, 25, 26, 32, 33, 34, 40, 41, 42, 58, 59, 60};

bool exists(RTCGeometryType type) {
  const bool is_curve = std::find(curves.begin(), curves.end(), static_cast<int>(type)) != curves.end();
  return is_curve || type == RTC_GEOMETRY_TYPE_SUBDIVISION ||
         (type >= RTC_GEOMETRY_TYPE_TRIANGLE && type <= RTC_GEOMETRY_TYPE_GRID) ||
         (type >= RTC_GEOMETRY_TYPE_SPHERE_POINT && type <= RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT) ||
         type == RTC_GEOMETRY_TYPE_USER || type == RTC_GEOMETRY_TYPE_INSTANCE;
}

void commit(Geometry& geometry) {
  ++geometry.version, geometry.is_dirty = false;
  const bool takes_all = geometry.device->takes_unsupported;
  require_allowed(takes_all || geometry.is_supported(),
                  "curves and subdivision surfaces are not supported: this geometry is empty");
  require_allowed(takes_all || geometry.time_steps == 1,
                  "motion blur is not supported: the first time step is used");
  if (!geometry.is_mesh()) return;
  const BufferView* vertices = geometry.find(RTC_BUFFER_TYPE_VERTEX);
  for (const auto& [kind, view] : geometry.buffers)
    require_allowed(
        kind.first != RTC_BUFFER_TYPE_VERTEX || (vertices != nullptr && view.count == vertices->count),
        "stride or size of vertex buffers differ");
}

// Changes a geometry, which then wants a commit.
template <class F>
void change(RTCGeometry handle, F&& f) {
  on(handle, [&](Geometry& geometry) { f(geometry), geometry.is_dirty = true; });
}
template <class F>
void change_user(RTCGeometry handle, F&& f) {
  change(handle, [&](Geometry& geometry) {
    require_allowed(geometry.is_user(), "operation only allowed for user geometries");
    f(geometry);
  });
}

}  // namespace
}  // namespace embree

using namespace embree;

RTC_API RTCGeometry rtcNewGeometry(RTCDevice handle, RTCGeometryType type) {
  return on(handle, [&](Device& device) {
    require(exists(type), "invalid geometry type");
    return reinterpret_cast<RTCGeometry>(new Geometry(device, type));
  });
}
RTC_API void rtcRetainGeometry(RTCGeometry handle) {
  on(handle, [](Geometry& geometry) { geometry.retain(); });
}
RTC_API void rtcReleaseGeometry(RTCGeometry handle) {
  on(handle, [](Geometry& geometry) { geometry.release(); });
}
RTC_API void rtcCommitGeometry(RTCGeometry handle) {
  on(handle, commit);
}
RTC_API void rtcEnableGeometry(RTCGeometry handle) {
  on(handle, [](Geometry& geometry) { geometry.version += !std::exchange(geometry.is_enabled, true); });
}
RTC_API void rtcDisableGeometry(RTCGeometry handle) {
  on(handle, [](Geometry& geometry) { geometry.version += std::exchange(geometry.is_enabled, false); });
}
RTC_API void rtcSetGeometryTimeStepCount(RTCGeometry handle, unsigned count) {
  change(handle, [&](Geometry& geometry) {
    require_allowed(count > 0 && count <= RTC_MAX_TIME_STEP_COUNT, "number of time steps out of range");
    geometry.time_steps = count;
  });
}
RTC_API void rtcSetGeometryTimeRange(RTCGeometry handle, float, float) {
  on(handle, [](Geometry&) {});
}
RTC_API void rtcSetGeometryVertexAttributeCount(RTCGeometry handle, unsigned) {
  on(handle, [](Geometry&) {});
}
RTC_API void rtcSetGeometryMask(RTCGeometry handle, unsigned mask) {
  change(handle, [&](Geometry& geometry) { geometry.mask = mask; });
}
RTC_API void rtcSetGeometryBuildQuality(RTCGeometry handle, RTCBuildQuality quality) {
  change(handle, [&](Geometry& geometry) {
    require(quality >= RTC_BUILD_QUALITY_LOW && quality <= RTC_BUILD_QUALITY_REFIT, "invalid build quality");
    geometry.quality = quality;
  });
}
RTC_API void rtcSetGeometryMaxRadiusScale(RTCGeometry handle, float) {
  on(handle, [](Geometry&) { require_allowed(false, "min-width is not supported"); });
}
RTC_API void rtcSetGeometryIntersectFilterFunction(RTCGeometry handle, RTCFilterFunctionN function) {
  change(handle, [&](Geometry& geometry) { geometry.intersect_filter = function; });
}
RTC_API void rtcSetGeometryOccludedFilterFunction(RTCGeometry handle, RTCFilterFunctionN function) {
  change(handle, [&](Geometry& geometry) { geometry.occluded_filter = function; });
}
RTC_API void rtcSetGeometryUserData(RTCGeometry handle, void* user) {
  on(handle, [&](Geometry& geometry) { geometry.user = user; });
}
RTC_API void* rtcGetGeometryUserData(RTCGeometry handle) {
  return on(handle, [](Geometry& geometry) { return geometry.user; });
}
RTC_API void rtcSetGeometryPointQueryFunction(RTCGeometry handle, RTCPointQueryFunction function) {
  on(handle, [&](Geometry& geometry) { geometry.point_query = function; });
}
RTC_API void rtcSetGeometryUserPrimitiveCount(RTCGeometry handle, unsigned count) {
  change_user(handle, [&](Geometry& geometry) { geometry.user_count = count; });
}
RTC_API void rtcSetGeometryBoundsFunction(RTCGeometry handle, RTCBoundsFunction function, void* user) {
  change_user(handle, [&](Geometry& geometry) { geometry.bounds = function, geometry.bounds_user = user; });
}
RTC_API void rtcSetGeometryIntersectFunction(RTCGeometry handle, RTCIntersectFunctionN function) {
  change_user(handle, [&](Geometry& geometry) { geometry.intersect = function; });
}
RTC_API void rtcSetGeometryOccludedFunction(RTCGeometry handle, RTCOccludedFunctionN function) {
  change_user(handle, [&](Geometry& geometry) { geometry.occluded = function; });
}
