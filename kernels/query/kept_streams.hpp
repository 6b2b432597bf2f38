// Batches of rays whose callers are asked about hits, by streams: each leaf asks about the hits of its rays, as a list,
// and the walk goes on with what is kept.
#pragma once

#include "gathering_leaves.hpp"
#include "hit_after.hpp"

namespace raylanes {
namespace {

// As StreamLeaves: nearest hits, or any.
class KeptLeaves : public GatheringLeaves<KeptLeaves, ExactOfAsked, NoCounters> {
  using Base = GatheringLeaves<KeptLeaves, ExactOfAsked, NoCounters>;
  using Query = KeptHit<float, false, HitRule, RestOfSegment<float>, KnownHits>;
  friend Base;

 public:
  KeptLeaves(const TreeView& tree, const KeptBatch& batch)
      : Base({.only_decides = batch.occluded != nullptr}, tree, batch), batch_(batch) {}

  void begin() {
    for (std::uint32_t i = 0; i < rays_.size; ++i) rays_.t_lo(i) = rays_.rows[i].tmax, rays_.hits[i] = Hit();
  }
  void store_results() {
    for (std::uint32_t i = 0; i < rays_.size; ++i) store(rays_.number[i], rays_.hits[i]);
  }
  void trace_single(std::size_t number) {
    const AskedRayOf one(batch_, static_cast<std::uint32_t>(number));
    store(number, closest_kept(tree_, batch_.rays[number], one.asked));
  }
  [[gnu::noinline]] void trace_singly(TreeReference from, const ListEntry* list, std::uint32_t size) {
    TreeView below = tree_;
    below.root = from;
    for (std::uint32_t k = 0; k < size; ++k) go_alone(below, index_of(list[k]));
  }
  [[gnu::noinline, gnu::flatten]] void visit_leaf(TreeReference leaf, const ListEntry* list,
                                                  std::uint32_t size) {
    gather(leaf, list, size);
    if (found_.size > 0) ask();
  }

 private:
  static constexpr std::size_t room = hits_of_list;
  // Nothing enters a box before −infinity.
  static constexpr float ended = -std::numeric_limits<float>::infinity();

  // A ray whose caller is asked about one hit at a time.
  struct AskedRayOf {
    const KeptBatch& batch;
    std::uint32_t number;
    AskedOf<float> asked;

    AskedRayOf(const KeptBatch& of, std::uint32_t i) : batch(of), number(i) {
      asked = {rejects, this, batch.facing, skipped_by(batch, i), nullptr, batch.occluded != nullptr};
    }
    AskedRayOf(const AskedRayOf&) = delete;
    AskedRayOf& operator=(const AskedRayOf&) = delete;
    static bool rejects(void* self, const Hit& hit) {
      const auto& of = *static_cast<const AskedRayOf*>(self);
      std::uint8_t is_rejected = 0;
      of.batch.ask(of.batch.function, &of.number, &hit, &is_rejected, 1);
      return is_rejected != 0;
    }
  };

  bool only_decides() const { return batch_.occluded != nullptr; }
  void store(std::size_t number, const Hit& hit) {
    if (only_decides())
      batch_.occluded[number] = hit ? 1 : 0;
    else
      batch_.hits[number] = hit;
  }
  void keep(std::uint32_t i, const Hit& hit) {
    rays_.hits[i] = hit;
    if (hit) rays_.rows[i].tmax = only_decides() ? ended : hit.t;
  }
  // Traces the rest of a ray from the root of a tree on. A hit whose t rounds to that of the best one may be better.
  void go_alone(const TreeView& tree, std::uint32_t i) {
    if (rays_.rows[i].tmax == ended) return;
    const AskedRayOf one(batch_, rays_.number[i]);
    Ray rest = batch_.rays[rays_.number[i]];
    const float end = float_above(rays_.rows[i].tmax);
    rest.tmax = end < rest.tmax ? end : rest.tmax;
    const Hit hit = closest_kept(tree, rest, one.asked);
    if (is_better(hit.t, hit.primitive, rays_.hits[i])) keep(i, hit);
  }

  bool make_room() {
    if (room - found_.size < std::size_t{tree_width + 1} * stream_lanes) ask();
    return true;
  }
  // A hit is certain up to the end of the ray's own segment, as its t will be known.
  static SegmentToHit<StreamFloats> segment(const StreamFloats (&packed)[row_floats],
                                            const StreamFloats (&ends)[4]) {
    return {{ends[2], ends[3]}, packed[free_column]};
  }
  static StreamBits names(const StreamFloats (&)[row_floats], const ListEntry* list) {
    return StreamBits::load(list) & StreamBits(index_mask);
  }
  void put(FloatMask<stream_lanes> lanes, StreamBits rays, StreamBits against, std::uint32_t leaf_triangle,
           std::uint32_t primitive) {
    found_.append(lanes, rays, against, leaf_triangle, primitive);
  }
  // Decides them one by one, as single rays do. A ray that comes to a triangle beside it goes on alone.
  [[gnu::noinline]] void put_undecided(std::uint32_t undecided, const ListEntry* list,
                                       std::uint32_t leaf_triangle) {
    const TreeTriangles triangles(tree_);
    for (; undecided != 0; undecided &= undecided - 1) {
      const std::uint32_t i = index_of(list[std::countr_zero(undecided)]);
      if (rays_.rows[i].tmax == ended) continue;
      const AskedRayOf one(batch_, rays_.number[i]);
      Query query(batch_.rays[rays_.number[i]], one.asked, RestOfSegment<float>(rays_.rows[i].tmax),
                  KnownHits());
      query.best = rays_.hits[i];
      if (query.sides.admitted(1u, triangles, leaf_triangle) == 0) continue;
      query.look_at(triangles, leaf_triangle, false);
      keep(i, query.best);
      if (query.beside == 0) continue;
      go_alone(tree_, i);
      rays_.rows[i].tmax = ended;
    }
  }

  // Whether a hit that was found counts, and would be the best so far.
  bool counts(std::size_t k, const Hit& hit) const {
    const std::uint32_t i = found_.ray[k], primitive = found_.of_mesh(k);
    return admits(batch_.facing, found_.side(k)) && tree_.masks.see(primitive) &&
           skipped_by(batch_, rays_.number[i]) != primitive && is_wanted(i, hit);
  }
  bool is_wanted(std::uint32_t i, const Hit& hit) const {
    return rays_.rows[i].tmax != ended && is_better(hit.t, hit.primitive, rays_.hits[i]);
  }
  // Asks about what was found, and ends rays at what is kept.
  [[gnu::noinline]] void ask() {
    const TreeTriangles triangles(tree_);
    std::size_t count = 0;
    for (std::size_t first = 0; first < found_.size; first += stream_lanes) {
      Hit hits[stream_lanes];
      for (std::size_t lane = 0; lane < stream_lanes; ++lane) {
        const bool is_one = first + lane < found_.size;
        const std::size_t k = is_one ? first + lane : first;
        numbers_.set(static_cast<int>(lane), triangles, batch_.rays[rays_.number[found_.ray[k]]],
                     is_one ? found_.leaf_triangle[k] : no_leaf_triangle);
      }
      numbers_.store(hits);
      for (std::size_t k = first; k < first + stream_lanes && k < found_.size; ++k) {
        const Hit& hit = hits[k - first];
        const std::uint32_t i = found_.ray[k];
        if (!counts(k, hit)) continue;
        if (!tree_.masks.may_reject(hit.primitive))
          keep(i, hit);
        else
          asked_[count] = i, number_[count] = rays_.number[i], hit_[count] = hit, rejected_[count++] = 0;
      }
    }
    found_.size = 0;
    if (count > 0) batch_.ask(batch_.function, number_, hit_, rejected_, count);
    for (std::size_t k = 0; k < count; ++k)
      if (rejected_[k] == 0 && is_wanted(asked_[k], hit_[k])) keep(asked_[k], hit_[k]);
  }

  const KeptBatch& batch_;
  std::uint32_t ray_[room], leaf_triangle_[room], primitive_[room];
  FoundColumns found_{ray_, leaf_triangle_, primitive_, 0, room};
  DeferredHits<stream_lanes> numbers_;
  std::uint32_t asked_[room], number_[room];  // places of rays that are asked about, and their numbers
  Hit hit_[room];
  std::uint8_t rejected_[room];
};

// As QueryKernels has it.
[[gnu::noinline]] void kept_together(const TreeView& tree, const KeptBatch& batch) {
  KeptLeaves leaves(tree, batch);
  if (tree.root != empty_reference) return Streams(leaves, batch.scratch).trace();
  for (std::size_t i = 0; i < batch.size; ++i) leaves.trace_single(i);
}

}  // namespace
}  // namespace raylanes
