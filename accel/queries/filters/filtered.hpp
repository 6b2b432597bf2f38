// Hits that a filter turns down, and the next hits of their rays: the loop that trees and scenes share.
#pragma once

#include "../../batch/checked_call.hpp"

namespace raylanes {

// The rays of a call for next hits: few enough for their hits to stay in the first levels of caches.
constexpr std::size_t rays_of_single_calls = 1024;

// The primitives that some rays of a batch skip, by their indices; empty: none.
inline std::vector<SkippedPrimitive> skips_of(const PrimitiveView& skip, std::span<const std::size_t> rays) {
  std::vector<SkippedPrimitive> skips;
  for (std::size_t k = 0; skip.first != nullptr && k < rays.size(); ++k)
    skips.push_back(skipped_at(skip, rays[k]));
  return skips;
}

// Rays whose hits were turned down, with these hits.
template <class AnyHit, class AnyRay>
struct TurnedDown {
  std::vector<std::size_t> indices;
  std::vector<AnyRay> rays;
  std::vector<AnyHit> hits;

  std::size_t size() const { return indices.size(); }
  void push_back(std::size_t index, const AnyRay& ray, const AnyHit& hit) {
    indices.push_back(index), rays.push_back(ray), hits.push_back(hit);
  }
  // Keeps the elements for whose position holds(k) is true.
  template <class Holds>
  void keep(const Holds& holds) {
    std::size_t left = 0;
    for (std::size_t k = 0; k < size(); ++k) {
      if (!holds(k)) continue;
      indices[left] = indices[k], rays[left] = rays[k], hits[left++] = hits[k];
    }
    indices.resize(left), rays.resize(left), hits.resize(left);
  }
  TurnedDown part(std::size_t first, std::size_t count) const {
    const auto some = [=](const auto& all) {
      return std::vector(all.begin() + static_cast<std::ptrdiff_t>(first),
                         all.begin() + static_cast<std::ptrdiff_t>(first + count));
    };
    return {some(indices), some(rays), some(hits)};
  }
};

struct EveryHit {
  template <class AnyHit>
  bool operator()(const AnyHit&) const {
    return true;
  }
};

// A filter and what it said last.
template <class Filter>
struct Asking {
  const Filter& filter;
  std::vector<std::uint8_t> rejected = {};

  template <class AnyHit>
  void operator()(const std::vector<std::size_t>& indices, const std::vector<AnyHit>& hits) {
    rejected.assign(indices.size(), 0);
    if (!indices.empty()) filter(indices, hits, rejected);
  }
};

// A filter is asked about so many hits at a time: these and what it says stay in the second level of caches.
constexpr std::size_t hits_of_filter_calls = 8192;

// The rays whose hits the filter turns down. It is asked about those for which may_turn_down(hit) is true.
template <class AnyHit, class Source, class Filter, class View, class Asked>
TurnedDown<AnyHit, typename Source::Ray> turned_down_of(const Source& rays, const View& hits,
                                                        Asking<Filter>& ask, const Asked& may_turn_down) {
  TurnedDown<AnyHit, typename Source::Ray> some;
  std::vector<std::size_t> indices;
  std::vector<AnyHit> found;
  for (std::size_t i = 0; i < rays.size();) {
    for (indices.clear(), found.clear(); i < rays.size() && indices.size() < hits_of_filter_calls; ++i) {
      const AnyHit hit = rays.takes_part(i) ? hits[i] : AnyHit();
      if (hit && may_turn_down(hit)) indices.push_back(i), found.push_back(hit);
    }
    ask(indices, found);
    for (std::size_t k = 0; k < indices.size(); ++k)
      if (ask.rejected[k] != 0) some.push_back(indices[k], rays[indices[k]], found[k]);
  }
  return some;
}

// Replaces hits that the filter turns down by the next ones, until it keeps them or there is none.
// next(rays, hits, indices) replaces hits[k] by the hit of rays[k] after it.
template <class AnyHit, class Source, class Filter, class View, class Next, class Asked = EveryHit>
void replace_turned_down(const Source& rays, const View& hits, const Filter& filter, const Next& next,
                         const Asked& may_turn_down = {}) {
  Asking<Filter> ask{filter};
  auto some = turned_down_of<AnyHit>(rays, hits, ask, may_turn_down);
  while (some.size() > 0) {
    next(some.rays, some.hits, some.indices);
    for (std::size_t k = 0; k < some.size(); ++k) hits.set(some.indices[k], some.hits[k]);
    some.keep([&](std::size_t k) { return some.hits[k] && may_turn_down(some.hits[k]); });
    ask(some.indices, some.hits);
    some.keep([&](std::size_t k) { return ask.rejected[k] != 0; });
  }
}

}  // namespace raylanes
