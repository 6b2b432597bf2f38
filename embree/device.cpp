// Devices and their errors.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

#include "handles.hpp"

namespace embree {
namespace {

thread_local RTCError error_without_device = RTC_ERROR_NONE;

void keep_first(RTCError& first, RTCError code) {
  if (first == RTC_ERROR_NONE) first = code;
}

// "threads=4,isa=avx2". With "unsupported=empty" commits do not report what is not supported. Other words are ignored,
// `isa` too: all ISA paths return the same bytes. The environment variable RAYLANES_PATH chooses one.
void configure(Device& device, std::string_view text) {
  while (!text.empty()) {
    const std::string word(text.substr(0, text.find(',')));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (word.find("unsupported=empty") != std::string::npos) device.takes_unsupported = true;
    const std::size_t key = word.find("threads"), equals = word.find('=');
    if (key != std::string::npos && key < equals && equals != std::string::npos &&
        word.find_first_not_of(" \t\n") == key)
      device.threads = std::max(0, std::atoi(word.c_str() + equals + 1));
  }
}

ssize_t property_of(const Device& device, int property) {
  switch (property) {
    case RTC_DEVICE_PROPERTY_VERSION:
      return RTC_VERSION;
    case RTC_DEVICE_PROPERTY_VERSION_MAJOR:
      return RTC_VERSION_MAJOR;
    case RTC_DEVICE_PROPERTY_VERSION_MINOR:
      return RTC_VERSION_MINOR;
    case RTC_DEVICE_PROPERTY_VERSION_PATCH:
      return RTC_VERSION_PATCH;
    case RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED:
    case RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED:
    case RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED:
    case RTC_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED:
    case RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED:
    case RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED:
    case RTC_DEVICE_PROPERTY_IGNORE_INVALID_RAYS_ENABLED:
    case RTC_DEVICE_PROPERTY_TRIANGLE_GEOMETRY_SUPPORTED:
    case RTC_DEVICE_PROPERTY_QUAD_GEOMETRY_SUPPORTED:
    case RTC_DEVICE_PROPERTY_USER_GEOMETRY_SUPPORTED:
    case RTC_DEVICE_PROPERTY_POINT_GEOMETRY_SUPPORTED:
    case RTC_DEVICE_PROPERTY_JOIN_COMMIT_SUPPORTED:
    case RTC_DEVICE_PROPERTY_PARALLEL_COMMIT_SUPPORTED:
    case RTC_DEVICE_PROPERTY_TASKING_SYSTEM:
      return 1;
    case RTC_DEVICE_PROPERTY_BACKFACE_CULLING_CURVES_ENABLED:
    case RTC_DEVICE_PROPERTY_BACKFACE_CULLING_ENABLED:
    case RTC_DEVICE_PROPERTY_COMPACT_POLYS_ENABLED:
    case RTC_DEVICE_PROPERTY_SUBDIVISION_GEOMETRY_SUPPORTED:
    case RTC_DEVICE_PROPERTY_CURVE_GEOMETRY_SUPPORTED:
      return 0;
    case 1000000:  // the number of threads, which Embree's own programs ask for
      return device.threads == 0 ? static_cast<ssize_t>(std::thread::hardware_concurrency()) : device.threads;
    default:
      refuse(RTC_ERROR_INVALID_ARGUMENT, "unknown readable property");
  }
}

}  // namespace

void Device::fail(RTCError code, const char* text) {
  {
    const std::lock_guard guard(lock);
    keep_first(errors[std::this_thread::get_id()], code);
  }
  if (error_function != nullptr) error_function(error_user, code, text);
}
void Device::memory(std::ptrdiff_t bytes, bool is_done) {
  if (memory_function != nullptr && bytes != 0 && !memory_function(memory_user, bytes, is_done) && bytes > 0)
    refuse(RTC_ERROR_OUT_OF_MEMORY, "memory monitor forced termination");
}

void report(Device* device, RTCError code, const char* text) {
  if (device != nullptr)
    device->fail(code, text);
  else
    keep_first(error_without_device, code);
}

}  // namespace embree

using namespace embree;

RTC_API RTCDevice rtcNewDevice(const char* config) {
  return guarded(nullptr, [&] {
    auto* device = new Device;
    if (config != nullptr) configure(*device, config);
    return reinterpret_cast<RTCDevice>(device);
  });
}
RTC_API void rtcRetainDevice(RTCDevice handle) {
  on(handle, [](Device& device) { device.retain(); });
}
RTC_API void rtcReleaseDevice(RTCDevice handle) {
  on(handle, [](Device& device) { device.release(); });
}
RTC_API ssize_t rtcGetDeviceProperty(RTCDevice handle, RTCDeviceProperty property) {
  return on(handle, [&](Device& device) { return property_of(device, static_cast<int>(property)); });
}
RTC_API void rtcSetDeviceProperty(RTCDevice handle, const RTCDeviceProperty property, ssize_t) {
  // Embree's own programs set properties from 1,000,000 on.
  on(handle, [&](Device&) { require(static_cast<int>(property) >= 1000000, "unknown writable property"); });
}
RTC_API RTCError rtcGetDeviceError(RTCDevice handle) {
  if (handle == nullptr) return std::exchange(error_without_device, RTC_ERROR_NONE);
  Device& device = *of(handle);
  const std::lock_guard guard(device.lock);
  const auto found = device.errors.extract(std::this_thread::get_id());
  return found.empty() ? RTC_ERROR_NONE : found.mapped();
}
RTC_API void rtcSetDeviceErrorFunction(RTCDevice handle, RTCErrorFunction function, void* user) {
  on(handle, [&](Device& device) { device.error_function = function, device.error_user = user; });
}
RTC_API void rtcSetDeviceMemoryMonitorFunction(RTCDevice handle, RTCMemoryMonitorFunction function,
                                               void* user) {
  on(handle, [&](Device& device) { device.memory_function = function, device.memory_user = user; });
}
