#include <embree3/rtcore.h>

#include "../rivals.hpp"
#include "plain_scene.hpp"

namespace raylanes::bench {
namespace {

Float3 minus(const Float3& a, const Float3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Float3 plus(const Float3& a, float t, const Float3& b) {
  return {a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]};
}
float dot(const Float3& a, const Float3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Region by region, as a program without lanes has it.
Float3 closest_on(const Float3& p, const Float3& a, const Float3& b, const Float3& c) {
  const Float3 ab = minus(b, a), ac = minus(c, a), ap = minus(p, a), bp = minus(p, b), cp = minus(p, c);
  const float d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
              d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return plus(a, d1 / (d1 - d3), ab);
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return plus(a, d2 / (d2 - d6), ac);
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return plus(b, (d4 - d3) / ((d4 - d3) + (d5 - d6)), minus(c, b));
  const float share = 1.0f / (va + vb + vc);
  return plus(plus(a, vb * share, ab), vc * share, ac);
}

struct Query {
  const Mesh* mesh;
  float squared;
};

bool look_at(RTCPointQueryFunctionArguments* arguments) {
  auto& query = *static_cast<Query*>(arguments->userPtr);
  const auto& [a, b, c] = query.mesh->triangles[arguments->primID];
  const Float3 point{arguments->query->x, arguments->query->y, arguments->query->z};
  const auto& vertices = query.mesh->vertices;
  const Float3 off = minus(closest_on(point, vertices[a], vertices[b], vertices[c]), point);
  const float squared = dot(off, off);
  if (!(squared < query.squared)) return false;
  query.squared = squared;
  arguments->query->radius = std::sqrt(squared);
  return true;
}

}  // namespace

struct EmbreePoints::Scene {
  const Mesh& mesh;
  PlainScene scene;

  explicit Scene(const Mesh& of)
      : mesh(of), scene([&](RTCDevice device) { return triangles_of(device, mesh); }) {}
};

EmbreePoints::EmbreePoints(const Mesh& mesh) : scene_(std::make_unique<Scene>(mesh)) {}
EmbreePoints::~EmbreePoints() = default;

void EmbreePoints::closest(std::span<const Float3> points, std::span<double> squared) const {
  const SubnormalsAreZero subnormals;
  for (std::size_t i = 0; i < points.size(); ++i) {
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery query{};
    query.x = points[i][0], query.y = points[i][1], query.z = points[i][2];
    query.radius = std::numeric_limits<float>::infinity();
    Query best{&scene_->mesh, std::numeric_limits<float>::infinity()};
    rtcPointQuery(scene_->scene.get(), &query, &context, look_at, &best);
    squared[i] = static_cast<double>(best.squared);
  }
}

}  // namespace raylanes::bench
