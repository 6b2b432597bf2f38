// Options and results of all hits, crossings, filters, and inside and outside. docs/crossings.md has the definitions.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include <raylanes/mesh.hpp>
#include <raylanes/progress.hpp>
#include <raylanes/rays.hpp>
#include <raylanes/traversal.hpp>
#include <raylanes/types.hpp>

namespace raylanes {

struct Path;  // <raylanes/paths.hpp>

namespace detail {

// The types of a class with queries: Number, Hit, Options; Crossing, ClosestPoint, ClosestOptions, DistanceOptions for
// such calls.
template <class Tree>
struct QueryTypes;

}  // namespace detail

/// Options of all_hits(), crossings() and count_crossings().
struct ListOptions {
  std::uint32_t max_count =
      0xffffffffu;              ///< keep the first so many items of each ray; up to 64 shorten the search
  Facing facing = Facing::any;  ///< keep hits of these sides only; of crossings, front: side −1, back: side 1
  const Path* path = nullptr;  ///< an ISA path that this machine supports; null: the active one
  int threads = 1;  ///< 1: the calling thread; n: up to n, at most one a core; 0: the caller's oneTBB arena
  LaneBits active = nullptr;  ///< the active rays; the others have empty lists; null: all
  PrimitiveView skip =
      {};  ///< for each ray a triangle that is not there for it; empty: none; as in TraceOptions
  std::uint32_t mask = ~0u;  ///< of instances of a scene, or with `masks`, as in TraceOptions
  std::span<const std::uint32_t> masks = {};  ///< of triangles, as in TraceOptions
  TraceCounters* counters =
      nullptr;  ///< as in TraceOptions; rays are traced individually then, sorting is not counted
  /// If not null, called between parts, as Progress says; if it throws, any counts may be written.
  const Progress* progress = nullptr;
};

/// A list of items for each ray.
template <class Item>
struct RayLists {
  std::vector<std::size_t> offsets{
      0};                   ///< where each ray's items begin, and the end of the last: one more than rays
  std::vector<Item> items;  ///< the items of all rays, ray by ray

  /// Returns the number of rays.
  std::size_t size() const { return offsets.size() - 1; }
  /// Returns the items of a ray. The span is valid until the lists change or are destroyed.
  std::span<const Item> operator[](std::size_t ray) const& {
    return std::span<const Item>(items).subspan(offsets[ray], offsets[ray + 1] - offsets[ray]);
  }
  /// Does not compile: temporary lists are destroyed before a loop over their items begins.
  std::span<const Item> operator[](std::size_t ray) const&& = delete;
};

/// A crossing of a ray and a surface.
template <class T>
struct CrossingOf {
  T t;                      ///< the exact quotient, rounded once
  std::uint32_t primitive;  ///< the triangle
  std::int32_t
      side;  ///< 1: along the normal (v1 − v0) × (v2 − v0), out of a solid; −1: against it, into a solid

  bool operator==(const CrossingOf&) const = default;
};
/// A crossing of a ray of floats.
using Crossing = CrossingOf<float>;
/// A crossing of a ray of doubles.
using CrossingD = CrossingOf<double>;

/// A function that rejects hits, a batch at a time: hits[k] is a hit of ray rays[k] of the call. Set rejected[k], which
/// is 0, to 1 to trace the ray on after this hit.
/// The calling thread calls it with hits of many rays at a time, one of each, behind the traversal. It sees the hits of
/// a ray in order, each once, up to the one that it keeps. Exceptions pass through. It is for functions that are dear
/// to call, as in Python; a function of a ray and a hit is asked during the traversal, in half the time.
template <class AnyHit>
using HitFilterOf = std::function<void(std::span<const std::size_t> rays, std::span<const AnyHit> hits,
                                       std::span<std::uint8_t> rejected)>;
/// A filter of hits of floats.
using HitFilter = HitFilterOf<Hit>;
/// A filter of hits of doubles.
using HitFilterD = HitFilterOf<HitD>;

namespace detail {

// A filter of batches, but not one that is asked during the search.
template <class Asked, class AnyHit>
concept FiltersLists = std::convertible_to<Asked, HitFilterOf<AnyHit>> &&
    (!std::predicate<const Asked&, std::size_t, const AnyHit&>);

// The rejection of hits in one call for a batch: a filter, or if that is null a function of lists, which any thread
// calls.
template <class AnyHit>
struct BatchRejection {
  const HitFilterOf<AnyHit>* filter = nullptr;
  void (*reject)(void* function, const std::size_t* rays, const AnyHit* hits, std::uint8_t* rejected,
                 std::size_t count) = nullptr;
  void* function = nullptr;
};
// Calls find(rejection). `rejects` may be any function or object.
template <class AnyHit, class Rejects, class Find>
void with_batch_rejection(Rejects& rejects, const Find& find) {
  const auto ask = [&](const std::size_t* rays, const AnyHit* hits, std::uint8_t* rejected,
                       std::size_t count) {
    for (std::size_t k = 0; k < count; ++k)
      rejected[k] = static_cast<bool>(rejects(rays[k], hits[k])) ? 1 : 0;
  };
  using Ask = std::remove_const_t<decltype(ask)>;
  find(BatchRejection<AnyHit>{
      nullptr,
      [](void* function, const std::size_t* rays, const AnyHit* hits, std::uint8_t* rejected,
         std::size_t count) { (*static_cast<const Ask*>(function))(rays, hits, rejected, count); },
      const_cast<void*>(static_cast<const void*>(&ask))});
}

}  // namespace detail

/// Rejects hits where the masks of ray and triangle have no bit in common: during the search, or as a HitFilter.
struct MaskFilter {
  std::span<const std::uint32_t> of_rays;       ///< a mask for each ray of the call
  std::span<const std::uint32_t> of_triangles;  ///< and for each triangle of the mesh

  /// Whether a hit of a ray is rejected.
  bool operator()(std::size_t ray, const Hit& hit) const {
    return (of_rays[ray] & of_triangles[hit.primitive]) == 0;
  }
  /// The same as a HitFilter.
  void operator()(std::span<const std::size_t> rays, std::span<const Hit> hits,
                  std::span<std::uint8_t> rejected) const {
    for (std::size_t k = 0; k < rays.size(); ++k) rejected[k] = (*this)(rays[k], hits[k]) ? 1 : 0;
  }
};
/// Returns a filter that keeps a hit if the masks of ray and triangle have a bit in common.
/// There must be a mask for each ray of the call and for each triangle of the mesh. The filter keeps both spans, so the
/// masks must outlive the filter. If all rays have one mask, TraceOptions::masks does the same in the walk.
inline MaskFilter mask_filter(std::span<const std::uint32_t> of_rays,
                              std::span<const std::uint32_t> of_triangles) {
  return {of_rays, of_triangles};
}

/// Does not compile: the filter would keep a view of a temporary.
template <class Rays, class Triangles>
MaskFilter mask_filter(Rays&& of_rays,
                       Triangles&& of_triangles) requires(detail::OwningTemporary<Rays> ||
                                                          detail::OwningTemporary<Triangles>) = delete;

/// The location of a point. Triangles without an area hold no point.
enum class Location : std::uint8_t {
  outside,  ///< outside the mesh
  inside,   ///< inside the mesh
  on        ///< on a triangle, exactly
};
/// The names of the locations, by enumerator.
inline constexpr std::array<std::string_view, 3> location_names{"outside", "inside", "on"};

/// When a point counts as inside. For a closed surface that does not intersect itself all rules agree.
enum class InsideRule : std::uint8_t {
  /// A ray from the point crosses the surface an odd number of times.
  parity,
  /// The sides of the crossings do not add up to 0: for solids that overlap, or are nested, with normals that all point
  /// out. A shell that bounds a hole must have normals into the hole.
  nonzero,
  /// Four or more of the six rays along the axes cross the surface an odd number of times: for meshes with holes, where
  /// the other rules depend on the direction of the ray. Takes up to six times as long.
  vote,
  /// The generalised winding number is ½ or more, as PointQueries::winding_numbers() defines it: for meshes with holes,
  /// faces turned over, or triangles that have nothing in common. On closed meshes with normals that all point out it
  /// agrees with `nonzero`. Takes the tree's boundary, which the first call finds.
  winding
};
/// The names of the rules, by enumerator.
inline constexpr std::array<std::string_view, 4> inside_rule_names{"parity", "nonzero", "vote", "winding"};

/// Options of locate(), and of Scene::innermost_parts() and Scene::containing_parts().
struct LocateOptions {
  InsideRule rule = InsideRule::parity;  ///< when a point counts as inside
  const Path* path = nullptr;            ///< an ISA path that this machine supports; null: the active one
  int threads = 1;  ///< 1: the calling thread; n: up to n, at most one a core; 0: the caller's oneTBB arena
  LaneBits active = nullptr;          ///< the active points; null: all
  std::uint32_t mask = ~0u;           ///< of instances of a scene, as in TraceOptions
  TraceCounters* counters = nullptr;  ///< as in TraceOptions
  /// If not null, called between parts, as Progress says; if it throws, any locations may be written.
  const Progress* progress = nullptr;
};

/// Options of winding_numbers().
struct WindingOptions {
  /// The greatest error of expansions that take the place of far parts of the boundary; 0: none do. Must not be
  /// negative or NaN. The larger, the faster.
  double accuracy = 1e-6;
  const Path* path = nullptr;  ///< an ISA path that this machine supports; null: the active one
  int threads = 1;  ///< 1: the calling thread; n: up to n, at most one a core; 0: the caller's oneTBB arena
  LaneBits active = nullptr;          ///< the active points; null: all
  std::uint32_t mask = ~0u;           ///< of instances of a scene, as in TraceOptions
  TraceCounters* counters = nullptr;  ///< as in TraceOptions, of the points' rays
  /// If not null, called between parts, as Progress says; if it throws, any numbers may be written.
  const Progress* progress = nullptr;
};

/// Options of signed_distances().
struct SignedDistanceOptions {
  InsideRule rule = InsideRule::parity;  ///< when a point counts as inside
  /// Points farther away get an infinity with the sign of their side: the smaller, the faster. If it is NaN or
  /// negative, all points off the mesh do.
  float max_distance = std::numeric_limits<float>::infinity();
  const Path* path = nullptr;  ///< an ISA path that this machine supports; null: the active one
  int threads = 1;  ///< 1: the calling thread; n: up to n, at most one a core; 0: the caller's oneTBB arena
  LaneBits active = nullptr;          ///< the active points; null: all
  std::uint32_t mask = ~0u;           ///< of instances of a scene, as in TraceOptions
  TraceCounters* counters = nullptr;  ///< as in TraceOptions, of both searches
  /// If not null, called between parts, as Progress says; if it throws, any distances may be written.
  const Progress* progress = nullptr;
};

}  // namespace raylanes
