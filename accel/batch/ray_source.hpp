// A batch of rays in any form, and where its answers go.
#pragma once

#include <raylanes/mesh.hpp>
#include <raylanes/numbers.hpp>
#include <raylanes/rays.hpp>

#include "../../dispatch/bits.hpp"
#include "../../dispatch/checked.hpp"
#include "../standard.hpp"

namespace raylanes {

// Rays from points to one point, or in one direction. They begin at the points: beside these the other end may be far.
template <class T>
struct SegmentsOf {
  PointOf<T> to;
  VertexRecords<T> points;
  SegmentEndsOf<T> ends = {};  // as shares from the other end on
  bool is_direction = false;

  RayOf<T> operator[](std::size_t i) const {
    RayOf<T> ray;
    put(i, ray);
    return ray;
  }
  // Number by number where the ray is to lie: one that is put together elsewhere and copied waits for its own stores.
  void put(std::size_t i, RayOf<T>& ray) const {
    const PointOf<T> from = points[i];
    if (is_direction) {
      ray.origin = from, ray.direction = to;
      ray.tmin = 0, ray.tmax = std::numeric_limits<T>::infinity();
      return;
    }
    T none = 0;  // NaN if a difference is not finite
    ray.tmin = 1 - ends.end, ray.tmax = last_t();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const T difference = to[axis] - from[axis];
      ray.origin[axis] = from[axis], ray.direction[axis] = difference;
      none += difference - difference;
    }
    if (none != 0) [[unlikely]]
      halve(ray);
  }
  // The point where all end, if none goes on behind it or begins behind its own; else null.
  const PointOf<T>* shared_end() const {
    return !is_direction && ends.start >= 0 && ends.end <= 1 ? &to : nullptr;
  }

 private:
  // Not the other end itself, if that is left out by less than numbers below 1 tell.
  T last_t() const {
    constexpr T below_one = 1 - std::numeric_limits<T>::epsilon() / 2;
    const T t = 1 - ends.start;
    return ends.start > 0 && t > below_one ? below_one : t;
  }
  static bool overflows(T x) { return x - x != 0; }
  // Twice the ends of half the direction are the same segment. Points that are not finite stay so.
  void halve(RayOf<T>& ray) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      T& x = ray.direction[axis];
      x = overflows(x) ? T(0.5) * to[axis] - T(0.5) * ray.origin[axis] : T(0.5) * x;
    }
    ray.tmin *= 2, ray.tmax *= 2;
  }
};

// Whether kernels can read rays where they lie.
template <class AnyRay>
bool lie_plain(const RayRecords<AnyRay>& rays) {
  return rays.parts == nullptr && rays.stride == sizeof(AnyRay) &&
         reinterpret_cast<std::uintptr_t>(rays.first) % alignof(AnyRay) == 0;
}

// Rays as records, or as an array for each number, or between points.
template <class T>
struct RaySourceOf {
  using Ray = RayOf<T>;
  RayRecords<Ray> records = {};
  const RayArraysOf<T>* arrays = nullptr;
  const SegmentsOf<T>* segments = nullptr;
  LaneBits active = nullptr;
  PrimitiveView skip = {};  // what is not there for each ray; null: nothing is left out

  std::size_t size() const {
    return arrays != nullptr ? arrays->size : segments != nullptr ? segments->points.count : records.count;
  }
  // In messages.
  const char* name() const { return segments != nullptr ? "points" : "rays"; }
  const PointOf<T>* shared_end() const { return segments != nullptr ? segments->shared_end() : nullptr; }
  // The sides that count for the rays: segments are seen from the end that they share.
  Facing sides(Facing facing) const {
    if (segments == nullptr || segments->is_direction) return facing;
    return facing == Facing::front ? Facing::back : facing == Facing::back ? Facing::front : facing;
  }
  bool takes_part(std::size_t i) const { return raylanes::takes_part(active, i); }
  bool takes_all() const { return active == nullptr; }
  Ray operator[](std::size_t i) const {
    if (segments != nullptr) return (*segments)[i];
    if (arrays == nullptr) return records[i];
    return {{arrays->origin[0][i], arrays->origin[1][i], arrays->origin[2][i]},
            arrays->tmin[i],
            {arrays->direction[0][i], arrays->direction[1][i], arrays->direction[2][i]},
            arrays->tmax[i]};
  }
  // The rays where they lie, if kernels can read them there.
  const Ray* in_place() const {
    const bool is_plain = arrays == nullptr && segments == nullptr && active == nullptr && lie_plain(records);
    return is_plain ? static_cast<const Ray*>(records.first) : nullptr;
  }
};
using Segments = SegmentsOf<float>;
using RaySource = RaySourceOf<float>;

// The rays of a call with options, for as long as the call lasts.
template <class AnyRay, class Options>
RaySourceOf<decltype(AnyRay::tmin)> source_of(const RayRecords<AnyRay>& rays, const Options& options) {
  return {.records = rays, .active = options.active, .skip = options.skip};
}
template <class Options>
RaySource source_of(const RayArrays& rays, const Options& options) {
  return {.arrays = &rays, .active = options.active, .skip = options.skip};
}
template <class Options>
RaySourceOf<double> source_of(const RayArraysD& rays, const Options& options) {
  return {.arrays = &rays, .active = options.active, .skip = options.skip};
}
template <class T, class Options>
RaySourceOf<T> source_of(const SegmentsOf<T>& segments, const Options& options) {
  return {.segments = &segments, .active = options.active, .skip = options.skip};
}

template <class Source>
void require_rays(const char* call, const Source& rays) {
  const auto* const parts = rays.records.parts;
  const bool is_null =
      rays.records.first == nullptr || (parts != nullptr && parts->direction.first == nullptr);
  if (is_null && rays.records.count > 0)
    throw std::invalid_argument(std::string(call) + ": a view of rays points to nothing");
}
inline void require_skip(const char* call, const PrimitiveView& skip, std::size_t rays) {
  if (skip.first != nullptr || skip.count > 0) require_size(call, "skip", skip.count, "rays", rays);
  if (skip.first == nullptr && skip.count > 0)
    throw std::invalid_argument(std::string(call) + ": a view of primitives to skip points to nothing");
}
template <class Record>
void require_after(const char* call, const AfterRecords<Record>& after, std::size_t rays) {
  if (after.first != nullptr || after.count > 0) require_size(call, "after", after.count, "rays", rays);
  if (after.first == nullptr && after.count > 0)
    throw std::invalid_argument(std::string(call) + ": a view of hits to look behind points to nothing");
}
// The primitive that a ray of a call skips; the one ray of a call.
template <class Options>
std::uint32_t skipped_of(const Options& options, std::size_t i) {
  return options.skip.first != nullptr ? options.skip[i] : no_primitive;
}
template <class Options>
std::uint32_t skipped_by_one(const Options& options) {
  return skipped_of(options, 0);
}
template <class Options>
std::uint32_t skip_of_one(const char* call, const Options& options) {
  require_skip(call, options.skip, 1);
  return skipped_by_one(options);
}
template <class Number>
void require_points(const char* call, const VertexRecords<Number>& points) {
  if (points.first == nullptr && points.count > 0)
    throw std::invalid_argument(std::string(call) + ": a view of points points to nothing");
}

inline void require_occluded(const char* call, std::span<std::uint8_t> occluded, const char* of,
                             std::size_t size) {
  require_size(call, "occluded", occluded.size(), of, size);
  if (occluded.data() == nullptr && size > 0)
    throw std::invalid_argument(std::string(call) + ": a span of results points to nothing");
}
template <class Record>
void require_hits(const char* call, const HitRecords<Record>& hits, std::size_t rays) {
  require_size(call, "hits", hits.count, "rays", rays);
  if (hits.first == nullptr && hits.count > 0)
    throw std::invalid_argument(std::string(call) + ": a view of hits points to nothing");
  if (hits.stride < sizeof(Record) && hits.count > 1)
    throw std::invalid_argument(std::string(call) + ": hits " + std::to_string(hits.stride) +
                                " bytes apart, a hit has " + std::to_string(sizeof(Record)));
}

// Receives hits.
template <class Record>
struct HitSink {
  HitRecords<Record> hits;
  using Answer = Record;

  Record* in_place() const {
    const bool is_plain =
        hits.stride == sizeof(Record) && reinterpret_cast<std::uintptr_t>(hits.first) % alignof(Record) == 0;
    return is_plain ? static_cast<Record*>(hits.first) : nullptr;
  }
  void set(std::size_t i, const Record& hit) const { hits.set(i, hit); }
};
// Contiguous answers.
template <class T>
struct SpanSink {
  std::span<T> answers;
  using Answer = T;

  T* in_place() const { return answers.data(); }
  void set(std::size_t i, const T& answer) const { answers[i] = answer; }
};

}  // namespace raylanes
