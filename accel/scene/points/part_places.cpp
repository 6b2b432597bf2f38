#include "part_places.hpp"

#include <numeric>

#include "../../../dispatch/checked.hpp"
#include "../../batch/batch.hpp"
#include "scene_search.hpp"

namespace raylanes {
namespace {

// Points that are located together, and of these in one instance; by the rule winding each instance has all points.
constexpr std::size_t most_at_once = std::size_t{1} << 17, most_in_task = 4096,
                      most_pairs = std::size_t{1} << 22;

// Calls visit(index in the order) for the leaves of a tree whose boxes hold a point, or nearly do: within a share of
// its largest coordinate.
template <class T, class Visit>
void each_box_around(const BoundedTreeArrays& tree, const PointOf<T>& point, const Visit& visit) {
  if (tree.root == empty_reference) return;
  PointOf<T> from = point, to = point;
  if (tree.slack > 0.0f) {
    const T room = T{tree.slack} * std::max({std::abs(point[0]), std::abs(point[1]), std::abs(point[2])});
    constexpr T end = std::numeric_limits<T>::max();  // of which there are neighbours
    for (std::size_t axis = 0; axis < 3; ++axis)
      from[axis] = number_below(std::max(point[axis] - room, -end)),
      to[axis] = number_above(std::min(point[axis] + room, end));
  }
  TreeReference stack[max_tree_depth * tree_width];
  std::size_t size = 0;
  stack[size++] = tree.root;
  while (size > 0) {
    const TreeReference next = stack[--size];
    if (refers_to_leaf(next)) {
      const LeafReference leaf = leaf_of(next);
      for (std::uint32_t k = leaf.block; k < leaf.block + leaf.size; ++k) visit(k);
      continue;
    }
    const WideNode& node = tree.nodes[next];
    for (std::uint32_t left = node.occupied; left != 0; left &= left - 1) {
      const auto child = static_cast<std::size_t>(std::countr_zero(left));
      bool holds = true;
      for (std::size_t axis = 0; axis < 3; ++axis)
        holds = holds && T{node.lo[axis][child]} <= to[axis] && T{node.hi[axis][child]} >= from[axis];
      if (holds) stack[size++] = node.child[child];
    }
  }
}

// Calls visit(instance) for the instances whose boxes hold a point, or nearly do, and some others.
template <class Visit>
void each_candidate(const SceneParts& scene, std::uint32_t mask, const Float3& point, const Visit& visit) {
  for (const TopLevel& top : scene.tops)
    each_box_around<float>(top.tree, point, [&](std::uint32_t k) { visit(top.tree.order[k]); });
  for (const auto& tree : scene.commons)
    if (scene.sees(*tree, mask))
      each_box_around<float>(tree->boxes, point, [&](std::uint32_t k) {
        const Member& member = tree->members[tree->boxes.order[k]];
        if (!member.is_struck) visit(member.instance);
      });
}
template <class Visit>
void each_candidate(const SceneDParts& scene, std::uint32_t, const Double3& point, const Visit& visit) {
  for (const InstanceBoxes* const boxes : {&scene.apart, &scene.together}) {
    each_box_around<double>(boxes->tree, point, [&](std::uint32_t k) { visit(boxes->tree.order[k]); });
    std::ranges::for_each(boxes->others, visit);
  }
}

}  // namespace

template <class Parts>
PartPlaces<Parts>::PartPlaces(const char* call, const Parts& scene, const LocateOptions& options)
    : scene_(scene), options_(options), at_once_(most_at_once) {
  checked_index(call, "rule", options.rule, inside_rule_names.size());
  checked_queries<typename Parts::Number>(call, options);
  require_triangles_seen(call, scene, options.mask);
  if (options.rule == InsideRule::winding) {
    each_seen(scene, options.mask, [&](std::uint32_t instance) { seen_.push_back(instance); });
    at_once_ = std::clamp<std::size_t>(most_pairs / std::max<std::size_t>(seen_.size(), 1) / 8 * 8, 64,
                                       most_at_once);
  }
}

template <class Parts>
void PartPlaces<Parts>::look_at(const Points& points, LaneBits active, std::size_t begin, std::size_t end,
                                std::vector<Candidate>& found) const {
  for (std::size_t i = begin; i < end; ++i) {
    if (!takes_part(active, i)) continue;
    const auto point = points[i];
    if (!is_finite(point)) continue;
    const auto note = [&](std::uint32_t instance) {
      if ((scene_.instances[instance].mask & options_.mask) != 0)
        found.push_back({instance, static_cast<std::uint32_t>(i)});
    };
    if (options_.rule == InsideRule::winding) {
      std::ranges::for_each(seen_, note);
      continue;
    }
    each_candidate(scene_, options_.mask, point, note);
  }
}

// Instance by instance, and in each by points.
template <class Parts>
void PartPlaces<Parts>::sort(std::span<const std::vector<Candidate>> found) {
  std::vector<std::size_t> end(scene_.instances.size() + 1);
  for (const auto& some : found)
    for (const Candidate& candidate : some) ++end[candidate.instance + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  candidates_.resize(end.back()), locations_.resize(end.back());
  for (std::uint32_t instance = 0; instance < scene_.instances.size(); ++instance) {
    std::size_t begin = end[instance];
    if (begin < end[instance + 1]) tree_of_part(scene_, instance, options_.threads);
    for (std::size_t last; begin < end[instance + 1]; begin = last) {
      last = std::min(begin + most_in_task, end[instance + 1]);
      tasks_.push_back({instance, begin, last});
    }
  }
  for (const auto& some : found)
    for (const Candidate& candidate : some) candidates_[end[candidate.instance]++] = candidate.point;
}

template <class Parts>
void PartPlaces<Parts>::locate(const Task& task, const Points& points, TraceCounters* counters) {
  const auto& instance = scene_.instances[task.instance];
  std::vector<PointOf<typename Parts::Number>> mapped;
  mapped.reserve(task.end - task.begin);
  for (std::size_t k = task.begin; k < task.end; ++k)
    mapped.push_back(in_part(instance, points[candidates_[k]]));
  tree_of_part(scene_, task.instance, 1)
      .locate(mapped, std::span(locations_).subspan(task.begin, mapped.size()),
              {.rule = options_.rule, .path = options_.path, .counters = counters});
}

template <class Parts>
std::span<const PartPlace> PartPlaces<Parts>::find(const Points& points, LaneBits active,
                                                   const Progress* progress) {
  tasks_.clear(), places_.clear();
  std::vector<std::vector<Candidate>> found((points.count + most_in_task - 1) / most_in_task);
  in_parallel(found.size(), 1, options_.threads, [&](std::size_t begin, std::size_t end) {
    for (; begin < end; ++begin) {
      const std::size_t first = begin * most_in_task;
      look_at(points, active, first, std::min(first + most_in_task, points.count), found[begin]);
    }
  });
  sort(found);
  BatchPlan plan{options_.threads, options_.counters};
  plan.min_part = 1, plan.progress = progress;
  over_parts(plan, tasks_.size(), [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    for (; begin < end; ++begin) locate(tasks_[begin], points, counters);
  });
  for (const Task& task : tasks_)
    for (std::size_t k = task.begin; k < task.end; ++k)
      if (locations_[k] != Location::outside)
        places_.push_back({candidates_[k], task.instance, locations_[k] == Location::on});
  return places_;
}

template class PartPlaces<SceneParts>;
template class PartPlaces<SceneDParts>;

}  // namespace raylanes
