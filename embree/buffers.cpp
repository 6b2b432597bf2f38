// Buffers, and what geometries take of them.
#include <cstdlib>

#include "geometry.hpp"

namespace embree {

Buffer::Buffer(Device& of_device, void* shared, std::size_t bytes)
    : device(&of_device), size(bytes), is_owned(shared == nullptr) {
  if (!is_owned) {
    data = static_cast<std::byte*>(shared);
    return;
  }
  if (bytes > std::size_t{1} << 46) throw std::bad_alloc();
  device->memory(static_cast<std::ptrdiff_t>(bytes), false);
  data = static_cast<std::byte*>(std::aligned_alloc(64, (bytes + 127) / 64 * 64));
  if (data == nullptr) throw std::bad_alloc();
}
Buffer::~Buffer() {
  if (!is_owned) return;
  std::free(data);
  device->memory(-static_cast<std::ptrdiff_t>(size), true);
}

namespace {

constexpr std::size_t most_items = 0xffffffff;

bool is_index_format(RTCGeometryType type, RTCFormat format) {
  return format == (type == RTC_GEOMETRY_TYPE_TRIANGLE ? RTC_FORMAT_UINT3 : RTC_FORMAT_UINT4);
}

// Refuses what a supported geometry has no use for. Others take any buffer, and are refused when they are committed.
void require_fit(const Geometry& geometry, RTCBufferType type, unsigned slot, RTCFormat format) {
  if (!geometry.is_supported()) return;
  require_allowed(geometry.is_mesh() || geometry.is_points(), "operation not supported for this geometry");
  const bool is_grid = geometry.type == RTC_GEOMETRY_TYPE_GRID;
  switch (type) {
    case RTC_BUFFER_TYPE_INDEX:
      require(slot == 0, "invalid buffer slot");
      require_allowed(geometry.is_mesh() && !is_grid, "operation not supported for this geometry");
      return require_allowed(is_index_format(geometry.type, format), "invalid index buffer format");
    case RTC_BUFFER_TYPE_GRID:
      return require_allowed(is_grid && slot == 0 && format == RTC_FORMAT_GRID, "invalid grid buffer");
    case RTC_BUFFER_TYPE_VERTEX:
      return require_allowed(format == (geometry.is_mesh() ? RTC_FORMAT_FLOAT3 : RTC_FORMAT_FLOAT4),
                             "invalid vertex buffer format");
    case RTC_BUFFER_TYPE_NORMAL:
      return require_allowed(
          geometry.type == RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT && format == RTC_FORMAT_FLOAT3,
          "invalid normal buffer");
    case RTC_BUFFER_TYPE_VERTEX_ATTRIBUTE:
      return require_allowed(format >= RTC_FORMAT_FLOAT && format <= RTC_FORMAT_FLOAT16,
                             "invalid vertex attribute buffer format");
    default:
      refuse(RTC_ERROR_INVALID_ARGUMENT, "unknown buffer type");
  }
}

void set_buffer(Geometry& geometry, RTCBufferType type, unsigned slot, BufferView view) {
  require_allowed((reinterpret_cast<std::uintptr_t>(view.data) | view.stride) % 4 == 0,
                  "buffer data and stride must be 4 bytes aligned");
  require_fit(geometry, type, slot, view.format);
  geometry.buffers[{type, slot}] = std::move(view);
  geometry.is_dirty = true;
}

}  // namespace
}  // namespace embree

using namespace embree;

RTC_API RTCBuffer rtcNewBuffer(RTCDevice handle, size_t bytes) {
  return on(handle,
            [&](Device& device) { return reinterpret_cast<RTCBuffer>(new Buffer(device, nullptr, bytes)); });
}
RTC_API RTCBuffer rtcNewSharedBuffer(RTCDevice handle, void* data, size_t bytes) {
  return on(handle, [&](Device& device) {
    require(reinterpret_cast<std::uintptr_t>(data) % 4 == 0, "data must be 4 bytes aligned");
    return reinterpret_cast<RTCBuffer>(new Buffer(device, data, bytes));
  });
}
RTC_API void* rtcGetBufferData(RTCBuffer handle) {
  return on(handle, [](Buffer& buffer) -> void* { return buffer.data; });
}
RTC_API void rtcRetainBuffer(RTCBuffer handle) {
  on(handle, [](Buffer& buffer) { buffer.retain(); });
}
RTC_API void rtcReleaseBuffer(RTCBuffer handle) {
  on(handle, [](Buffer& buffer) { buffer.release(); });
}

RTC_API void rtcSetGeometryBuffer(RTCGeometry handle, RTCBufferType type, unsigned slot, RTCFormat format,
                                  RTCBuffer buffer_handle, size_t offset, size_t stride, size_t count) {
  on(handle, [&](Geometry& geometry) {
    Buffer& buffer = object_of(buffer_handle);
    require_same_device(geometry, buffer);
    require(count <= most_items, "buffer too large");
    require(offset <= buffer.size && (stride == 0 || count <= (buffer.size - offset) / stride),
            "buffer range out of bounds");
    set_buffer(geometry, type, slot, {Ref<Buffer>(&buffer), buffer.data + offset, stride, count, format});
  });
}
RTC_API void rtcSetSharedGeometryBuffer(RTCGeometry handle, RTCBufferType type, unsigned slot,
                                        RTCFormat format, const void* data, size_t offset, size_t stride,
                                        size_t count) {
  on(handle, [&](Geometry& geometry) {
    require(count <= most_items, "buffer too large");
    if (count > 0) require_some(data);
    auto* bytes = static_cast<std::byte*>(const_cast<void*>(data));
    set_buffer(geometry, type, slot, {{}, bytes == nullptr ? bytes : bytes + offset, stride, count, format});
  });
}
RTC_API void* rtcSetNewGeometryBuffer(RTCGeometry handle, RTCBufferType type, unsigned slot, RTCFormat format,
                                      size_t stride, size_t count) {
  return on(handle, [&](Geometry& geometry) -> void* {
    require(count <= most_items, "buffer too large");
    if (stride > std::size_t{1} << 31) throw std::bad_alloc();
    const Ref<Buffer> owner(new Buffer(*geometry.device, nullptr, stride * count));
    owner->release();
    set_buffer(geometry, type, slot, {owner, owner->data, stride, count, format});
    return owner->data;
  });
}
RTC_API void* rtcGetGeometryBufferData(RTCGeometry handle, RTCBufferType type, unsigned slot) {
  return on(handle, [&](Geometry& geometry) -> void* {
    const BufferView* view = geometry.find(type, slot);
    return view == nullptr ? nullptr : view->data;
  });
}
RTC_API void rtcUpdateGeometryBuffer(RTCGeometry handle, RTCBufferType type, unsigned slot) {
  on(handle, [&](Geometry& geometry) {
    require(geometry.find(type, slot) != nullptr, "unknown buffer");
    geometry.is_dirty = true;
  });
}
