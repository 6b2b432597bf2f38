// Buffers and geometries, as their caller describes them.
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "handles.hpp"

namespace embree {

struct Buffer : Counted {
  Ref<Device> device;
  std::size_t size;
  bool is_owned;
  std::byte* data = nullptr;  // an owned one has 64 bytes behind its end, which vectors may read

  Buffer(Device& of_device, void* shared, std::size_t bytes);
  ~Buffer() override;
};

struct BufferView {
  Ref<Buffer> buffer;  // null: shared with the caller
  std::byte* data = nullptr;
  std::size_t stride = 0, count = 0;
  RTCFormat format = RTC_FORMAT_UNDEFINED;

  template <class T>
  const T* at(std::size_t i) const {
    return reinterpret_cast<const T*>(data + i * stride);
  }
};

// An affine map, by rows.
struct Matrix {
  double row[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

  Matrix inverse() const;
  void move_point(const double (&from)[3], double (&to)[3]) const {
    for (int i = 0; i < 3; ++i)
      to[i] = row[i][0] * from[0] + row[i][1] * from[1] + row[i][2] * from[2] + row[i][3];
  }
  void turn(const double (&from)[3], double (&to)[3]) const {
    for (int i = 0; i < 3; ++i) to[i] = row[i][0] * from[0] + row[i][1] * from[1] + row[i][2] * from[2];
  }
};

struct Geometry : Counted {
  Ref<Device> device;
  const RTCGeometryType type;
  std::map<std::pair<int, unsigned>, BufferView> buffers;
  unsigned mask = ~0u;
  bool is_enabled = true, is_dirty = true;
  unsigned version = 0;  // how often it was committed, enabled or disabled
  unsigned time_steps = 1;
  RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;
  void* user = nullptr;
  RTCFilterFunctionN intersect_filter = nullptr, occluded_filter = nullptr;
  RTCPointQueryFunction point_query = nullptr;
  // For user geometries.
  unsigned user_count = 0;
  RTCBoundsFunction bounds = nullptr;
  void* bounds_user = nullptr;
  RTCIntersectFunctionN intersect = nullptr;
  RTCOccludedFunctionN occluded = nullptr;
  // For instances.
  Ref<Scene> instanced;
  Matrix to_scene, to_local;

  Geometry(Device& of_device, RTCGeometryType of_type);
  ~Geometry() override;

  const BufferView* find(RTCBufferType kind, unsigned slot = 0) const {
    const auto found = buffers.find({kind, slot});
    return found == buffers.end() ? nullptr : &found->second;
  }
  bool is_mesh() const { return type <= RTC_GEOMETRY_TYPE_GRID; }
  bool is_points() const {
    return type >= RTC_GEOMETRY_TYPE_SPHERE_POINT && type <= RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT;
  }
  bool is_user() const { return type == RTC_GEOMETRY_TYPE_USER; }
  bool is_instance() const { return type == RTC_GEOMETRY_TYPE_INSTANCE; }
  bool is_supported() const { return is_mesh() || is_points() || is_user() || is_instance(); }
  bool has_filter() const { return intersect_filter != nullptr || occluded_filter != nullptr; }
  std::uint32_t primitive_count() const;
};

}  // namespace embree
