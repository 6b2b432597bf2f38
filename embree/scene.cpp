// Scenes: geometries attached by id, flags, bounds.
#include "scene.hpp"

namespace embree {
namespace {

// With the scene's lock held.
void attach(Scene& scene, RTCGeometry handle, unsigned id) {
  Geometry& geometry = object_of(handle);
  require_same_device(scene, geometry);
  require(id != RTC_INVALID_GEOMETRY_ID, "invalid geometry ID");
  require_allowed(scene.geometries.emplace(id, Ref<Geometry>(&geometry)).second,
                  "geometry ID already in use");
  scene.is_modified = true;
}
unsigned lowest_free_id(const Scene& scene) {
  const auto& used = scene.geometries;
  if (!used.empty() && used.rbegin()->first + 1 == used.size()) return used.rbegin()->first + 1;
  unsigned id = 0;
  while (used.contains(id)) ++id;
  return id;
}

RTCGeometry geometry_of(const Scene& scene, unsigned id) {
  const auto found = scene.geometries.find(id);
  return found == scene.geometries.end() ? nullptr : reinterpret_cast<RTCGeometry>(found->second.get());
}

RTCBounds bounds_of(const Scene& scene) {
  require_allowed(!scene.is_modified, "scene not committed");
  const raylanes::Box& box = scene.built->bounds;
  return {box.lo[0], box.lo[1], box.lo[2], 0, box.hi[0], box.hi[1], box.hi[2], 0};
}

template <class T>
void set(RTCScene handle, T Scene::*member, T value) {
  on(handle, [&](Scene& scene) { scene.is_modified |= std::exchange(scene.*member, value) != value; });
}

}  // namespace
}  // namespace embree

using namespace embree;

RTC_API RTCScene rtcNewScene(RTCDevice handle) {
  return on(handle, [](Device& device) { return reinterpret_cast<RTCScene>(new Scene(device)); });
}
RTC_API RTCDevice rtcGetSceneDevice(RTCScene handle) {
  return on(handle,
            [](Scene& scene) { return reinterpret_cast<RTCDevice>(Ref<Device>(scene.device).give()); });
}
RTC_API void rtcRetainScene(RTCScene handle) {
  on(handle, [](Scene& scene) { scene.retain(); });
}
RTC_API void rtcReleaseScene(RTCScene handle) {
  on(handle, [](Scene& scene) { scene.release(); });
}
RTC_API void rtcAttachGeometryByID(RTCScene handle, RTCGeometry geometry, unsigned id) {
  on(handle, [&](Scene& scene) {
    const std::lock_guard guard(scene.lock);
    attach(scene, geometry, id);
  });
}
RTC_API unsigned rtcAttachGeometry(RTCScene handle, RTCGeometry geometry) {
  unsigned attached = RTC_INVALID_GEOMETRY_ID;
  on(handle, [&](Scene& scene) {
    const std::lock_guard guard(scene.lock);
    const unsigned id = lowest_free_id(scene);
    attach(scene, geometry, id);
    attached = id;
  });
  return attached;
}
RTC_API void rtcDetachGeometry(RTCScene handle, unsigned id) {
  on(handle, [&](Scene& scene) {
    const std::lock_guard guard(scene.lock);
    require_allowed(scene.geometries.erase(id) == 1, "invalid geometry");
    scene.is_modified = true;
  });
}
// Without the lock: callbacks of a commit may call this.
RTC_API RTCGeometry rtcGetGeometry(RTCScene handle, unsigned id) {
  return on(handle, [&](Scene& scene) { return geometry_of(scene, id); });
}
RTC_API RTCGeometry rtcGetGeometryThreadSafe(RTCScene handle, unsigned id) {
  return on(handle, [&](Scene& scene) {
    const std::lock_guard guard(scene.lock);
    return geometry_of(scene, id);
  });
}
RTC_API void rtcCommitScene(RTCScene handle) {
  on(handle, [](Scene& scene) { scene.commit(); });
}
// The first thread builds; the others wait for it.
RTC_API void rtcJoinCommitScene(RTCScene handle) {
  on(handle, [](Scene& scene) { scene.commit(); });
}
RTC_API void rtcSetSceneProgressMonitorFunction(RTCScene handle, RTCProgressMonitorFunction function,
                                                void* user) {
  on(handle, [&](Scene& scene) { scene.progress = function, scene.progress_user = user; });
}
RTC_API void rtcSetSceneBuildQuality(RTCScene handle, RTCBuildQuality quality) {
  on(handle, [&](Scene&) {
    require(quality >= RTC_BUILD_QUALITY_LOW && quality <= RTC_BUILD_QUALITY_HIGH, "invalid build quality");
    set(handle, &Scene::quality, quality);
  });
}
RTC_API void rtcSetSceneFlags(RTCScene handle, RTCSceneFlags flags) {
  set(handle, &Scene::flags, flags);
}
RTC_API RTCSceneFlags rtcGetSceneFlags(RTCScene handle) {
  return on(handle, [](Scene& scene) { return scene.flags; });
}
RTC_API void rtcGetSceneBounds(RTCScene handle, RTCBounds* bounds) {
  on(handle, [&](Scene& scene) {
    require_some(bounds);
    *bounds = bounds_of(scene);
  });
}
RTC_API void rtcGetSceneLinearBounds(RTCScene handle, RTCLinearBounds* bounds) {
  on(handle, [&](Scene& scene) {
    require_some(bounds);
    bounds->bounds0 = bounds->bounds1 = bounds_of(scene);
  });
}
