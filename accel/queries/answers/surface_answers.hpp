// The text of SurfaceQueries, for every class: closest crossings, all hits, crossings. Each class has a
// SurfaceDoor of its own, in the class's file.
#pragma once

#include <raylanes/ray_queries.hpp>

#include "../../../dispatch/quiet_floats.hpp"
#include "../crossing_judge.hpp"
#include "../ray_lists.hpp"

namespace raylanes {

// How a class answers for surfaces. It is made of the object, and has
//   require_closest_crossing(options)   throws if these options have no closest crossings
//   judge(options)              what says of a ray, its skipped primitive and a hit whether the hit is a crossing
//   hits(rays, options), crossings(rays, options), count(rays, counts, options)
template <class Tree>
struct SurfaceDoor;

// The nearest hits, of which those that are no crossings give way to the hits after them.
template <class Tree, class T, class AnyHit, class Options>
void find_closest_crossings(const Tree& tree, const RaySourceOf<T>& given, const HitRecords<AnyHit>& hits,
                            const Options& by) {
  const SurfaceDoor<Tree> door(tree);
  door.require_closest_crossing(by);
  const CheckedCall call("closest_crossing", given, hits, by);
  const RaySourceOf<T>& rays = call.rays;
  const Options& options = call.options;
  rays.arrays != nullptr ? tree.closest(*rays.arrays, hits, options)
                         : tree.closest(rays.records, hits, options);
  auto judge = door.judge(options);
  const auto turn_down = [&](std::span<const std::size_t> indices, std::span<const AnyHit> found,
                             std::span<std::uint8_t> rejected) {
    for (std::size_t k = 0; k < indices.size(); ++k) {
      SkippedPrimitive skipped{no_primitive, 0};
      if (rays.skip.first != nullptr) skipped = skipped_at(rays.skip, indices[k]);
      rejected[k] = judge(rays[indices[k]], skipped, found[k]) ? 0 : 1;
    }
  };
  filter_hits<T>(
      rays, hits, turn_down, options,
      [&](const std::vector<RayOf<T>>& some, std::vector<AnyHit>& last, const Options& again) {
        tree.closest(some, last, again);
      },
      [](const AnyHit& hit) { return may_touch_edge(hit); });
}

template <class Tree>
auto SurfaceQueries<Tree>::closest_crossing(const Ray& ray, const Options& options) const -> Hit {
  const Tree& tree = this->self();
  SurfaceDoor<Tree>(tree).require_closest_crossing(options);
  Hit hit = tree.closest(ray, options);
  const QuietFloats quiet;
  if (!hit || !may_touch_edge(hit)) return hit;
  Options of_batch = options;  // whose own options mean nothing here
  of_batch.active = nullptr, of_batch.progress = nullptr;
  find_closest_crossings(tree, source_of(Rays(&ray, 1), of_batch), Hits(&hit, 1), of_batch);
  return hit;
}
template <class Tree>
void SurfaceQueries<Tree>::closest_crossing(Rays rays, Hits hits, const Options& options) const {
  find_closest_crossings(this->self(), source_of(rays, options), hits, options);
}
template <class Tree>
void SurfaceQueries<Tree>::closest_crossing(const Columns& rays, Hits hits, const Options& options) const {
  find_closest_crossings(this->self(), source_of(rays, options), hits, options);
}

template <class Tree>
auto SurfaceQueries<Tree>::all_hits(Rays rays, const ListOptions& options) const -> RayLists<Hit> {
  return SurfaceDoor<Tree>(this->self()).hits(source_of(rays, options), options);
}
template <class Tree>
auto SurfaceQueries<Tree>::all_hits(const Columns& rays, const ListOptions& options) const -> RayLists<Hit> {
  return SurfaceDoor<Tree>(this->self()).hits(source_of(rays, options), options);
}
template <class Tree>
std::size_t SurfaceQueries<Tree>::all_hits(Rays rays, std::span<std::size_t> offsets, std::span<Hit> hits,
                                           const ListOptions& options) const {
  require_size("all_hits", "offsets", offsets.size(), "rays and an end", rays.count + 1);
  require_apart("all_hits", "offsets", Extent(offsets), Extent(hits));
  const RayLists<Hit> lists = all_hits(rays, options);
  std::copy(lists.offsets.begin(), lists.offsets.end(), offsets.begin());
  if (lists.items.size() <= hits.size()) std::copy(lists.items.begin(), lists.items.end(), hits.begin());
  return lists.items.size();
}
template <class Tree>
auto SurfaceQueries<Tree>::crossings(Rays rays, const ListOptions& options) const -> RayLists<Crossing> {
  return SurfaceDoor<Tree>(this->self()).crossings(source_of(rays, options), options);
}
template <class Tree>
auto SurfaceQueries<Tree>::crossings(const Columns& rays, const ListOptions& options) const
    -> RayLists<Crossing> {
  return SurfaceDoor<Tree>(this->self()).crossings(source_of(rays, options), options);
}
template <class Tree>
void SurfaceQueries<Tree>::count_crossings(Rays rays, std::span<CrossingCount> counts,
                                           const ListOptions& options) const {
  SurfaceDoor<Tree>(this->self()).count(source_of(rays, options), counts, options);
}
template <class Tree>
void SurfaceQueries<Tree>::count_crossings(const Columns& rays, std::span<CrossingCount> counts,
                                           const ListOptions& options) const {
  SurfaceDoor<Tree>(this->self()).count(source_of(rays, options), counts, options);
}

// The door of a tree of triangles, whose views lists take.
template <class T, class View>
class SurfaceOfTree {
 public:
  explicit SurfaceOfTree(const View& view) : view_(view) {}

  template <class Options>
  auto judge(const Options& options) const {
    return [judge = CrossingJudge<T>(view_, options)](const RayOf<T>& ray, const SkippedPrimitive& skipped,
                                                      const HitOf<T>& hit) {
      return judge(ray, skipped.primitive, hit);
    };
  }
  RayLists<HitOf<T>> hits(const RaySourceOf<T>& rays, const ListOptions& options) const {
    return hits_of<T>(view_, rays, options);
  }
  RayLists<CrossingOf<T>> crossings(const RaySourceOf<T>& rays, const ListOptions& options) const {
    return crossings_of<T>(view_, rays, options);
  }
  void count(const RaySourceOf<T>& rays, std::span<CrossingCount> counts, const ListOptions& options) const {
    count_crossings_of<T>(view_, rays, counts, options);
  }

 private:
  View view_;
};

}  // namespace raylanes
