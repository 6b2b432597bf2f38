// The trees over a scene's instances.

#include "../queries/traced_tree.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

// Instances whose share is at most that, a band after the other: one ill-conditioned transform would pad the boxes of
// all instances of its tree. A rotation's share is 2^-20; 2^-12 adds a box test for few rays.
constexpr float largest_shares[] = {0x1p-12f, 0x1p-6f, std::numeric_limits<float>::max()};

// A node is opened under two conditions. Its box in the scene has more than min_share of the top level's area. The
// boxes of its children together have less than max_growth times its area, else they overlap as much. Measured.
constexpr double min_share = 1.0 / 25, max_growth = 1.7;
constexpr std::size_t max_added = 2048;
// Streams take as long as single rays where the boxes of instances have so many times the area of all. Measured.
constexpr double max_overlap = 5;

// An entry in the scene.
struct PlacedEntry {
  InstanceEntry entry;
  Box box;
  double area;

  PlacedEntry(InstanceEntry entry_, const Box& box_) : entry(entry_), box(box_), area(half_area_of(box_)) {}
  bool operator<(const PlacedEntry& other) const { return area < other.area; }
};

// Replaces the largest entry by the children of its node, again and again: instances that overlap have nodes that
// overlap less (partial re-braiding: Benthin, Woop, Wald and Áfra 2017).
void open_largest(std::vector<PlacedEntry>& entries, std::span<const Instance> instances, double least) {
  const std::size_t most = entries.size() + max_added;
  std::vector<PlacedEntry> closed;
  std::make_heap(entries.begin(), entries.end());
  while (!entries.empty() && entries[0].area > least && entries.size() + closed.size() + tree_width <= most) {
    std::pop_heap(entries.begin(), entries.end());
    const PlacedEntry from = entries.back();
    entries.pop_back();
    if (refers_to_leaf(from.entry.from)) {
      closed.push_back(from);
      continue;
    }
    const Instance& instance = instances[from.entry.instance];
    const WideNode& node = instance.tree->nodes[from.entry.from];
    const std::size_t before = entries.size();
    double area = 0;
    for (std::size_t child = 0; child < tree_width; ++child) {
      if ((node.occupied >> child & 1u) == 0) continue;
      const Box box{{node.lo[0][child], node.lo[1][child], node.lo[2][child]},
                    {node.hi[0][child], node.hi[1][child], node.hi[2][child]}};
      entries.push_back({{from.entry.instance, node.child[child]}, bounds_of(instance, box, 0).box});
      area += entries.back().area;
    }
    if (area > max_growth * from.area) {
      entries.erase(entries.begin() + static_cast<std::ptrdiff_t>(before), entries.end());
      closed.push_back(from);
      continue;
    }
    for (std::size_t end = before; end < entries.size();)
      std::push_heap(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(++end));
  }
  entries.insert(entries.end(), closed.begin(), closed.end());
}

// Sets the entries that kernels walk, in the order of their tree.
void set_entries(TopLevel& top, std::span<const Instance> instances, std::span<const InstanceBounds> bounds) {
  std::vector<PlacedEntry> entries;
  entries.reserve(top.tree.order.size());
  for (const std::uint32_t i : top.tree.order) {
    const TreeView& tree = *instances[i].tree;
    entries.push_back({{i, tree.root}, bounds[i].box});
    top.closest_from += tree.streams_from.closest, top.occluded_from += tree.streams_from.occluded;
  }
  double area = 0;
  for (const PlacedEntry& entry : entries) area += entry.area;
  const double whole = half_area_of(top.tree.bounds), least = min_share * whole;
  top.overlaps = area > max_overlap * whole;
  const auto is_large = [&](const PlacedEntry& entry) { return entry.area > least; };
  const bool opens = entries.size() > 1 && std::ranges::any_of(entries, is_large);
  if (opens) {
    open_largest(entries, instances, least);
    std::vector<Box> boxes;
    for (const PlacedEntry& entry : entries) boxes.push_back(entry.box);
    top.opened = build_box_tree("scene", boxes, {});
    top.opened.slack = top.tree.slack;
  }
  for (std::size_t i = 0; i < entries.size(); ++i)
    top.entries.push_back(entries[opens ? top.opened.order[i] : i].entry);
}

// Appends the top levels over instances that have trees of triangles, or over those that have none.
void append_tops(std::vector<TopLevel>& tops, bool of_triangles, std::span<const Instance> instances,
                 std::span<const InstanceBounds> all) {
  std::vector<Box> boxes(all.size());
  float least = -1.0f;
  for (const float most : largest_shares) {
    TopLevel top;
    float share = 0.0f;
    bool has_any = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const InstanceBounds& bounds = all[i];
      const bool is_in = (instances[i].tree != nullptr) == of_triangles && bounds.share > least &&
                         bounds.share <= most && is_visited(bounds.box);
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
    if (of_triangles) set_entries(top, instances, all);
    tops.push_back(std::move(top));
  }
}

}  // namespace

std::vector<TopLevel> tops_over(std::span<const Instance> instances, std::span<const InstanceBounds> all) {
  std::vector<TopLevel> tops;
  for (const bool of_triangles : {true, false}) append_tops(tops, of_triangles, instances, all);
  return tops;
}

void SceneParts::set_trees() noexcept {
  for (Instance& instance : instances) {
    const Geometry& geometry = *geometries[instance.geometry];
    const bool is_walked = geometry.has_tree() && words_of(instance.geometry) == nullptr;
    const Bvh* const tree = is_walked ? geometry.triangles() : nullptr;
    instance.tree =
        tree != nullptr && TreeAccess::arrays(*tree) != nullptr ? TreeAccess::ready(*tree) : nullptr;
  }
}
void SceneParts::set_tops(std::vector<TopLevel> made) noexcept {
  tops = std::move(made);
  for (TopLevel& top : tops)
    top.walked = {(top.opened.size > 0 ? top.opened : top.tree).view(),
                  top.entries.empty() ? nullptr : top.entries.data(), instances.data(), sizeof(Instance)};
}

}  // namespace raylanes
