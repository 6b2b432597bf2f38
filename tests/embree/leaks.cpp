// Rays from inside a closed sphere, at random, at its vertices and at points of its edges: each miss is a leak.
//
// usage: embree_leaks [fast|robust]
// Prints the leaks of each kind, in a sphere at 0 and in one far from 0. Exit status: 1 if there are any.
#include <cstdlib>
#include <random>
#include <string>

#include "calls.hpp"

void show(const char*, RTCScene, const RTCRayHit&) {}

namespace {

constexpr unsigned rows = 200, columns = 400, rays = 300000;

struct Sphere {
  std::vector<Vec> vertices;  // rows + 1 circles of `columns`
  std::vector<unsigned> triangles, edges;
};
Sphere sphere_at(Vec centre) {
  Sphere s;
  const double pi = std::acos(-1.0);
  for (unsigned i = 0; i <= rows; ++i)
    for (unsigned j = 0; j < columns; ++j) {
      const double a = pi * i / rows, b = 2 * pi * j / columns, r = i % rows == 0 ? 0 : 2 * std::sin(a);
      s.vertices.push_back({static_cast<float>(static_cast<double>(centre.x) + r * std::cos(b)),
                            static_cast<float>(static_cast<double>(centre.y) + 2 * std::cos(a)),
                            static_cast<float>(static_cast<double>(centre.z) + r * std::sin(b))});
    }
  for (unsigned i = 0; i < rows; ++i)
    for (unsigned j = 0; j < columns; ++j) {
      const unsigned a = i * columns + j, b = i * columns + (j + 1) % columns, c = b + columns,
                     d = a + columns;
      s.triangles.insert(s.triangles.end(), {a, b, d, c, d, b});
      s.edges.insert(s.edges.end(), {a, b, a, d, b, d});
    }
  return s;
}
RTCScene scene_of_sphere(Sphere& s, bool is_robust) {
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const std::size_t count = s.vertices.size();
  s.vertices.push_back({});  // Embree reads 16 bytes of the last one
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, s.vertices.data(), 0, 12,
                             count);
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, s.triangles.data(), 0, 12,
                             s.triangles.size() / 3);
  return scene_of({g}, is_robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
}

enum class Kind { random, vertices, edges };

unsigned leaks_of(RTCScene scene, const Sphere& s, Vec centre, Kind kind) {
  std::mt19937 bits(7);
  const auto number = [&] { return static_cast<float>(bits() >> 8) * 0x1p-23f - 1; };
  unsigned leaks = 0;
  for (unsigned i = 0; i < rays; ++i) {
    const Vec o{centre.x + number(), centre.y + number(), centre.z + number()};
    Vec d{number(), number(), number()};
    const std::size_t edge = bits() % (s.edges.size() / 2);
    const float w = kind == Kind::vertices ? 0 : (1 + number()) / 2;
    if (kind != Kind::random) {
      const Vec a = s.vertices[s.edges[2 * edge]], b = s.vertices[s.edges[2 * edge + 1]];
      d = {a.x + w * (b.x - a.x) - o.x, a.y + w * (b.y - a.y) - o.y, a.z + w * (b.z - a.z) - o.z};
    }
    RTCRayHit ray = ray_of(o, d);
    rtcIntersect1(scene, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) ++leaks;
  }
  return leaks;
}

}  // namespace

int main(int argc, char** argv) {
  const bool is_robust = argc > 1 && argv[1] == std::string("robust");
  unsigned all = 0;
  for (const Vec centre : {Vec{148376, 1234, -223423}, Vec{0, 0, 0}}) {
    Sphere s = sphere_at(centre);
    RTCScene scene = scene_of_sphere(s, is_robust);
    unsigned leaks[3];
    for (const Kind kind : {Kind::random, Kind::vertices, Kind::edges})
      all += leaks[static_cast<int>(kind)] = leaks_of(scene, s, centre, kind);
    std::printf("sphere at %g, %g, %g: leaks of %u rays: random %u, at vertices %u, at edges %u\n",
                static_cast<double>(centre.x), static_cast<double>(centre.y), static_cast<double>(centre.z),
                rays, leaks[0], leaks[1], leaks[2]);
    rtcReleaseScene(scene);
  }
  return all == 0 ? 0 : 1;
}
