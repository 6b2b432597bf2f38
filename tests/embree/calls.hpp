// Scenes and rays for programs written against Embree's header.
#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <vector>

inline constexpr float inf = std::numeric_limits<float>::infinity();
inline RTCDevice device = rtcNewDevice("threads=1");
inline RTCIntersectContext context = [] {
  RTCIntersectContext made;
  rtcInitIntersectContext(&made);
  return made;
}();

struct Vec {
  float x, y, z;
};
inline RTCRayHit ray_of(Vec o, Vec d, float tnear = 0, float tfar = inf, unsigned mask = ~0u) {
  return {{o.x, o.y, o.z, tnear, d.x, d.y, d.z, 0, tfar, mask, 0, 0},
          {9, 9, 9, 9, 9, RTC_INVALID_GEOMETRY_ID, RTC_INVALID_GEOMETRY_ID, {RTC_INVALID_GEOMETRY_ID}}};
}

template <class T>
void fill(RTCGeometry g, RTCBufferType type, RTCFormat format, std::size_t stride,
          const std::vector<T>& values) {
  void* to = rtcSetNewGeometryBuffer(g, type, 0, format, stride, values.size() * sizeof(T) / stride);
  if (to != nullptr) std::memcpy(to, values.data(), values.size() * sizeof(T));
}
inline RTCGeometry mesh_of(RTCGeometryType type, const std::vector<float>& vertices,
                           const std::vector<unsigned>& indices) {
  RTCGeometry g = rtcNewGeometry(device, type);
  fill(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 12, vertices);
  const bool is_quad = type == RTC_GEOMETRY_TYPE_QUAD;
  fill(g, RTC_BUFFER_TYPE_INDEX, is_quad ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3, is_quad ? 16 : 12, indices);
  return g;
}
// Triangles with three vertices of their own each.
inline RTCGeometry triangles_of(const std::vector<float>& vertices) {
  std::vector<unsigned> indices(vertices.size() / 3);
  for (unsigned i = 0; i < indices.size(); ++i) indices[i] = i;
  return mesh_of(RTC_GEOMETRY_TYPE_TRIANGLE, vertices, indices);
}
inline const std::vector<float> unit_triangle{0, 0, 0, 1, 0, 0, 0, 1, 0};
inline RTCGeometry points_of(RTCGeometryType type, const std::vector<float>& balls) {
  RTCGeometry g = rtcNewGeometry(device, type);
  fill(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 16, balls);
  return g;
}
inline RTCGeometry instance_of(RTCScene scene, const float (&columns)[12]) {
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(g, scene);
  rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
  return g;
}
inline RTCScene scene_of(std::initializer_list<RTCGeometry> geometries, int flags = 0) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(flags));
  for (RTCGeometry g : geometries) rtcCommitGeometry(g), rtcAttachGeometry(scene, g), rtcReleaseGeometry(g);
  rtcCommitScene(scene);
  return scene;
}

// Prints the hit of one ray, which all calls must agree on.
void show(const char* name, RTCScene scene, const RTCRayHit& ray);
// The rows of user geometries, point queries, interpolation and changes.
void show_callbacks();
void show_changes();
