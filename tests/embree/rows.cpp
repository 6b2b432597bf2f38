// Results of Embree's functions, one line a case: tests/embree/compare_rows runs this with two libraries.
#include <dlfcn.h>

#include <string>

#include "calls.hpp"

namespace {

const Vec down{0, 0, -1};
const Vec over{.25f, .25f, 1};

std::string text_of(const RTCRayHit& r) {
  char text[200];
  const RTCHit& h = r.hit;
  // Without −0, whose sign libraries may choose.
  std::snprintf(text, sizeof text, "geom %d prim %d inst %d tfar %.5g Ng %.4g %.4g %.4g uv %.4g %.4g",
                static_cast<int>(h.geomID), static_cast<int>(h.primID), static_cast<int>(h.instID[0]),
                static_cast<double>(r.ray.tfar + 0), static_cast<double>(h.Ng_x + 0),
                static_cast<double>(h.Ng_y + 0), static_cast<double>(h.Ng_z + 0),
                static_cast<double>(h.u + 0), static_cast<double>(h.v + 0));
  return text;
}

bool has_packets_of_16() {
  return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
}

// A ray through packets of `lanes`, as each of their active rays. Debian's library writes to inactive lanes of 16, too,
// on processors without AVX-512, where it has no packets of 16 of its own.
template <int lanes, class Call>
bool is_same_in_packet(const RTCRayHit& before, const RTCRayHit& after, Call&& call) {
  alignas(64) RTCRayHitNt<lanes> packet;
  alignas(64) int valid[lanes];
  unsigned words[20];
  std::memcpy(words, &before, sizeof words);
  auto* const at = reinterpret_cast<unsigned*>(&packet);
  for (int i = 0; i < lanes; ++i) {
    valid[i] = i % 3 == 0 ? 0 : -1;
    for (int k = 0; k < 20; ++k) at[k * lanes + i] = words[k];
  }
  call(valid, &packet);
  for (int i = 0; i < lanes; ++i) {
    for (int k = 0; k < 20; ++k) words[k] = at[k * lanes + i];
    RTCRayHit one;
    std::memcpy(static_cast<void*>(&one), words, sizeof words);
    if (valid[i] == 0 && lanes == 16 && !has_packets_of_16()) continue;
    if (text_of(one) != text_of(valid[i] == 0 ? before : after)) return false;
  }
  return true;
}

}  // namespace

void show(const char* name, RTCScene scene, const RTCRayHit& ray) {
  RTCRayHit one = ray, shadow = ray;
  rtcIntersect1(scene, &context, &one);
  rtcOccluded1(scene, &context, &shadow.ray);
  const std::string text = text_of(one);
  bool is_same = is_same_in_packet<4>(ray, one, [&](const int* valid, auto* p) {
    rtcIntersect4(valid, scene, &context, reinterpret_cast<RTCRayHit4*>(p));
  });
  is_same = is_same && is_same_in_packet<8>(ray, one, [&](const int* valid, auto* p) {
              rtcIntersect8(valid, scene, &context, reinterpret_cast<RTCRayHit8*>(p));
            });
  is_same = is_same && is_same_in_packet<16>(ray, one, [&](const int* valid, auto* p) {
              rtcIntersect16(valid, scene, &context, reinterpret_cast<RTCRayHit16*>(p));
            });
  std::vector<RTCRayHit> many(40, ray), others(40, ray), shadows(40, ray);
  rtcIntersect1M(scene, &context, many.data(), 40, sizeof(RTCRayHit));
  std::vector<RTCRayHit*> pointers;
  for (RTCRayHit& r : others) pointers.push_back(&r);
  rtcIntersect1Mp(scene, &context, pointers.data(), 40);
  rtcOccluded1M(scene, &context, &shadows[0].ray, 40, sizeof(RTCRayHit));
  for (int i = 0; i < 40; ++i)
    is_same = is_same && text_of(many[i]) == text && text_of(others[i]) == text &&
              shadows[i].ray.tfar == shadow.ray.tfar;
  std::printf("%s: %s%s%s\n", name, text.c_str(), shadow.ray.tfar == -inf ? ", occluded" : "",
              is_same ? "" : ", OTHERWISE IN PACKETS OR STREAMS");
}

namespace {

// As a library rounds it. Debian's compares in fast scenes before it divides, and rounds on each processor otherwise.
float t_of(RTCScene scene, RTCRayHit ray) {
  rtcIntersect1(scene, &context, &ray);
  return ray.ray.tfar;
}

void rays_of_a_triangle() {
  for (const int flags : {0, static_cast<int>(RTC_SCENE_FLAG_ROBUST)}) {
    RTCScene s = scene_of({triangles_of(unit_triangle)}, flags);
    std::printf("%s\n", flags == 0 ? "fast" : "robust");
    show("plain", s, ray_of(over, down));
    show("from the triangle", s, ray_of({.25f, .25f, 0}, down));
    const float t = flags == 0 ? 1 : t_of(s, ray_of(over, down)), below = std::nextafter(t, 0.0f);
    show("tnear is t", s, ray_of(over, down, t));
    show("tfar is t", s, ray_of(over, down, 0, t));
    show("tnear below t", s, ray_of(over, down, below));
    show("tfar below t", s, ray_of(over, down, 0, below));
    show("tfar minus infinity", s, ray_of(over, down, 0, -inf));
    show("tfar below tnear", s, ray_of(over, down, 3, 2));
    show("on an edge", s, ray_of({.5f, 0, 1}, down));
    show("on a vertex", s, ray_of({0, 0, 1}, down));
    show("beside it", s, ray_of({.75f, .75f, 1}, down));
    show("in the plane", s, ray_of({-1, .25f, 0}, {1, 0, 0}));
    show("from behind", s, ray_of({.25f, .25f, -1}, {0, 0, 1}));
    show("long direction", s, ray_of(over, {0, 0, -8}));
    show("mask 0", s, ray_of(over, down, 0, inf, 0));
    show("mask 2", s, ray_of(over, down, 0, inf, 2));
    rtcReleaseScene(s);
  }
}

void filters() {
  std::vector<float> five;
  for (const int depth : {3, 1, 4, 0, 2})
    for (std::size_t i = 0; i < 9; ++i)
      five.push_back(i % 3 == 2 ? static_cast<float>(-depth) : unit_triangle[i]);
  const auto odd = [](const RTCFilterFunctionNArguments* a) {
    for (unsigned i = 0; i < a->N; ++i)
      if (RTCHitN_primID(a->hit, a->N, i) % 2 == 1) a->valid[i] = 0;
  };
  const auto all = [](const RTCFilterFunctionNArguments* a) { std::fill(a->valid, a->valid + a->N, 0); };
  const auto change = [](const RTCFilterFunctionNArguments* a) {
    for (unsigned i = 0; i < a->N; ++i)
      RTCHitN_u(a->hit, a->N, i) = .125f, RTCHitN_primID(a->hit, a->N, i) = 77;
  };
  for (const RTCFilterFunctionN filter : {+odd, +all, +change}) {
    RTCGeometry g = triangles_of(five);
    rtcSetGeometryIntersectFilterFunction(g, filter);
    rtcSetGeometryOccludedFilterFunction(g, filter);
    RTCScene s = scene_of({g});
    show("filter of a geometry", s, ray_of(over, down));
    show("filter behind tnear", s, ray_of(over, down, 2.5f));
  }
  RTCScene s = scene_of({triangles_of(five)}, RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  context.filter = odd;
  show("filter of the context", s, ray_of(over, down));
  context.filter = nullptr;
  show("none", s, ray_of(over, down));
}

// Three geometries behind one another, with masks of their own; then a filter turns down all hits of the first.
void geometries_apart() {
  const auto none = [](const RTCFilterFunctionNArguments* a) { std::fill(a->valid, a->valid + a->N, 0); };
  for (const bool are_spheres : {false, true})
    for (const bool gives_verdicts : {false, true}) {
      RTCGeometry g[3];
      for (unsigned i = 0; i < 3; ++i) {
        const float z = -3 * static_cast<float>(i);
        g[i] = are_spheres ? points_of(RTC_GEOMETRY_TYPE_SPHERE_POINT, {.25f, .25f, z, 1})
                           : triangles_of({0, 0, z, 1, 0, z, 0, 1, z});
        rtcSetGeometryMask(g[i], 1u << i);
      }
      if (gives_verdicts) {
        rtcSetGeometryIntersectFilterFunction(g[0], none);
        rtcSetGeometryOccludedFilterFunction(g[0], none);
      }
      RTCScene s = scene_of({g[0], g[1], g[2]});
      for (const unsigned mask : {~0u, 1u, 2u, 4u, 6u})
        show("geometries apart", s, ray_of({.25f, .25f, 5}, down, 0, inf, mask));
    }
}

void instances() {
  RTCGeometry masked = triangles_of(unit_triangle), instance;
  rtcSetGeometryMask(masked, 6);
  RTCScene inner = scene_of({masked});
  instance = instance_of(inner, {-2, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 5});
  RTCScene s = scene_of({triangles_of({9, 9, 9, 10, 9, 9, 9, 10, 9}), instance});
  for (const unsigned mask : {~0u, 1u, 2u})
    show("mirrored instance", s, ray_of({-.5f, .5f, 9}, down, 0, inf, mask));
  rtcSetGeometryMask(instance, 3);
  rtcCommitGeometry(instance);
  rtcCommitScene(s);
  for (const unsigned mask : {1u, 2u, 4u, 5u})
    show("two masks", s, ray_of({-.5f, .5f, 9}, down, 0, inf, mask));
  rtcDisableGeometry(instance);
  rtcCommitScene(s);
  show("disabled", s, ray_of({-.5f, .5f, 9}, down));
  rtcEnableGeometry(instance);
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                          std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 3, 0, 0}.data());
  rtcCommitGeometry(instance);
  rtcCommitScene(s);
  show("moved", s, ray_of({3.25f, .25f, 9}, down));
  RTCBounds b;
  rtcGetSceneBounds(s, &b);
  std::printf("bounds: %g %g %g .. %g %g %g\n", static_cast<double>(b.lower_x),
              static_cast<double>(b.lower_y), static_cast<double>(b.lower_z), static_cast<double>(b.upper_x),
              static_cast<double>(b.upper_y), static_cast<double>(b.upper_z));
}

void other_shapes() {
  const std::vector<float> bent{0, 0, 0, 1, 0, 0, 1, 1, .5f, 0, 1, 0};
  RTCScene s = scene_of({mesh_of(RTC_GEOMETRY_TYPE_QUAD, bent, {0, 1, 2, 3})});
  for (const Vec at : {Vec{.2f, .3f, 2}, Vec{.8f, .7f, 2}, Vec{.5f, .5f, 2}})
    show("quad", s, ray_of(at, down));
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_GRID);
  fill(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 12,
       std::vector<float>{0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, .5f, 2, 1, 0});
  fill(g, RTC_BUFFER_TYPE_GRID, RTC_FORMAT_GRID, 12, std::vector<RTCGrid>{{0, 3, 3, 2}});
  s = scene_of({g});
  for (const Vec at : {Vec{.2f, .3f, 2}, Vec{1.8f, .7f, 2}}) show("grid", s, ray_of(at, down));
  for (const auto type : {RTC_GEOMETRY_TYPE_SPHERE_POINT, RTC_GEOMETRY_TYPE_DISC_POINT,
                          RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT}) {
    RTCGeometry points = points_of(type, {0, 0, 0, 1, 0, 0, 5, .5f});
    if (type == RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT)
      fill(points, RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, 12, std::vector<float>{0, 1, 1, 0, 0, 1});
    s = scene_of({points});
    show("point", s, ray_of({0, .25f, 9}, down));
    show("point behind", s, ray_of({0, .25f, 3}, down));
    show("within", s, ray_of({0, .25f, .125f}, down));
    show("beside points", s, ray_of({2, 0, 9}, down));
  }
}

void ids_and_errors() {
  RTCScene s = rtcNewScene(device);
  rtcCommitScene(s);
  show("empty scene", s, ray_of(over, down));
  const auto attach = [&] {
    RTCGeometry g = triangles_of(unit_triangle);
    rtcCommitGeometry(g);
    return rtcAttachGeometry(s, g);
  };
  const unsigned first = attach(), second = attach(), third = attach();
  rtcDetachGeometry(s, second);
  const unsigned fourth = attach(), fifth = attach();
  std::printf("ids: %u %u %u, then %u %u\n", first, second, third, fourth, fifth);
  rtcDetachGeometry(s, 99);
  std::printf("detach of none: %d\n", rtcGetDeviceError(device));
  rtcAttachGeometry(s, triangles_of(unit_triangle));
  rtcCommitScene(s);
  std::printf("geometry that got no commit: %d\n", rtcGetDeviceError(device));
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT2, 8, 3);
  std::printf("format of vertices: %d\n", rtcGetDeviceError(device));
  rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 1, RTC_FORMAT_UINT3, 12, 1);
  std::printf("slot of indices: %d\n", rtcGetDeviceError(device));
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, over.x > 0 ? &over : nullptr, 0,
                             13, 1);
  std::printf("stride of 13: %d\n", rtcGetDeviceError(device));
  rtcSetGeometryUserPrimitiveCount(g, 1);
  std::printf("user primitives of triangles: %d\n", rtcGetDeviceError(device));
  rtcGetGeometryBufferData(g, RTC_BUFFER_TYPE_VERTEX, 0);
  std::printf("data of no buffer: %d\n", rtcGetDeviceError(device));
  rtcCommitScene(nullptr);
  const int error = rtcGetDeviceError(nullptr), next = rtcGetDeviceError(nullptr);
  std::printf("no scene: %d, then %d\n", error, next);
}

}  // namespace

int main() {
  Dl_info library{};
  dladdr(reinterpret_cast<void*>(&rtcNewDevice), &library);
  std::printf("library %s\n", library.dli_fname);
  rays_of_a_triangle();
  filters();
  geometries_apart();
  instances();
  other_shapes();
  ids_and_errors();
  show_callbacks();
  show_changes();
}
