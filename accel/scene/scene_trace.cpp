#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>

#include "../../dispatch/table/queries.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../batch/scratch.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

// Rays to an instance spread over its part of the picture. Fewer rays than this make packets with wide frusta, so they
// are traced as streams or single rays. Measured.
constexpr std::size_t min_packets = 4096;

// Spreads the hits of one instance into hits of the scene, from the front. As words: a hit's two, the second of which
// ends with the primitive, and one that names the instance and geometry.
[[gnu::noinline]] void spread(const Hit* hits, std::size_t size, std::uint32_t geometry,
                              std::uint32_t instance, SceneHit* all) {
  static_assert(sizeof(Hit) == 16 && offsetof(Hit, primitive) == 12 && sizeof(SceneHit) == 24 &&
                offsetof(SceneHit, geometry) == 16 && offsetof(SceneHit, instance) == 20);
  using Word = std::uint64_t;
  const Word of_hit = Word{instance} << 32 | geometry, of_miss = ~Word{0};
  const auto* from = reinterpret_cast<const std::byte*>(hits);
  auto* to = reinterpret_cast<std::byte*>(all);
  for (; size > 0; --size, from += sizeof(Hit), to += sizeof(SceneHit)) {
    Word first, second;
    std::memcpy(&first, from, sizeof first), std::memcpy(&second, from + 8, sizeof second);
    const Word of_this = second >> 32 != no_primitive ? of_hit : of_miss;
    std::memcpy(to, &first, sizeof first), std::memcpy(to + 8, &second, sizeof second);
    std::memcpy(to + 16, &of_this, sizeof of_this);
  }
}

class SceneTracer {
 public:
  SceneTracer(const SceneQuery& query, const SceneBatch& batch) : query_(query), batch_(batch) {}

  void trace() {
    const std::vector<TopLevel>& tops = query_.scene.tops;
    if (tops.size() == 1 && refers_to_leaf(tops[0].tree.root)) return trace_only(tops[0].tree.order[0]);
    clear_answers(batch_);
    for (const TopLevel& top : tops) visit_instances(top, &top != tops.data());
  }

 private:
  void visit_instances(const TopLevel& top, bool has_answers) {
    const std::size_t bytes = query_.kernels.traversal.scratch_bytes(TraversalMode::stream, batch_.size);
    Scratch scratch(Scratch::bytes_of<std::byte>(bytes) + Scratch::bytes_of<float>(batch_.size));
    VisitBatch boxes;
    boxes.rays = batch_.rays, boxes.size = batch_.size;
    boxes.scratch = scratch.take<std::byte>(bytes);
    if (has_answers) boxes.tmax = rest_of_rays(scratch.take<float>(batch_.size));
    boxes.visit = leaf, boxes.context = this;
    boxes.counters = query_.choice.counters;
    top_ = &top.tree;
    query_.queries().visit(padded(top), boxes);
  }
  TreeView padded(const TopLevel& top) const {
    TreeView view = top.tree.view();
    if (query_.test != TriangleTest::exact)
      view.origin_share += top.rounded.share, view.padding = top.rounded.distance;
    return view;
  }
  // How far each ray goes after the answers so far.
  const float* rest_of_rays(float* rest) const {
    for (std::size_t i = 0; i < batch_.size; ++i) {
      const float end = batch_.hits != nullptr    ? tmax_behind(batch_.hits[i].t)
                        : batch_.occluded[i] != 0 ? -std::numeric_limits<float>::infinity()
                                                  : std::numeric_limits<float>::infinity();
      rest[i] = batch_.rays[i].tmax < end ? batch_.rays[i].tmax : end;
    }
    return rest;
  }
  bool is_seen(const Instance& instance) const { return (instance.mask & query_.mask) != 0; }

  // Rays in the space of an instance.
  GeometryBatch batch_of(std::uint32_t number, const Ray* rays, std::size_t size,
                         const detail::RayNumbers& numbers) const {
    GeometryBatch batch{rays, size, nullptr, nullptr, nullptr, query_.choice.counters};
    batch.may_be_packets = size >= min_packets;
    batch.numbers = numbers, batch.instance = number;
    return batch;
  }

  // The primitives of an instance that rays skip: each number(k) of the caller's batch.
  const std::uint32_t* skips_within(std::uint32_t instance, const detail::RayNumbers& numbers,
                                    std::size_t size, std::uint32_t* skips) const {
    for (std::size_t k = 0; k < size; ++k) {
      const std::size_t number = numbers[k];
      skips[k] = query_.skip.instance(number) == instance ? query_.skip[number] : no_primitive;
    }
    return skips;
  }
  bool skips() const { return query_.skip.first != nullptr; }

  // All rays go to the only instance: its tree's root is as good as a top level. Its hits are written at the end of the
  // memory for the scene's hits, and spread from the front: none is written over before it is read.
  void trace_only(std::uint32_t number) const {
    const Instance& instance = query_.scene.instances[number];
    if (!is_seen(instance)) return clear_answers(batch_);
    GeometryBatch part = batch_of(number, batch_.rays, batch_.size, batch_.numbers);
    part.occluded = batch_.occluded;
    std::optional<Scratch> last;
    if (batch_.after != nullptr) {
      Hit* const after = last.emplace(Scratch::bytes_of<Hit>(batch_.size)).take<Hit>(batch_.size);
      for (std::size_t k = 0; k < batch_.size; ++k) after[k] = after_within(number, batch_.after[k]);
      part.after = after;
    }
    std::optional<Scratch> skipped;
    if (skips()) {
      skipped.emplace(Scratch::bytes_of<std::uint32_t>(batch_.size));
      part.skip =
          skips_within(number, batch_.numbers, batch_.size, skipped->take<std::uint32_t>(batch_.size));
    }
    auto* const places = reinterpret_cast<std::byte*>(batch_.hits);
    if (places != nullptr)
      part.hits = reinterpret_cast<Hit*>(places + batch_.size * (sizeof(SceneHit) - sizeof(Hit)));
    Ray one;
    std::optional<Scratch> scratch;
    if (!instance.is_identity) {
      Ray* mapped = &one;
      if (batch_.size > 1)
        mapped = scratch.emplace(Scratch::bytes_of<Ray>(batch_.size)).take<Ray>(batch_.size);
      query_.kernels.queries.map_rays(batch_.rays, nullptr, batch_.size, instance.inverse, mapped);
      part.rays = mapped;
    }
    query_.scene.geometries[instance.geometry]->trace(query_, part);
    if (places != nullptr) spread(part.hits, batch_.size, instance.geometry, number, batch_.hits);
  }
  static void leaf(void* context, const VisitedLeaf& leaf) {
    auto& tracer = *static_cast<SceneTracer*>(context);
    for (std::uint32_t k = leaf.first; k < leaf.first + leaf.size; ++k)
      tracer.visit(tracer.top_->order[k], leaf);
  }

  void visit(std::uint32_t number, const VisitedLeaf& leaf) const {
    const std::uint32_t* const rays = leaf.rays;
    const std::size_t count = leaf.count;
    const Instance& instance = query_.scene.instances[number];
    if (!is_seen(instance)) return;
    const Geometry& geometry = *query_.scene.geometries[instance.geometry];
    Scratch scratch(Scratch::bytes_of<Ray>(count) +
                    (batch_.after != nullptr ? 2 : 1) * Scratch::bytes_of<Hit>(count) +
                    (skips() ? Scratch::bytes_of<std::uint32_t>(count) : 0));
    auto* const mapped = scratch.take<Ray>(count);
    if (instance.is_identity)
      for (std::size_t k = 0; k < count; ++k) mapped[k] = batch_.rays[rays[k]];
    else
      query_.kernels.queries.map_rays(batch_.rays, rays, count, instance.inverse, mapped);
    detail::RayNumbers numbers = batch_.numbers;
    numbers.picked = rays;
    GeometryBatch part = batch_of(number, mapped, count, numbers);
    if (geometry.keeps_ends())
      part.tmax = leaf.tmax;
    else
      for (std::size_t k = 0; k < count; ++k) mapped[k].tmax = leaf.tmax[k];
    if (batch_.hits != nullptr)
      part.hits = scratch.take<Hit>(count);
    else
      part.occluded = scratch.take<std::uint8_t>(count);
    if (batch_.after != nullptr) {
      Hit* const after = scratch.take<Hit>(count);
      for (std::size_t k = 0; k < count; ++k) after[k] = after_within(number, batch_.after[rays[k]]);
      part.after = after;
    }
    if (skips()) part.skip = skips_within(number, numbers, count, scratch.take<std::uint32_t>(count));
    geometry.trace(query_, part);
    if (batch_.hits != nullptr)
      keep_hits(number, leaf, part);
    else
      keep_occluded(leaf, part);
  }

  // The hit of an instance behind which its own next hit comes, in the order of t, instance, primitive.
  static Hit after_within(std::uint32_t number, const SceneHit& last) {
    constexpr std::uint32_t behind_all = no_primitive - 1;
    if (!(last.t < std::numeric_limits<float>::infinity())) return {};
    if (!last || number < last.instance) return {last.t, 0, 0, behind_all};
    if (number == last.instance) return {last.t, 0, 0, last.primitive};
    return {before(last.t), 0, 0, behind_all};
  }
  // The number before t among the values that t may have: with subnormals flushed none lies between −2^-126 and 0.
  static float before(float t) {
    using Limits = std::numeric_limits<float>;
    const volatile float subnormal = Limits::denorm_min();
    return t == 0.0f && subnormal == 0.0f ? -Limits::min() : float_below(std::max(t, Limits::lowest()));
  }

  void keep_hits(std::uint32_t number, const VisitedLeaf& leaf, const GeometryBatch& part) const {
    for (std::size_t k = 0; k < part.size; ++k) {
      const Hit& hit = part.hits[k];
      SceneHit& best = batch_.hits[leaf.rays[k]];
      if (!hit || !(hit.t < best.t || (hit.t == best.t && number < best.instance))) continue;
      best = wide(hit, number);
      leaf.tmax[k] = std::min(leaf.tmax[k], tmax_behind(hit.t));
    }
  }
  void keep_occluded(const VisitedLeaf& leaf, const GeometryBatch& part) const {
    for (std::size_t k = 0; k < part.size; ++k) {
      if (part.occluded[k] == 0) continue;
      batch_.occluded[leaf.rays[k]] = 1;
      leaf.tmax[k] = -std::numeric_limits<float>::infinity();
    }
  }
  SceneHit wide(const Hit& hit, std::uint32_t number) const {
    return {hit.t, hit.u, hit.v, hit.primitive, query_.scene.instances[number].geometry, number};
  }

  const SceneQuery& query_;
  const SceneBatch& batch_;
  const BoundedTreeArrays* top_ = nullptr;  // that is visited
};

}  // namespace

void trace_scene(const SceneQuery& query, const SceneBatch& batch) {
  SceneTracer(query, batch).trace();
}

}  // namespace raylanes
