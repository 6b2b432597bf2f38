// Vectors of rays against the triangles of a leaf by the screen of the exact test.
#pragma once

#include "../exact/leaf_screen.hpp"
#include "../ray/ranges.hpp"
#include "stream_octant.hpp"

namespace raylanes {
namespace {

// Vectors of rays against the triangles of a leaf by a screen. Self keeps rays by their index in the octant:
//   keep(i, t_lo, t_hi, leaf_triangle)   has a new best hit
//   end_ray(i)                           is hit, if that is all that is asked
//   compared(i, leaf_triangle)           the best hit, if this triangle is compared with it exactly: it is kept
//   is_hit(i, leaf_triangle)             whether the triangle is hit, exactly
//   not_skipped(leaf_triangle, skipped)   the lanes for whose rays the triangle is there; if sides() chooses
template <class Self, class V, bool only_decides>
class ScreenedRays {
 protected:
  // In registers while triangles are tested: a load of what was just stored lane by lane waits for all stores before
  // it.
  using State = RayState<V, only_decides>;

  // Without a branch on what is hit: one in three of these registers has a ray that is, and nothing foretells which.
  // Returns the lanes with hits that are only in `left`. triangles: a bit each. skipped: by each ray, or null.
  template <class Screen>
  std::uint32_t classify_triangles(const RayLanes<V>& rays, V length, const Screen& screen,
                                   std::uint32_t triangles, std::uint32_t first, const ListEntry* list,
                                   std::uint32_t active, State& left, const V* skipped = nullptr) {
    const auto sides = self().sides();
    auto going = MaskOf<V>::from_bits(active), found = going & ~going;
    for (; triangles != 0; triangles &= triangles - 1) {
      const int triangle = std::countr_zero(triangles);
      const std::uint32_t leaf_triangle = first + static_cast<std::uint32_t>(triangle);
      self().counters().triangles(bits(going));
      const auto verdict = screen.classify(rays, length, triangle, left, sides);
      auto certain = verdict.certain & going, undecided = verdict.undecided & going;
      if constexpr (sides.chooses)
        if (skipped != nullptr) {
          const auto is_there = self().not_skipped(leaf_triangle, *skipped);
          certain = certain & is_there, undecided = undecided & is_there;
        }
      self().counters().hits(bits(certain)), self().counters().undecided(bits(undecided));
      found = found | certain;
      if constexpr (only_decides) {
        going = going & ~certain;
      } else {
        left.keep(certain, verdict.t_lo, verdict.t_hi, as_bits(leaf_triangle));
      }
      if (any(undecided)) [[unlikely]] {
        store_certain(bits(found), left, list);
        found = found & ~found;
        going = going & ~MaskOf<V>::from_bits(take_undecided(bits(undecided), list, leaf_triangle, left));
      }
      if (only_decides && !any(going)) break;
    }
    return bits(found);
  }

  void store_certain(std::uint32_t found, const State& left, const ListEntry* list) {
    if (found == 0) return;
    T t_lo[N], t_hi[N];
    Word leaf_triangle[N];
    if constexpr (!only_decides)
      left.t_lo.store(t_lo), left.tmax.store(t_hi), as<Word>(left.leaf_triangle).store(leaf_triangle);
    for (; found != 0; found &= found - 1) {
      const int lane = std::countr_zero(found);
      if constexpr (only_decides)
        self().end_ray(index_of(list[lane]));
      else
        self().keep(index_of(list[lane]), t_lo[lane], t_hi[lane],
                    static_cast<std::uint32_t>(leaf_triangle[lane]));
    }
  }

 private:
  using T = typename NumberOf<V>::type;
  using Word = typename BitsOf<T>::type;
  static constexpr int N = lanes_of<V>;

  Self& self() { return static_cast<Self&>(*this); }
  static V as_bits(std::uint32_t word) { return as<T>(Lanes<Word, N>(Word{word})); }

  // Returns the rays that end.
  [[gnu::noinline]] std::uint32_t take_undecided(std::uint32_t undecided, const ListEntry* list,
                                                 std::uint32_t leaf_triangle, State& left) {
    std::uint32_t ended = 0;
    for (; undecided != 0; undecided &= undecided - 1) {
      const int lane = std::countr_zero(undecided);
      const std::uint32_t i = index_of(list[lane]);
      if constexpr (only_decides) {
        if (!self().is_hit(i, leaf_triangle)) continue;
        self().end_ray(i);
        ended |= 1u << lane;
      } else {
        const auto best = self().compared(i, leaf_triangle);
        const auto changed = MaskOf<V>::from_bits(1u << lane);
        left.keep(changed, V(best.t_lo), V(best.tmax), as_bits(best.leaf_triangle));
      }
    }
    return ended;
  }
};

}  // namespace
}  // namespace raylanes
