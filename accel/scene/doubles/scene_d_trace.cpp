// A ray of doubles through a scene: the common trees, then other instances, nearest first.
#include "../scene_parts.hpp"
#include "scene_d_parts.hpp"

namespace raylanes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The distances at which a ray enters boxes. A quotient is off by three roundings; t of a hit by one. Boxes of nodes
// were rounded outwards to floats, by far more than what padding takes.
class SlabsD {
 public:
  SlabsD(const RayD& ray, double share) : origin_(ray.origin), first_(ray.tmin) {
    double largest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double d = ray.direction[axis], size = std::abs(d);
      largest = std::max(largest, std::abs(origin_[axis]));
      is_parallel_[axis] = d == 0;
      inverse_[axis] = size > 0x1p-1000 && size < 0x1p1000 ? 1 / d : 0;  // 0: the axis says nothing
    }
    padding_ = share * largest;
  }
  // At least as far as where the ray enters the box of a child; infinite if it does not.
  double entry(const WideNode& node, std::size_t child) const {
    double first = -infinity, last = infinity;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double lo = static_cast<double>(node.lo[axis][child]) - padding_ - origin_[axis],
                   hi = static_cast<double>(node.hi[axis][child]) + padding_ - origin_[axis];
      if (is_parallel_[axis] && (lo > margin(lo) || hi < -margin(hi))) return infinity;
      if (inverse_[axis] == 0) continue;
      const double a = lo * inverse_[axis], b = hi * inverse_[axis], before = std::min(a, b),
                   behind = std::max(a, b);
      first = std::max(first, before - margin(before)), last = std::min(last, behind + margin(behind));
    }
    return first > last || last < first_ ? infinity : first;
  }

 private:
  static double margin(double t) { return std::abs(t) * 0x1p-49 + 0x1p-1000; }

  Double3 origin_;
  double first_, padding_ = 0, inverse_[3];
  bool is_parallel_[3];
};

// Goes through the nodes with the nearest child first.
template <class Visit>
void walk(const BoundedTreeArrays& top, const RayD& ray, double end, const Visit& visit) {
  if (top.root == empty_reference) return;
  struct Waiting {
    double entry;
    TreeReference from;
  };
  const SlabsD slabs(ray, static_cast<double>(top.slack));
  Waiting stack[max_tree_depth * tree_width];
  std::size_t size = 0;
  stack[size++] = {-infinity, top.root};
  while (size > 0) {
    const Waiting next = stack[--size];
    if (!(next.entry <= end)) continue;
    if (refers_to_leaf(next.from)) {
      const LeafReference leaf = leaf_of(next.from);
      for (std::uint32_t k = leaf.block; k < leaf.block + leaf.size; ++k) end = visit(top.order[k]);
      continue;
    }
    const WideNode& node = top.nodes[next.from];
    const std::size_t before = size;
    for (std::uint32_t left = node.occupied; left != 0; left &= left - 1) {
      const auto child = static_cast<std::size_t>(std::countr_zero(left));
      const double entry = slabs.entry(node, child);
      if (!(entry <= end) || entry == infinity) continue;
      std::size_t at = size++;
      for (; at > before && stack[at - 1].entry < entry; --at) stack[at] = stack[at - 1];
      stack[at] = {entry, node.child[child]};
    }
  }
}

template <class Visit>
void each_along(const SceneDParts& scene, std::uint32_t mask, const RayD& ray, double end,
                const Visit& visit) {
  const auto look_at = [&](std::uint32_t instance) {
    if ((scene.instances[instance].mask & mask) != 0) end = visit(instance);
    return end;
  };
  for (const std::uint32_t instance : scene.apart.others)
    if (ray.tmin <= end) look_at(instance);
  walk(scene.apart.tree, ray, end, look_at);
}

// The rest of a ray that may have a hit before or at another one: exact quotients are rounded up or down.
RayD rest_of(RayD ray, const SceneHitD& best) {
  if (best && number_above(best.t) < ray.tmax) ray.tmax = number_above(best.t);
  return ray;
}

std::uint32_t number_of(const SkippedPrimitive& skipped, const MemberNumbers& numbers) {
  return skipped.primitive != no_primitive ? numbers.of(skipped.instance, skipped.primitive) : no_primitive;
}

// How a ray is searched for in the trees that it comes to: after a hit, and for hits that its caller keeps. null: after
// none, and all.
struct SearchD {
  const SceneDQuery& query;
  const SkippedPrimitive& skipped;
  const SceneHitD* after;
  const detail::Rejection<SceneHitD>* rejection;

  SceneHitD closest(const DoubleTreeView& tree, const MemberNumbers& numbers, const RayD& ray) const {
    const TriangleOwners& owners = numbers.owners;
    const std::uint32_t skipped_here = number_of(skipped, numbers);
    if (after == nullptr && rejection == nullptr)
      return in_scene(query.kernels.closest_of_ray(tree, ray, query.facing, skipped_here), owners);
    HitD last;
    if (after != nullptr) last = numbers.after(*after);
    AskedInTree ask{*this, owners};
    return in_scene(
        query.kernels.kept.closest(tree, ray, ask.of(skipped_here, after != nullptr ? &last : nullptr)),
        owners);
  }
  bool any(const DoubleTreeView& tree, const MemberNumbers& numbers, const RayD& ray) const {
    const std::uint32_t skipped_here = number_of(skipped, numbers);
    if (rejection == nullptr) return query.kernels.any_of_ray(tree, ray, query.facing, skipped_here);
    AskedInTree ask{*this, numbers.owners};
    return query.kernels.kept.any(tree, ray, ask.of(skipped_here, nullptr));
  }

 private:
  struct AskedInTree {
    const SearchD& search;
    const TriangleOwners& owners;

    AskedOf<double> of(std::uint32_t skipped_here, const HitD* last) {
      return {search.rejection != nullptr ? rejects : nullptr, this, search.query.facing, skipped_here, last};
    }
    static bool rejects(void* self, const HitD& hit) {
      const auto& [search, owners] = *static_cast<const AskedInTree*>(self);
      return search.rejection->rejects(search.rejection->function, in_scene(hit, owners));
    }
  };
};

// The tree of an instance, as a call with this mask sees its triangles.
class SeenTree {
 public:
  SeenTree(const SceneDParts& scene, const InstanceD& instance, std::uint32_t mask)
      : all_(scene.tree_of(instance)->ready) {
    if (scene.words_of(instance.geometry) != nullptr)
      some_.emplace(all_).tree.masks = scene.masks_of(instance.geometry, mask);
  }
  const DoubleTreeView& view() const { return some_ ? *some_ : all_; }

 private:
  const DoubleTreeView& all_;
  std::optional<DoubleTreeView> some_;
};

}  // namespace

SceneDQuery checked_query(const SceneDParts& scene, const TraceOptionsD& options) {
  const DoubleRayKernels& kernels = checked_kernels(options);
  if (options.skip.first != nullptr && options.skip.to_instance == 0)
    throw std::invalid_argument(
        "scene: skip takes hits in scenes, which name an instance besides the primitive");
  if (options.after.first != nullptr && options.after.to_instance == 0)
    throw std::invalid_argument(
        "scene: after takes hits in scenes, which name an instance besides the primitive");
  if (!options.masks.empty())
    throw std::invalid_argument(
        "scene: masks are of the triangles of one tree; instances have masks of their own");
  require_current(scene.is_current);
  return {scene, kernels, options.mask, options.facing, options.skip};
}

SceneHitD SceneDQuery::closest(const RayD& ray, const SkippedPrimitive& skipped, const SceneHitD* after,
                               const detail::Rejection<SceneHitD>* rejection) const {
  const SearchD search{*this, skipped, after, rejection};
  if (const CommonTreeD* const only = after == nullptr ? scene.only(mask) : nullptr)
    return search.closest(only->arrays().ready, only->numbers(), ray);
  SceneHitD best;
  const auto look_in = [&](const DoubleTreeView& tree, const MemberNumbers& numbers, const RayD& mapped) {
    const SceneHitD hit = search.closest(tree, numbers, mapped);
    if (is_before(hit, best)) best = hit;
  };
  for (const auto& tree : scene.commons)
    if ((tree->mask & mask) != 0) look_in(tree->arrays().ready, tree->numbers(), rest_of(ray, best));
  each_along(scene, mask, ray, rest_of(ray, best).tmax, [&](std::uint32_t number) {
    const InstanceD& instance = scene.instances[number];
    const RayD rest = rest_of(ray, best);
    look_in(SeenTree(scene, instance, mask).view(), OneMember(number, instance.geometry).numbers(),
            in_part(instance, rest));
    return rest_of(ray, best).tmax;
  });
  return best;
}
bool SceneDQuery::any(const RayD& ray, const SkippedPrimitive& skipped,
                      const detail::Rejection<SceneHitD>* rejection) const {
  const SearchD search{*this, skipped, nullptr, rejection};
  bool is_hit = false;
  const auto look_in = [&](const DoubleTreeView& tree, const MemberNumbers& numbers, const RayD& mapped) {
    is_hit = is_hit || search.any(tree, numbers, mapped);
    return is_hit ? -infinity : ray.tmax;
  };
  for (const auto& tree : scene.commons)
    if (!is_hit && (tree->mask & mask) != 0) look_in(tree->arrays().ready, tree->numbers(), ray);
  if (is_hit) return true;
  each_along(scene, mask, ray, ray.tmax, [&](std::uint32_t number) {
    const InstanceD& instance = scene.instances[number];
    return look_in(SeenTree(scene, instance, mask).view(), OneMember(number, instance.geometry).numbers(),
                   in_part(instance, ray));
  });
  return is_hit;
}

void each_instance_along(const SceneDParts& scene, std::uint32_t mask, const RayD& ray,
                         const InstanceVisitD& visit) {
  each_along(scene, mask, ray, ray.tmax, visit);
}

}  // namespace raylanes
