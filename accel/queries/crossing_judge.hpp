// Which hits are crossings of a surface, as docs/crossings.md defines them. Almost all are seen to be from their
// numbers. A hit that may be on an edge is looked for among the crossings around it.
#pragma once

#include "../../dispatch/bits.hpp"
#include "../mesh/boundary.hpp"
#include "after.hpp"
#include "lists.hpp"

namespace raylanes {

// The corners of a leaf triangle.
inline Corners corners_of(const TreeView& tree, std::uint32_t leaf_triangle) {
  const auto& block = static_cast<const LeafBlock<9>*>(tree.blocks)[leaf_triangle / tree_width];
  Corners corners;
  for (std::size_t k = 0; k < 9; ++k)
    corners.vertex[k / 3][k % 3] = block.number[k][leaf_triangle % tree_width];
  return corners;
}

// Whether the weight of a corner may be zero. The weights are u, v and 1 − u − v; u and v are rounded once, the sum is
// rounded again.
template <class AnyHit>
bool may_touch_edge(const AnyHit& hit) {
  constexpr auto below_one = 1 - 2 * std::numeric_limits<decltype(hit.u)>::epsilon();
  return !(hit.u > 0 && hit.v > 0 && hit.u + hit.v < below_one);
}

// The edge or the corner of a crossed triangle that a ray passes through: an edge by its ends, in any order, a corner
// twice. There is none where the ray passes between the edges.
template <class T>
struct MetEdge {
  PointOf<T> ends[2] = {};
  bool is_met = false;

  MetEdge(const ListEntryOf<T>& entry, const CornersOf<T>& corners) : is_met(entry.zero_weights != 0) {
    const unsigned zero_weights = entry.zero_weights;
    std::size_t count = 0;
    for (unsigned k = 0; k < 3; ++k)
      if ((zero_weights >> k & 1u) == 0 && count < 2) ends[count++] = corners.vertex[k];
    if (count == 1) ends[1] = ends[0];
  }
  bool operator==(const MetEdge& other) const {
    return is_met && other.is_met && std::is_permutation(ends, ends + 2, other.ends);
  }
};

// Says of hits that may touch an edge whether they are crossings.
template <class T>
class CrossingJudge {
 public:
  template <class Tree, class Options>
  CrossingJudge(const Tree& tree, const Options& options)
      : maker_(checked_maker("closest_crossing", ListKind::sides, tree, options_of_lists(options))) {}

  bool operator()(const RayOf<T>& ray, std::uint32_t skipped, const HitOf<T>& hit) const {
    bool is_crossing = false;
    const RayOf<T> around = part_around(ray, hit.t);
    const RaySourceOf<T> rays{.records = RayRecords<RayOf<T>>(&around, 1), .skip = skipped};
    each_list<ListEntryOf<T>>(maker_, rays, 0, 1, maker_.counters,
                              [&](std::size_t, std::span<ListEntryOf<T>> sides) {
                                is_crossing = is_among(distinct(sides), hit.primitive);
                              });
    return is_crossing;
  }

 private:
  template <class Options>
  static ListOptions options_of_lists(const Options& options) {
    ListOptions lists;
    lists.path = options.path, lists.mask = options.mask, lists.masks = options.masks;
    if constexpr (requires { options.counters; }) lists.counters = options.counters;
    return lists;
  }
  // Crossings of the same edge have one t, so that others do no harm: room for what is rounded or flushed.
  static RayOf<T> part_around(RayOf<T> ray, T t) {
    using Limits = std::numeric_limits<T>;
    const T room = 4 * Limits::epsilon() * std::abs(t) + 4 * Limits::min();
    ray.tmin = std::max(ray.tmin, t - room), ray.tmax = std::min(ray.tmax, t + room);
    return ray;
  }
  // The sides of all crossings of an edge add up to how often the ray passes there. As many count, of that side, with
  // the lowest primitives. All count if their triangles lie in one place.
  bool is_among(std::span<const ListEntryOf<T>> sides, std::uint32_t primitive) const {
    const auto own = std::find_if(sides.begin(), sides.end(),
                                  [&](const ListEntryOf<T>& side) { return side.primitive == primitive; });
    if (own == sides.end()) return false;
    if (own->leaf_triangle == no_leaf_triangle) return true;
    const CornersOf<T> corners = corners_of(maker_.tree, own->leaf_triangle);
    const MetEdge<T> edge(*own, corners);
    if (!edge.is_met) return true;
    int sum = 0, before = 0;
    bool is_alone = true;
    for (const ListEntryOf<T>& side : sides) {
      if (side.leaf_triangle == no_leaf_triangle) continue;
      const CornersOf<T> others = corners_of(maker_.tree, side.leaf_triangle);
      if (!(MetEdge<T>(side, others) == edge)) continue;
      sum += side.side;
      if (side.side == own->side && side.primitive < primitive) before += side.side;
      is_alone = is_alone && std::is_permutation(corners.vertex, corners.vertex + 3, others.vertex);
    }
    return is_alone || (sum - before) * own->side > 0;
  }

  ListMaker<T> maker_;
};

}  // namespace raylanes
