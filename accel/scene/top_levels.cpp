// The trees over a scene's instances.
#include "../queries/traced_tree.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

// Instances whose share is at most that, a band after the other: one ill-conditioned transform would pad the boxes of
// all instances of its tree. A rotation's share is 2^-20; 2^-12 adds a box test for few rays.
constexpr float largest_shares[] = {0x1p-12f, 0x1p-6f, std::numeric_limits<float>::max()};

// Sets the entries in the order of the tree, if all its instances have triangles.
void set_entries(TopLevel& top, std::span<const Instance> instances) {
  top.entries.reserve(top.tree.order.size());
  for (const std::uint32_t i : top.tree.order) {
    if (instances[i].tree == nullptr) return top.entries.clear();
    top.entries.push_back({i, instances[i].tree->root});
  }
}

}  // namespace

std::vector<TopLevel> tops_over(std::span<const Instance> instances, std::span<const InstanceBounds> all) {
  std::vector<TopLevel> tops;
  std::vector<Box> boxes(all.size());
  float least = -1.0f;
  for (const float most : largest_shares) {
    TopLevel top;
    float share = 0.0f;
    bool has_any = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const InstanceBounds& bounds = all[i];
      const bool is_in = bounds.share > least && bounds.share <= most && is_visited(bounds.box);
      boxes[i] = is_in ? bounds.box : empty_box;
      if (!is_in) continue;
      has_any = true;
      share = std::max(share, bounds.share);
      top.rounded.share = std::max(top.rounded.share, bounds.rounded.share);
      top.rounded.distance = std::max(top.rounded.distance, bounds.rounded.distance);
    }
    least = most;
    if (!has_any) continue;
    top.tree = build_box_tree("scene", boxes, {});
    top.tree.slack = share;
    set_entries(top, instances);
    tops.push_back(std::move(top));
  }
  return tops;
}

void SceneParts::set_trees() noexcept {
  for (Instance& instance : instances) {
    const Geometry& geometry = *geometries[instance.geometry];
    const Bvh* const tree = geometry.has_tree() ? geometry.triangles() : nullptr;
    instance.tree = tree != nullptr && TreeOf::arrays(*tree) != nullptr ? TreeOf::ready(*tree) : nullptr;
  }
}
void SceneParts::set_tops(std::vector<TopLevel> made) noexcept {
  tops = std::move(made);
  for (TopLevel& top : tops)
    top.walked = {top.tree.view(), top.entries.empty() ? nullptr : top.entries.data(), instances.data(),
                  sizeof(Instance)};
}

}  // namespace raylanes
