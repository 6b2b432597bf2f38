// All that a ray of doubles meets, in one traversal.
#pragma once

#include "../query/hit_lists.hpp"
#include "double_search.hpp"

namespace raylanes {
namespace {

// Nearest children first, so that the search for the nearest few hits ends early.
struct DoubleList : AllHits<HitStore<double>> {
  using AllHits<HitStore<double>>::ListInOrder;
  const FrameRay* frame = nullptr;
  float end = 0.0f;           // of the ray in the frame
  int beside = never_beside;  // how many registers were undecided

  float box_tmax() const { return end; }
  // FrameRay finds that out.
  static bool may_hit(const DoubleTreeView&, const RayD&) { return true; }

  template <class AnyVerdict>
  bool add_found(const DoubleTreeView& tree, const RayD& ray, const AnyVerdict& verdict,
                 std::uint32_t first) {
    const double before = tmax;
    if (verdict.undecided != 0) [[unlikely]]
      ++beside;
    const bool is_done = HitList::add_found(tree, ray, verdict, first);
    if (tmax < before) end = frame->end_of(tmax);
    return is_done;
  }
};

struct WalksFrame {
  template <class Test, class Counters>
  static void walk(const DoubleTreeView& tree, const RayD& ray, DoubleList& list, Counters&) {
    FrameRay frame(tree, ray, ray.tmin);
    if (!frame.may_hit) return;
    list.frame = &frame, list.end = frame.ray.tmax;
    search(tree, ray, frame, list);
  }
};

}  // namespace
}  // namespace raylanes
