// Rays and hits in Embree's layouts: one ray, and packets of 4, 8 and 16.
#pragma once

#include <embree3/rtcore.h>
#include <emmintrin.h>

#include <raylanes/types.hpp>

#include "../../../dispatch/checked.hpp"
#include "../../support/std.hpp"

namespace raylanes::bench {

inline constexpr float infinity = std::numeric_limits<float>::infinity();

// Embree's own limit of |x| for the coordinates of a ray. Debian's Embree is built with assertions and
// aborts the process for rays beyond it and for tmin < 0, so no such ray may reach it.
inline constexpr float largest_coordinate = 1.844e18f;

inline constexpr Ray nothing = {{0, 0, 0}, 1, {0, 0, 1}, 0};  // tmin > tmax: hits nothing

// Handles a ray that Embree must not see. Does nothing if the ray hits nothing by the contract of Ray, and throws if
// Embree cannot answer.
inline void check_outside(const Ray& ray) {
  bool finite = true, large = false;
  for (int axis = 0; axis < 3; ++axis)
    for (const float x : {ray.origin[axis], ray.direction[axis]}) {
      finite = finite && std::isfinite(x);
      large = large || std::abs(x) > largest_coordinate;
    }
  if (!finite || !(ray.tmin <= ray.tmax)) return;
  if (large)
    throw std::invalid_argument(
        "Embree: a ray has a coordinate beyond its limit, allowed are |x| <= 1.844e18");
  if (ray.tmin < 0)
    throw std::invalid_argument("Embree: a ray has tmin = " + text_of(ray.tmin) + ", allowed are tmin >= 0");
}

inline bool traceable(const Ray& ray) {
  bool inside = ray.tmin >= 0 && ray.tmin <= ray.tmax;
  for (int axis = 0; axis < 3; ++axis)
    inside = inside && std::abs(ray.origin[axis]) <= largest_coordinate &&
             std::abs(ray.direction[axis]) <= largest_coordinate;
  if (!inside) check_outside(ray);
  return inside;
}

// Rows of four lanes, turned from the array of structs into Embree's struct of arrays and back.
struct FourRays {
  __m128 origin[3], tmin, direction[3], tmax;
};

inline FourRays load_four(const Ray* rays) {
  FourRays r;
  __m128 a[4], b[4];
  for (int lane = 0; lane < 4; ++lane) {
    a[lane] = _mm_loadu_ps(rays[lane].origin.data());
    b[lane] = _mm_loadu_ps(rays[lane].direction.data());
  }
  _MM_TRANSPOSE4_PS(a[0], a[1], a[2], a[3]);
  _MM_TRANSPOSE4_PS(b[0], b[1], b[2], b[3]);
  for (int axis = 0; axis < 3; ++axis) {
    r.origin[axis] = a[axis];
    r.direction[axis] = b[axis];
  }
  r.tmin = a[3];
  r.tmax = b[3];
  return r;
}

inline __m128 traceable(const FourRays& r) {
  const __m128 magnitude = _mm_castsi128_ps(_mm_set1_epi32(0x7fffffff));
  const __m128 limit = _mm_set1_ps(largest_coordinate);
  __m128 inside = _mm_and_ps(_mm_cmple_ps(r.tmin, r.tmax), _mm_cmple_ps(_mm_setzero_ps(), r.tmin));
  for (int axis = 0; axis < 3; ++axis) {
    inside = _mm_and_ps(inside, _mm_cmple_ps(_mm_and_ps(r.origin[axis], magnitude), limit));
    inside = _mm_and_ps(inside, _mm_cmple_ps(_mm_and_ps(r.direction[axis], magnitude), limit));
  }
  return inside;
}

// Embree's assertions also look at lanes that are switched off: give those a harmless ray.
inline std::array<Ray, 4> only_traceable(const Ray* rays) {
  std::array<Ray, 4> out;
  for (std::size_t lane = 0; lane < 4; ++lane) out[lane] = traceable(rays[lane]) ? rays[lane] : nothing;
  return out;
}

template <typename Packet>
void store_four(const Ray* rays, Packet& packet, std::size_t at, std::int32_t* valid) {
  FourRays r = load_four(rays + at);
  const __m128 inside = traceable(r);
  if (_mm_movemask_ps(inside) != 0xf) r = load_four(only_traceable(rays + at).data());
  float* const origin[3] = {packet.org_x, packet.org_y, packet.org_z};
  float* const direction[3] = {packet.dir_x, packet.dir_y, packet.dir_z};
  for (int axis = 0; axis < 3; ++axis) {
    _mm_store_ps(origin[axis] + at, r.origin[axis]);
    _mm_store_ps(direction[axis] + at, r.direction[axis]);
  }
  _mm_store_ps(packet.tnear + at, r.tmin);
  _mm_store_ps(packet.tfar + at, r.tmax);
  _mm_store_ps(packet.time + at, _mm_setzero_ps());
  const auto store_bits = [at](auto* to, int bits) {
    _mm_store_si128(reinterpret_cast<__m128i*>(to + at), _mm_set1_epi32(bits));
  };
  store_bits(packet.mask, -1);
  store_bits(packet.id, 0);
  store_bits(packet.flags, 0);
  _mm_store_si128(reinterpret_cast<__m128i*>(valid + at), _mm_castps_si128(inside));
}

template <typename RayHits>
void write_four_hits(const RayHits& packet, std::size_t at, Hit* hits) {
  const auto bits = [at](const unsigned* from) {
    return _mm_load_si128(reinterpret_cast<const __m128i*>(from + at));
  };
  const __m128i none = _mm_set1_epi32(-1);
  const __m128 miss = _mm_castsi128_ps(_mm_cmpeq_epi32(bits(packet.hit.geomID), none));
  __m128 t = _mm_or_ps(_mm_and_ps(miss, _mm_set1_ps(infinity)),
                       _mm_andnot_ps(miss, _mm_load_ps(packet.ray.tfar + at)));
  __m128 u = _mm_andnot_ps(miss, _mm_load_ps(packet.hit.u + at));
  __m128 v = _mm_andnot_ps(miss, _mm_load_ps(packet.hit.v + at));
  __m128 primitive = _mm_or_ps(miss, _mm_castsi128_ps(bits(packet.hit.primID)));
  _MM_TRANSPOSE4_PS(t, u, v, primitive);
  const __m128 rows[4] = {t, u, v, primitive};
  for (int lane = 0; lane < 4; ++lane) _mm_storeu_ps(&hits[lane].t, rows[lane]);
}

// Embree marks an occluded ray by tfar = -inf; a ray that was invalid may have come with that bound.
template <typename Packet>
void write_four_flags(const Packet& packet, std::size_t at, const std::int32_t* valid, std::uint8_t* flags) {
  const __m128 done = _mm_cmpeq_ps(_mm_load_ps(packet.tfar + at), _mm_set1_ps(-infinity));
  const __m128 live = _mm_castsi128_ps(_mm_load_si128(reinterpret_cast<const __m128i*>(valid + at)));
  const int mask = _mm_movemask_ps(_mm_and_ps(done, live));
  for (int lane = 0; lane < 4; ++lane) flags[lane] = static_cast<std::uint8_t>((mask >> lane) & 1);
}

// Packets: streams of them are rtcIntersectNM and rtcOccludedNM.
template <std::size_t n, class PacketRays, class PacketRayHits, auto intersect, auto occluded>
struct Width {
  static constexpr std::size_t lanes = n;
  using Rays = PacketRays;
  using RayHits = PacketRayHits;
  static constexpr auto closest = intersect;
  static constexpr auto any = occluded;
};
using Width4 = Width<4, RTCRay4, RTCRayHit4, rtcIntersect4, rtcOccluded4>;
using Width8 = Width<8, RTCRay8, RTCRayHit8, rtcIntersect8, rtcOccluded8>;
using Width16 = Width<16, RTCRay16, RTCRayHit16, rtcIntersect16, rtcOccluded16>;

// A packet in Embree's layout, for the nearest hits or for any.
template <typename W>
struct ClosestPacket {
  alignas(64) typename W::RayHits packet;
  alignas(64) std::int32_t valid[W::lanes];

  void lay_out(const Ray* rays) {
    const __m128i none = _mm_set1_epi32(-1);
    for (std::size_t at = 0; at < W::lanes; at += 4) {
      store_four(rays, packet.ray, at, valid);
      _mm_store_si128(reinterpret_cast<__m128i*>(packet.hit.geomID + at), none);
      _mm_store_si128(reinterpret_cast<__m128i*>(packet.hit.instID[0] + at), none);
    }
  }
  void trace(RTCScene scene, RTCIntersectContext& context) { W::closest(valid, scene, &context, &packet); }
  static void trace_stream(RTCScene scene, RTCIntersectContext& context, std::span<ClosestPacket> stream) {
    rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(&stream[0].packet), W::lanes,
                   static_cast<unsigned>(stream.size()), sizeof(ClosestPacket));
  }
  void write(Hit* hits) const {
    for (std::size_t at = 0; at < W::lanes; at += 4) write_four_hits(packet, at, hits + at);
  }
  unsigned part(std::size_t lane, bool is_instance) const {
    return is_instance ? packet.hit.instID[0][lane] : packet.hit.geomID[lane];
  }
};

template <typename W>
struct AnyPacket {
  alignas(64) typename W::Rays packet;
  alignas(64) std::int32_t valid[W::lanes];

  void lay_out(const Ray* rays) {
    for (std::size_t at = 0; at < W::lanes; at += 4) store_four(rays, packet, at, valid);
  }
  void trace(RTCScene scene, RTCIntersectContext& context) { W::any(valid, scene, &context, &packet); }
  static void trace_stream(RTCScene scene, RTCIntersectContext& context, std::span<AnyPacket> stream) {
    rtcOccludedNM(scene, &context, reinterpret_cast<RTCRayN*>(&stream[0].packet), W::lanes,
                  static_cast<unsigned>(stream.size()), sizeof(AnyPacket));
  }
  void write(std::uint8_t* flags) const {
    for (std::size_t at = 0; at < W::lanes; at += 4) write_four_flags(packet, at, valid, flags + at);
  }
};

// Runs `packet(rays, results)` over whole packets; the tail goes through a padded copy.
template <std::size_t lanes, typename Result, typename Packet>
void for_each_packet(std::span<const Ray> rays, std::span<Result> results, const Packet& packet) {
  const std::size_t whole = rays.size() - rays.size() % lanes;
  for (std::size_t i = 0; i < whole; i += lanes) packet(rays.data() + i, results.data() + i);
  const std::size_t rest = rays.size() - whole;
  if (rest == 0) return;
  std::array<Ray, lanes> padded;
  padded.fill(nothing);
  std::copy_n(rays.data() + whole, rest, padded.data());
  std::array<Result, lanes> out;
  packet(padded.data(), out.data());
  std::copy_n(out.data(), rest, results.data() + whole);
}

inline RTCRay single_ray(const Ray& ray) {
  RTCRay r;
  std::memcpy(&r.org_x, &ray, 7 * sizeof(float));  // origin, tmin and direction lie alike in both
  r.time = 0;
  r.tfar = ray.tmax;
  r.mask = ~0u;
  r.id = 0;
  r.flags = 0;
  return r;
}

// A ray in Embree's layout; where Embree must not see it, one that hits nothing.
struct ClosestRay {
  RTCRayHit query;

  void lay_out(const Ray* ray) {
    query.ray = single_ray(traceable(*ray) ? *ray : nothing);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  }
  void trace(RTCScene scene, RTCIntersectContext& context) { rtcIntersect1(scene, &context, &query); }
  static void trace_stream(RTCScene scene, RTCIntersectContext& context, std::span<ClosestRay> stream) {
    rtcIntersect1M(scene, &context, &stream[0].query, static_cast<unsigned>(stream.size()),
                   sizeof(ClosestRay));
  }
  void write(Hit* hit) const {
    const bool misses = query.hit.geomID == RTC_INVALID_GEOMETRY_ID;
    *hit = misses ? Hit{infinity, 0, 0, no_primitive}
                  : Hit{query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
  }
  unsigned part(std::size_t, bool is_instance) const {
    return is_instance ? query.hit.instID[0] : query.hit.geomID;
  }
};

struct AnyRay {
  RTCRay query;

  void lay_out(const Ray* ray) { query = single_ray(traceable(*ray) ? *ray : nothing); }
  void trace(RTCScene scene, RTCIntersectContext& context) { rtcOccluded1(scene, &context, &query); }
  static void trace_stream(RTCScene scene, RTCIntersectContext& context, std::span<AnyRay> stream) {
    rtcOccluded1M(scene, &context, &stream[0].query, static_cast<unsigned>(stream.size()), sizeof(AnyRay));
  }
  void write(std::uint8_t* flag) const { *flag = query.tfar == -infinity ? 1 : 0; }
};

}  // namespace raylanes::bench
