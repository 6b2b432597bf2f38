// The objects behind Embree's handles: counted references, devices, errors.
#pragma once

#define RTC_EXPORT_API
#include <embree3/rtcore.h>
#include <embree3/rtcore_builder.h>

#include <atomic>
#include <cstddef>
#include <map>
#include <mutex>
#include <new>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <utility>

namespace embree {

struct Error : std::runtime_error {
  RTCError code;
  Error(RTCError error, const char* text) : std::runtime_error(text), code(error) {}
};
[[noreturn]] inline void refuse(RTCError code, const char* text) {
  throw Error(code, text);
}
inline void require(bool holds, const char* text) {
  if (!holds) refuse(RTC_ERROR_INVALID_ARGUMENT, text);
}
inline void require_allowed(bool holds, const char* text) {
  if (!holds) refuse(RTC_ERROR_INVALID_OPERATION, text);
}
template <class... Pointers>
void require_some(const Pointers*... pointers) {
  require(((pointers != nullptr) && ...), "invalid argument: a pointer is null");
}

struct Counted {
  std::atomic<int> owners{1};

  Counted() = default;
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  virtual ~Counted() = default;
  void retain() { owners.fetch_add(1, std::memory_order_relaxed); }
  void release() {
    if (owners.fetch_sub(1, std::memory_order_acq_rel) == 1) delete this;
  }
};

// One of an object's owners.
template <class T>
class Ref {
 public:
  Ref() = default;
  explicit Ref(T* object) : object_(object) {
    if (object_ != nullptr) object_->retain();
  }
  Ref(const Ref& other) : Ref(other.object_) {}
  Ref(Ref&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Ref& operator=(Ref other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~Ref() {
    if (object_ != nullptr) object_->release();
  }
  T* get() const { return object_; }
  T* give() { return std::exchange(object_, nullptr); }
  T* operator->() const { return object_; }
  T& operator*() const { return *object_; }

 private:
  T* object_ = nullptr;
};

struct Device : Counted {
  std::mutex lock;
  std::map<std::thread::id, RTCError> errors;  // of each thread the first since it last asked
  RTCErrorFunction error_function = nullptr;
  void* error_user = nullptr;
  RTCMemoryMonitorFunction memory_function = nullptr;
  void* memory_user = nullptr;
  int threads = 0;  // 0: the caller's oneTBB arena
  bool takes_unsupported = false;

  void fail(RTCError code, const char* text);
  // Tells the monitor; throws if it refuses more memory.
  void memory(std::ptrdiff_t bytes, bool is_done);
};

// Keeps an error for rtcGetDeviceError(). The device may be null.
void report(Device* device, RTCError code, const char* text);

// Calls f. Exceptions become errors of the device, and a result of zero.
template <class F>
auto guarded(Device* device, F&& f) -> decltype(f()) {
  try {
    return f();
  } catch (const Error& error) {
    report(device, error.code, error.what());
  } catch (const std::bad_alloc&) {
    report(device, RTC_ERROR_OUT_OF_MEMORY, "out of memory");
  } catch (const std::exception& error) {
    report(device, RTC_ERROR_UNKNOWN, error.what());
  }
  return decltype(f())();
}

struct Buffer;
struct Geometry;
struct Scene;
inline Device* of(RTCDevice handle) {
  return reinterpret_cast<Device*>(handle);
}
inline Buffer* of(RTCBuffer handle) {
  return reinterpret_cast<Buffer*>(handle);
}
inline Geometry* of(RTCGeometry handle) {
  return reinterpret_cast<Geometry*>(handle);
}
inline Scene* of(RTCScene handle) {
  return reinterpret_cast<Scene*>(handle);
}
template <class Handle>
auto& object_of(Handle handle) {
  auto* object = of(handle);
  require_some(object);
  return *object;
}
template <class Object>
Device* device_of(Object* object) {
  if constexpr (std::is_same_v<Object, Device>)
    return object;
  else
    return object == nullptr ? nullptr : object->device.get();
}
template <class A, class B>
void require_same_device(const A& a, const B& b) {
  require(a.device.get() == b.device.get(), "inputs are from different devices");
}

// A call on a handle: on(handle, [](Object& object) {…}).
template <class Handle, class F>
auto on(Handle handle, F&& f) {
  const Ref<Device> device(device_of(of(handle)));  // which the call may release
  return guarded(device.get(), [&] { return f(object_of(handle)); });
}

}  // namespace embree
