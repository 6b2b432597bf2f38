// All that a ray meets, in one traversal. While the traversal runs a hit is a leaf triangle with a bound of its t; t, u
// and v are computed for all lists of a call together, a register of hits at a time. docs/crossings.md says what
// crossings are.
#pragma once

#include <bit>

#include "../../dispatch/bits.hpp"
#include "../../dispatch/table/double_rays.hpp"
#include "../exact/exact_test.hpp"
#include "../traverse/single.hpp"
#include "nearest_few.hpp"

namespace raylanes {
namespace {

inline void add_side(CrossingCount& count, bool is_against_normal) {
  ++count.crossings, count.winding += is_against_normal ? -1 : 1;
}

// The memory of a list's entries.
template <class T>
struct HitStore {
  using Number = T;
  ListEntryOf<T>*next, *end;       // the entries that there is still room for
  ListEntryOf<T>* list = nullptr;  // where the ray's list begins
  CrossingCount* count = nullptr;  // what a full list of sides is added to; null: none

  // Returns false, and keeps nothing, if there is no room.
  bool put(std::int16_t side, std::uint32_t leaf_triangle, std::uint32_t primitive,
           std::uint16_t zero_weights) {
    if (next == end) [[unlikely]] {
      if (count == nullptr) return false;
      add_to_count();
    }
    next->t = 0, next->leaf_triangle = leaf_triangle, next->primitive = primitive;
    next->side = side, next->zero_weights = zero_weights;
    ++next;
    return true;
  }
  // Empties a list of sides into the count.
  [[gnu::noinline]] void add_to_count() {
    for (const ListEntryOf<T>* entry = list; entry != next; ++entry) add_side(*count, entry->side < 0);
    next = list;
  }
};

// The list of a ray while it is traced.
template <class Store>
struct HitList {
  using T = typename Store::Number;
  const ListBatchOf<T>& batch;
  std::uint32_t skipped;
  T tmax;
  Store store;
  bool is_full = false;
  NearestFew<T> nearest;

  HitList(const ListBatchOf<T>& of, std::size_t ray, Store to)
      : batch(of),
        skipped(skipped_by(batch, ray)),
        tmax(finite_tmax(batch.rays[ray].tmax)),
        store(to),
        nearest(batch.kind == ListKind::hits ? batch.max_count : 0) {}
  float box_tmax() const { return tmax; }
  static bool may_hit(const TreeView& tree, const Ray& ray) {
    return tree.root != empty_reference && is_valid(ray);
  }

  // With an upper bound of t, for lists of hits. True ends the search.
  bool add(T t_hi, int side, std::uint32_t leaf_triangle, std::uint32_t primitive,
           std::uint32_t zero_weights = 0) {
    if (primitive == skipped || !batch.masks.see(primitive)) return false;
    is_full = !store.put(static_cast<std::int16_t>(side), leaf_triangle, primitive,
                         static_cast<std::uint16_t>(zero_weights));
    if (is_full) return true;
    if (batch.kind == ListKind::hits) tmax = nearest.keep(t_hi, primitive, tmax);
    return false;
  }
  bool stop_at(std::uint32_t primitive) {
    add(0, 0, no_leaf_triangle, primitive);
    return true;
  }
  // A lane that floats leave undecided.
  template <class Triangles, class AnyRay>
  [[gnu::noinline]] bool add_undecided(const Triangles& triangles, const AnyRay& ray,
                                       std::uint32_t leaf_triangle) {
    if (batch.kind == ListKind::hits) {
      const auto hit = exact_hit(triangles, ray, leaf_triangle);
      if (!hit) return false;
      const int side = batch.facing == Facing::any ? 0 : side_of(triangles, ray, leaf_triangle);
      // Hits that round to one t stay in the list.
      return admits(batch.facing, side) && add(number_above(hit.t), side, leaf_triangle, hit.primitive);
    }
    const std::uint32_t primitive = triangles.primitive(leaf_triangle);
    if (batch.stop == ListStop::undecided) return stop_at(primitive);
    if (along_axes(triangles, ray, leaf_triangle).is_apart) return false;
    const PredicateInput<T> in(triangles, ray, leaf_triangle);
    const auto crossing = detail::cross_exactly(in.origin, in.direction, in.corners, finite_tmin(ray.tmin),
                                                finite_tmax(ray.tmax));
    if (batch.stop == ListStop::at_origin && crossing.holds_origin) return stop_at(primitive);
    return crossing.side != 0 && admits(batch.facing, crossing.side) &&
           add(0, crossing.side, crossing.is_at_origin ? no_leaf_triangle : leaf_triangle, primitive,
               crossing.zero_weights);
  }
  // Lanes of a register that begins with `first`, with at least one certain or undecided. True ends the search.
  template <class Tree, class AnyRay, class AnyVerdict>
  bool add_found(const Tree& tree, const AnyRay& ray, const AnyVerdict& verdict, std::uint32_t first) {
    using V = decltype(verdict.t_hi);
    T t_hi[lanes_of<V>];
    verdict.t_hi.store(t_hi);
    const std::uint32_t against = bits(verdict.det > V(0.0f));
    std::uint32_t found = verdict.certain | verdict.undecided;
    if (batch.facing != Facing::any)
      found = verdict.undecided | admitted_lanes(batch.facing, verdict.certain, against);
    const TrianglesOfRay<AnyRay> triangles(tree);
    for (std::uint32_t lanes = found; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      const std::uint32_t leaf_triangle = first + static_cast<std::uint32_t>(lane);
      if ((verdict.undecided >> lane & 1u) != 0) [[unlikely]] {
        if (add_undecided(triangles, ray, leaf_triangle)) return true;
        continue;
      }
      const int side = (against >> lane & 1u) != 0 ? -1 : 1;
      if (add(t_hi[lane], side, leaf_triangle, triangles.primitive(leaf_triangle))) return true;
    }
    return false;
  }
};

// By the order in which children come; as they are stored where nothing ends the search but that the place is known.
template <class Store, class Order>
struct ListInOrder : HitList<Store>, Order {
  using HitList<Store>::HitList;
};
template <class Store>
using AllHits = ListInOrder<Store, NearestFirst>;
using HitsAsStored = ListInOrder<HitStore<float>, AsStored>;

template <class Test, class Tree, class AnyRay, class Prepared, class Load, class Query, class Counters>
requires requires(Query query) {
  query.store;
}
inline bool visit_screened(const Tree& tree, const AnyRay& ray, const Prepared& prepared, Load load,
                           std::uint32_t occupied, std::uint32_t first, Query& query, Counters& counters) {
  using V = std::remove_cvref_t<decltype(prepared.triangles.shear_x)>;
  auto verdict = Test::template classify<true>(prepared.triangles, load, occupied, [&] {
    return Segment<V>{V(prepared.tmin), V(query.tmax)};
  });
  if ((verdict.certain | verdict.undecided) == 0) return false;
  counters.hits(verdict.certain), counters.undecided(verdict.undecided);
  return query.add_found(tree, ray, verdict, first);
}

// The numbers of N entries of lists at a time: hits, or t of crossings. `ray` is that of the first one and moves along.
template <int N, class T>
inline void put_numbers(const typename TrianglesOf<T>::type& triangles, const ListBatchOf<T>& batch,
                        std::size_t& at, std::size_t count, std::size_t& ray) {
  DeferredHits<N, T> numbers;
  HitOf<T> crossings[N];
  constexpr std::size_t ahead = 2 * N;
  for (; count - at >= N; at += N) {
    ListEntryOf<T>* const entries = batch.list + at;
    for (std::size_t k = at + ahead; k < at + ahead + N && k < count; ++k)
      if (const std::uint32_t next = batch.list[k].leaf_triangle; next != no_leaf_triangle)
        triangles.prefetch(next);
    for (int lane = 0; lane < N; ++lane) {
      while (batch.end[ray] <= at + static_cast<std::size_t>(lane)) ++ray;
      numbers.set(lane, triangles, batch.rays[ray], entries[lane].leaf_triangle);
    }
    const bool are_hits = batch.kind == ListKind::hits;
    numbers.store(are_hits ? batch.hits + at : crossings);
    for (int lane = 0; lane < N && !are_hits; ++lane)
      entries[lane].t = entries[lane].leaf_triangle == no_leaf_triangle ? 0 : crossings[lane].t;
  }
}

template <class T>
inline void put_all_numbers(const TreeViewOf<T>& tree, const ListBatchOf<T>& batch, std::size_t count) {
  if (batch.kind == ListKind::sides) return;
  std::size_t at = 0, ray = 0;
  const typename TrianglesOf<T>::type triangles(tree);
  if constexpr (TrianglesOf<T>::lanes > 1)
    put_numbers<TrianglesOf<T>::lanes>(triangles, batch, at, count, ray);
  put_numbers<1>(triangles, batch, at, count, ray);
}

// Rays that may lie in planes of a mesh go without boxes of such planes from the root on.
struct WalksLists {
  template <class Test, class Query, class Counters>
  static void walk(const TreeView& tree, const Ray& ray, Query& query, Counters& counters) {
    if (has_zero(ray.direction)) [[unlikely]]
      walk_beside<Test>(tree, ray, query, counters);
    else
      WalksNodes::walk<Test>(tree, ray, query, counters);
  }
};

// As QueryKernels and DoubleRayKernels have it.
template <class Walk, class List, class Counters, class T = typename List::T>
[[gnu::flatten, gnu::noinline]] std::size_t list_all(const TreeViewOf<T>& tree, const ListBatchOf<T>& batch) {
  using Test = Exact<Grade::reproducible>;
  TraceBatch counted;
  counted.counters = batch.counters;
  Counters counters(counted);
  ListEntryOf<T>* next = batch.list;
  std::size_t done = 0;
  for (; done < batch.size; ++done) {
    const RayOf<T>& ray = batch.rays[done];
    CrossingCount* const count = batch.counts != nullptr ? batch.counts + done : nullptr;
    List query(batch, done, {next, batch.list + batch.room, next, count});
    if (count != nullptr) *count = {};
    if (List::may_hit(tree, ray)) Walk::template walk<Test>(tree, ray, query, counters);
    if (query.is_full) break;
    if (count != nullptr) {
      query.store.add_to_count();
      continue;
    }
    next = query.store.next;
    batch.end[done] = static_cast<std::size_t>(next - batch.list);
  }
  put_all_numbers(tree, batch, static_cast<std::size_t>(next - batch.list));
  return done;
}

}  // namespace
}  // namespace raylanes
