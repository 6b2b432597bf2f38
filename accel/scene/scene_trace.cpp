#include <algorithm>

#include "../memory/scratch.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

// Rays that come to an instance lie in a picture as that does: fewer than this make packets with wide frusta, and go as
// streams, or alone. Measured.
constexpr std::size_t least_packets = 4096;

// Rays in the space of an instance, and room for what its part answers.
struct RaysOfPart {
  const Ray* rays;
  const float* tmax;  // of parts whose rays keep their own, what is of use; null: that of the rays
  std::size_t size;
  Hit* hits;
  std::uint8_t* occluded;
};

struct TracesPart {
  const SceneQuery& query;
  const RaysOfPart& part;

  void operator()(const Triangles& triangles) const {
    const TracedTree tree = TreeOf::bvh(triangles.tree);
    TreeView view = tree.view;
    if (tree.leaves != nullptr) view.blocks = tree.leaves->blocks(query.test);
    TraceBatch batch;
    batch.rays = part.rays, batch.size = part.size;
    batch.hits = part.hits, batch.occluded = part.occluded;
    batch.counters = query.counters;
    TraversalChoice choice = query.choice;
    if (part.size < least_packets) choice.hint = BatchHint::incoherent;
    trace_here(view, choice, batch);
  }
  void operator()(const Spheres& spheres) const { trace_spheres(*spheres.leaves, query.kernels, boxed()); }
  void operator()(const UserPrimitives& user) const {
    trace_boxes(*user.boxes, query.kernels, user.test, boxed());
  }

 private:
  BoxedBatch boxed() const {
    return {part.rays, part.size, part.hits, part.occluded, part.tmax, query.counters};
  }
};

class SceneTracer {
 public:
  SceneTracer(const SceneQuery& query, const SceneBatch& batch) : query_(query), batch_(batch) {}

  void trace() {
    const BoxTree& top = query_.scene.top;
    if (top.root != empty_reference && refers_to_leaf(top.root)) return trace_only(top.order[0]);
    clear();
    if (top.root == empty_reference) return;
    const QueryKernels& row =
        query_.counters != nullptr ? query_.kernels.queries.counted : query_.kernels.queries.plain;
    const std::size_t bytes = query_.kernels.stream_scratch_bytes(batch_.size);
    Scratch scratch(Scratch::bytes_of<float>(batch_.size) + bytes);
    tmax_ = scratch.take<float>(batch_.size);
    for (std::size_t i = 0; i < batch_.size; ++i) tmax_[i] = batch_.rays[i].tmax;
    VisitBatch boxes;
    boxes.rays = batch_.rays, boxes.size = batch_.size, boxes.tmax = tmax_;
    boxes.scratch = scratch.take<std::byte>(bytes);
    boxes.visit = leaf, boxes.context = this;
    boxes.counters = query_.counters;
    row.visit(top.view(), boxes);
  }

 private:
  void clear() const {
    if (batch_.hits != nullptr)
      std::fill_n(batch_.hits, batch_.size, SceneHit());
    else
      std::fill_n(batch_.occluded, batch_.size, std::uint8_t{0});
  }
  bool is_seen(const Instance& instance) const { return (instance.mask & query_.mask) != 0; }

  // All rays go to the one instance that there is: its tree's root is as good as a top level.
  void trace_only(std::uint32_t number) const {
    const Instance& instance = query_.scene.instances[number];
    if (!is_seen(instance)) return clear();
    Scratch scratch(Scratch::bytes_of<Ray>(batch_.size) + Scratch::bytes_of<Hit>(batch_.size));
    RaysOfPart part{batch_.rays, nullptr, batch_.size, nullptr, batch_.occluded};
    if (batch_.hits != nullptr) part.hits = scratch.take<Hit>(batch_.size);
    if (!instance.is_identity) {
      Ray* const mapped = scratch.take<Ray>(batch_.size);
      query_.kernels.queries.map_rays(batch_.rays, nullptr, batch_.size, instance.inverse, mapped);
      part.rays = mapped;
    }
    std::visit(TracesPart{query_, part}, query_.scene.geometries[instance.geometry]);
    if (batch_.hits == nullptr) return;
    for (std::size_t i = 0; i < batch_.size; ++i) {
      const Hit& hit = part.hits[i];
      batch_.hits[i] = hit ? wide(hit, number) : SceneHit();
    }
  }

  static void leaf(void* context, const VisitedLeaf& leaf) {
    auto& tracer = *static_cast<SceneTracer*>(context);
    for (std::uint32_t k = leaf.first; k < leaf.first + leaf.size; ++k)
      tracer.visit(tracer.query_.scene.top.order[k], leaf.rays, leaf.count);
  }

  void visit(std::uint32_t number, const std::uint32_t* rays, std::size_t count) const {
    const Instance& instance = query_.scene.instances[number];
    if (!is_seen(instance)) return;
    const Geometry& geometry = query_.scene.geometries[instance.geometry];
    Scratch scratch(count * (sizeof(Ray) + sizeof(Hit) + sizeof(float)) + 192);
    auto* const mapped = scratch.take<Ray>(count);
    if (instance.is_identity)
      for (std::size_t k = 0; k < count; ++k) mapped[k] = batch_.rays[rays[k]];
    else
      query_.kernels.queries.map_rays(batch_.rays, rays, count, instance.inverse, mapped);
    RaysOfPart part{mapped, nullptr, count, nullptr, nullptr};
    if (std::holds_alternative<Spheres>(geometry)) {
      auto* const tmax = scratch.take<float>(count);
      for (std::size_t k = 0; k < count; ++k) tmax[k] = tmax_[rays[k]];
      part.tmax = tmax;
    } else {
      for (std::size_t k = 0; k < count; ++k) mapped[k].tmax = tmax_[rays[k]];
    }
    if (batch_.hits != nullptr)
      part.hits = scratch.take<Hit>(count);
    else
      part.occluded = scratch.take<std::uint8_t>(count);
    std::visit(TracesPart{query_, part}, geometry);
    if (batch_.hits != nullptr)
      keep_hits(number, rays, part);
    else
      keep_occluded(rays, part);
  }

  void keep_hits(std::uint32_t number, const std::uint32_t* rays, const RaysOfPart& part) const {
    for (std::size_t k = 0; k < part.size; ++k) {
      const Hit& hit = part.hits[k];
      SceneHit& best = batch_.hits[rays[k]];
      if (!hit || !(hit.t < best.t || (hit.t == best.t && number < best.instance))) continue;
      best = wide(hit, number);
      tmax_[rays[k]] = std::min(tmax_[rays[k]], tmax_behind(hit.t));
    }
  }
  void keep_occluded(const std::uint32_t* rays, const RaysOfPart& part) const {
    for (std::size_t k = 0; k < part.size; ++k) {
      if (part.occluded[k] == 0) continue;
      batch_.occluded[rays[k]] = 1;
      tmax_[rays[k]] = -std::numeric_limits<float>::infinity();
    }
  }
  SceneHit wide(const Hit& hit, std::uint32_t number) const {
    return {hit.t, hit.u, hit.v, hit.primitive, query_.scene.instances[number].geometry, number};
  }

  const SceneQuery& query_;
  const SceneBatch& batch_;
  float* tmax_ = nullptr;  // by ray: behind this no hit is of use
};

}  // namespace

void trace_scene(const SceneQuery& query, const SceneBatch& batch) {
  SceneTracer(query, batch).trace();
}

}  // namespace raylanes
