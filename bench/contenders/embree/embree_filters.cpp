#include <embree3/rtcore.h>

#include "../rivals.hpp"
#include "embree_layouts.hpp"
#include "plain_scene.hpp"

namespace raylanes::bench {
namespace {

RTCRayHit query_of(const Ray& ray) {
  RTCRayHit query;
  query.ray = single_ray(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return query;
}

struct Gathering : RTCIntersectContext {
  std::vector<Hit>* hits;
};
void gather(const RTCFilterFunctionNArguments* a) {
  const auto* ray = reinterpret_cast<const RTCRay*>(a->ray);
  const auto* hit = reinterpret_cast<const RTCHit*>(a->hit);
  static_cast<Gathering*>(a->context)->hits->push_back({ray->tfar, hit->u, hit->v, hit->primID});
  a->valid[0] = 0;
}

struct Keeping : RTCIntersectContext {
  unsigned share;
};
void keep_some(const RTCFilterFunctionNArguments* a) {
  const auto* hit = reinterpret_cast<const RTCHit*>(a->hit);
  const float t = reinterpret_cast<const RTCRay*>(a->ray)->tfar;
  if (is_rejected({t, hit->u, hit->v, hit->primID}, static_cast<Keeping*>(a->context)->share))
    a->valid[0] = 0;
}

}  // namespace

struct EmbreeFilters::Scene {
  PlainScene plain;

  Scene(const Mesh& mesh, bool is_robust)
      : plain([&](RTCDevice device) { return triangles_of(device, mesh); },
              static_cast<RTCSceneFlags>((is_robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE) |
                                         RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION)) {}
};

EmbreeFilters::EmbreeFilters(const Mesh& mesh, bool is_robust)
    : scene_(std::make_unique<Scene>(mesh, is_robust)) {}
EmbreeFilters::~EmbreeFilters() = default;

void EmbreeFilters::all_hits(std::span<const Ray> rays, RayLists<Hit>& lists) const {
  const SubnormalsAreZero subnormals;
  Gathering context;
  rtcInitIntersectContext(&context);
  context.filter = gather, context.hits = &lists.items;
  lists.items.clear(), lists.offsets.assign(1, 0);
  for (const Ray& ray : rays) {
    if (traceable(ray)) {
      RTCRayHit query = query_of(ray);
      rtcIntersect1(scene_->plain.get(), &context, &query);
      std::sort(
          lists.items.begin() + static_cast<std::ptrdiff_t>(lists.offsets.back()), lists.items.end(),
          [](const Hit& a, const Hit& b) { return a.t < b.t || (a.t == b.t && a.primitive < b.primitive); });
    }
    lists.offsets.push_back(lists.items.size());
  }
}

void EmbreeFilters::keep(std::span<const Ray> rays, bool only_decides, unsigned share,
                         std::span<std::uint8_t> found) const {
  const SubnormalsAreZero subnormals;
  Keeping context;
  rtcInitIntersectContext(&context);
  context.filter = keep_some, context.share = share;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    found[i] = 0;
    if (!traceable(rays[i])) continue;
    RTCRayHit query = query_of(rays[i]);
    if (only_decides) {
      rtcOccluded1(scene_->plain.get(), &context, &query.ray);
      found[i] = query.ray.tfar < 0 ? 1 : 0;
    } else {
      rtcIntersect1(scene_->plain.get(), &context, &query);
      found[i] = query.hit.geomID != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
    }
  }
}

}  // namespace raylanes::bench
