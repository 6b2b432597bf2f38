// Lists of hits or crossings in a scene of triangles, by the tree of each instance.
#pragma once

#include <numeric>

#include "../../batch/scratch.hpp"
#include "../../queries/traced_tree.hpp"
#include "../scene_parts.hpp"
#include "lists_in_trees.hpp"

namespace raylanes {

// Lists of a scene that has several trees.
template <class Item>
class InstanceLists {
 public:
  // Rays of no direction are inactive. options.max_count is of each tree.
  InstanceLists(const SceneQuery& query, const std::vector<Ray>& rays, const ListOptions& options)
      : query_(query), rays_(rays), options_(options), progress_(options.progress) {
    options_.active = nullptr;
  }

  // The items of all rays. A ray's items of one instance are in order.
  std::vector<FoundItem<Item>> find() {
    of_instance_.resize(query_.scene.instances.size());
    for (const TopLevel& top : query_.scene.tops) visit_instances(top);
    std::vector<std::uint32_t> all(rays_.size());
    std::iota(all.begin(), all.end(), 0u);
    std::size_t rays = all.size() * query_.scene.commons.size();
    for (const auto& of_instance : of_instance_) rays += of_instance.size();
    progress_.expect(rays);
    for (const auto& tree : query_.scene.commons)
      if (query_.scene.sees(*tree, query_.mask))
        find_in(*tree->geometry->triangles(), tree->numbers(), all, rays_);
    for (std::uint32_t instance = 0; instance < of_instance_.size(); ++instance)
      if (!of_instance_[instance].empty()) find_in_instance(instance);
    progress_.finish();
    return std::move(found_);
  }

 private:
  // Notes which rays come to which instances.
  void visit_instances(const TopLevel& top) {
    constexpr std::size_t step = 16384;
    const std::size_t bytes = query_.kernels.traversal.scratch_bytes(TraversalMode::stream, step);
    Scratch scratch(Scratch::bytes_of<std::byte>(bytes));
    VisitBatch batch;
    batch.scratch = scratch.take<std::byte>(bytes), batch.visit = note, batch.context = this;
    top_ = &top.tree;
    for (first_ = 0; first_ < rays_.size(); first_ += step) {
      batch.rays = rays_.data() + first_, batch.size = std::min(step, rays_.size() - first_);
      query_.queries().visit(top.tree.view(), batch);
      progress_.tell_sometimes(0);
    }
  }
  static void note(void* context, const VisitedLeaf& leaf) {
    auto& self = *static_cast<InstanceLists*>(context);
    for (std::uint32_t k = leaf.first; k < leaf.first + leaf.size; ++k) {
      const std::uint32_t number = self.top_->order[k];
      if ((self.query_.scene.instances[number].mask & self.query_.mask) == 0) continue;
      for (std::size_t i = 0; i < leaf.count; ++i)
        self.of_instance_[number].push_back(static_cast<std::uint32_t>(self.first_ + leaf.rays[i]));
    }
  }
  void find_in_instance(std::uint32_t number) {
    const Instance& instance = query_.scene.instances[number];
    const std::vector<std::uint32_t>& picked = of_instance_[number];
    std::vector<Ray> mapped(picked.size());
    for (std::size_t k = 0; k < picked.size(); ++k) mapped[k] = rays_[picked[k]];
    if (!instance.is_identity)
      query_.kernels.queries.map_rays(rays_.data(), picked.data(), picked.size(), instance.inverse,
                                      mapped.data());
    find_in(*query_.scene.geometries[instance.geometry]->triangles(),
            OneMember(number, instance.geometry).numbers(), picked, mapped);
  }
  // Appends what a tree has of rays in its space.
  void find_in(const Bvh& tree, const MemberNumbers& numbers, const std::vector<std::uint32_t>& picked,
               const std::vector<Ray>& rays) {
    options_.masks = query_.scene.masks_in(numbers.members[0].geometry);
    options_.progress = progress_.of_tree(rays.size());
    append_lists<Item>(found_, TreeAccess::traced(tree), numbers, picked, rays, query_.skip, options_);
  }

  const SceneQuery& query_;
  const std::vector<Ray>& rays_;
  ListOptions options_;
  ProgressInTrees progress_;
  const BoundedTreeArrays* top_ = nullptr;  // that is visited, with rays from `first_` on
  std::size_t first_ = 0;
  std::vector<std::vector<std::uint32_t>> of_instance_;  // the rays that come to each
  std::vector<FoundItem<Item>> found_;
};

}  // namespace raylanes
