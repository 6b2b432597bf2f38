
#include "../../dispatch/table/queries.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../batch/scratch.hpp"
#include "../batch/shared_points.hpp"
#include "rays/searched_instances.hpp"
#include "reach.hpp"

namespace raylanes {
namespace {

// Rays to an instance spread over its part of the picture. Fewer rays than this make packets with wide frusta, so they
// are traced as streams or single rays. Measured.
constexpr std::size_t min_packets = 4096;

// Spreads the hits of a tree into hits of the scene, from the front. As words: a hit's two, the second of which ends
// with the primitive, and one that names the geometry and the instance.
[[gnu::noinline]] void spread(const Hit* hits, std::size_t size, const TriangleOwners& owners,
                              SceneHit* all) {
  static_assert(sizeof(Hit) == 16 && offsetof(Hit, primitive) == 12 && sizeof(SceneHit) == 24 &&
                offsetof(SceneHit, geometry) == 16 && offsetof(SceneHit, instance) == 20 &&
                offsetof(TriangleOwner, instance) == offsetof(TriangleOwner, geometry) + 4);
  using Word = std::uint64_t;
  const auto* from = reinterpret_cast<const std::byte*>(hits);
  auto* to = reinterpret_cast<std::byte*>(all);
  for (; size > 0; --size, from += sizeof(Hit), to += sizeof(SceneHit)) {
    Word first, second, of_this;
    std::memcpy(&first, from, sizeof first), std::memcpy(&second, from + 8, sizeof second);
    const auto triangle = static_cast<std::uint32_t>(second >> 32);
    const bool is_hit = triangle != no_primitive;
    const TriangleOwner& owner = owners.of(is_hit ? triangle : 0);
    std::memcpy(&of_this, &owner.geometry, sizeof of_this);
    second -= is_hit ? Word{owner.first} << 32 : 0;
    of_this = is_hit ? of_this : ~Word{0};
    std::memcpy(to, &first, sizeof first), std::memcpy(to + 8, &second, sizeof second);
    std::memcpy(to + 16, &of_this, sizeof of_this);
  }
}

class SceneTracer {
 public:
  SceneTracer(const SceneQuery& query, const SceneBatch& batch) : query_(query), batch_(batch) {}

  void trace() {
    const std::vector<TopLevel>& tops = query_.scene.tops;
    bool has_answers = false;
    for (const auto& tree : query_.scene.commons) {
      if (!query_.scene.sees(*tree, query_.mask)) continue;
      has_answers ? trace_further(*tree) : trace_all(*tree->geometry, tree->numbers(), batch_.rays);
      has_answers = true;
    }
    if (has_answers) return visit_tops(true);
    if (tops.size() == 1 && refers_to_leaf(tops[0].tree.root)) return trace_only(tops[0].tree.order[0]);
    clear_answers(batch_);
    visit_tops(false);
  }
  void trace_others() {
    for (const TopLevel& top : query_.scene.tops)
      if (top.walked.entries == nullptr) visit_instances(top, true);
  }

 private:
  void visit_tops(bool has_answers) {
    for (const TopLevel& top : query_.scene.tops) visit_instances(top, has_answers), has_answers = true;
  }
  void visit_instances(const TopLevel& top, bool has_answers) {
    top_ = &top;
    walks_ = top.walked.entries != nullptr && query_.test == TriangleTest::exact &&
             query_.choice.counters == nullptr;
    if (walks_ && are_apart(top)) return walk_singly(top);
    if (has_answers && refers_to_leaf(top.tree.root) && query_.choice.counters == nullptr)
      return visit_few(padded(top));
    const std::size_t bytes = query_.kernels.traversal.scratch_bytes(TraversalMode::stream, batch_.size);
    Scratch scratch(Scratch::bytes_of<std::byte>(bytes) + Scratch::bytes_of<float>(batch_.size));
    VisitBatch boxes;
    boxes.rays = batch_.rays, boxes.size = batch_.size;
    boxes.scratch = scratch.take<std::byte>(bytes);
    if (has_answers) boxes.tmax = rest_of_rays(scratch.take<float>(batch_.size));
    boxes.visit = leaf, boxes.context = this;
    boxes.counters = query_.choice.counters;
    query_.queries().visit(padded(top), boxes);
  }
  // Whether rays meet little together in instances: a batch is not slower than a call for each ray.
  bool are_apart(const TopLevel& top) const {
    const TraversalChoice& choice = query_.choice;
    if (choice.mode != TraversalMode::automatic) return choice.mode == TraversalMode::single;
    if (top.overlaps) return true;
    if (choice.hint != BatchHint::none) return choice.hint == BatchHint::incoherent;
    const std::uint64_t from = batch_.hits != nullptr ? top.closest_from : top.occluded_from;
    return batch_.size < from && !are_coherent(std::span(batch_.rays, batch_.size), top.tree.bounds);
  }
  void walk_singly(const TopLevel& top) const {
    for (std::size_t i = 0; i < batch_.size; ++i) walk_ray(top.walked, i);
  }
  // One ray through instances, by the kernel of single rays.
  void walk_ray(const InstancesView& instances, std::size_t i) const {
    if (takes_all()) return walk_ray(instances, i, nullptr);
    const SearchedInstances by_options(query_.scene, query_.kernels, rule_of(i));
    walk_ray(instances, i, &by_options);
  }
  void walk_ray(const InstancesView& instances, std::size_t i, const InstanceSearch* search) const {
    const TraversalKernels& kernels = query_.kernels.traversal;
    if (batch_.hits != nullptr)
      kernels.closest_of_instances(instances, batch_.rays[i], query_.mask, search, batch_.hits[i]);
    else if (batch_.occluded[i] == 0)
      batch_.occluded[i] = kernels.any_of_instances(instances, batch_.rays[i], query_.mask, search) ? 1 : 0;
  }
  // The only leaf of a top level: most rays of a large scene come to none of a few instances.
  void visit_few(const TreeView& tree) {
    Scratch scratch(Scratch::bytes_of<std::uint32_t>(batch_.size) + Scratch::bytes_of<float>(batch_.size));
    auto* const rays = scratch.take<std::uint32_t>(batch_.size);
    float* const rest = rest_of_rays(scratch.take<float>(batch_.size));
    const std::size_t count =
        pick(rays, rest, [&](const Ray& ray, float end) { return may_reach(tree, ray, end); });
    const LeafReference range = leaf_of(tree.root);
    if (count > 0) leaf(this, {range.block, range.size, rays, rest, count});
  }
  // Moves the numbers and ends of rays that may find something to the front; returns how many these are.
  template <class May>
  std::size_t pick(std::uint32_t* rays, float* rest, const May& may) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < batch_.size; ++i) {
      const Ray& ray = batch_.rays[i];
      if (!(rest[i] >= ray.tmin) || std::isnan(ray.tmax) || !may(ray, rest[i])) continue;
      rays[count] = static_cast<std::uint32_t>(i);
      rest[count++] = std::min(rest[i], std::numeric_limits<float>::max());
    }
    return count;
  }
  TreeView padded(const TopLevel& top) const {
    TreeView view = top.tree.view();
    if (query_.test != TriangleTest::exact)
      view.origin_share += top.rounded.share, view.padding = top.rounded.distance;
    return view;
  }
  // How far each ray goes after the answers so far.
  float* rest_of_rays(float* rest) const {
    for (std::size_t i = 0; i < batch_.size; ++i) {
      const float end = end_of_answer(i);
      rest[i] = batch_.rays[i].tmax < end ? batch_.rays[i].tmax : end;
    }
    return rest;
  }
  // The end of a ray after its answer so far.
  float end_of_answer(std::size_t i) const {
    if (batch_.hits != nullptr) return tmax_after(batch_.hits[i].t);
    return batch_.occluded[i] != 0 ? -std::numeric_limits<float>::infinity()
                                   : std::numeric_limits<float>::infinity();
  }
  bool is_seen(const Instance& instance) const { return (instance.mask & query_.mask) != 0; }

  bool skips() const { return query_.skip.first != nullptr; }
  // Whether all triangles of instances that the mask sees count.
  bool takes_all() const {
    return query_.choice.facing == Facing::any && batch_.after == nullptr && batch_.rejection == nullptr &&
           !skips();
  }
  RuleInScene rule_of(std::size_t i) const {
    RuleInScene rule{.facing = query_.choice.facing, .rejection = batch_.rejection};
    if (batch_.after != nullptr) rule.after = batch_.after + i;
    if (skips()) rule.skipped = skipped_at(query_.skip, batch_.numbers[i]);
    return rule;
  }

  // Rays in the space of an instance.
  GeometryBatch batch_of(const Ray* rays, std::size_t size, const detail::RayNumbers& numbers,
                         std::uint32_t instance) const {
    GeometryBatch batch{rays, size, nullptr, nullptr, nullptr, query_.choice.counters};
    batch.numbers = numbers, batch.instance = instance;
    return batch;
  }
  // The hits of a geometry, whose triangles may have masks.
  void trace(const Geometry& geometry, const MemberNumbers& numbers, GeometryBatch& part) const {
    part.masks = query_.scene.masks_of(numbers.members[0].geometry, query_.mask);
    if (batch_.rejection != nullptr) {
      const AskedInTree search(batch_.rejection, numbers.owners, query_.choice.facing,
                               part.skip != nullptr ? *part.skip : no_primitive, part.after);
      part.asked = &search.asked;
      return geometry.trace(query_, part);
    }
    if (part.masks.see_all()) return geometry.trace(query_, part);
    GeometryQuery query = query_;
    query.choice = query_.of_words;
    query.choice.counters = query_.choice.counters, query.choice.facing = query_.choice.facing;
    geometry.trace(query, part);
  }
  // How much memory set_options() takes.
  std::size_t bytes_of_options(std::size_t size) const {
    return (batch_.after != nullptr ? Scratch::bytes_of<Hit>(size) : 0) +
           (skips() ? Scratch::bytes_of<std::uint32_t>(size) : 0);
  }
  // Sets after which hits rays look and what they skip, in the numbers of a tree. Ray k of the part is picked[k] of the
  // batch; null: ray k.
  void set_options(GeometryBatch& part, const MemberNumbers& numbers, const std::uint32_t* picked,
                   Scratch& scratch) const {
    if (batch_.after != nullptr) {
      Hit* const after = scratch.take<Hit>(part.size);
      for (std::size_t k = 0; k < part.size; ++k)
        after[k] = numbers.after(batch_.after[picked != nullptr ? picked[k] : k]);
      part.after = after;
    }
    if (!skips()) return;
    auto* const skip = scratch.take<std::uint32_t>(part.size);
    for (std::size_t k = 0; k < part.size; ++k) {
      const std::size_t number = part.numbers[k];
      skip[k] = numbers.of(query_.skip.instance(number), query_.skip[number]);
    }
    part.skip = skip;
  }

  // All rays go to one tree, as its root is as good as a top level. Its hits are written at the end of the memory for
  // the scene's hits, and spread from the front: none is written over before it is read.
  void trace_all(const Geometry& geometry, const MemberNumbers& numbers, const Ray* rays) const {
    GeometryBatch part = batch_of(rays, batch_.size, batch_.numbers, numbers.members[0].instance);
    part.occluded = batch_.occluded;
    Scratch scratch(bytes_of_options(batch_.size));
    set_options(part, numbers, nullptr, scratch);
    auto* const places = reinterpret_cast<std::byte*>(batch_.hits);
    if (places != nullptr)
      part.hits = reinterpret_cast<Hit*>(places + batch_.size * (sizeof(SceneHit) - sizeof(Hit)));
    trace(geometry, numbers, part);
    if (places != nullptr) spread(part.hits, batch_.size, numbers.owners, batch_.hits);
  }
  void trace_only(std::uint32_t number) const {
    const Instance& instance = query_.scene.instances[number];
    if (!is_seen(instance)) return clear_answers(batch_);
    const Geometry& geometry = *query_.scene.geometries[instance.geometry];
    const OneMember only(number, instance.geometry);
    if (instance.is_identity) return trace_all(geometry, only.numbers(), batch_.rays);
    Ray one;
    Ray* mapped = &one;
    std::optional<Scratch> scratch;
    if (batch_.size > 1) mapped = scratch.emplace(Scratch::bytes_of<Ray>(batch_.size)).take<Ray>(batch_.size);
    query_.kernels.queries.map_rays(batch_.rays, nullptr, batch_.size, instance.inverse, mapped);
    trace_all(geometry, only.numbers(), mapped);
  }
  static void leaf(void* context, const VisitedLeaf& leaf) {
    auto& tracer = *static_cast<SceneTracer*>(context);
    if (tracer.walks_ && leaf.count < min_list) return tracer.walk(leaf);
    for (std::uint32_t k = leaf.first; k < leaf.first + leaf.size; ++k)
      tracer.visit(tracer.top_->tree.order[k], leaf);
  }

  // Each ray through the instances of a leaf, by the kernel of single rays.
  void walk(const VisitedLeaf& leaf) const {
    InstanceEntry entries[tree_width];
    for (std::uint32_t k = 0; k < leaf.size; ++k) {
      const std::uint32_t number = top_->tree.order[leaf.first + k];
      entries[k] = {number, query_.scene.instances[number].tree->root};
    }
    InstancesView view = top_->walked;
    view.entries = entries, view.tree.root = tree_reference({0, leaf.size});
    for (std::size_t k = 0; k < leaf.count; ++k) {
      walk_ray(view, leaf.rays[k]);
      leaf.tmax[k] = std::min(leaf.tmax[k], end_of_answer(leaf.rays[k]));
    }
  }

  void visit(std::uint32_t number, const VisitedLeaf& leaf) const {
    const Instance& instance = query_.scene.instances[number];
    if (!is_seen(instance)) return;
    const OneMember only(number, instance.geometry);
    trace_some(*query_.scene.geometries[instance.geometry], only.numbers(),
               instance.is_identity ? nullptr : instance.inverse, leaf, leaf.count >= min_packets);
  }
  // A common tree, after answers from others.
  void trace_further(const CommonTree& tree) const {
    Scratch scratch(Scratch::bytes_of<std::uint32_t>(batch_.size) + Scratch::bytes_of<float>(batch_.size));
    auto* const rays = scratch.take<std::uint32_t>(batch_.size);
    float* const rest = rest_of_rays(scratch.take<float>(batch_.size));
    const std::size_t count = pick(rays, rest, [](const Ray&, float) { return true; });
    if (count > 0) trace_some(*tree.geometry, tree.numbers(), nullptr, {0, 0, rays, rest, count}, true);
  }
  // The rays of a leaf through a tree, in its space; no inverse: that of the scene.
  void trace_some(const Geometry& geometry, const MemberNumbers& owners, const double* inverse,
                  const VisitedLeaf& leaf, bool may_be_packets) const {
    const std::uint32_t* const rays = leaf.rays;
    const std::size_t count = leaf.count;
    Scratch scratch(Scratch::bytes_of<Ray>(count) + Scratch::bytes_of<Hit>(count) + bytes_of_options(count));
    auto* const mapped = scratch.take<Ray>(count);
    if (inverse == nullptr)
      for (std::size_t k = 0; k < count; ++k) mapped[k] = batch_.rays[rays[k]];
    else
      query_.kernels.queries.map_rays(batch_.rays, rays, count, inverse, mapped);
    detail::RayNumbers numbers = batch_.numbers;
    numbers.picked = rays;
    GeometryBatch part = batch_of(mapped, count, numbers, owners.members[0].instance);
    part.may_be_packets = may_be_packets;
    if (geometry.keeps_ends())
      part.tmax = leaf.tmax;
    else
      for (std::size_t k = 0; k < count; ++k) mapped[k].tmax = leaf.tmax[k];
    if (batch_.hits != nullptr)
      part.hits = scratch.take<Hit>(count);
    else
      part.occluded = scratch.take<std::uint8_t>(count);
    set_options(part, owners, rays, scratch);
    trace(geometry, owners, part);
    if (batch_.hits != nullptr)
      keep_hits(owners.owners, leaf, part);
    else
      keep_occluded(leaf, part);
  }

  void keep_hits(const TriangleOwners& owners, const VisitedLeaf& leaf, const GeometryBatch& part) const {
    for (std::size_t k = 0; k < part.size; ++k) {
      if (!part.hits[k]) continue;
      const SceneHit hit = owners.spread(part.hits[k]);
      SceneHit& best = batch_.hits[leaf.rays[k]];
      if (!is_before(hit, best)) continue;
      best = hit;
      leaf.tmax[k] = std::min(leaf.tmax[k], tmax_after(hit.t));
    }
  }
  void keep_occluded(const VisitedLeaf& leaf, const GeometryBatch& part) const {
    for (std::size_t k = 0; k < part.size; ++k) {
      if (part.occluded[k] == 0) continue;
      batch_.occluded[leaf.rays[k]] = 1;
      leaf.tmax[k] = -std::numeric_limits<float>::infinity();
    }
  }

  const SceneQuery& query_;
  const SceneBatch& batch_;
  const TopLevel* top_ = nullptr;  // that is visited
  bool walks_ = false;             // whether rays may go through it one by one, by kernels
};

}  // namespace

void trace_scene(const SceneQuery& query, const SceneBatch& batch) {
  SceneTracer(query, batch).trace();
}
void trace_others(const SceneQuery& query, const SceneBatch& batch) {
  SceneTracer(query, batch).trace_others();
}

}  // namespace raylanes
