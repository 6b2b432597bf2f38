// The front door of calls on batches: views are checked, what a call reads is kept apart from where it writes, and no
// floating-point exception traps until the call ends.
#pragma once

#include <raylanes/queries.hpp>

#include "../../dispatch/quiet_floats.hpp"
#include "ray_source.hpp"

namespace raylanes {

// A primitive to skip, of an instance where there are some.
struct SkippedPrimitive {
  std::uint32_t primitive, instance;
};
inline SkippedPrimitive skipped_at(const PrimitiveView& skip, std::size_t i) {
  return {skip[i], skip.to_instance != 0 ? skip.instance(i) : 0};
}

// The bytes of a view: `count` elements of `size` bytes, `stride` bytes from one to the next.
struct Extent {
  const void* first;
  std::size_t count, stride, size;

  Extent(const void* elements, std::size_t n, std::size_t bytes_apart, std::size_t bytes)
      : first(elements), count(n), stride(bytes_apart), size(bytes) {}
  template <class T>
  explicit Extent(std::span<T> elements) : Extent(elements.data(), elements.size(), sizeof(T), sizeof(T)) {}
  template <class Record>
  explicit Extent(const HitRecords<Record>& hits)
      : Extent(hits.first, hits.count, hits.stride, sizeof(Record)) {}
  template <class T>
  explicit Extent(const VertexRecords<T>& points)
      : Extent(points.first, points.count, points.stride, 3 * sizeof(T)) {}
};
// Whether a byte belongs to elements of both. Takes time for each element only where both lie in one range of
// addresses and their strides differ.
bool overlap(const Extent& a, const Extent& b);
// Throws std::invalid_argument if what a call reads overlaps its results.
void require_apart(const char* call, const char* what, const Extent& read, const Extent& results);
template <class T>
void require_apart(const char* call, const RaySourceOf<T>& rays, const Extent& results) {
  if (rays.segments != nullptr) return require_apart(call, "points", Extent(rays.segments->points), results);
  const auto require = [&](const void* first, std::size_t stride, std::size_t numbers) {
    if (first != nullptr)
      require_apart(call, "rays", {first, rays.size(), stride, numbers * sizeof(T)}, results);
  };
  const RayArraysOf<T>* const arrays = rays.arrays;
  const RayParts* const parts = rays.records.parts;
  if (arrays != nullptr) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      require(arrays->origin[axis], sizeof(T), 1), require(arrays->direction[axis], sizeof(T), 1);
    require(arrays->tmin, sizeof(T), 1), require(arrays->tmax, sizeof(T), 1);
  } else if (parts != nullptr) {
    require(parts->origin.first, parts->origin.stride, 3), require(parts->tmin.first, parts->tmin.stride, 1);
    require(parts->direction.first, parts->direction.stride, 3);
    require(parts->tmax.first, parts->tmax.stride, 1);
  } else {
    require(rays.records.first, rays.records.stride, 8);
  }
}

// Copies of what a call reads of active elements, where that lies among its results. Returns views of the copies, else
// the views given.
class KeptApart {
 public:
  PrimitiveView primitives(const PrimitiveView& given, LaneBits active, const Extent& results);
  LaneBits active(LaneBits given, std::size_t count, const Extent& results);
  // Parts of a call copy their hits to look behind before they write: these may lie where results of the same rays go.
  template <class Record>
  AfterRecords<Record> after(const AfterRecords<Record>& given, LaneBits active, const Extent& results) {
    constexpr std::size_t primitive = offsetof(Record, primitive);
    const bool is_in_place = given.first == results.first && given.stride == results.stride;
    if (is_in_place || !meet(given, sizeof(Record), primitive, results)) return given;
    struct Behind {
      Record hit;
      std::uint32_t instance = 0;
    };
    hits_.resize(given.count * sizeof(Behind));
    for (std::size_t i = 0; i < given.count; ++i) {
      if (!takes_part(active, i)) continue;
      Behind behind{given[i]};
      if (given.to_instance != 0) behind.instance = given.instance(i);
      std::memcpy(hits_.data() + i * sizeof behind, &behind, sizeof behind);
    }
    const std::ptrdiff_t to_instance = offsetof(Behind, instance) - primitive;
    return {hits_.data(), given.count, sizeof(Behind), given.to_instance != 0 ? to_instance : 0};
  }

 private:
  // Whether results overlap elements of `size` bytes, or their instances.
  template <class View>
  static bool meet(const View& view, std::size_t size, std::size_t primitive, const Extent& results) {
    if (view.first == nullptr) return false;
    const auto* const index = static_cast<const std::byte*>(view.first) + primitive;
    return overlap({view.first, view.count, view.stride, size}, results) ||
           overlap({index + view.to_instance, view.count, view.stride, sizeof(std::uint32_t)}, results);
  }

  std::vector<SkippedPrimitive> primitives_;
  std::vector<std::byte> hits_;
  std::vector<std::uint8_t> bits_;
};

// A call for rays that writes a result of each: hits, bytes or counts. Throws std::invalid_argument unless views have
// elements, and as many as there are rays.
template <class T, class Options>
class CheckedCall {
  QuietFloats quiet_;
  KeptApart apart_;

 public:
  RaySourceOf<T> rays;
  Options options;

  template <class Record>
  CheckedCall(const char* call, const RaySourceOf<T>& given, const HitRecords<Record>& hits,
              const Options& by)
      : CheckedCall(call, given, by) {
    require_hits(call, hits, rays.size());
    require_after(call, options.after, rays.size());
    keep_apart(call, Extent(hits));
    options.after = apart_.after(options.after, options.active, Extent(hits));
  }
  CheckedCall(const char* call, const RaySourceOf<T>& given, std::span<std::uint8_t> occluded,
              const Options& by)
      : CheckedCall(call, given, by) {
    require_occluded(call, occluded, rays.name(), rays.size());
    keep_apart(call, Extent(occluded));
  }
  CheckedCall(const char* call, const RaySourceOf<T>& given, std::span<CrossingCount> counts,
              const Options& by)
      : CheckedCall(call, given, by) {
    require_size(call, "counts", counts.size(), "rays", rays.size());
    keep_apart(call, Extent(counts));
  }
  // A call for lists, which are new.
  CheckedCall(const char* call, const RaySourceOf<T>& given, const Options& by) : rays(given), options(by) {
    require_rays(call, rays);
    if (rays.segments != nullptr) require_points(call, rays.segments->points);
    require_skip(call, options.skip, rays.size());
  }
  CheckedCall(const CheckedCall&) = delete;
  CheckedCall& operator=(const CheckedCall&) = delete;

 private:
  void keep_apart(const char* call, const Extent& results) {
    require_apart(call, rays, results);
    rays.active = options.active = apart_.active(options.active, rays.size(), results);
    options.skip = apart_.primitives(options.skip, options.active, results);
    if (rays.skip.first != nullptr) rays.skip = options.skip;  // scenes read that of the options
  }
};

// A call for points that writes a result of each; otherwise as for rays.
template <class T>
class CheckedPoints {
  QuietFloats quiet_;
  KeptApart apart_;

 public:
  LaneBits active;

  template <class Result>
  CheckedPoints(const char* call, const VertexRecords<T>& points, const char* what, std::span<Result> results,
                LaneBits given)
      : active(given) {
    require_points(call, points);
    require_size(call, what, results.size(), "points", points.count);
    require_apart(call, "points", Extent(points), Extent(results));
    active = apart_.active(active, points.count, Extent(results));
  }
};

}  // namespace raylanes
