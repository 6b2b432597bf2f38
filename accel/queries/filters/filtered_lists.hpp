// Filters of batches that find next hits in lists: the hits of a ray in order, from one walk.
#pragma once

#include <numeric>

#include "../ray_lists.hpp"
#include "filtered.hpp"

namespace raylanes {

// Whether a hit comes after another one of its ray, in the order of t, instance and primitive.
template <class AnyHit>
bool comes_after(const AnyHit& hit, const AnyHit& last) {
  const auto number = [](const AnyHit& of) {
    if constexpr (requires { of.instance; })
      return (std::uint64_t{of.instance} << 32) + of.primitive;
    else
      return of.primitive;
  };
  return hit.t > last.t || (hit.t == last.t && number(hit) > number(last));
}

// Asks about the hits of lists[k] after some.hits[k], in order, until one is kept. Rays stay in `some`, with the last
// hit that was turned down, if their lists had `most` hits and none of them was kept; hits are set for the others.
template <class AnyHit, class AnyRay, class Filter, class View, class Asked>
void ask_in_lists(TurnedDown<AnyHit, AnyRay>& some, const RayLists<AnyHit>& lists, std::size_t most,
                  Asking<Filter>& ask, const View& hits, const Asked& may_turn_down) {
  std::vector<std::size_t> at(some.size()), open(some.size()), asked;
  std::vector<std::uint8_t> is_kept(some.size());
  for (std::size_t k = 0; k < at.size(); ++k) {
    const auto list = lists[k];
    const auto behind =
        std::ranges::find_if(list, [&](const AnyHit& hit) { return comes_after(hit, some.hits[k]); });
    at[k] = lists.offsets[k] + static_cast<std::size_t>(behind - list.begin());
  }
  std::iota(open.begin(), open.end(), std::size_t{0});
  std::vector<std::size_t> indices;
  std::vector<AnyHit> found;
  for (;;) {
    std::erase_if(open, [&](std::size_t k) { return is_kept[k] != 0 || at[k] == lists.offsets[k + 1]; });
    if (open.empty()) break;
    indices.clear(), found.clear(), asked.clear();
    for (const std::size_t k : open) {
      const AnyHit& hit = some.hits[k] = lists.items[at[k]++];
      if (may_turn_down(hit))
        asked.push_back(k), indices.push_back(some.indices[k]), found.push_back(hit);
      else
        is_kept[k] = 1;
    }
    ask(indices, found);
    for (std::size_t j = 0; j < asked.size(); ++j) is_kept[asked[j]] = ask.rejected[j] == 0 ? 1 : 0;
  }
  const auto goes_on = [&](std::size_t k) { return is_kept[k] == 0 && lists[k].size() >= most; };
  for (std::size_t k = 0; k < some.size(); ++k)
    if (!goes_on(k)) hits.set(some.indices[k], is_kept[k] != 0 ? some.hits[k] : AnyHit());
  some.keep(goes_on);
}

// How many hits a list is to have. A single ray finds the nearest few: twice as many as a filter is asked about until
// it keeps one, if it goes on as it began. Streams find all at once, in half the time, where a sample of rays has few.
class LengthOfLists {
 public:
  LengthOfLists(std::size_t asked, std::size_t turned_down, bool has_streams)
      : few_(std::clamp<std::size_t>(2 * asked / (asked - turned_down + 1), 4, most_of_sample)),
        has_streams_(has_streams) {}
  // The number of rays that the next part of a batch has at most, and the length of its lists.
  std::size_t rays() const { return rays_; }
  std::uint32_t of(std::size_t rays) const {
    const bool are_streams = has_streams_ && rays >= min_rays_together;
    const std::size_t of_stream = mean_ == 0                   ? most_of_sample
                                  : mean_ < most_of_sample / 2 ? max_as_singles + 1
                                                               : few_;
    return static_cast<std::uint32_t>(are_streams ? of_stream : few_);
  }
  void learn(std::size_t rays, std::size_t hits) {
    mean_ = static_cast<double>(hits) / static_cast<double>(rays);
    rays_ = std::min(4 * rays_, rays_together);
  }

 private:
  static constexpr std::size_t most_of_sample = 32;

  std::size_t few_;
  bool has_streams_;
  double mean_ = 0;  // of hits a ray in the last part; 0: there was none
  std::size_t rays_ = min_rays_together;
};

// As replace_turned_down(). list(rays, indices, most) are the first `most` hits of rays, in order.
template <class AnyHit, class Source, class Filter, class Asked, class List>
void replace_from_lists(const Source& rays, const HitRecords<AnyHit>& hits, const Filter& filter,
                        const Asked& may_turn_down, bool has_streams, const List& list) {
  Asking<Filter> ask{filter};
  const auto all = turned_down_of<AnyHit>(rays, hits, ask, may_turn_down);
  LengthOfLists length(rays.size(), all.size(), has_streams);
  for (std::size_t first = 0, count; first < all.size(); first += count) {
    count = std::min(length.rays(), all.size() - first);
    auto some = all.part(first, count);
    for (std::uint32_t most = length.of(count); some.size() > 0; most = most > ~0u / 8 ? ~0u : 8 * most) {
      const RayLists<AnyHit> lists = list(some.rays, some.indices, most);
      if (some.size() == count) length.learn(count, lists.items.size());
      ask_in_lists(some, lists, most, ask, hits, may_turn_down);
    }
  }
}

// The options of a call for lists of `most` hits.
template <class Options>
ListOptions options_of_lists(const Options& by, std::uint32_t most) {
  ListOptions options{.max_count = most, .facing = by.facing, .path = by.path, .threads = by.threads};
  if constexpr (requires { by.masks; }) options.mask = by.mask, options.masks = by.masks;
  if constexpr (requires { by.counters; }) options.counters = by.counters;
  return options;
}
// Lists of a tree. Trees and scenes that make no lists have NoLists.
template <class T, class Tree>
struct TreeLists {
  static constexpr bool have_streams = is_float<T>;
  Tree tree;

  explicit operator bool() const { return true; }
  template <class Options>
  RayLists<HitOf<T>> operator()(const std::vector<RayOf<T>>& rays, const PrimitiveView& skip,
                                std::uint32_t most, const Options& by) const {
    return hits_of<T>(tree, {.records = rays, .skip = skip}, options_of_lists(by, most));
  }
};
struct NoLists {
  explicit operator bool() const { return false; }
};

}  // namespace raylanes
