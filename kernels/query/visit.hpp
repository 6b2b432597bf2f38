// Rays to the leaves of a tree over boxes, by the traversals that triangles have: what is in a leaf its owner tests,
// many rays at a time where they are many, and says how far each of them still goes.
#pragma once

#include "../../dispatch/table/queries.hpp"
#include "../traverse/streams.hpp"
#include "../traverse/walk_boxes.hpp"

namespace raylanes {
namespace {

// Fewer rays than this go one by one.
inline constexpr std::size_t min_visit_stream = 16;

inline void visit_rays(const VisitBatch& batch, TreeReference leaf, const std::uint32_t* rays, float* tmax,
                       std::size_t count) {
  batch.visit(batch.context,
              {leaf_of(leaf).block, static_cast<std::uint32_t>(leaf_size(leaf)), rays, tmax, count});
}

// A ray that goes alone: its leaves ask a function.
struct NearestVisit : NearestFirst {
  float tmax;
  float box_tmax() const { return tmax; }
};
struct AskedLeaves {
  float (*ask)(void* context, std::uint32_t first, std::uint32_t size);
  void* context;

  bool visit(TreeReference leaf, NearestVisit& query) const {
    const float t = ask(context, leaf_of(leaf).block, leaf_of(leaf).size), end = end_after(t);
    query.tmax = end < query.tmax ? end : query.tmax;
    return t < -largest_t;
  }
  bool visit_unusual(TreeReference leaf, NearestVisit& query) const { return visit(leaf, query); }
};
// From the root. A tree of one leaf has no box that a ray could miss.
[[maybe_unused, gnu::flatten]] void visit_ray(const TreeView& tree, const Ray& ray, float end,
                                              float (*ask)(void* context, std::uint32_t first,
                                                           std::uint32_t size),
                                              void* context) {
  if (refers_to_leaf(tree.root) && !is_valid(ray)) return;
  NearestVisit query{{}, finite_tmax(end)};
  NoCounters counters(query);
  walk_boxes(tree, ray, tree.origin_share * largest_of(ray.origin) + tree.padding, AskedLeaves{ask, context},
             query, counters);
}

// The rest of a ray of a batch that goes on alone. Returns what is left of it then.
template <class Boxes, class Counters>
inline float visit_single(const TreeView& tree, const VisitBatch& batch, const Boxes& boxes,
                          std::uint32_t number, float tmax, Counters& counters) {
  NearestVisit query{{}, tmax};
  walk_nodes(tree, boxes, query, counters, [&](TreeReference leaf) {
    counters.leaf();
    visit_rays(batch, leaf, &number, &query.tmax, 1);
    return query.tmax < -largest_t;
  });
  return query.tmax;
}
inline float first_tmax(const VisitBatch& batch, std::size_t number) {
  return finite_tmax(batch.tmax != nullptr ? batch.tmax[number] : batch.rays[number].tmax);
}

// From the root that the tree has. Returns what is left of the ray then.
template <class Counters>
inline float visit_single(const TreeView& tree, const VisitBatch& batch, std::uint32_t number, float tmax) {
  const Ray& ray = batch.rays[number];
  if (!is_valid(ray)) return tmax;
  Counters counters(batch);
  const float padding = tree.origin_share * largest_of(ray.origin) + tree.padding;
  return visit_single(tree, batch, padded_boxes(tree, ray, padding), number, tmax, counters);
}

// As StreamLeaves. The memory in which other streams keep leaf triangles and hits has the indices of a leaf's rays and
// their ends.
template <class Counters>
class VisitLeaves : public StreamOctant<Counters> {
  using Base = StreamOctant<Counters>;
  using Base::counters, Base::rays_, Base::tree_;

 public:
  VisitLeaves(const TreeView& tree, const VisitBatch& batch)
      : Base(Base::template calls_of<VisitLeaves>, {.only_decides = false}, tree, batch), batch_(batch) {}

  void begin() {
    if (batch_.tmax == nullptr) return;  // rows have the rays' own
    for (std::uint32_t i = 0; i < rays_.size; ++i) rays_.rows[i].tmax = first_tmax(batch_, rays_.number[i]);
  }
  void store_results() {}
  void prefetch_leaf(TreeReference) {}
  void trace_single(std::size_t number) {
    visit_single<Counters>(tree_, batch_, static_cast<std::uint32_t>(number), first_tmax(batch_, number));
  }
  [[gnu::noinline, gnu::flatten]] void trace_singly(TreeReference from, const ListEntry* list,
                                                    std::uint32_t size) {
    this->each_single(
        from, list, size,
        [this](const TreeView& below, const SingleBoxes& boxes, std::uint32_t i, Counters& cost) {
          float& tmax = rays_.rows[i].tmax;
          tmax = visit_single(below, batch_, boxes, rays_.number[i], tmax, cost);
        });
  }
  [[gnu::noinline]] void visit_leaf(TreeReference leaf, const ListEntry* list, std::uint32_t size) {
    std::uint32_t* const numbers = rays_.leaf_triangle;
    auto* const tmax = reinterpret_cast<float*>(rays_.hits);
    counters().leaf();
    for (std::uint32_t k = 0; k < size; ++k) {
      const std::uint32_t i = index_of(list[k]);
      numbers[k] = rays_.number[i], tmax[k] = rays_.rows[i].tmax;
    }
    visit_rays(batch_, leaf, numbers, tmax, size);
    for (std::uint32_t k = 0; k < size; ++k) rays_.rows[index_of(list[k])].tmax = tmax[k];
  }

 private:
  const VisitBatch& batch_;
};

}  // namespace
}  // namespace raylanes
