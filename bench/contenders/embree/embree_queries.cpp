#include "embree_queries.hpp"

#include <algorithm>
#include <chrono>
#include <vector>

#include "embree_layouts.hpp"

namespace raylanes::bench {
namespace {

RTCIntersectContext make_context(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

// The differences between the two queries.
struct Closest {
  using Result = Hit;
  using Single = ClosestRay;
  template <typename W>
  using Packet = ClosestPacket<W>;
};
struct Any {
  using Result = std::uint8_t;
  using Single = AnyRay;
  template <typename W>
  using Packet = AnyPacket<W>;
};

// Calls with the packet of the mode and its lanes: `with.template operator()<Packet, lanes>()`.
template <typename Query, typename With>
void with_packet(EmbreeMode mode, const With& with) {
  switch (mode) {
    case EmbreeMode::single:
      return with.template operator()<typename Query::Single, 1>();
    case EmbreeMode::packet4:
      return with.template operator()<typename Query::template Packet<Width4>, 4>();
    case EmbreeMode::packet8:
      return with.template operator()<typename Query::template Packet<Width8>, 8>();
    case EmbreeMode::packet16:
      return with.template operator()<typename Query::template Packet<Width16>, 16>();
  }
}

template <typename Query>
void trace(RTCScene scene, EmbreeMode mode, bool coherent, std::span<const Ray> rays,
           std::span<typename Query::Result> results) {
  RTCIntersectContext context = make_context(coherent);
  with_packet<Query>(mode, [&]<typename Packet, std::size_t lanes>() {
    for_each_packet<lanes>(rays, results, [&](const Ray* in, typename Query::Result* out) {
      Packet packet;
      packet.lay_out(in);
      packet.trace(scene, context);
      packet.write(out);
    });
  });
}

template <typename Query>
double trace_packed(RTCScene scene, EmbreeMode mode, bool coherent, std::span<const Ray> rays,
                    std::span<typename Query::Result> results) {
  using Clock = std::chrono::steady_clock;
  using Result = typename Query::Result;
  RTCIntersectContext context = make_context(coherent);
  double seconds = 0.0;
  with_packet<Query>(mode, [&]<typename Packet, std::size_t lanes>() {
    std::vector<Packet> packets((rays.size() + lanes - 1) / lanes);
    std::size_t at = 0;
    for_each_packet<lanes>(rays, results, [&](const Ray* in, Result*) { packets[at++].lay_out(in); });
    const Clock::time_point start = Clock::now();
    for (Packet& packet : packets) packet.trace(scene, context);
    seconds = std::chrono::duration<double>(Clock::now() - start).count();
    at = 0;
    for_each_packet<lanes>(rays, results, [&](const Ray*, Result* out) { packets[at++].write(out); });
  });
  return seconds;
}

}  // namespace

void trace_closest(RTCScene scene, EmbreeMode mode, bool coherent, std::span<const Ray> rays,
                   std::span<Hit> hits) {
  trace<Closest>(scene, mode, coherent, rays, hits);
}

void trace_any(RTCScene scene, EmbreeMode mode, bool coherent, std::span<const Ray> rays,
               std::span<std::uint8_t> occluded) {
  trace<Any>(scene, mode, coherent, rays, occluded);
}

double trace_packed_closest(RTCScene scene, EmbreeMode mode, bool coherent, std::span<const Ray> rays,
                            std::span<Hit> hits) {
  return trace_packed<Closest>(scene, mode, coherent, rays, hits);
}

double trace_packed_any(RTCScene scene, EmbreeMode mode, bool coherent, std::span<const Ray> rays,
                        std::span<std::uint8_t> occluded) {
  return trace_packed<Any>(scene, mode, coherent, rays, occluded);
}

void trace_all(RTCScene scene, std::span<const Ray> rays, RayLists<Hit>& lists) {
  struct Gathering : RTCIntersectContext {
    std::vector<Hit>* hits;
  } context;
  rtcInitIntersectContext(&context);
  context.filter = [](const RTCFilterFunctionNArguments* a) {
    const auto* ray = reinterpret_cast<const RTCRay*>(a->ray);
    const auto* hit = reinterpret_cast<const RTCHit*>(a->hit);
    static_cast<Gathering*>(a->context)->hits->push_back({ray->tfar, hit->u, hit->v, hit->primID});
    a->valid[0] = 0;
  };
  context.hits = &lists.items;
  lists.items.clear(), lists.offsets.assign(1, 0);
  for (const Ray& ray : rays) {
    if (traceable(ray)) {
      RTCRayHit query;
      query.ray = single_ray(ray);
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene, &context, &query);
      std::sort(
          lists.items.begin() + static_cast<std::ptrdiff_t>(lists.offsets.back()), lists.items.end(),
          [](const Hit& a, const Hit& b) { return a.t < b.t || (a.t == b.t && a.primitive < b.primitive); });
    }
    lists.offsets.push_back(lists.items.size());
  }
}

}  // namespace raylanes::bench
