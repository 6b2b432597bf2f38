// Batches of rays whose caller is asked about hits during the search: by streams in trees of floats, else ray by ray.
#pragma once

#include "../../../dispatch/checked.hpp"
#include "../../../dispatch/table/kernel_table.hpp"
#include "../after.hpp"
#include "../traced_tree.hpp"

namespace raylanes {

// A hit of a tree as its caller sees it: as it is.
struct AsHitOfTree {
  using Seen = Hit;
  const Hit& operator()(const Hit& hit) const { return hit; }
};

// The function of a tree's kernels to ask about hits of the rays of a call.
template <class Seeing>
class AskedCall {
  using Seen = typename Seeing::Seen;

 public:
  AskedCall(const detail::BatchRejection<Seen>& rejected, const detail::RayNumbers& places,
            const Seeing& seeing)
      : rejected_(rejected), places_(places), seeing_(seeing) {}
  AskedCall(const AskedCall&) = delete;
  AskedCall& operator=(const AskedCall&) = delete;

  static void ask(void* self, const std::uint32_t* rays, const Hit* hits, std::uint8_t* rejected,
                  std::size_t count) {
    static_cast<AskedCall*>(self)->ask_about({rays, count}, hits, rejected);
  }
  static bool rejects(void* self, const Hit& hit) {
    auto& of = *static_cast<AskedCall*>(self);
    std::uint8_t is_rejected = 0;
    of.ask_about({&of.only, 1}, &hit, &is_rejected);
    return is_rejected != 0;
  }

  std::uint32_t only = 0;  // the ray that rejects() is about

 private:
  void ask_about(std::span<const std::uint32_t> rays, const Hit* hits, std::uint8_t* rejected) {
    in_batch_.clear();
    for (const std::uint32_t ray : rays) in_batch_.push_back(places_[ray]);
    const Seen* seen;
    if constexpr (std::is_same_v<Seen, Hit>) {
      seen = hits;
    } else {
      seen_.clear();
      for (std::size_t k = 0; k < rays.size(); ++k) seen_.push_back(seeing_(hits[k]));
      seen = seen_.data();
    }
    rejected_.reject(rejected_.function, in_batch_.data(), seen, rejected, rays.size());
  }

  const detail::BatchRejection<Seen>& rejected_;
  const detail::RayNumbers& places_;
  const Seeing& seeing_;
  std::vector<std::size_t> in_batch_;
  std::vector<Seen> seen_;
};

// Rays in one tree of floats. `by` is checked, and its facing is that of rays.
template <class Seeing>
class KeptInTree {
 public:
  using Seen = typename Seeing::Seen;

  KeptInTree(const TreeView& tree, const QueryKernels& kernels, const TraceOptions& by, const Seeing& seeing)
      : tree_(tree), kernels_(kernels), by_(by), seeing_(seeing) {}

  template <class Sink>
  void trace(const RaySource& rays, const Sink& sink, const detail::BatchRejection<Seen>& rejected) const {
    using Answer = typename Sink::Answer;
    constexpr bool spreads = !std::is_same_v<Answer, std::uint8_t> && !std::is_same_v<Answer, Hit>;
    BatchPlan plan{by_.threads, nullptr};
    plan.progress = by_.progress;
    const auto bytes_of_streams = [&](std::size_t n) {
      return Scratch::bytes_of<std::byte>(kernels_.ruled_stream.scratch_bytes(n));
    };
    over_calls(
        plan, rays, sink,
        [&](std::size_t n) { return bytes_of_streams(n) + (spreads ? Scratch::bytes_of<Hit>(n) : 0); },
        [&](const RayCall<Answer>& call) {
          AskedCall asked(rejected, call.indices, seeing_);
          KeptBatch batch;
          batch.rays = call.rays, batch.size = call.size, batch.scratch = call.scratch;
          batch.facing = by_.facing, batch.skip = call.skip;
          batch.ask = AskedCall<Seeing>::ask, batch.function = &asked;
          if constexpr (!spreads) {
            set_answers(batch, call.answers);
            return keep(batch, asked);
          } else {
            batch.hits =
                reinterpret_cast<Hit*>(static_cast<std::byte*>(call.scratch) + bytes_of_streams(call.size));
            keep(batch, asked);
            for (std::size_t k = 0; k < call.size; ++k) call.answers[k] = seeing_(batch.hits[k]);
          }
        });
  }

 private:
  // Fewer rays gain nothing from each other: measured.
  static constexpr std::size_t min_together = 64;

  // Streams pad boxes of trees far from zero by much.
  bool go_together(std::size_t rays) const {
    if (by_.mode != TraversalMode::automatic) return by_.mode != TraversalMode::single;
    return rays >= min_together && tree_.max_fused_size != 0.0f;
  }
  void keep(const KeptBatch& batch, AskedCall<Seeing>& asked) const {
    if (go_together(batch.size)) return kernels_.kept_together(tree_, batch);
    AskedOf<float> of_one{AskedCall<Seeing>::rejects, &asked, by_.facing};
    for (std::size_t k = 0; k < batch.size; ++k) {
      asked.only = static_cast<std::uint32_t>(k);
      if (batch.skip != nullptr) of_one.skipped = batch.skip[k];
      if (batch.hits != nullptr)
        batch.hits[k] = kernels_.kept.closest(tree_, batch.rays[k], of_one);
      else
        batch.occluded[k] = kernels_.kept.any(tree_, batch.rays[k], of_one) ? 1 : 0;
    }
  }

  const TreeView& tree_;
  const QueryKernels& kernels_;
  const TraceOptions& by_;
  const Seeing& seeing_;
};

// False if these options are for single rays.
template <class Sink, class Seeing>
bool keep_in_tree(const TracedTree& tree, const RaySource& rays, const Sink& sink,
                  const detail::BatchRejection<typename Seeing::Seen>& rejected, const TraceOptions& by,
                  const Seeing& seeing) {
  if (by.counters != nullptr || by.after.first != nullptr) return false;
  const TreeView view = checked_traversal(tree, by).tree;
  KeptInTree(view, kernels_of(checked_path(by.path)).queries.plain, by, seeing).trace(rays, sink, rejected);
  return true;
}

// Whether a hit of a ray of a batch is rejected.
template <class AnyHit>
bool rejects_hit(const detail::BatchRejection<AnyHit>& rejected, std::size_t ray, const AnyHit& hit) {
  std::uint8_t is_rejected = 0;
  rejected.reject(rejected.function, &ray, &hit, &is_rejected, 1);
  return is_rejected != 0;
}
// The rejection of hits of one ray of a batch.
template <class AnyHit>
struct RejectionOfRay {
  const detail::BatchRejection<AnyHit>& batch;
  std::size_t ray = 0;

  static bool rejects(void* self, const AnyHit& hit) {
    const auto& of = *static_cast<const RejectionOfRay*>(self);
    return rejects_hit(of.batch, of.ray, hit);
  }
  detail::Rejection<AnyHit> rejection() { return {rejects, this}; }
};

// Element i of a view alone; of a view of nothing the same.
template <class View>
View element_of(const View& view, std::size_t i) {
  if (view.first == nullptr) return view;
  return {static_cast<const std::byte*>(view.first) + i * view.stride, 1, view.stride, view.to_instance};
}
// The options of single rays of a batch, whose views are to be set.
template <class Options>
Options options_of_singles(Options of_batch) {
  of_batch.active = nullptr, of_batch.progress = nullptr, of_batch.threads = 1;
  return of_batch;
}
// The rays of a batch one by one, by a door's calls with one ray.
template <class Door, class Source, class Sink, class AnyHit, class Options>
void keep_one_by_one(const Door& door, Source rays, const Sink& sink,
                     const detail::BatchRejection<AnyHit>& rejected, const Options& by) {
  using Answer = typename Sink::Answer;
  TraceCounters* counters = nullptr;
  if constexpr (requires { by.counters; }) counters = by.counters;
  rays.skip = {};
  over_calls(
      plan_of_singles(by.threads, counters, by.progress), rays, sink,
      [](std::size_t) { return std::size_t{0}; },
      [&](const RayCall<Answer, typename Source::Ray>& call) {
        Options one = options_of_singles(by);
        if constexpr (requires { one.counters; }) one.counters = call.counters;
        RejectionOfRay<AnyHit> of_ray{rejected};
        for (std::size_t k = 0; k < call.size; ++k) {
          of_ray.ray = call.indices[k];
          one.skip = element_of(by.skip, of_ray.ray), one.after = element_of(by.after, of_ray.ray);
          if constexpr (std::is_same_v<Answer, std::uint8_t>)
            call.answers[k] = door.any_kept(call.rays[k], of_ray.rejection(), one) ? 1 : 0;
          else
            call.answers[k] = door.closest_kept(call.rays[k], of_ray.rejection(), one);
        }
      });
}

// Rays of a checked call; by.facing is that of rays.
template <class Door, class Source, class Sink, class AnyHit, class Options>
void keep_rays(const Door& door, const Source& rays, const Sink& sink,
               const detail::BatchRejection<AnyHit>& rejected, const Options& by) {
  if constexpr (requires { door.keep(rays, sink, rejected, by); })
    if (door.keep(rays, sink, rejected, by)) return;
  keep_one_by_one(door, rays, sink, rejected, by);
}

}  // namespace raylanes
