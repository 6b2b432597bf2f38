// Rays in trees of doubles: how RayQueries<BvhD> answers.
#include "../../dispatch/checked.hpp"
#include "../../dispatch/quiet_floats.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../queries/answers/ray_answers.hpp"
#include "bvh_d_arrays.hpp"

namespace raylanes {
namespace {

// A tree's kernels of calls with one ray, by options.
class KernelsOfDoubles {
 public:
  // `tree`: null if there are none to be used.
  KernelsOfDoubles(const DoubleTreeView* tree, const TraceOptionsD& options)
      : tree_(tree), options_(options) {
    if (tree != nullptr) kernels_ = &kernels_of(checked_path(options.path)).doubles;
  }
  explicit operator bool() const { return tree_ != nullptr; }
  std::size_t batch_size() const { return batch_size_of(tree_->tree); }
  template <class Answer>
  bool takes(const FewRays<RayD, Answer>&, bool) const {
    return true;
  }
  HitD closest(const RayD& ray, std::size_t i) const {
    return kernels_->closest_of_ray(*tree_, ray, options_.facing, skipped_of(options_, i));
  }
  bool any(const RayD& ray, std::size_t i) const {
    return kernels_->any_of_ray(*tree_, ray, options_.facing, skipped_of(options_, i));
  }

 private:
  const DoubleTreeView* tree_;
  const TraceOptionsD& options_;
  const DoubleRayKernels* kernels_ = nullptr;
};

}  // namespace

template <>
class RayDoor<BvhD> {
 public:
  static constexpr const char* name = "trace";

  explicit RayDoor(const BvhD& tree) : tree_(TreeAccess::arrays(tree)) {}

  HitD closest(const RayD& ray) const {
    return is_quick() ? in_use().closest_of_ray(tree_->ready, ray, Facing::any, no_primitive)
                      : closest_by(ray, {});
  }
  bool any(const RayD& ray) const {
    return is_quick() ? in_use().any_of_ray(tree_->ready, ray, Facing::any, no_primitive) : any_by(ray, {});
  }
  [[gnu::always_inline]] KernelsOfDoubles kernels(const TraceOptionsD& options, std::size_t rays,
                                                  bool are_default = false) const {
    const bool are_usual =
        is_quick() && (are_default || (options.threads >= 0 &&
                                       static_cast<std::size_t>(options.facing) < facing_names.size() &&
                                       options.skip.count == (options.skip.first != nullptr ? rays : 0) &&
                                       options.after.first == nullptr));
    if (!are_usual) return {nullptr, options};
    const LastingView<DoubleTreeView>& all = tree_->ready;
    return {options.masks.empty() ? &all : &masked_for_call(all, masks_of(options)), options};
  }
  HitD closest_by(const RayD& ray, const TraceOptionsD& options) const {
    HitD hit;
    DoubleBatch batch;
    batch.hits = &hit;
    HitD after;
    require_after(name, options.after, 1);
    if (options.after.first != nullptr) after = options.after[0], batch.after = &after;
    trace_one(ray, options, batch, &DoubleRayKernels::closest);
    return hit;
  }
  bool any_by(const RayD& ray, const TraceOptionsD& options) const {
    std::uint8_t occluded = 0;
    DoubleBatch batch;
    batch.occluded = &occluded;
    trace_one(ray, options, batch, &DoubleRayKernels::any);
    return occluded != 0;
  }
  void trace(const RaySourceOf<double>& rays, const HitViewD& hits, const TraceOptionsD& options) const {
    trace_hits(view_of(tree_), rays, hits, options);
  }
  void trace(const RaySourceOf<double>& rays, std::span<std::uint8_t> occluded,
             const TraceOptionsD& options) const {
    trace_occluded(view_of(tree_), rays, occluded, options);
  }

  static void require_order(const TraceOptionsD&) {}
  TreeLists<double, DoubleTreeView> lists(const TraceOptionsD&) const { return {view_of(tree_)}; }
  using KeptOfTree = KeptCalls<DoubleTreeView, double>;
  KeptOfTree kept_at_once() const {
    if (!is_quick()) return {};
    return {&in_use().kept, &tree_->ready};
  }
  HitD closest_kept(const RayD& ray, const detail::Rejection<HitD>& rejection,
                    const TraceOptionsD& options) const {
    return asking<HitD>(rejection, options, [&](const KeptOfTree& kept, const AskedOf<double>& asked) {
      return kept.closest(ray, asked);
    });
  }
  bool any_kept(const RayD& ray, const detail::Rejection<HitD>& rejection,
                const TraceOptionsD& options) const {
    return asking<bool>(rejection, options, [&](const KeptOfTree& kept, const AskedOf<double>& asked) {
      return kept.any(ray, asked);
    });
  }

  detail::KernelsOfCalls<BvhD> kernels_of_calls(const TraceOptionsD& options) const {
    const DoubleRayKernels& kernels = checked_kernels(options);
    if (!this->kernels(options, 1)) return {};
    return with_masks(detail::KernelsOfCalls<BvhD>{&tree_->ready, nullptr, nullptr, kernels.closest_of_ray,
                                                   kernels.any_of_ray},
                      options);
  }

 private:
  // Whether a call with one ray may go straight to the kernel: there is a tree, and nothing traps.
  bool is_quick() const { return tree_ != nullptr && !QuietFloats::are_wanted(); }
  static const DoubleRayKernels& in_use() { return kernels_of(path_in_use()).doubles; }
  // Without masks there is no copy of the tree, whose vectors would wait for its stores.
  template <class Answer, class Call>
  Answer asking(const detail::Rejection<HitD>& rejection, const TraceOptionsD& options,
              const Call& call) const {
    const auto* const row = &checked_kernels(options).kept;
    const KeptCall<double> kept(rejection, options);
    const QuietFloats quiet;
    if (tree_ != nullptr && options.masks.empty()) return call(KeptOfTree{row, &tree_->ready}, kept.asked);
    const DoubleTreeView tree = masked(view_of(tree_), options);
    return call(KeptOfTree{row, &tree}, kept.asked);
  }
  void trace_one(const RayD& ray, const TraceOptionsD& options, DoubleBatch& batch,
                 decltype(DoubleRayKernels::any) DoubleRayKernels::*row) const {
    const DoubleRayKernels& kernels = checked_kernels(options);
    const QuietFloats quiet;
    const std::uint32_t skipped = skip_of_one(name, options);
    batch.rays = &ray, batch.size = 1, batch.facing = options.facing;
    if (skipped != no_primitive) batch.skip = &skipped;
    (kernels.*row)(masked(view_of(tree_), options), batch);
  }

  const BvhDArrays* tree_;  // null: the empty tree
};
template class RayQueries<BvhD>;

RayCalls<BvhD> BvhD::calls(const TraceOptionsD& options) const& {
  RayCalls<BvhD> calls(*this, options);
  checked_kernels(options);
  skip_of_one("trace", options), require_after("trace", options.after, 1);
  calls.options_.path = &checked_path(options.path);
  calls.kernels_ = RayDoor<BvhD>(*this).kernels_of_calls(calls.options_);
  return calls;
}

}  // namespace raylanes
