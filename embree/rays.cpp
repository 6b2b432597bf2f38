// rtcIntersect… and rtcOccluded…: single rays, packets and streams.
#include <algorithm>
#include <cstring>
#include <span>

#include "trace.hpp"

namespace embree {
namespace {

constexpr float minus_infinity = -std::numeric_limits<float>::infinity();
constexpr std::size_t most_in_batch = std::size_t{1} << 17, most_in_packet = 512;
// Fewer rays are traced as single ones. Rays that are said to be coherent go as a packet from 16 on.
constexpr std::size_t fewest_in_batch = 32, fewest_coherent = 16;
constexpr int words_of_ray = 12, words_of_both = 20;  // 32-bit numbers of RTCRay and RTCRayHit
static_assert(sizeof(RTCRayHit) / 4 >= words_of_both && offsetof(RTCRayHit, hit) == 4 * words_of_ray);

// Rays in any layout: word k of ray i, of the hit from 12 on, is at locate(k, i).
template <class Locate>
class Rays {
 public:
  Rays(std::size_t size, bool with_hits, const int* valid, Locate locate)
      : size_(size), with_hits_(with_hits), valid_(valid), locate_(locate) {}

  std::size_t size() const { return size_; }
  bool with_hits() const { return with_hits_; }
  bool is_active(std::size_t i) const {
    return (valid_ == nullptr || valid_[i] != 0) && number(3, i) <= number(8, i);
  }
  unsigned mask(std::size_t i) const { return word(9, i); }
  raylanes::Ray ray(std::size_t i, bool is_robust) const {
    return {{number(0, i), number(1, i), number(2, i)},
            tmin_of(number(3, i), is_robust),
            {number(4, i), number(5, i), number(6, i)},
            number(8, i)};
  }
  void read(std::size_t i, RTCRay& ray) const {
    for (int k = 0; k < words_of_ray; ++k) copy(locate_(k, i), reinterpret_cast<std::byte*>(&ray) + 4 * k);
  }
  void set_far(std::size_t i, float far) const { number(8, i) = far; }
  void set_hit(std::size_t i, const RTCHit& hit) const {
    for (int k = words_of_ray; k < words_of_both; ++k)
      copy(reinterpret_cast<const std::byte*>(&hit) + 4 * (k - words_of_ray), locate_(k, i));
  }

 private:
  static void copy(const void* from, void* to) { std::memcpy(to, from, 4); }
  float& number(int k, std::size_t i) const { return *static_cast<float*>(locate_(k, i)); }
  unsigned& word(int k, std::size_t i) const { return *static_cast<unsigned*>(locate_(k, i)); }

  std::size_t size_;
  bool with_hits_;
  const int* valid_;
  Locate locate_;
};

bool is_coherent(const RTCIntersectContext* context) {
  return (context->flags & RTC_INTERSECT_CONTEXT_FLAG_COHERENT) != 0;
}

// Whether neighbours among the coherent rays of this thread's last call mostly met the same triangle. Otherwise small
// packets lose against single rays.
thread_local bool are_dense = true;
void note_density(std::span<const raylanes::SceneHit> hits) {
  std::size_t changes = 0;
  for (std::size_t i = 1; i < hits.size(); ++i) changes += hits[i].primitive != hits[i - 1].primitive;
  are_dense = 4 * changes <= hits.size();
}

// Many rays that no callback sees, as batches of raylanes.
template <class Locate>
void trace_batch(const Built& built, const RTCIntersectContext* context, const Rays<Locate>& rays,
                 unsigned mask) {
  thread_local std::vector<raylanes::Ray> copies;
  thread_local std::vector<raylanes::SceneHit> hits;
  thread_local std::vector<std::uint8_t> occluded;
  raylanes::TraceOptions options{.mask = mask};
  const bool is_small = is_coherent(context) && rays.size() <= most_in_packet;
  if (is_coherent(context)) {
    options.hint = raylanes::BatchHint::coherent;
    if (are_dense && is_small) options.mode = raylanes::TraversalMode::packet;
  }
  for (std::size_t begin = 0; begin < rays.size(); begin += most_in_batch) {
    const std::size_t size = std::min(most_in_batch, rays.size() - begin);
    copies.resize(size);
    for (std::size_t i = 0; i < size; ++i)
      copies[i] = rays.is_active(begin + i) ? rays.ray(begin + i, built.is_robust) : raylanes::Ray();
    if (!rays.with_hits()) {
      occluded.resize(size);
      built.placed.occluded(copies, occluded, options);
      for (std::size_t i = 0; i < size; ++i)
        if (occluded[i] != 0) rays.set_far(begin + i, minus_infinity);
      continue;
    }
    hits.resize(size);
    built.placed.closest(copies, hits, options);
    if (is_small) note_density(hits);
    for (std::size_t i = 0; i < size; ++i)
      if (const raylanes::SceneHit& found = hits[i]) {
        RTCHit hit;
        put_placed(built, found, context->instID[0], hit);
        rays.set_far(begin + i, found.t), rays.set_hit(begin + i, hit);
      }
  }
}

template <class Locate>
void trace_single(const Built& built, RTCIntersectContext* context, const Rays<Locate>& rays, std::size_t i) {
  RTCRayHit both;
  rays.read(i, both.ray);
  if (!rays.with_hits()) {
    if (trace_occluded(built, context, both.ray)) rays.set_far(i, minus_infinity);
    return;
  }
  both.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  const float far = both.ray.tfar;
  trace_closest(built, context, both);
  if (both.ray.tfar < far || both.hit.geomID != RTC_INVALID_GEOMETRY_ID)
    rays.set_far(i, both.ray.tfar), rays.set_hit(i, both.hit);
}

template <class Locate>
void trace(const Built& built, RTCIntersectContext* context, const Rays<Locate>& rays) {
  const std::size_t fewest = is_coherent(context) ? fewest_coherent : fewest_in_batch;
  if (rays.size() >= fewest && uses_placed(built, context) && built.other_count == 0) {
    const unsigned mask = rays.mask(0);
    bool is_same = true;
    for (std::size_t i = 1; i < rays.size() && is_same; ++i) is_same = rays.mask(i) == mask;
    if (is_same) return trace_batch(built, context, rays, mask);
  }
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays.is_active(i)) trace_single(built, context, rays, i);
}

// A call with rays, `first` of which is not null. It holds no reference: a scene outlives its calls.
template <class Trace>
void on_scene(RTCScene handle, const RTCIntersectContext* context, const void* first, Trace&& trace_in) {
  const Scene* const scene = of(handle);
  guarded(scene == nullptr ? nullptr : scene->device.get(), [&] {
    require_some(scene, context, first);
    trace_in(*scene->built);
  });
}
template <class Locate>
void on_rays(RTCScene handle, RTCIntersectContext* context, const void* first, std::size_t size,
             bool with_hits, const int* valid, Locate locate) {
  on_scene(handle, context, first,
           [&](const Built& built) { trace(built, context, Rays<Locate>(size, with_hits, valid, locate)); });
}

// Packets of `lanes` rays, one array per word in each, `stride` bytes from one packet to the next.
void on_packets(RTCScene handle, RTCIntersectContext* context, void* first, std::size_t lanes,
                std::size_t packets, std::size_t stride, bool with_hits) {
  auto* const bytes = static_cast<std::byte*>(first);
  on_rays(handle, context, first, lanes * packets, with_hits, nullptr, [=](int k, std::size_t i) -> void* {
    return bytes + i / lanes * stride + (static_cast<std::size_t>(k) * lanes + i % lanes) * 4;
  });
}
template <std::size_t lanes>
void on_packet(const int* valid, RTCScene handle, RTCIntersectContext* context, void* first, bool with_hits) {
  auto* const words = static_cast<unsigned*>(first);
  on_rays(handle, context, first, lanes, with_hits, valid,
          [=](int k, std::size_t i) -> void* { return words + static_cast<std::size_t>(k) * lanes + i; });
}
void on_records(RTCScene handle, RTCIntersectContext* context, void* first, std::size_t size,
                std::size_t stride, bool with_hits) {
  auto* const bytes = static_cast<std::byte*>(first);
  on_rays(handle, context, first, size, with_hits, nullptr,
          [=](int k, std::size_t i) -> void* { return bytes + i * stride + 4 * k; });
}
void on_pointers(RTCScene handle, RTCIntersectContext* context, void* const* first, std::size_t size,
                 bool with_hits) {
  on_rays(handle, context, first, size, with_hits, nullptr,
          [=](int k, std::size_t i) -> void* { return static_cast<std::byte*>(first[i]) + 4 * k; });
}
// Arrays, some of which may be missing: then tnear is 0, tfar infinite, the mask has all bits.
void on_arrays(RTCScene handle, RTCIntersectContext* context, const void* first, std::size_t size,
               bool with_hits) {
  thread_local unsigned missing[words_of_both];
  std::fill(missing, missing + words_of_both, 0u);
  missing[8] = std::bit_cast<unsigned>(-minus_infinity), missing[9] = ~0u;
  auto* const* const arrays = static_cast<unsigned* const*>(first);
  on_rays(handle, context, first, size, with_hits, nullptr,
          [=](int k, std::size_t i) -> void* { return arrays[k] == nullptr ? &missing[k] : arrays[k] + i; });
}

}  // namespace
}  // namespace embree

using namespace embree;

RTC_API void rtcIntersect1(RTCScene handle, RTCIntersectContext* context, RTCRayHit* ray) {
  on_scene(handle, context, ray, [&](const Built& built) {
    if (ray->ray.tnear <= ray->ray.tfar) trace_closest(built, context, *ray);
  });
}
RTC_API void rtcOccluded1(RTCScene handle, RTCIntersectContext* context, RTCRay* ray) {
  on_scene(handle, context, ray, [&](const Built& built) {
    if (!(ray->tnear <= ray->tfar)) return;
    const float far = ray->tfar;
    ray->tfar = trace_occluded(built, context, *ray) ? minus_infinity : far;
  });
}
RTC_API void rtcIntersect4(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRayHit4* rays) {
  on_packet<4>(valid, scene, context, rays, true);
}
RTC_API void rtcIntersect8(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRayHit8* rays) {
  on_packet<8>(valid, scene, context, rays, true);
}
RTC_API void rtcIntersect16(const int* valid, RTCScene scene, RTCIntersectContext* context,
                            RTCRayHit16* rays) {
  on_packet<16>(valid, scene, context, rays, true);
}
RTC_API void rtcOccluded4(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRay4* rays) {
  on_packet<4>(valid, scene, context, rays, false);
}
RTC_API void rtcOccluded8(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRay8* rays) {
  on_packet<8>(valid, scene, context, rays, false);
}
RTC_API void rtcOccluded16(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRay16* rays) {
  on_packet<16>(valid, scene, context, rays, false);
}
RTC_API void rtcIntersect1M(RTCScene scene, RTCIntersectContext* context, RTCRayHit* rays, unsigned count,
                            size_t stride) {
  on_records(scene, context, rays, count, stride, true);
}
RTC_API void rtcOccluded1M(RTCScene scene, RTCIntersectContext* context, RTCRay* rays, unsigned count,
                           size_t stride) {
  on_records(scene, context, rays, count, stride, false);
}
RTC_API void rtcIntersect1Mp(RTCScene scene, RTCIntersectContext* context, RTCRayHit** rays, unsigned count) {
  on_pointers(scene, context, reinterpret_cast<void* const*>(rays), count, true);
}
RTC_API void rtcOccluded1Mp(RTCScene scene, RTCIntersectContext* context, RTCRay** rays, unsigned count) {
  on_pointers(scene, context, reinterpret_cast<void* const*>(rays), count, false);
}
RTC_API void rtcIntersectNM(RTCScene scene, RTCIntersectContext* context, RTCRayHitN* rays, unsigned lanes,
                            unsigned packets, size_t stride) {
  on_packets(scene, context, rays, lanes, packets, stride, true);
}
RTC_API void rtcOccludedNM(RTCScene scene, RTCIntersectContext* context, RTCRayN* rays, unsigned lanes,
                           unsigned packets, size_t stride) {
  on_packets(scene, context, rays, lanes, packets, stride, false);
}
RTC_API void rtcIntersectNp(RTCScene scene, RTCIntersectContext* context, const RTCRayHitNp* rays,
                            unsigned count) {
  on_arrays(scene, context, rays, count, true);
}
RTC_API void rtcOccludedNp(RTCScene scene, RTCIntersectContext* context, const RTCRayNp* rays,
                           unsigned count) {
  on_arrays(scene, context, rays, count, false);
}
