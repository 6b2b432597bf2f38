// Rays in scenes: how RayQueries<Scene> answers.

#include "../../../dispatch/quiet_floats.hpp"
#include "../../../dispatch/table/kernel_table.hpp"
#include "../../../dispatch/table/queries.hpp"
#include "../../../dispatch/table/traversal.hpp"
#include "../../queries/answers/ray_answers.hpp"
#include "../../queries/filters/found_parts.hpp"
#include "../../queries/traced_tree.hpp"
#include "../reach.hpp"
#include "kept_in_scene.hpp"
#include "searched_instances.hpp"

namespace raylanes {

SceneQuery checked_query(const SceneParts& scene, const TraceOptions& options) {
  const Traversal traversal = checked_traversal({TreeKind::bvh, nullptr, no_tree}, options);
  if (options.skip.first != nullptr && options.skip.to_instance == 0)
    throw std::invalid_argument(
        "scene: skip takes hits in scenes, which name an instance besides the primitive");
  if (!options.masks.empty())
    throw std::invalid_argument(
        "scene: masks are of the triangles of one tree; set_triangle_masks() gives them to a geometry");
  if (options.facing != Facing::any)
    for (const auto& geometry : scene.geometries) geometry->require(options);
  require_current(scene.is_current);
  SceneQuery query{{options.test, traversal.choice, kernels_of(checked_path(options.path))},
                   scene,
                   options.mask,
                   options.skip,
                   traversal.choice};
  if (scene.has_words()) {
    constexpr std::uint32_t any_word = ~0u;
    TraceOptions by_words = options;
    by_words.masks = std::span(&any_word, 1);
    query.of_words = checked_traversal({TreeKind::bvh, nullptr, no_tree}, by_words).choice;
  }
  return query;
}

namespace {

template <class Sink>
void trace_all(const SceneQuery& query, const RaySource& rays, const Sink& sink, int threads) {
  BatchPlan plan{threads, query.choice.counters};
  plan.progress = query.choice.progress, plan.fixed_parts = query.choice.fixed_parts;
  over_calls(
      plan, rays, sink, [](std::size_t) { return std::size_t{0}; },
      [&](const RayCall<typename Sink::Answer>& call) {
        SceneBatch batch{call.rays, call.size, nullptr, nullptr, call.indices};
        set_answers(batch, call.answers);
        SceneQuery counted = query;
        counted.choice.counters = call.counters;
        trace_scene(counted, batch);
      });
}

// Whether a call with one ray by the exact test may go by kernels through the instances that consist of triangles.
bool is_walked(const SceneParts& scene) {
  return scene.is_current && !scene.has_only_others() && !QuietFloats::are_wanted();
}
bool comes_to_others(const SceneParts& scene, const Ray& ray, float end) {
  return scene.has_others() && std::ranges::any_of(scene.tops, [&](const TopLevel& top) {
           return top.walked.entries == nullptr && may_reach(top.tree.view(), ray, end);
         });
}
// search: by options; null: all triangles count. With options the scene has no others.
SceneHit walked_closest(const SceneParts& scene, const Path& path, const Ray& ray, std::uint32_t mask,
                        const SearchedInstances* search = nullptr) {
  const TraversalKernels& kernels = kernels_of(path).traversal;
  SceneHit hit;
  for (const auto& tree : scene.commons) {
    if (!scene.sees(*tree, mask)) continue;
    Ray shorter;
    const Ray* rest = &ray;  // a copy that is read as vectors waits for its stores
    if (hit && tmax_after(hit.t) < ray.tmax) shorter = ray, shorter.tmax = tmax_after(hit.t), rest = &shorter;
    const SceneHit next = search != nullptr
                              ? search->closest_in_common(*tree, *rest)
                              : kernels.closest_in_scene(*tree->view, tree->numbers().owners, *rest);
    if (is_before(next, hit)) hit = next;
  }
  for (const TopLevel& top : scene.tops)
    if (top.walked.entries != nullptr) kernels.closest_of_instances(top.walked, ray, mask, search, hit);
  if (comes_to_others(scene, ray, tmax_after(hit.t)))
    trace_others(checked_query(scene, {.path = &path, .mask = mask}), {&ray, 1, &hit, nullptr});
  return hit;
}
bool walked_occluded(const SceneParts& scene, const Path& path, const CallRow* row, const Ray& ray,
                     std::uint32_t mask, const SearchedInstances* search = nullptr) {
  for (const auto& tree : scene.commons)
    if (scene.sees(*tree, mask) &&
        (search != nullptr ? search->any_in_common(*tree, ray) : row->any(*tree->view, ray)))
      return true;
  for (const TopLevel& top : scene.tops)
    if (top.walked.entries != nullptr &&
        kernels_of(path).traversal.any_of_instances(top.walked, ray, mask, search))
      return true;
  std::uint8_t is_occluded = 0;
  if (comes_to_others(scene, ray, std::numeric_limits<float>::infinity()))
    trace_others(checked_query(scene, {.path = &path, .mask = mask}), {&ray, 1, nullptr, &is_occluded});
  return is_occluded != 0;
}

// A scene's kernels of calls with one ray, by options: a tree has all that the mask sees, or they walk through
// several.
class KernelsOfScene {
 public:
  KernelsOfScene(const SceneParts& scene, const TraceOptions& options, std::size_t rays, bool are_default)
      : scene_(scene), options_(options), tree_(quick_tree(scene, options.mask)) {
    if (tree_ == nullptr && (options.test != TriangleTest::exact || !is_walked(scene))) return;
    rows_ = are_default ? RowsOfCalls{&default_row()} : rows_of_calls(options, rays);
    const bool names_no_instance = options.skip.first != nullptr && options.skip.to_instance == 0;
    const bool may_choose = !names_no_instance && (tree_ != nullptr || !scene.has_others());
    if (!may_choose || !options.masks.empty()) rows_.by_rule = nullptr;
    if (tree_ == nullptr && rows_) path_ = &checked_path(options.path);
  }
  explicit operator bool() const { return static_cast<bool>(rows_); }
  std::size_t batch_size() const { return tree_ != nullptr ? batch_size_of(*tree_->view) : min_list; }
  template <class Answer>
  bool takes(const FewRays<Ray, Answer>& few, bool may_be_alike) const {
    if (tree_ == nullptr) return !scene_.has_others();
    return !few.may_be_packet(tree_->view->bounds, rows_.by_rule == nullptr, may_be_alike);
  }
  template <class Answer>
  bool trace_alike(const FewRays<Ray, Answer>& few) const {
    if (tree_ == nullptr) return false;
    TraceBatch batch = few.batch();
    if constexpr (std::is_same_v<Answer, SceneHit>) {
      Hit hits[rays_of_columns];
      batch.hits = hits;
      if (!raylanes::trace_alike(*tree_->view, batch)) return false;
      for (std::size_t i = 0; i < batch.size; ++i) few.answers()[i] = tree_->numbers().owners.spread(hits[i]);
      return true;
    } else {
      batch.occluded = few.answers();
      return raylanes::trace_alike(*tree_->view, batch);
    }
  }
  SceneHit closest(const Ray& ray, std::size_t i) const {
    if (tree_ == nullptr)
      return walk(i, [&](const SearchedInstances* search) {
        return walked_closest(scene_, *path_, ray, options_.mask, search);
      });
    const Hit hit = rows_.closest(*tree_->view, ray, options_.facing, [&] { return skipped(i); });
    return tree_->numbers().owners.spread(hit);
  }
  bool any(const Ray& ray, std::size_t i) const {
    if (tree_ == nullptr)
      return walk(i, [&](const SearchedInstances* search) {
        return walked_occluded(scene_, *path_, rows_.usual, ray, options_.mask, search);
      });
    return rows_.any(*tree_->view, ray, options_.facing, [&] { return skipped(i); });
  }

 private:
  template <class Walk>
  std::invoke_result_t<Walk, const SearchedInstances*> walk(std::size_t i, const Walk& walk_by) const {
    if (rows_.usual != nullptr) return walk_by(nullptr);
    RuleInScene rule{.facing = options_.facing};
    if (options_.skip.first != nullptr) rule.skipped = skipped_at(options_.skip, i);
    const SearchedInstances search(scene_, kernels_of(*path_), rule);
    return walk_by(&search);
  }
  std::uint32_t skipped(std::size_t i) const {
    const PrimitiveView& skip = options_.skip;
    return skip.first != nullptr ? tree_->numbers().of(skip.instance(i), skip[i]) : no_primitive;
  }

  const SceneParts& scene_;
  const TraceOptions& options_;
  const CommonTree* tree_;
  RowsOfCalls rows_;
  const Path* path_ = nullptr;
};

// A batch of a scene whose rays see no more than a common tree, as one of that tree.
struct BatchOfCommon {
  const CommonTree& tree;
  std::vector<std::uint32_t> skips = {};  // by numbers of the tree
  RaySource rays;
  TraceOptions options;

  BatchOfCommon(const CommonTree& of, const RaySource& in_scene, const TraceOptions& by)
      : tree(of), rays(in_scene), options(by) {
    if (by.skip.first == nullptr) return;
    skips = tree.numbers().of_skips(rays, by.skip);
    rays.skip = options.skip = skips;
  }
  BatchOfCommon(const BatchOfCommon&) = delete;
  BatchOfCommon& operator=(const BatchOfCommon&) = delete;
  TracedTree traced() const { return TreeAccess::traced(*tree.geometry->triangles()); }
};

// Hits of a common tree as its scene's.
struct AsHitOfScene {
  using Seen = SceneHit;
  TriangleOwners owners;

  SceneHit operator()(const Hit& hit) const { return owners.spread(hit); }
};

// Lists of hits where a common tree has all that the mask sees.
struct ListsOfCommon {
  static constexpr bool have_streams = true;
  const CommonTree* tree;

  explicit operator bool() const { return tree != nullptr; }
  RayLists<SceneHit> operator()(const std::vector<Ray>& rays, std::span<const SkippedPrimitive> skips,
                                std::uint32_t most, const TraceOptions& by) const {
    return lists_in_common<Hit>(TreeAccess::traced(*tree->geometry->triangles()), tree->numbers(),
                                {.records = rays, .skip = skips}, options_of_lists(by, most));
  }
};

}  // namespace

const CommonTree* quick_tree(const SceneParts& scene, std::uint32_t mask) {
  if (!scene.is_current || QuietFloats::are_wanted()) return nullptr;
  if (scene.only != nullptr) [[likely]]
    return (scene.only->mask & mask) != 0 ? scene.only : nullptr;
  if (!scene.tops.empty()) return nullptr;
  const CommonTree* only = nullptr;
  for (const auto& tree : scene.commons) {
    if (!scene.sees(*tree, mask)) continue;
    if (only != nullptr) return nullptr;
    only = tree.get();
  }
  return only;
}

template <>
class RayDoor<Scene> {
 public:
  static constexpr const char* name = "scene";

  explicit RayDoor(const Scene& scene) : scene_(scene), parts_(TreeAccess::parts(scene)) {}

  SceneHit closest(const Ray& ray) const {
    if (const CommonTree* const tree = quick_tree(parts_, ~0u)) [[likely]]
      return kernels_of(path_in_use()).traversal.closest_in_scene(*tree->view, tree->numbers().owners, ray);
    return is_walked(parts_) ? walked_closest(parts_, path_in_use(), ray, ~0u) : closest_by(ray, {});
  }
  bool any(const Ray& ray) const {
    if (const CommonTree* const tree = quick_tree(parts_, ~0u)) [[likely]]
      return default_row().any(*tree->view, ray);
    return is_walked(parts_) ? walked_occluded(parts_, path_in_use(), &default_row(), ray, ~0u)
                             : any_by(ray, {});
  }
  KernelsOfScene kernels(const TraceOptions& options, std::size_t rays, bool are_default = false) const {
    return {parts_, options, rays, are_default};
  }
  // rejection: what the caller rejects; null: nothing.
  [[gnu::cold, gnu::noinline]] SceneHit closest_by(
      const Ray& ray, const TraceOptions& options,
      const detail::Rejection<SceneHit>* rejection = nullptr) const {
    require_skip(name, options.skip, 1);
    require_after_in_scene(options, 1);
    const SceneQuery query = checked_query(parts_, options);
    const QuietFloats quiet;
    const bool has_after = options.after.first != nullptr;
    const SceneHit last = has_after ? hit_of_after(options.after, 0) : SceneHit();
    SceneHit hit;
    trace_scene(query, {&ray, 1, &hit, nullptr, {}, has_after ? &last : nullptr, rejection});
    return hit;
  }
  [[gnu::cold, gnu::noinline]] bool any_by(const Ray& ray, const TraceOptions& options,
                                           const detail::Rejection<SceneHit>* rejection = nullptr) const {
    require_skip(name, options.skip, 1);
    const SceneQuery query = checked_query(parts_, options);
    const QuietFloats quiet;
    std::uint8_t is_occluded = 0;
    trace_scene(query, {&ray, 1, nullptr, &is_occluded, {}, nullptr, rejection});
    return is_occluded != 0;
  }
  void trace(RaySource rays, const SceneHitView& hits, const TraceOptions& options) const {
    rays.skip = {};  // scenes read that of the options
    const CheckedCall call(name, rays, hits, options);
    require_after_in_scene(options, rays.size());
    const SceneQuery query = checked_query(parts_, call.options);
    if (options.after.first != nullptr) return trace_after(query, call.rays, hits, call.options);
    trace_all(query, call.rays, HitSink<SceneHit>{hits}, options.threads);
  }
  void trace(RaySource rays, std::span<std::uint8_t> occluded, const TraceOptions& options) const {
    rays.skip = {};
    const CheckedCall call(name, rays, occluded, options);
    SceneQuery query = checked_query(parts_, call.options);
    query.choice.facing = rays.sides(options.facing);
    trace_all(query, call.rays, SpanSink<std::uint8_t>{occluded}, options.threads);
  }

  // False if rays see more than one tree: these have no common parts.
  bool find_parts(const RaySource& rays, std::span<TreeReference> parts, const TraceOptions& options) const {
    checked_query(parts_, options);
    const CommonTree* const tree = quick_tree(parts_, options.mask);
    if (tree == nullptr) return false;
    const BatchOfCommon batch(*tree, rays, options);
    raylanes::find_parts(batch.traced(), batch.rays, parts, batch.options);
    return true;
  }
  void hits_in_parts(const RaySource& rays, std::span<const TreeReference> parts,
                     std::span<const std::size_t> some, std::span<SceneHit> hits,
                     const TraceOptions& options) const {
    const BatchOfCommon batch(*quick_tree(parts_, options.mask), rays, options);
    std::vector<Hit> in_tree(hits.size());
    raylanes::hits_in_parts(batch.traced(), batch.rays, parts, some, in_tree, batch.options);
    const MemberNumbers numbers = batch.tree.numbers();
    std::ranges::transform(in_tree, hits.begin(), [&](const Hit& hit) { return numbers.owners.spread(hit); });
  }

  // False if rays see more than a common tree.
  template <class Sink>
  bool keep(const RaySource& rays, const Sink& sink, const detail::BatchRejection<SceneHit>& rejected,
            const TraceOptions& by) const {
    checked_query(parts_, by);
    const CommonTree* const tree = quick_tree(parts_, by.mask);
    const bool names_instance = by.skip.first == nullptr || by.skip.to_instance != 0;
    if (tree == nullptr || !names_instance || by.after.first != nullptr) return false;
    const BatchOfCommon batch(*tree, rays, by);
    return keep_in_tree(batch.traced(), batch.rays, sink, rejected, batch.options,
                        AsHitOfScene{tree->numbers().owners});
  }
  static void require_order(const TraceOptions& options) { require_exact_in_scene(options); }
  ListsOfCommon lists(const TraceOptions& options) const { return {quick_tree(parts_, options.mask)}; }
  SceneHit closest_kept(const Ray& ray, const detail::Rejection<SceneHit>& rejection,
                        const TraceOptions& options) const {
    require_exact_in_scene(options);
    if (const KeptInCommon call(parts_, rejection, options); call.tree != nullptr)
      return call.owners().spread(call.row().closest(*call.tree->view, ray, call.asked));
    if (options.counters == nullptr) return closest_by(ray, options, &rejection);
    return first_kept(rejection, options,
                      [&](const TraceOptions& next) { return scene_.closest(ray, next); });
  }
  bool any_kept(const Ray& ray, const detail::Rejection<SceneHit>& rejection,
                const TraceOptions& options) const {
    require_exact_in_scene(options);
    if (const KeptInCommon call(parts_, rejection, options); call.tree != nullptr)
      return call.row().any(*call.tree->view, ray, call.asked);
    if (options.counters == nullptr) return any_by(ray, options, &rejection);
    return static_cast<bool>(closest_kept(ray, rejection, options));
  }

 private:
  const Scene& scene_;
  const SceneParts& parts_;
};
template class RayQueries<Scene>;

}  // namespace raylanes
