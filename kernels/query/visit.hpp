// Rays to the leaves of a tree over boxes, by the traversals that triangles have: what is in a leaf its owner tests,
// many rays at a time where they are many, and says how far each of them still goes.
#pragma once

#include "../traverse/streams.hpp"

namespace raylanes {
namespace {

// Fewer rays than this go one by one.
inline constexpr std::size_t least_visit_stream = 16;

inline float visit_rays(const VisitBatch& batch, TreeReference leaf, const std::uint32_t* rays,
                        std::size_t count) {
  batch.visit(batch.context,
              {leaf & leaf_block_mask, static_cast<std::uint32_t>(leaf_size(leaf)), rays, count});
  return finite_tmax(batch.tmax[rays[0]]);
}

// What is left of a ray, which goes on alone.
struct VisitQuery : NearestFirst {
  float tmax;
  float box_tmax() const { return tmax; }
};
template <class Boxes, class Counters>
inline void visit_alone(const TreeView& tree, const VisitBatch& batch, const Boxes& boxes,
                        std::uint32_t number, Counters& counters) {
  VisitQuery query{{}, finite_tmax(batch.tmax[number])};
  walk_nodes(tree, boxes, query, counters, [&](TreeReference leaf) {
    counters.leaf();
    query.tmax = visit_rays(batch, leaf, &number, 1);
    return query.tmax < -largest_t;
  });
}

// As StreamLeaves. The numbers of rays stand where other streams keep leaf triangles.
template <class Test, class Counters>
class VisitLeaves {
 public:
  using Batch = VisitBatch;
  static constexpr bool only_decides = false, shortens_rays = true, packs_numbers = false;

  VisitLeaves(const TreeView& tree, const VisitBatch& batch, OctantRays& rays, float)
      : tree_(tree), batch_(batch), rays_(rays) {
    for (std::uint32_t i = 0; i < rays.size; ++i) shorten(i);
  }

  static void trace_single(const TreeView& tree, const VisitBatch& batch, std::size_t number) {
    const Ray& ray = batch.rays[number];
    if (!is_valid(ray)) return;
    Counters counters(counted(batch));
    float largest = 0.0f;
    for (const float x : ray.origin) largest = x > largest ? x : -x > largest ? -x : largest;
    const auto slabs = PaddedSlabs::for_exact_hits(ray, tree.bounds, tree.origin_share * largest);
    const NodeTest<node_lanes> boxes(slabs, ray.tmin);
    visit_alone(tree, batch, boxes, static_cast<std::uint32_t>(number), counters);
  }

 protected:
  Counters counters() const { return Counters(counted(batch_)); }

  template <class Prepared>
  void trace_lone(const TreeView& below, const Ray&, const Prepared& prepared, std::uint32_t i,
                  Counters& cost) {
    visit_alone(below, batch_, prepared.nodes, rays_.number[i], cost);
    shorten(i);
  }

  [[gnu::noinline]] void visit_leaf(TreeReference leaf, const ListEntry* list, std::uint32_t size) {
    counters().leaf();
    for (std::uint32_t k = 0; k < size; ++k) rays_.leaf_triangle[k] = rays_.number[index_of(list[k])];
    visit_rays(batch_, leaf, rays_.leaf_triangle, size);
    for (std::uint32_t k = 0; k < size; ++k) shorten(index_of(list[k]));
  }

  const TreeView& tree_;
  const VisitBatch& batch_;
  OctantRays& rays_;
  float farthest_ = 0.0f, scale_ = 1.0f;  // triangles would ask for them

 private:
  static TraceBatch counted(const VisitBatch& batch) {
    TraceBatch counted;
    counted.counters = batch.counters;
    return counted;
  }
  void shorten(std::uint32_t i) { rays_.rows[i].tmax = finite_tmax(batch_.tmax[rays_.number[i]]); }
};

// As QueryKernels has it. Rays that are counted go alone.
template <class Counters>
[[gnu::noinline]] void visit_boxes(const TreeView& tree, const VisitBatch& batch) {
  using Leaves = VisitLeaves<Exact<Grade::reproducible>, Counters>;
  if (tree.root == empty_reference) return;
  if constexpr (std::is_same_v<Counters, NoCounters>)
    if (batch.size >= least_visit_stream)
      return Streams<Exact<Grade::reproducible>, Leaves, Counters>(tree, batch).trace();
  for (std::size_t i = 0; i < batch.size; ++i) Leaves::trace_single(tree, batch, i);
}

}  // namespace
}  // namespace raylanes
