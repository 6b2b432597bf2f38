// All that a ray of doubles meets, in one traversal.
#pragma once

#include "../query/nearest_few.hpp"
#include "double_search.hpp"

namespace raylanes {
namespace {

// Nearest children first, so that the search for the nearest few hits ends early.
struct DoubleList : NearestFirst {
  const DoubleListBatch& batch;
  const FrameRay& frame;
  std::uint32_t skipped;
  double tmax;
  float end;
  HitD *next, *end_of_room;
  bool is_full = false;
  NearestFew<double> nearest;

  DoubleList(const DoubleListBatch& of, std::size_t ray, const FrameRay& in_frame, HitD* to)
      : batch(of),
        frame(in_frame),
        skipped(skipped_by(of, ray)),
        tmax(finite_tmax(of.rays[ray].tmax)),
        end(in_frame.ray.tmax),
        next(to),
        end_of_room(of.list + of.room),
        nearest(of.kind == ListKind::hits ? of.max_count : 0) {}
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
    lanes = lanes_but(skipped, lanes, triangles, first);
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
  [[gnu::noinline]] bool take_hit(const DoubleTriangles& triangles, const RayD& ray,
                                  std::uint32_t leaf_triangle, int side) {
    const HitD hit = exact_hit(triangles, ray, leaf_triangle);
    if (!hit) return false;
    const bool is_wanted = side != 0 || batch.facing == Facing::any ||
                           counts(batch.facing, side_of(triangles, ray, leaf_triangle));
    if (!is_wanted) return false;
    if (put(hit)) return true;
    shorten(number_above(hit.t), hit.primitive);
    return false;
  }
  // t_hi: an upper bound of the exact t, so that hits that round to one t stay in the list.
  void shorten(double t_hi, std::uint32_t primitive) {
    const double before = tmax;
    tmax = nearest.keep(t_hi, primitive, tmax);
    if (tmax < before) end = frame.end_of(tmax);
  }
  [[gnu::noinline]] bool take_crossing(const DoubleTriangles& triangles, const RayD& ray,
                                       std::uint32_t leaf_triangle, int side) {
    const std::uint32_t primitive = triangles.primitive(leaf_triangle);
    bool is_at_origin = false;
    if (side == 0 && batch.kind == ListKind::lines) {
      put({0.0, 0.0, 0.0, primitive, 0});
      return true;
    }
    if (side == 0) {
      if (along_axes(triangles, ray, leaf_triangle).is_apart) return false;
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
    const auto as_number = static_cast<double>(side);
    if (batch.kind == ListKind::sides || batch.kind == ListKind::places)
      return put({as_number, 0.0, 0.0, primitive, 0});
    const double t = is_at_origin ? 0.0 : exact_hit(triangles, ray, leaf_triangle).t;
    return put({t, as_number, is_at_origin ? 1.0 : 0.0, primitive, 0});
  }
};

[[maybe_unused, gnu::flatten]] std::size_t list_doubles(const DoubleTreeView& tree,
                                                        const DoubleListBatch& batch) {
  HitD* next = batch.list;
  std::size_t done = 0;
  for (; done < batch.size; ++done) {
    const RayD& ray = batch.rays[done];
    FrameRay frame(tree, ray, ray.tmin);
    if (frame.may_hit) {
      DoubleList query(batch, done, frame, next);
      search(tree, ray, frame, query);
      if (query.is_full) break;
      next = query.next;
    }
    batch.end[done] = static_cast<std::size_t>(next - batch.list);
  }
  return done;
}

}  // namespace
}  // namespace raylanes
