// Lists of hits or crossings of a scene's trees, of floats or doubles, as lists in the scene.
#pragma once

#include <chrono>
#include <tuple>

#include <raylanes/scene_d.hpp>

#include "../../batch/in_parallel.hpp"
#include "../../queries/ray_lists.hpp"
#include "../common/common_tree.hpp"

namespace raylanes {

// The float or double of an item, a hit or a crossing.
template <class Item>
using NumberOf = std::remove_cv_t<decltype(Item::t)>;
template <class Item>
inline constexpr bool is_hit = std::is_same_v<Item, HitOf<NumberOf<Item>>>;

template <class Item>
struct ItemInScene;
template <>
struct ItemInScene<Hit> : std::type_identity<SceneHit> {};
template <>
struct ItemInScene<HitD> : std::type_identity<SceneHitD> {};
template <>
struct ItemInScene<Crossing> : std::type_identity<SceneCrossing> {};
template <>
struct ItemInScene<CrossingD> : std::type_identity<SceneCrossingD> {};
template <class Item>
using SceneItem = typename ItemInScene<Item>::type;

// A hit or a crossing in a tree, as one in the scene; a miss as one.
template <class Item>
SceneItem<Item> in_scene(Item item, const TriangleOwners& owners) {
  if constexpr (is_hit<Item>) {
    if (!item) return {};
    const TriangleOwner& owner = owners.of(item.primitive);
    return {item.t, item.u, item.v, item.primitive - owner.first, owner.geometry, owner.instance};
  } else {
    const TriangleOwner& owner = owners.of(item.primitive);
    item.primitive -= owner.first;
    return {item, owner.geometry, owner.instance};
  }
}
// The same as an entry of all rays' lists.
template <class Item>
struct FoundItem : SceneItem<Item> {
  std::size_t ray;
};

// The lists of rays in one tree, where numbers say which instances own its triangles. rays.skip names instances.
template <class Item, class Tree>
RayLists<Item> lists_in_tree(const Tree& tree, const MemberNumbers& numbers, RaySourceOf<NumberOf<Item>> rays,
                             ListOptions options) {
  std::vector<std::uint32_t> skip;
  if (rays.skip.first != nullptr) {
    skip = numbers.of_skips(rays, rays.skip);
    rays.skip = skip;
  }
  options.skip = rays.skip;
  if constexpr (is_hit<Item>)
    return hits_of<NumberOf<Item>>(tree, rays, options);
  else
    return crossings_of<NumberOf<Item>>(tree, rays, options);
}
// The lists of rays in a tree that has all that they see, as lists in the scene.
template <class Item, class Tree>
RayLists<SceneItem<Item>> lists_in_common(const Tree& tree, const MemberNumbers& numbers,
                                          const RaySourceOf<NumberOf<Item>>& rays,
                                          const ListOptions& options) {
  RayLists<Item> found = lists_in_tree<Item>(tree, numbers, rays, options);
  RayLists<SceneItem<Item>> lists{std::move(found.offsets), {}};
  lists.items.reserve(found.items.size());
  for (const Item& item : found.items) lists.items.push_back(in_scene(item, numbers.owners));
  return lists;
}
// Appends what a tree has of rays in its space: ray k is picked[k] of the call, which `skip` is of.
template <class Item, class Tree>
void append_lists(std::vector<FoundItem<Item>>& found, const Tree& tree, const MemberNumbers& numbers,
                  std::span<const std::uint32_t> picked, const std::vector<RayOf<NumberOf<Item>>>& rays,
                  const PrimitiveView& skip, const ListOptions& options) {
  std::vector<SkippedPrimitive> skips;
  if (skip.first != nullptr)
    for (const std::uint32_t i : picked) skips.push_back(skipped_at(skip, i));
  const RayLists<Item> lists = lists_in_tree<Item>(tree, numbers, {.records = rays, .skip = skips}, options);
  for (std::size_t k = 0; k < rays.size(); ++k)
    for (const Item& item : lists[k]) found.push_back({in_scene(item, numbers.owners), picked[k]});
}

// Tells of the progress of lists that several trees make one after the other, as the contract of Progress says.
class ProgressInTrees {
 public:
  explicit ProgressInTrees(const Progress* progress)
      : progress_(progress != nullptr && *progress ? progress : nullptr) {
    tell(0);
  }

  // Before the first tree: how many rays come to all trees.
  void expect(std::size_t rays) { all_ = std::max(1.0, static_cast<double>(rays)); }
  // For the options of the next tree, to which so many rays come.
  const Progress* of_tree(std::size_t rays) {
    if (progress_ == nullptr) return nullptr;
    before_ += of_tree_, of_tree_ = static_cast<double>(rays);
    share_of_tree_ = [this](double share) { tell_sometimes((before_ + share * of_tree_) / all_); };
    return &share_of_tree_;
  }
  void finish() { tell(1); }
  // The share is told if some time has passed: of thousands of trees each may take less than a report.
  void tell_sometimes(double share) {
    constexpr std::chrono::milliseconds between{10};
    if (progress_ != nullptr && Clock::now() >= last_ + between) tell(std::min(share, 1.0));
  }

 private:
  using Clock = std::chrono::steady_clock;
  void tell(double share) {
    if (progress_ != nullptr) isolated([&] { (*progress_)(share); });
    last_ = Clock::now();
  }

  const Progress* progress_;
  Progress share_of_tree_;
  double all_ = 1, before_ = 0, of_tree_ = 0;
  Clock::time_point last_;
};

// A call for lists in a scene, whose options are found good.
template <class T, class Query>
struct SceneListCall {
  CheckedCall<T, ListOptions> checked;
  Query query;

  template <class Parts>
  SceneListCall(const char* call, const Parts& scene, const RaySourceOf<T>& rays, const ListOptions& options)
      : checked(call, rays, options),
        query(checked_query(scene, {.path = options.path,
                                    .threads = options.threads,
                                    .facing = options.facing,
                                    .skip = options.skip,
                                    .mask = options.mask,
                                    .masks = options.masks})) {
    checked_queries<T>(call, options);
  }
  // All rays; inactive ones hit nothing.
  std::vector<RayOf<T>> active() const {
    std::vector<RayOf<T>> active(checked.rays.size());
    for (std::size_t i = 0; i < active.size(); ++i)
      if (checked.rays.takes_part(i)) active[i] = checked.rays[i];
    return active;
  }
};

// Items in the order of rays, t, instances and primitives, as lists of at most max_count.
template <class Found, class Item>
void set_lists(std::vector<Found> found, std::size_t rays, std::size_t max_count, RayLists<Item>& lists) {
  std::ranges::sort(found, {},
                    [](const Found& f) { return std::tuple(f.ray, f.t, f.instance, f.primitive); });
  lists.offsets.reserve(rays + 1);
  for (std::size_t i = 0, at = 0; i < rays; ++i) {
    for (std::size_t count = 0; at < found.size() && found[at].ray == i; ++at, ++count)
      if (count < max_count) lists.items.push_back(found[at]);
    lists.offsets.push_back(lists.items.size());
  }
}
// The crossings of a scene, counted for each active ray.
template <class T, class Item>
void set_counts(const RayLists<Item>& lists, const RaySourceOf<T>& rays, std::span<CrossingCount> counts) {
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if (!rays.takes_part(i)) continue;
    counts[i] = {};
    for (const Item& crossing : lists[i]) ++counts[i].crossings, counts[i].winding += crossing.side;
  }
}

}  // namespace raylanes
