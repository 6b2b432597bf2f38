#include "scene_d_search.hpp"

#include "../../../dispatch/table/placed_triangle.hpp"

namespace raylanes {
namespace {

// Far more than the roundings of boxes and of distances, as a share of the largest coordinate; and of a distance.
constexpr double share_of_errors = 0x1p-44, above_roundings = 1.0 + 0x1p-40;
constexpr double infinity = std::numeric_limits<double>::infinity();

double largest_of(const Double3& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

bool is_nearer(const SceneClosestPointD& a, const SceneClosestPointD& b) {
  return std::tuple(a.distance_squared, a.distance, a.instance, a.primitive) <
         std::tuple(b.distance_squared, b.distance, b.instance, b.primitive);
}

// The closest point of a triangle in the scene, by numbers that are scaled to about 1, so that squares neither overflow
// nor vanish. None if it is farther away than max_distance.
SceneClosestPointD closest_of(const Double3& point, const Double3 (&corners)[3], double max_distance) {
  int power = -exponent_of_largest(point);
  for (const Double3& corner : corners) power = std::min(power, -exponent_of_largest(corner));
  double from[3];
  PlacedCorners placed;
  for (std::size_t k = 0; k < 3; ++k) {
    from[k] = times_power(point[k], power);
    for (std::size_t corner = 0; corner < 3; ++corner)
      placed[3 * corner + k] = times_power(corners[corner][k], power);
  }
  const PointOfPlaced at = closest_of_placed(from, placed);
  const double most = times_power(max_distance, power), square = most * most;
  if (at.distance_squared > square || (at.distance_squared == square && std::fma(most, most, -square) < 0.0))
    return {};
  SceneClosestPointD found;
  found.distance_squared = times_power(at.distance_squared, -2 * power);
  found.distance = times_power(std::sqrt(at.distance_squared), -power);
  found.u = at.u, found.v = at.v;
  for (std::size_t k = 0; k < 3; ++k) {
    const double* const x = placed + k;
    found.point[k] = times_power(x[0] + (at.u * (x[3] - x[0]) + at.v * (x[6] - x[0])), -power);
  }
  return found;
}

}  // namespace

SceneClosestPointD SceneSearchD::closest(const Double3& point) {
  best_ = {}, point_ = point, limit_ = infinity;
  if (!std::ranges::all_of(point, [](double x) { return std::isfinite(x); }) || !(max_distance_ >= 0.0))
    return {};
  limit_ = max_distance_ * above_roundings + share_of_errors * largest_of(point);
  for (const auto& tree : scene_.commons)
    if ((tree->mask & mask_) != 0) search_tree(tree->arrays(), tree->numbers());
  waiting_.clear();
  for (const std::uint32_t instance : scene_.apart.others) enter(instance, 0.0);
  if (scene_.apart.tree.root != empty_reference) wait({0.0, no_part, scene_.apart.tree.root});
  while (!waiting_.empty() && waiting_.front().least <= limit_) {
    std::pop_heap(waiting_.begin(), waiting_.end());
    const Waiting nearest = waiting_.back();
    waiting_.pop_back();
    search(nearest);
  }
  return best_;
}

// A tree in the space of the scene.
void SceneSearchD::search_tree(const BvhDArrays& tree, const MemberNumbers& numbers) {
  ClosestPointD found;
  kernels_.closest_of_point(tree.ready, point_, max_distance_, found);
  if (found) keep(closest_in_scene(found, numbers.owners));
}
void SceneSearchD::enter(std::uint32_t number, double least) {
  const InstanceD& instance = scene_.instances[number];
  if ((instance.mask & mask_) == 0) return;
  const BvhDArrays& tree = *scene_.tree_of(instance);
  if (instance.is_identity) return search_tree(tree, OneMember(number, instance.geometry).numbers());
  wait({least, number, tree.live_root()});
}
void SceneSearchD::wait(const Waiting& entry) {
  if (entry.from == empty_reference || !(entry.least <= limit_)) return;
  waiting_.push_back(entry);
  std::push_heap(waiting_.begin(), waiting_.end());
}

void SceneSearchD::search(const Waiting& entry) {
  const bool is_top = entry.instance == no_part;
  const InstanceD* const instance = is_top ? nullptr : &scene_.instances[entry.instance];
  const BvhDArrays* const tree = is_top ? nullptr : scene_.tree_of(*instance);
  if (refers_to_leaf(entry.from)) {
    const LeafReference leaf = leaf_of(entry.from);
    if (!is_top) return search_leaf(entry.instance, *tree, leaf);
    for (std::uint32_t k = leaf.block; k < leaf.block + leaf.size; ++k)
      enter(scene_.apart.tree.order[k], entry.least);
    return;
  }
  const WideNode& node = (is_top ? scene_.apart.tree.nodes : tree->nodes)[entry.from];
  for (std::uint32_t left = node.occupied; left != 0; left &= left - 1) {
    const auto child = static_cast<std::size_t>(std::countr_zero(left));
    BoxD box;
    if (is_top)
      for (std::size_t axis = 0; axis < 3; ++axis)
        box.lo[axis] = double{node.lo[axis][child]}, box.hi[axis] = double{node.hi[axis][child]};
    else
      box = moved(*instance, *tree, node, child);
    wait({std::max(entry.least, distance_to(box.lo, box.hi)), entry.instance, node.child[child]});
  }
}

// The box in the scene of a child, whose bounds are in the tree's frame: around its middle, by its half edges.
BoxD SceneSearchD::moved(const InstanceD& instance, const BvhDArrays& tree, const WideNode& node,
                         std::size_t child) const {
  BoxD box;
  Double3 middle, half;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lo = double{node.lo[axis][child]}, hi = double{node.hi[axis][child]};
    middle[axis] = times_power(0.5 * lo + 0.5 * hi + tree.frame.centre[axis], -tree.frame.power);
    half[axis] = times_power(0.5 * (hi - lo), -tree.frame.power);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double(&row)[4] = instance.transform.row[axis];
    double at = row[3], size = 0, sizes = std::abs(row[3]);
    for (std::size_t k = 0; k < 3; ++k) {
      at += row[k] * middle[k], size += std::abs(row[k]) * half[k];
      sizes += std::abs(row[k]) * (std::abs(middle[k]) + half[k]);
    }
    size += share_of_errors * sizes;
    box.lo[axis] = at - size, box.hi[axis] = at + size;
  }
  return box;
}
// Along the longest axis, which is less than the distance by a factor of 1.8 at most, where squares would overflow.
double SceneSearchD::distance_to(const Double3& lo, const Double3& hi) const {
  Double3 off;
  for (std::size_t axis = 0; axis < 3; ++axis)
    off[axis] = std::max({lo[axis] - point_[axis], point_[axis] - hi[axis], 0.0}) -
                share_of_errors * std::abs(point_[axis]);
  for (double& x : off) x = std::max(x, 0.0);
  const double largest = largest_of(off);
  if (!(largest > 0x1p-500 && largest < 0x1p500)) return largest;
  return std::sqrt(off[0] * off[0] + off[1] * off[1] + off[2] * off[2]) * (1.0 - 0x1p-50);
}

void SceneSearchD::search_leaf(std::uint32_t number, const BvhDArrays& tree, LeafReference leaf) {
  const InstanceD& instance = scene_.instances[number];
  const TrianglesOfHalves triangles{tree.halves.data()};
  const std::uint32_t first = TrianglesOfHalves::first_of(leaf);
  for (std::uint32_t triangle = first; triangle < first + leaf.size; ++triangle) {
    const CornersOf<double> given = corners_of(tree.view(), triangle);
    if (has_equal_corners(given.vertex[0], given.vertex[1], given.vertex[2])) continue;  // after a refit
    Double3 corners[3];
    for (std::size_t k = 0; k < 3; ++k) corners[k] = in_scene(instance, given.vertex[k]);
    SceneClosestPointD found = closest_of(point_, corners, max_distance_);
    if (!(found.distance < infinity)) continue;
    found.primitive = triangles.primitive(triangle), found.geometry = instance.geometry,
    found.instance = number;
    keep(found);
  }
}
void SceneSearchD::keep(const SceneClosestPointD& found) {
  if (best_ && !is_nearer(found, best_)) return;
  best_ = found;
  limit_ = std::min(limit_, found.distance * above_roundings + share_of_errors * largest_of(point_));
}

}  // namespace raylanes
