// Batches of rays with a filter: of nearest hits, or of any.
#pragma once

#include <raylanes/ray_queries.hpp>

#include "../../batch/shared_points.hpp"
#include "../../batch/triangle_masks.hpp"
#include "../after.hpp"
#include "kept_rays.hpp"

namespace raylanes {

template <class Tree>
class RayDoor;

// A batch whose hits a filter turns down: behind the traversal, if it takes lists. Hits after those turned down come
// from lists, where there are some.
template <class Tree>
class FilteredCall {
  using Number = typename RayQueries<Tree>::Number;
  using Hit = typename RayQueries<Tree>::Hit;
  using Options = typename RayQueries<Tree>::Options;
  using Source = RaySourceOf<Number>;

 public:
  FilteredCall(const RayDoor<Tree>& door, const detail::BatchRejection<Hit>& rejected, const Options& options)
      : door_(door), rejected_(rejected), options_(options) {}

  void closest(const Source& rays, const HitRecords<Hit>& hits) const {
    const CheckedCall checked(door_.name, rays, hits, options_);
    if (is_asked_within()) return keep_closest(checked.rays, hits, checked.options);
    find(checked.rays, hits, filter(), checked.options);
  }
  void occluded(const Source& rays, std::span<std::uint8_t> occluded) const {
    if (!is_asked_within() && !filter()) return door_.trace(rays, occluded, options_);
    Options by = options_;  // with the sides that the rays see
    if constexpr (requires { by.facing; }) by.facing = rays.sides(by.facing);
    const CheckedCall checked(door_.name, rays, occluded, by);
    by = checked.options, by.after = {};  // of closest() only
    if (is_asked_within()) return keep(checked.rays, SpanSink<std::uint8_t>{occluded}, by);
    if (!counts(by) && !share_origin(checked.rays)) return decide(checked.rays, occluded, by);
    std::vector<Hit> hits(rays.size());
    find(checked.rays, hits, filter(), by);
    for (std::size_t i = 0; i < hits.size(); ++i)
      if (checked.rays.takes_part(i)) occluded[i] = hits[i] ? 1 : 0;
  }

 private:
  bool is_asked_within() const { return rejected_.filter == nullptr; }
  const HitFilterOf<Hit>& filter() const { return *rejected_.filter; }
  template <class Sink>
  void keep(const Source& rays, const Sink& sink, const Options& by) const {
    door_.require_order(by);
    keep_rays(door_, rays, sink, rejected_, by);
  }
  // If few hits are rejected, all modes find nearest hits first: packets in half of the time of streams that ask.
  void keep_closest(const Source& rays, const HitRecords<Hit>& hits, const Options& by) const {
    constexpr std::size_t least = 2048;
    constexpr double most = 0.05, most_of_packets = 0.3;  // measured
    const bool may_find_first = rays.size() >= least && by.after.first == nullptr && !counts(by);
    if (!may_find_first || share_rejected(rays, by) > (share_origin(rays) ? most_of_packets : most))
      return keep(rays, HitSink<Hit>{hits}, by);
    door_.require_order(by);
    door_.trace(rays, hits, by);
    const auto filter = [&](std::span<const std::size_t> some, std::span<const Hit> found,
                            std::span<std::uint8_t> rejected) {
      rejected_.reject(rejected_.function, some.data(), found.data(), rejected.data(), some.size());
    };
    Asking<decltype(filter)> ask{filter};
    keep_rest(turned_down_of<Hit>(rays, hits, ask, MayReject{masks_of(by)}), hits, by);
  }
  // Keeps hits of rays whose nearest ones are rejected.
  void keep_rest(const TurnedDown<Hit, RayOf<Number>>& some, const HitRecords<Hit>& hits,
                 const Options& by) const {
    const auto skips = skips_of(by.skip, some.indices);
    Options of_some = by;
    of_some.active = nullptr, of_some.progress = nullptr, of_some.skip = skips;
    std::vector<Hit> found(some.size());
    const auto rejects = [&](std::size_t k, const Hit& hit) {
      return rejects_hit(rejected_, some.indices[k], hit);
    };
    detail::with_batch_rejection<Hit>(rejects, [&](const detail::BatchRejection<Hit>& rejected) {
      keep_rays(door_, Source{.records = some.rays, .skip = skips}, HitSink<Hit>{HitRecords<Hit>(found)},
                rejected, of_some);
    });
    for (std::size_t k = 0; k < found.size(); ++k) hits.set(some.indices[k], found[k]);
  }
  // The share of hits that is rejected, of a sample of rays.
  double share_rejected(const Source& rays, const Options& by) const {
    constexpr std::size_t sample = 64;
    Options one = options_of_singles(by);
    std::size_t asked = 0, turned_down = 0;
    for (std::size_t k = 0; k < sample; ++k) {
      const std::size_t i = place_in_sample(k, rays.size());
      if (!rays.takes_part(i)) continue;
      one.skip = element_of(by.skip, i);
      const auto rejects = [&](const Hit& hit) {
        const bool is_rejected = rejects_hit(rejected_, i, hit);
        ++asked, turned_down += is_rejected ? 1 : 0;
        return is_rejected;
      };
      detail::with_rejection<Hit>(rejects, [&](const detail::Rejection<Hit>& rejection) {
        return door_.closest_kept(rays[i], rejection, one);
      });
    }
    return asked > 0 ? static_cast<double>(turned_down) / static_cast<double>(asked) : 0.0;
  }
  static bool counts(const Options& by) {
    if constexpr (requires { by.counters; }) return by.counters != nullptr;
    return false;
  }
  // Whether many rays seem to begin at one point: packets find their nearest hits sooner than each finds any hit.
  static bool share_origin(const Source& rays) {
    constexpr std::size_t looked_at = 64, least = 32;
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < rays.size(); i += std::max<std::size_t>(rays.size() / looked_at, 1)) {
      if (!rays.takes_part(i)) continue;
      if (count++ == 0) first = i;
      if (rays[i].origin != rays[first].origin) return false;
    }
    return count >= least;
  }
  // Any hit comes first, and the filter is asked about that; then what hits the filter has rejected are searched for
  // nearest hits.
  void decide(const Source& rays, std::span<std::uint8_t> occluded, const Options& by) const {
    door_.require_order(by);
    std::vector<std::uint8_t> decided(rays.size());  // apart, as filters may throw
    std::vector<std::size_t> open;
    bool have_parts = false;
    if constexpr (requires(std::span<TreeReference> parts) { door_.find_parts(rays, parts, by); })
      have_parts = keeps_any_hit(rays, decided, by, open);
    if (!have_parts) {
      Options of_batch = by;
      if constexpr (requires { by.facing; }) of_batch.facing = rays.sides(by.facing);
      door_.trace(rays, decided, of_batch);
      for (std::size_t i = 0; i < rays.size(); ++i)
        if (rays.takes_part(i) && decided[i] != 0) open.push_back(i);
    }
    keep_nearest(rays, decided, by, open);
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (rays.takes_part(i)) occluded[i] = decided[i];
  }
  // Decides of rays by a hit of each, where trees say in which part of them one is. `open` are the others in the end:
  // there is none in the part, or the filter rejects it. False, if there are no parts.
  bool keeps_any_hit(const Source& rays, std::span<std::uint8_t> decided, const Options& by,
                     std::vector<std::size_t>& open) const {
    std::vector<TreeReference> parts(rays.size());
    if (!door_.find_parts(rays, parts, by)) return false;
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (rays.takes_part(i) && parts[i] != empty_reference) open.push_back(i);
    std::vector<Hit> hits(open.size());
    door_.hits_in_parts(rays, parts, open, hits, by);
    ask_about(hits, open, decided, by);
    return true;
  }
  // Decides of some rays by their nearest hits that the filter keeps.
  void keep_nearest(const Source& rays, std::span<std::uint8_t> decided, const Options& by,
                    const std::vector<std::size_t>& open) const {
    std::vector<RayOf<Number>> some;
    for (const std::size_t i : open) some.push_back(rays[i]);
    const auto skips = skips_of(by.skip, open);
    Options of_some = by;
    of_some.active = nullptr, of_some.progress = nullptr, of_some.skip = skips;
    std::vector<std::size_t> in_batch;
    const HitFilterOf<Hit> filter = [&](std::span<const std::size_t> indices, std::span<const Hit> found,
                                        std::span<std::uint8_t> rejected) {
      in_batch.clear();
      for (const std::size_t k : indices) in_batch.push_back(open[k]);
      this->filter()(in_batch, found, rejected);
    };
    std::vector<Hit> hits(open.size());
    find({.records = some, .skip = skips}, hits, filter, of_some);
    for (std::size_t k = 0; k < open.size(); ++k) decided[open[k]] = hits[k] ? 1 : 0;
  }
  void ask_about(const std::vector<Hit>& hits, std::vector<std::size_t>& open,
                 std::span<std::uint8_t> decided, const Options& by) const {
    const MayReject may_reject{masks_of(by)};
    Asking<HitFilterOf<Hit>> ask{filter()};
    std::vector<std::size_t> indices, left;
    std::vector<Hit> found;
    for (std::size_t k = 0; k < open.size();) {
      for (indices.clear(), found.clear(); k < open.size() && indices.size() < hits_of_filter_calls; ++k) {
        if (!hits[k])
          left.push_back(open[k]);
        else if (!may_reject(hits[k]))
          decided[open[k]] = 1;
        else
          indices.push_back(open[k]), found.push_back(hits[k]);
      }
      ask(indices, found);
      for (std::size_t n = 0; n < indices.size(); ++n) {
        decided[indices[n]] = 1;
        if (ask.rejected[n] != 0) left.push_back(indices[n]);
      }
    }
    open.swap(left);
  }

  void find(const Source& rays, const HitRecords<Hit>& hits, const HitFilterOf<Hit>& filter,
            const Options& by) const {
    door_.require_order(by);
    door_.trace(rays, hits, by);
    const MayReject may_reject{masks_of(by)};
    const auto lists = door_.lists(by);
    if constexpr (!std::is_same_v<decltype(lists), const NoLists>)
      if (filter && lists)
        return replace_from_lists(rays, hits, filter, may_reject, lists.have_streams,
                                  [&](const std::vector<RayOf<Number>>& some,
                                      const std::vector<std::size_t>& indices, std::uint32_t most) {
                                    const auto skips = skips_of(rays.skip, indices);
                                    return lists(some, skips, most, by);
                                  });
    filter_hits<Number>(
        rays, hits, filter, by,
        [&](const std::vector<RayOf<Number>>& some, std::vector<Hit>& last, const Options& again) {
          door_.trace({.records = some, .skip = again.skip}, last, again);
        },
        may_reject);
  }

  const RayDoor<Tree>& door_;
  const detail::BatchRejection<Hit>& rejected_;
  const Options& options_;
};

}  // namespace raylanes
