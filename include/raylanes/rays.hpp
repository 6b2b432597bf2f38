// Views of batches of rays and hits.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <ranges>
#include <type_traits>
#include <utility>

#include <raylanes/mesh.hpp>
#include <raylanes/types.hpp>

namespace raylanes {

namespace detail {

template <class R, class T>
concept RangeOfRecords = std::ranges::contiguous_range<R> && std::ranges::sized_range<R> &&
    std::convertible_to<std::add_pointer_t<std::ranges::range_reference_t<R>>, T*>;

// The address of the T in the first element, which need not begin with it; null if there is none.
template <class T, class R>
T* first_of(R& range) {
  return std::ranges::size(range) == 0 ? nullptr : static_cast<T*>(std::ranges::data(range));
}

}  // namespace detail

/// Rays whose origins, directions and ends lie in arrays of their own, of any alignment: floats for Ray, doubles for
/// RayD. It owns nothing. With a stride of 0 all rays share one origin, direction or end.
struct RayParts {
  /// Numbers of each ray.
  struct Part {
    const void* first = nullptr;  ///< the numbers of the first ray
    std::size_t stride = 0;       ///< bytes from the numbers of one ray to the next ray's
  };
  Part origin;            ///< three numbers a ray
  Part direction;         ///< three numbers a ray
  Part tmin;              ///< one number a ray; null: 0
  Part tmax;              ///< one number a ray; null: +infinity
  std::size_t count = 0;  ///< the number of rays
};

/// A view of rays: a Record every `stride` bytes, of any alignment, or RayParts. It owns nothing.
/// It converts from a contiguous range of Record, or of a class derived from Record; and from RayParts, which must
/// outlive it.
template <class Record>
struct RayRecords {
  const void* first = nullptr;          ///< the first ray, or the origin of the first; null only if count = 0
  std::size_t count = 0;                ///< the number of rays
  std::size_t stride = sizeof(Record);  ///< bytes from one ray to the next, or from one origin to the next
  const RayParts* parts = nullptr;      ///< where the numbers of rays lie; null: in records

  /// Makes a view of no rays.
  RayRecords() = default;
  /// Makes a view of `size` rays, `bytes_apart` bytes from one to the next.
  RayRecords(const void* rays, std::size_t size, std::size_t bytes_apart = sizeof(Record))
      : first(rays), count(size), stride(bytes_apart) {}
  /// Makes a view of rays whose numbers lie apart.
  RayRecords(const RayParts& apart RAYLANES_LIFETIMEBOUND)
      : first(apart.origin.first), count(apart.count), stride(apart.origin.stride), parts(&apart) {}
  /// Makes a view of a range.
  template <class R>
  requires detail::RangeOfRecords<const R, const Record> RayRecords(const R& rays)
      : first(detail::first_of<const Record>(rays)),
        count(std::ranges::size(rays)),
        stride(sizeof(std::ranges::range_value_t<R>)) {}
  /// Makes a view of a temporary range, valid until the end of the full expression.
  template <detail::OwningTemporary R>
  requires detail::RangeOfRecords<const R, const Record> RayRecords(const R&& rays RAYLANES_LIFETIMEBOUND)
      : RayRecords(rays) {}

  /// Returns a copy of ray i.
  Record operator[](std::size_t i) const {
    Record ray;
    copy(i, ray);
    return ray;
  }
  /// Writes a copy of ray i to `ray`.
  void copy(std::size_t i, Record& ray) const {
    if constexpr (requires { ray.direction; })
      if (parts != nullptr) {
        read(parts->origin, i, ray.origin), read(parts->direction, i, ray.direction);
        ray.tmin = Record().tmin, ray.tmax = Record().tmax;
        if (parts->tmin.first != nullptr) read(parts->tmin, i, ray.tmin);
        if (parts->tmax.first != nullptr) read(parts->tmax, i, ray.tmax);
        return;
      }
    read({first, stride}, i, ray);
  }

 private:
  template <class Numbers>
  static void read(const RayParts::Part& part, std::size_t i, Numbers& to) {
    std::memcpy(static_cast<void*>(&to), static_cast<const std::byte*>(part.first) + i * part.stride,
                sizeof to);
  }
};
/// A view of rays of floats.
using RayView = RayRecords<Ray>;

/// The part of a segment that occluded_from() tests, as shares of its length from the shared point on: all of it, both
/// points included. If `end` is 0.999, it leaves out what is near points[i]. A point on a surface leaves out its own
/// triangle by TraceOptions::skip.
template <class T>
struct SegmentEndsOf {
  T start = 0, end = 1;
};
/// The ends of segments of floats.
using SegmentEnds = SegmentEndsOf<float>;

/// A view of hits to write: a Record every `stride` bytes, of any alignment. It owns nothing; bytes between hits are
/// left unchanged. It converts from a contiguous range of Record, or of a class derived from Record; not from a
/// temporary that owns its elements, because hits in it would be lost.
template <class Record>
struct HitRecords {
  void* first = nullptr;                ///< the first hit; null only if count = 0
  std::size_t count = 0;                ///< the number of hits
  std::size_t stride = sizeof(Record);  ///< bytes from one hit to the next

  /// Makes a view of no hits.
  HitRecords() = default;
  /// Makes a view of `size` hits, `bytes_apart` bytes from one to the next.
  HitRecords(void* hits, std::size_t size, std::size_t bytes_apart = sizeof(Record))
      : first(hits), count(size), stride(bytes_apart) {}
  /// Makes a view of a range.
  template <class R>
  requires(detail::RangeOfRecords<R, Record> && !detail::OwningTemporary<R>) HitRecords(R&& hits)
      : first(detail::first_of<Record>(hits)),
        count(std::ranges::size(hits)),
        stride(sizeof(std::ranges::range_value_t<R>)) {}

  /// Returns a copy of hit i.
  Record operator[](std::size_t i) const {
    Record hit;
    std::memcpy(static_cast<void*>(&hit), static_cast<const std::byte*>(first) + i * stride, sizeof hit);
    return hit;
  }
  /// Writes hit i.
  void set(std::size_t i, const Record& hit) const {
    std::memcpy(static_cast<std::byte*>(first) + i * stride, &hit, sizeof hit);
  }
};
/// A view of hits in trees.
using HitView = HitRecords<Hit>;

namespace detail {

// A record that names a primitive: a hit, a crossing, a closest point.
template <class T>
concept NamesPrimitive = std::same_as<decltype(T::primitive), std::uint32_t>;
template <class R>
concept RangeOfNames = std::ranges::contiguous_range<const R> && std::ranges::sized_range<const R> &&
    NamesPrimitive<std::ranges::range_value_t<const R>>;

template <class Record>
constexpr std::ptrdiff_t bytes_to_instance() {
  if constexpr (requires { Record::instance; })
    return static_cast<std::ptrdiff_t>(offsetof(Record, instance)) -
           static_cast<std::ptrdiff_t>(offsetof(Record, primitive));
  else
    return 0;
}
// A hit that is a Record, or begins with the bytes of one: hits in scenes are longer.
template <class T, class Record>
concept BeginsAs = std::derived_from<T, Record> || requires(T hit) {
  requires std::same_as<decltype(hit.t), decltype(Record::t)>;
  requires std::same_as<decltype(hit.instance), std::uint32_t>;
};
template <class R, class Record>
concept RangeOfHits = std::ranges::contiguous_range<R> && std::ranges::sized_range<R> &&
    BeginsAs<std::ranges::range_value_t<R>, Record>;

template <class R>
const void* first_primitive(const R& range) {
  return std::ranges::size(range) == 0 ? nullptr : &std::ranges::data(range)->primitive;
}

}  // namespace detail

/// A view of indices of primitives to read, one for each ray: a std::uint32_t every `stride` bytes, of any alignment.
/// It owns nothing. It converts from one index, from a contiguous range of indices, and from records that name a
/// primitive: one hit, or a contiguous range of hits, crossings or closest points, or a view of hits. A view of
/// temporaries is valid until the end of the full expression. Hits in scenes also name the instance, which scenes need.
struct PrimitiveView {
  const void* first = nullptr;                 ///< the first index; null: there are none
  std::size_t count = 0;                       ///< the number of indices
  std::size_t stride = sizeof(std::uint32_t);  ///< bytes from one index to the next
  std::ptrdiff_t to_instance = 0;  ///< bytes from an index to that of its instance; 0: there is none

  /// Makes a view of no indices.
  PrimitiveView() = default;
  /// Makes a view of `size` indices, `bytes_apart` bytes from one to the next.
  PrimitiveView(const void* primitives, std::size_t size, std::size_t bytes_apart = sizeof(std::uint32_t),
                std::ptrdiff_t bytes_to_instance = 0)
      : first(primitives), count(size), stride(bytes_apart), to_instance(bytes_to_instance) {}
  /// Makes a view of one index.
  PrimitiveView(const std::uint32_t& primitive RAYLANES_LIFETIMEBOUND) : first(&primitive), count(1) {}
  /// Makes a view of the primitive of one record.
  template <detail::NamesPrimitive Record>
  PrimitiveView(const Record& record RAYLANES_LIFETIMEBOUND)
      : first(&record.primitive), count(1), to_instance(detail::bytes_to_instance<Record>()) {}
  /// Makes a view of a range of indices.
  template <class R>
  requires detail::RangeOfRecords<const R, const std::uint32_t> PrimitiveView(
      const R& primitives RAYLANES_LIFETIMEBOUND)
      : first(detail::first_of<const std::uint32_t>(primitives)), count(std::ranges::size(primitives)) {}
  /// Makes a view of the primitives of a range of records.
  template <detail::RangeOfNames R>
  PrimitiveView(const R& records RAYLANES_LIFETIMEBOUND)
      : first(detail::first_primitive(records)),
        count(std::ranges::size(records)),
        stride(sizeof(std::ranges::range_value_t<R>)),
        to_instance(detail::bytes_to_instance<std::ranges::range_value_t<const R>>()) {}
  /// Makes a view of the primitives of hits in a view.
  template <class Record>
  PrimitiveView(const HitRecords<Record>& hits)
      : first(hits.first == nullptr
                  ? nullptr
                  : static_cast<const std::byte*>(hits.first) + offsetof(Record, primitive)),
        count(hits.count),
        stride(hits.stride),
        to_instance(detail::bytes_to_instance<Record>()) {}

  /// Returns index i.
  std::uint32_t operator[](std::size_t i) const { return word(i, 0); }
  /// Returns the instance of index i; there must be some.
  std::uint32_t instance(std::size_t i) const { return word(i, to_instance); }

 private:
  std::uint32_t word(std::size_t i, std::ptrdiff_t at) const {
    std::uint32_t index;
    std::memcpy(&index, static_cast<const std::byte*>(first) + i * stride + at, sizeof index);
    return index;
  }
};

/// A view of hits to read: for each ray the hit after which the next one is looked for, a Record every `stride` bytes,
/// of any alignment. It owns nothing. It converts from one hit, from a contiguous range of hits, and from a view of
/// hits; not from a temporary range that owns its elements. Hits in scenes also name the instance, which scenes need.
template <class Record>
struct AfterRecords {
  const void* first = nullptr;          ///< the first hit; null: there are none
  std::size_t count = 0;                ///< the number of hits
  std::size_t stride = sizeof(Record);  ///< bytes from one hit to the next
  std::ptrdiff_t to_instance = 0;  ///< bytes from the primitive of a hit to its instance; 0: there is none

  /// Makes a view of no hits.
  AfterRecords() = default;
  /// Makes a view of `size` hits, `bytes_apart` bytes from one to the next.
  AfterRecords(const void* hits, std::size_t size, std::size_t bytes_apart = sizeof(Record),
               std::ptrdiff_t bytes_to_instance = 0)
      : first(hits), count(size), stride(bytes_apart), to_instance(bytes_to_instance) {}
  /// Makes a view of one hit.
  template <detail::BeginsAs<Record> Other>
  AfterRecords(const Other& hit RAYLANES_LIFETIMEBOUND)
      : AfterRecords(address(hit), 1, sizeof(Other), detail::bytes_to_instance<Other>()) {}
  /// Makes a view of a range of hits.
  template <detail::RangeOfHits<Record> R>
  requires(!detail::OwningTemporary<R>) AfterRecords(R&& hits)
      : AfterRecords(std::ranges::size(hits) == 0 ? nullptr : address(*std::ranges::data(hits)),
                     std::ranges::size(hits), sizeof(std::ranges::range_value_t<R>),
                     detail::bytes_to_instance<std::ranges::range_value_t<R>>()) {}
  /// Makes a view of the hits in a view to write.
  template <detail::BeginsAs<Record> Other>
  AfterRecords(const HitRecords<Other>& hits)
      : AfterRecords(hits.first, hits.count, hits.stride, detail::bytes_to_instance<Other>()) {}

  /// Returns a copy of hit i.
  Record operator[](std::size_t i) const {
    Record hit;
    std::memcpy(static_cast<void*>(&hit), at(i), sizeof hit);
    return hit;
  }
  /// Returns the instance of hit i; there must be some.
  std::uint32_t instance(std::size_t i) const {
    std::uint32_t index;
    std::memcpy(&index, at(i) + offsetof(Record, primitive) + to_instance, sizeof index);
    return index;
  }

 private:
  const std::byte* at(std::size_t i) const { return static_cast<const std::byte*>(first) + i * stride; }
  template <class Other>
  static const void* address(const Other& hit) {
    if constexpr (std::derived_from<Other, Record>)
      return static_cast<const Record*>(std::addressof(hit));
    else
      return std::addressof(hit);
  }
};
/// A view of the hits after which rays look for the next.
using AfterView = AfterRecords<Hit>;

namespace detail {

// A caller's function that rejects hits, for one call.
template <class AnyHit>
struct Rejection {
  bool (*rejects)(void* function, const AnyHit& hit);
  void* function;
};
// Calls find(rejection). `rejects` may be any function or object.
template <class AnyHit, class Rejects, class Find>
auto with_rejection(Rejects& rejects, const Find& find) {
  const auto ask = [&](const AnyHit& hit) -> bool { return static_cast<bool>(rejects(hit)); };
  using Ask = std::remove_const_t<decltype(ask)>;
  return find(Rejection<AnyHit>{
      [](void* function, const AnyHit& hit) { return (*static_cast<const Ask*>(function))(hit); },
      const_cast<void*>(static_cast<const void*>(&ask))});
}

}  // namespace detail

}  // namespace raylanes
