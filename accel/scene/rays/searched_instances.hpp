// How a ray goes through the trees of instances by options that the kernel of instances does not know.
#pragma once

#include <type_traits>

#include "../../../dispatch/table/instances.hpp"
#include "../../../dispatch/table/kernel_table.hpp"
#include "../../../dispatch/table/queries.hpp"
#include "../scene_parts.hpp"

namespace raylanes {

// A search in one tree, and what the caller says of hits of the scene there. Null: nothing is rejected, or skipped.
class AskedInTree {
 public:
  AskedInTree(const detail::Rejection<SceneHit>* rejection, const TriangleOwners& owners, Facing facing,
              std::uint32_t skipped, const Hit* after)
      : rejection_(rejection),
        owners_(owners),
        asked{rejection != nullptr ? rejects : nullptr, this, facing, skipped, after} {}
  AskedInTree(const AskedInTree&) = delete;
  AskedInTree& operator=(const AskedInTree&) = delete;

 private:
  static bool rejects(void* search, const Hit& hit) {
    const auto& [rejection, owners, asked] = *static_cast<const AskedInTree*>(search);
    return rejection->rejects(rejection->function, owners.spread(hit));
  }
  const detail::Rejection<SceneHit>* rejection_;
  const TriangleOwners& owners_;

 public:
  const AskedOf<float> asked;
};

// The triangles and hits that count for a ray by the options of its call.
struct RuleInScene {
  Facing facing = Facing::any;
  SkippedPrimitive skipped = {no_primitive, no_part};
  const SceneHit* after = nullptr;                         // null: hits come after none
  const detail::Rejection<SceneHit>* rejection = nullptr;  // null: none is rejected
};

class SearchedInstances : public InstanceSearch {
 public:
  SearchedInstances(const SceneParts& scene, const KernelTable& kernels, const RuleInScene& rule)
      : InstanceSearch{closest_in, any_in, this}, scene_(scene), rows_(kernels.queries.plain), rule_(rule) {}
  SearchedInstances(const SearchedInstances&) = delete;
  SearchedInstances& operator=(const SearchedInstances&) = delete;

  // In a common tree, without asking the caller.
  SceneHit closest_in_common(const CommonTree& tree, const Ray& ray) const {
    const MemberNumbers numbers = tree.numbers();
    return numbers.owners.spread(
        rows_.ruled_call.closest(*tree.view, ray, rule_.facing, skipped_by(numbers)));
  }
  bool any_in_common(const CommonTree& tree, const Ray& ray) const {
    return rows_.ruled_call.any(*tree.view, ray, rule_.facing, skipped_by(tree.numbers()));
  }

 private:
  static Hit closest_in(const void* search, const TreeView& below, const Ray& ray, std::uint32_t instance) {
    const auto& self = *static_cast<const SearchedInstances*>(search);
    if (!self.asks())
      return self.rows_.ruled_call.closest(below, ray, self.rule_.facing, self.skipped(instance));
    return self.asking(
        instance, [&](const AskedOf<float>& asked) { return self.rows_.kept.closest(below, ray, asked); });
  }
  static bool any_in(const void* search, const TreeView& below, const Ray& ray, std::uint32_t instance) {
    const auto& self = *static_cast<const SearchedInstances*>(search);
    if (!self.asks()) return self.rows_.ruled_call.any(below, ray, self.rule_.facing, self.skipped(instance));
    return self.asking(instance,
                       [&](const AskedOf<float>& asked) { return self.rows_.kept.any(below, ray, asked); });
  }

  bool asks() const { return rule_.after != nullptr || rule_.rejection != nullptr; }
  template <class Search>
  std::invoke_result_t<Search, const AskedOf<float>&> asking(std::uint32_t instance,
                                                             const Search& search) const {
    const OneMember only(instance, scene_.instances[instance].geometry);
    const MemberNumbers numbers = only.numbers();
    Hit last;
    if (rule_.after != nullptr) last = numbers.after(*rule_.after);
    const AskedInTree in_tree(rule_.rejection, numbers.owners, rule_.facing, skipped(instance),
                              rule_.after != nullptr ? &last : nullptr);
    return search(in_tree.asked);
  }
  std::uint32_t skipped(std::uint32_t instance) const {
    return rule_.skipped.instance == instance ? rule_.skipped.primitive : no_primitive;
  }
  std::uint32_t skipped_by(const MemberNumbers& numbers) const {
    return numbers.of(rule_.skipped.instance, rule_.skipped.primitive);
  }

  const SceneParts& scene_;
  const QueryKernels& rows_;
  const RuleInScene rule_;
};

}  // namespace raylanes
