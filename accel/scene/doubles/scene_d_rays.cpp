// Rays in scenes of doubles: how RayQueries<SceneD> answers.
#include "../../../dispatch/quiet_floats.hpp"
#include "../../batch/in_parallel.hpp"
#include "../../queries/answers/ray_answers.hpp"
#include "scene_d_parts.hpp"

namespace raylanes {
namespace {

SceneHitD hit_of_after(const AfterViewD& after, std::size_t i) {
  const HitD hit = after[i];
  return {hit.t, hit.u, hit.v, hit.primitive, no_part, after.instance(i)};
}

// A batch in the tree that has all that its mask sees. Hits of trees are the begins of hits in scenes.
class BatchInCommon {
 public:
  BatchInCommon(const CommonTreeD& tree, const RaySourceOf<double>& rays, const TraceOptionsD& options)
      : tree_(tree), rays_(rays), options_(options) {
    const MemberNumbers numbers = tree.numbers();
    if (options.skip.first != nullptr) {
      skip_ = numbers.of_skips(rays, options.skip);
      options_.skip = rays_.skip = skip_;
    }
    if (options.after.first != nullptr) {
      after_.resize(rays.size());
      for (std::size_t i = 0; i < after_.size(); ++i)
        if (rays.takes_part(i)) after_[i] = numbers.after(hit_of_after(options.after, i));
      options_.after = after_;
    }
  }
  void closest(const SceneHitViewD& hits) const {
    static_assert(offsetof(SceneHitD, primitive) == offsetof(HitD, primitive));
    const HitViewD found(hits.first, hits.count, hits.stride);
    trace_hits(tree_.arrays().view(), rays_, found, options_);
    const TriangleOwners owners = tree_.numbers().owners;
    in_parallel(hits.count, grain_of(hits.count, options_.threads, 4, 16384), options_.threads,
                [&](std::size_t begin, std::size_t end) {
                  for (std::size_t i = begin; i < end; ++i)
                    if (rays_.takes_part(i)) hits.set(i, in_scene(found[i], owners));
                });
  }
  void occluded(std::span<std::uint8_t> occluded) const {
    trace_occluded(tree_.arrays().view(), rays_, occluded, options_);
  }

 private:
  const CommonTreeD& tree_;
  RaySourceOf<double> rays_;
  TraceOptionsD options_;
  std::vector<std::uint32_t> skip_;
  std::vector<HitD> after_;
};

// Calls with one ray, by options; false if these ask for more.
struct CallsInSceneD {
  std::optional<SceneDQuery> query;

  explicit operator bool() const { return query.has_value(); }
  static std::size_t batch_size() { return min_flying_batch; }
  template <class Answer>
  bool takes(const FewRays<RayD, Answer>&, bool) const {
    return true;
  }
  SceneHitD closest(const RayD& ray, std::size_t i) const {
    return query->closest(ray, query->skipped(i), nullptr);
  }
  bool any(const RayD& ray, std::size_t i) const { return query->any(ray, query->skipped(i)); }
};

// Lists of hits where a common tree has all that the mask sees.
struct ListsOfCommonD {
  static constexpr bool have_streams = false;
  const CommonTreeD* tree;

  explicit operator bool() const { return tree != nullptr; }
  RayLists<SceneHitD> operator()(const std::vector<RayD>& rays, std::span<const SkippedPrimitive> skips,
                                 std::uint32_t most, const TraceOptionsD& by) const {
    return lists_in_common<HitD>(tree->arrays().view(), tree->numbers(), {.records = rays, .skip = skips},
                                 options_of_lists(by, most));
  }
};

}  // namespace

template <>
class RayDoor<SceneD> {
 public:
  static constexpr const char* name = "scene";

  explicit RayDoor(const SceneD& scene) : parts_(TreeAccess::parts(scene)) {}

  SceneHitD closest(const RayD& ray) const {
    return is_quick() ? quick_query({}).closest(ray, nothing, nullptr) : closest_by(ray, {});
  }
  bool any(const RayD& ray) const { return is_quick() ? quick_query({}).any(ray, nothing) : any_by(ray, {}); }
  CallsInSceneD kernels(const TraceOptionsD& options, std::size_t rays, bool are_default = false) const {
    const bool are_usual =
        is_quick() &&
        (are_default ||
         (options.threads >= 0 && static_cast<std::size_t>(options.facing) < facing_names.size() &&
          options.skip.count == (options.skip.first != nullptr ? rays : 0) &&
          (options.skip.first == nullptr || options.skip.to_instance != 0) &&
          options.after.first == nullptr && options.after.count == 0 && options.masks.empty()));
    if (!are_usual) return {};
    return {quick_query(options)};
  }
  SceneHitD closest_by(const RayD& ray, const TraceOptionsD& options,
                       const detail::Rejection<SceneHitD>* rejection = nullptr) const {
    require_skip(name, options.skip, 1), require_after(name, options.after, 1);
    const SceneDQuery query = checked_query(parts_, options);
    const QuietFloats quiet;
    if (options.after.first == nullptr) return query.closest(ray, query.skipped(0), nullptr, rejection);
    const SceneHitD last = hit_of_after(options.after, 0);
    return query.closest(ray, query.skipped(0), &last, rejection);
  }
  bool any_by(const RayD& ray, const TraceOptionsD& options,
              const detail::Rejection<SceneHitD>* rejection = nullptr) const {
    require_skip(name, options.skip, 1);
    const SceneDQuery query = checked_query(parts_, without_after(options));
    const QuietFloats quiet;
    return query.any(ray, query.skipped(0), rejection);
  }
  void trace(RaySourceOf<double> rays, const SceneHitViewD& hits, const TraceOptionsD& given) const {
    rays.skip = {};  // scenes read that of the options
    const CheckedCall call(name, rays, hits, given);
    const TraceOptionsD& options = call.options;
    const SceneDQuery query = checked_query(parts_, options);
    if (const CommonTreeD* const tree = parts_.only(options.mask))
      return BatchInCommon(*tree, call.rays, options).closest(hits);
    trace_calls(call.rays, HitSink<SceneHitD>{hits}, options, [&](const RayD& ray, std::size_t i) {
      SceneHitD last;
      if (options.after.first != nullptr) last = hit_of_after(options.after, i);
      return query.closest(ray, query.skipped(i), options.after.first != nullptr ? &last : nullptr);
    });
  }
  void trace(RaySourceOf<double> rays, std::span<std::uint8_t> occluded, const TraceOptionsD& given) const {
    rays.skip = {};
    const CheckedCall call(name, rays, occluded, without_after(given));
    SceneDQuery query = checked_query(parts_, call.options);
    if (const CommonTreeD* const tree = parts_.only(given.mask))
      return BatchInCommon(*tree, call.rays, call.options).occluded(occluded);
    query.facing = rays.sides(given.facing);
    trace_calls(call.rays, SpanSink<std::uint8_t>{occluded}, call.options,
                [&](const RayD& ray, std::size_t i) -> std::uint8_t {
                  return query.any(ray, query.skipped(i)) ? 1 : 0;
                });
  }

  static void require_order(const TraceOptionsD&) {}
  ListsOfCommonD lists(const TraceOptionsD& options) const { return {parts_.only(options.mask)}; }
  SceneHitD closest_kept(const RayD& ray, const detail::Rejection<SceneHitD>& rejection,
                         const TraceOptionsD& options) const {
    return closest_by(ray, options, &rejection);
  }
  bool any_kept(const RayD& ray, const detail::Rejection<SceneHitD>& rejection,
                const TraceOptionsD& options) const {
    return any_by(ray, options, &rejection);
  }

 private:
  static constexpr SkippedPrimitive nothing{no_primitive, no_part};

  // Whether a call with one ray needs no checks, and nothing traps.
  bool is_quick() const { return parts_.is_current && !QuietFloats::are_wanted(); }
  SceneDQuery quick_query(const TraceOptionsD& options) const {
    return {parts_, kernels_of(checked_path(options.path)).doubles, options.mask, options.facing,
            options.skip};
  }
  // Occlusion ignores it.
  static TraceOptionsD without_after(TraceOptionsD options) {
    options.after = {};
    return options;
  }
  // answers[i] = call(rays[i], i)
  template <class Sink, class Call>
  static void trace_calls(const RaySourceOf<double>& rays, const Sink& sink, const TraceOptionsD& options,
                          const Call& call) {
    over_calls(
        plan_of_singles(options.threads, nullptr, options.progress), rays, sink,
        [](std::size_t) { return std::size_t{0}; },
        [&](const RayCall<typename Sink::Answer, RayD>& some) {
          for (std::size_t k = 0; k < some.size; ++k) some.answers[k] = call(some.rays[k], some.indices[k]);
        });
  }

  const SceneDParts& parts_;
};
template class RayQueries<SceneD>;

}  // namespace raylanes
