// The nearest hit that a caller keeps, or any: its filter is asked in the walk, about each hit that would be the best
// so far, once its numbers are known. So the walk goes on where a hit is rejected.
#pragma once

#include "../../dispatch/table/queries.hpp"
#include "single.hpp"

namespace raylanes {
namespace {

// The end of what is left of a segment: for the numbers of hits, and for boxes.
template <class T>
struct RestOfSegment {
  T tmax;

  explicit RestOfSegment(T end) : tmax(end) {}
  T box_tmax() const { return tmax; }
  void end_at(T t) { tmax = t; }
};

// The numbers of a triangle that is hit.
struct KnownHits {
  Hit operator()(const TreeTriangles& triangles, const Ray& ray, std::uint32_t leaf_triangle) const {
    DeferredHits<1> winner;
    Hit hit;
    winner.set(0, triangles, ray, leaf_triangle), winner.store(&hit);
    return hit;
  }
};

// T: float or double. first_one: the search is for any hit that is kept. `Rest` is a RestOfSegment, or has what it has.
template <class T, bool first_one, class Sides, class Rest, class Known>
class KeptHit : public std::conditional_t<first_one, AsStored, NearestFirst>, public Rest {
 public:
  static constexpr bool only_decides = first_one, asks = true;
  const Sides sides;
  const T segment_end;
  const Known known;
  const AskedOf<T>& asked;
  int beside = 0;  // as in Candidate
  HitOf<T> best;

  // ray: with the segment's own begin.
  KeptHit(const RayOf<T>& ray, const AskedOf<T>& what, const Rest& rest, const Known& numbers)
      : Rest(rest),
        sides(what.facing, what.skipped),
        segment_end(rest.tmax),
        known(numbers),
        asked(what),
        ray_(ray) {}

  // The hits of a register that begins with `first`, at least one that is certain or undecided. True ends the search.
  template <class Triangles, class Verdict>
  bool ask(const Triangles& triangles, const Verdict& verdict, std::uint32_t first) {
    constexpr int N = lanes_of<decltype(verdict.t_lo)>;
    T t_lo[N];
    verdict.t_lo.store(t_lo);
    for (std::uint32_t lanes = verdict.certain | verdict.undecided; lanes != 0;) {
      const int lane = first_one ? std::countr_zero(lanes) : nearest_of(lanes, t_lo);
      lanes &= ~(1u << lane);
      if (t_lo[lane] > this->tmax) continue;
      const bool is_certain = (verdict.certain >> lane & 1u) != 0;
      if (look_at(triangles, first + static_cast<std::uint32_t>(lane), is_certain)) return true;
    }
    return beside > max_beside;
  }

  // A triangle that floats are certain of, or not. True ends the search.
  template <class Triangles>
  [[gnu::noinline]] bool look_at(const Triangles& triangles, std::uint32_t leaf_triangle, bool is_certain) {
    HitOf<T> hit;
    if (is_certain) {
      hit = known(triangles, ray_, leaf_triangle);
    } else {
      const AlongAxes along = along_axes(triangles, ray_, leaf_triangle);
      if (along.misses) {
        ++beside;
        return false;
      }
      hit = exact_hit(triangles, ray_, leaf_triangle, along);
      if (!hit || !is_of_side(triangles, leaf_triangle)) return false;
    }
    if (!is_better(hit.t, hit.primitive, best) || !is_after(hit, asked.after) ||
        !take(hit, triangles.masks()))
      return false;
    const bool has_ended = first_one || asked.any;
    if (has_ended) beside = 0;
    return has_ended;
  }

 private:
  // Asks about a hit that counts, if its triangle is one to ask about, and keeps it if it is not rejected.
  bool take(const HitOf<T>& hit, const TriangleMasks& masks) {
    const bool is_rejected =
        asked.rejects != nullptr && masks.may_reject(hit.primitive) && asked.rejects(asked.function, hit);
    if (is_rejected) return false;
    best = hit, this->end_at(hit.t);
    return true;
  }
  static int nearest_of(std::uint32_t lanes, const T* t_lo) {
    int nearest = std::countr_zero(lanes);
    for (lanes &= lanes - 1; lanes != 0; lanes &= lanes - 1)
      if (const int lane = std::countr_zero(lanes); t_lo[lane] < t_lo[nearest]) nearest = lane;
    return nearest;
  }

  template <class Triangles>
  bool is_of_side(const Triangles& triangles, std::uint32_t leaf_triangle) const {
    return asked.facing == Facing::any || admits(asked.facing, side_of(triangles, ray_, leaf_triangle));
  }

  const RayOf<T>& ray_;
};

// The begin of a search for what comes after a hit: infinity, if there is nothing.
template <class T>
inline T begin_after(const HitOf<T>* after, T tmin) {
  if (after == nullptr) return tmin;
  // Nothing comes after a miss, nor after NaN.
  if (!(after->t < std::numeric_limits<T>::infinity())) return std::numeric_limits<T>::infinity();
  return after->t > tmin ? after->t : tmin;
}

}  // namespace
}  // namespace raylanes
