// All that a ray of doubles meets, in one traversal.
#pragma once

#include "double_search.hpp"

namespace raylanes {
namespace {

struct DoubleList : AsStored {
  static constexpr bool only_decides = true;  // no order, and no end that comes nearer
  const DoubleListBatch& batch;
  double tmax;
  float end;
  HitD *next, *end_of_room;
  bool is_full = false;

  DoubleList(const DoubleListBatch& of, const RayD& ray, const FrameRay& frame, HitD* to)
      : batch(of),
        tmax(finite_tmax(ray.tmax)),
        end(frame.ray.tmax),
        next(to),
        end_of_room(of.list + of.room) {}
  float box_tmax() const { return end; }

  template <class V>
  Segment<V> segment(double begin) const {
    return {V(begin), V(tmax)};
  }
  // Returns true if that ends the search.
  bool put(const HitD& item) {
    is_full = next == end_of_room;
    if (!is_full) *next++ = item;
    return is_full;
  }

  template <class Filtered>
  bool take(const DoubleTriangles& triangles, const RayD& ray, const Filtered& filtered,
            std::uint32_t first) {
    const std::uint32_t fronts = fronts_of(filtered);
    std::uint32_t lanes = filtered.undecided | lanes_that_count(batch.facing, filtered.certain, fronts);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      const bool is_certain = (filtered.certain >> lane & 1u) != 0;
      const int side = !is_certain ? 0 : (fronts >> lane & 1u) != 0 ? -1 : 1;
      if (batch.kind == ListKind::hits ? take_hit(triangles, ray, first + lane, side)
                                       : take_crossing(triangles, ray, first + lane, side))
        return true;
    }
    return false;
  }

 private:
  // side: 0 if the filter has not decided.
  bool take_hit(const DoubleTriangles& triangles, const RayD& ray, std::uint32_t leaf_triangle, int side) {
    const HitD hit = exact_hit(triangles, ray, leaf_triangle);
    if (!hit) return false;
    const bool is_wanted = side != 0 || batch.facing == Facing::any ||
                           counts(batch.facing, side_of(triangles, ray, leaf_triangle));
    return is_wanted && put(hit);
  }
  bool take_crossing(const DoubleTriangles& triangles, const RayD& ray, std::uint32_t leaf_triangle,
                     int side) {
    const std::uint32_t primitive = triangles.primitive(leaf_triangle);
    bool is_at_origin = false;
    if (side == 0) {
      const PredicateInput<double> in(triangles, ray, leaf_triangle);
      const auto crossing =
          detail::cross_exactly(in.origin, in.direction, in.corners, finite_tmin(ray.tmin), tmax);
      if (batch.kind == ListKind::places && crossing.holds_origin) {
        put({0.0, 0.0, 0.0, primitive, 0});
        return true;
      }
      if (crossing.side == 0 || !counts(batch.facing, crossing.side)) return false;
      side = crossing.side, is_at_origin = crossing.is_at_origin;
    }
    // Places and counts take the side alone.
    const bool wants_t = batch.kind == ListKind::crossings && !is_at_origin;
    const double t = wants_t ? exact_hit(triangles, ray, leaf_triangle).t : 0.0;
    return put({t, static_cast<double>(side), 0.0, primitive, 0});
  }
};

[[maybe_unused, gnu::flatten]] std::size_t list_doubles(const DoubleTreeView& tree,
                                                        const DoubleListBatch& batch) {
  HitD* next = batch.list;
  std::size_t done = 0;
  for (; done < batch.size; ++done) {
    const RayD& ray = batch.rays[done];
    if (may_hit(tree, ray, ray.tmin)) {
      const FrameRay frame(tree.frame, ray, finite_tmin(ray.tmin));
      DoubleList query(batch, ray, frame, next);
      search(tree, ray, finite_tmin(ray.tmin), frame, query);
      if (query.is_full) break;
      next = query.next;
    }
    batch.end[done] = static_cast<std::size_t>(next - batch.list);
  }
  return done;
}

}  // namespace
}  // namespace raylanes
