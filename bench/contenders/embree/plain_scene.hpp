// The state of the processor that Embree recommends, and a scene of Embree with one geometry, in a device of its own
// with one thread.
#pragma once

#include <embree3/rtcore.h>
#include <xmmintrin.h>

#include <raylanes/mesh.hpp>

#include "../../support/std.hpp"

namespace raylanes::bench {

// Embree's manual: flush results and operands that are subnormal to zero in each thread that calls it.
class SubnormalsAreZero {
 public:
  SubnormalsAreZero() { _mm_setcsr(before_ | 0x8040u); }
  ~SubnormalsAreZero() { _mm_setcsr(before_); }
  SubnormalsAreZero(const SubnormalsAreZero&) = delete;
  SubnormalsAreZero& operator=(const SubnormalsAreZero&) = delete;

 private:
  const unsigned before_ = _mm_getcsr();
};

class PlainScene {
 public:
  // make(device) returns the geometry. Throws std::runtime_error if Embree reports an error.
  template <class Make>
  explicit PlainScene(const Make& make, RTCSceneFlags flags = RTC_SCENE_FLAG_NONE)
      : device_(rtcNewDevice("threads=1")) {
    const SubnormalsAreZero subnormals;
    if (device_ == nullptr) throw std::runtime_error("Embree: no device");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, flags);
    const RTCGeometry geometry = make(device_);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
      throw std::runtime_error("Embree: error " + std::to_string(error));
  }
  ~PlainScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  PlainScene(const PlainScene&) = delete;
  PlainScene& operator=(const PlainScene&) = delete;

  RTCScene get() const { return scene_; }

 private:
  RTCDevice device_;
  RTCScene scene_ = nullptr;
};

// A geometry of copies of a mesh.
inline RTCGeometry triangles_of(RTCDevice device, const Mesh& mesh) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const auto put = [&](RTCBufferType type, RTCFormat format, const auto& items) {
    const std::size_t size = sizeof(items[0]);
    void* const buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, size, items.size());
    if (buffer != nullptr) std::memcpy(buffer, items.data(), items.size() * size);
  };
  put(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
  put(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
  return geometry;
}

}  // namespace raylanes::bench
