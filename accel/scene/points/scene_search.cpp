#include "scene_search.hpp"

#include "../../../dispatch/bits.hpp"
#include "../../queries/traced_tree.hpp"

namespace raylanes {
namespace {

// The error of a distance to a triangle, as a share of the largest coordinates of the point and of what its corners are
// summed from: 11·2^-53 of the distance to the farthest corner, which is √3 of both at most, and 2^-51·√3 for corners.
constexpr double share_of_errors = 0x1p-47;
// For the roundings of sums of squares.
constexpr double above_roundings = 1.0 + 0x1p-40;

// The columns of a transform.
struct Columns {
  double square[3];  // of their lengths
  double least;      // the squared length of A·d is at least `least` times the sum of square·d²

  explicit Columns(const Transform& transform) {
    double a[3][3], cosine[3] = {};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) a[j][i] = static_cast<double>(transform.row[i][j]);
    const auto product = [&](std::size_t j, std::size_t k) {
      return (a[j][0] * a[k][0] + a[j][1] * a[k][1]) + a[j][2] * a[k][2];
    };
    for (std::size_t j = 0; j < 3; ++j) square[j] = product(j, j);
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t y = (j + 1) % 3, z = (j + 2) % 3;
      cosine[j] = product(y, z) / (std::sqrt(square[y]) * std::sqrt(square[z]));
    }
    least = least_eigenvalue(cosine[0], cosine[1], cosine[2]);
  }

 private:
  // A bound from below for the matrix with ones on its diagonal and these numbers beside it: by the circles of
  // Gershgorin, which are small for columns that are nearly orthogonal; or by the product of its eigenvalues, whose sum
  // is 3, so that the product of two is at most 9/4. 0 if rounding decides.
  static double least_eigenvalue(double x, double y, double z) {
    const double ax = std::abs(x), ay = std::abs(y), az = std::abs(z),
                 circles = 1.0 - std::max({ax + ay, ay + az, az + ax}),
                 product = 1.0 + 2.0 * x * y * z - (x * x + y * y + z * z);
    return std::max(0.0, std::max(circles, product * (4.0 / 9.0)) - 0x1p-44);
  }
};

double largest_of(const Box& box) {
  double largest = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::abs(double{box.lo[axis]}), std::abs(double{box.hi[axis]})});
  return largest;
}

// The largest sum of sizes that a coordinate of a moved corner is computed from.
double reach_of(const Transform& transform, const Box& part) {
  const double most = largest_of(part);
  double reach = 0.0;
  for (const float(&row)[4] : transform.row)
    reach = std::max(reach,
                     (std::abs(double{row[0]}) + std::abs(double{row[1]}) + std::abs(double{row[2]})) * most +
                         std::abs(double{row[3]}));
  return reach;
}

bool moved_corners(const LeafBlock<9>& block, std::size_t lane, const Transform& transform,
                   PlacedCorners& corners) {
  float given[9];
  for (std::size_t k = 0; k < 9; ++k) given[k] = block.number[k][lane];
  if (has_equal_corners(given, given + 3, given + 6)) return false;  // after a refit
  for (std::size_t k = 0; k < 3; ++k) {
    const Double3 corner = moved_to_scene(transform, {given[3 * k], given[3 * k + 1], given[3 * k + 2]});
    std::copy(corner.begin(), corner.end(), corners + 3 * k);
  }
  return true;
}

}  // namespace

void require_triangles_seen(const char* call, const SceneParts& scene, std::uint32_t mask) {
  require_current(scene.is_current);
  if (!scene.has_others()) return;
  for (const TopLevel& top : scene.tops) {
    if (top.walked.entries != nullptr) continue;
    for (const std::uint32_t i : top.tree.order) {
      const Instance& instance = scene.instances[i];
      if ((instance.mask & mask) != 0 && scene.geometries[instance.geometry]->triangles() == nullptr)
        throw std::invalid_argument(
            std::string(call) + ": instance " + std::to_string(i) +
            " of the scene has spheres or primitives of your own; the mask may hide it");
    }
  }
}
const TreeView* tree_of(const SceneParts& scene, const Instance& instance) {
  return instance.tree != nullptr ? instance.tree
                                  : TreeAccess::ready(*scene.geometries[instance.geometry]->triangles());
}

ClosestPoint ScenePointQuery::closest_in(const TreeView& tree, const Float3& point, double most) const {
  ClosestPoint closest;
  if (counters == nullptr) {
    kernels.closest_of_point(tree, point, most, closest);
    return closest;
  }
  PointBatch batch;
  batch.points = reinterpret_cast<const std::byte*>(point.data()), batch.end = 1, batch.closest = &closest;
  batch.max_distance = most, batch.counters = counters;
  kernels.counted(tree, batch);
  return closest;
}
double SceneSearch::Tree::distance(const Box& box) const {
  double square = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double off = std::max(
        std::max(double{box.lo[axis]} - at[axis], at[axis] - double{box.hi[axis]}) - error[axis], 0.0);
    square += weight[axis] * (off * off);
  }
  return square;
}
// Without calls and branches, so that compilers make vectors of it.
void SceneSearch::Tree::distances(const Planes& lo, const Planes& hi, double (&squares)[tree_width]) const {
  for (double& square : squares) square = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double from = at[axis], by = error[axis], of_axis = weight[axis];
    for (std::size_t child = 0; child < tree_width; ++child) {
      const double below = static_cast<double>(lo[axis][child]) - from,
                   above = from - static_cast<double>(hi[axis][child]),
                   off = (below > above ? below : above) - by, least = off > 0.0 ? off : 0.0;
      squares[child] += of_axis * (least * least);
    }
  }
}

void SceneSearch::find(const Float3& point, SceneClosestPoint& closest) {
  if (!is_finite(point) || !(query_.max_distance >= 0.0)) return;
  given_ = point, largest_ = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    point_[axis] = double{point[axis]}, largest_ = std::max(largest_, std::abs(point_[axis]));
  best_ = closest;
  if (!best_) best_.distance_squared = query_.max_distance * query_.max_distance;
  limit_ = best_.distance_squared * above_roundings;
  trees_.clear(), waiting_.clear();
  for (const TopLevel& top : query_.scene.tops) enter_top(top);
  while (!waiting_.empty() && may_be_nearer(waiting_.front().square)) search(nearest_waiting());
  if (best_) closest = best_;
}

// The boxes of instances have room for far more than the roundings of corners.
void SceneSearch::enter_top(const TopLevel& top) {
  Tree tree{top.tree.nodes.data(), nullptr, top.tree.order.data(), nullptr, 0, {}, {}, {}};
  const double error = share_of_errors * (largest_ + largest_of(top.tree.bounds));
  for (std::size_t axis = 0; axis < 3; ++axis)
    tree.at[axis] = point_[axis], tree.error[axis] = error, tree.weight[axis] = 1.0;
  add_tree(tree, top.tree.root, tree.distance(top.tree.bounds));
}

// With A the matrix of the transform, the distance of a moved point A·x + b to the point A·q + b is |A·(x − q)|. The
// point in the space of the instance, q, is computed by the inverse, which is wrong by a share. A distance that is too
// large by an error is less than one whose parts along the axes are too large by that error.
void SceneSearch::enter(std::uint32_t number, double square) {
  const Instance& instance = query_.scene.instances[number];
  if ((instance.mask & query_.mask) == 0) return;
  const TreeView* const view = tree_of(query_.scene, instance);
  if (view == nullptr || view->root == empty_reference) return;
  if (instance.is_identity) return search_as_it_stands(instance, number, *view);
  Tree tree{view->nodes, view->blocks, nullptr, &instance, number, {}, {}, {}};
  const Columns columns(instance.transform);
  const double error = share_of_errors * (largest_ + reach_of(instance.transform, view->bounds)),
               wrong = 2.0 * instance.doubt + 0x1p-49;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double* const row = instance.inverse + axis;
    double size = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      size += std::abs(row[3 * k]) * (std::abs(point_[k]) + std::abs(double{instance.transform.row[k][3]}));
    tree.at[axis] = ((row[0] * point_[0] + row[3] * point_[1]) + row[6] * point_[2]) + row[9];
    tree.weight[axis] = columns.least * columns.square[axis];
    tree.error[axis] = tree.weight[axis] > 0.0 ? wrong * size + error / std::sqrt(tree.weight[axis]) : 0.0;
  }
  add_tree(tree, view->root, std::max(square, tree.distance(view->bounds)));
}

void SceneSearch::add_tree(const Tree& tree, TreeReference root, double square) {
  if (root == empty_reference) return;
  trees_.push_back(tree);
  wait({square, static_cast<std::uint32_t>(trees_.size() - 1), root});
}
void SceneSearch::wait(const Waiting& entry) {
  if (!may_be_nearer(entry.square)) return;
  waiting_.push_back(entry);
  std::push_heap(waiting_.begin(), waiting_.end());
}

SceneSearch::Waiting SceneSearch::nearest_waiting() {
  std::pop_heap(waiting_.begin(), waiting_.end());
  const Waiting nearest = waiting_.back();
  waiting_.pop_back();
  return nearest;
}

// Goes on with the nearest child as long as nothing that waits is nearer.
void SceneSearch::search(Waiting next) {
  const Tree& tree = trees_[next.tree];
  while (!refers_to_leaf(next.from)) {
    const WideNode& node = tree.nodes[next.from];
    double squares[tree_width];
    tree.distances(node.lo, node.hi, squares);
    if (query_.counters != nullptr)
      ++query_.counters->nodes,
          query_.counters->box_tests += static_cast<unsigned>(std::popcount(node.occupied));
    const double least = next.square;
    next.square = std::numeric_limits<double>::infinity(), next.from = empty_reference;
    for (std::uint32_t left = node.occupied; left != 0; left &= left - 1) {
      const int child = std::countr_zero(left);
      Waiting other{std::max(squares[child], least), next.tree, node.child[child]};
      if (other.square < next.square || next.from == empty_reference) std::swap(other, next);
      if (other.from != empty_reference) wait(other);
    }
    if (next.from == empty_reference) return;
    const bool is_nearest = waiting_.empty() || next.square <= waiting_.front().square;
    if (!is_nearest || !may_be_nearer(next.square)) return wait(next);
  }
  if (query_.counters != nullptr) ++query_.counters->leaves;
  if (tree.instance != nullptr)
    search_leaf(tree, leaf_of(next.from));
  else
    search_top_leaf(next);
}
void SceneSearch::search_top_leaf(const Waiting& entry) {
  const std::uint32_t* const order = trees_[entry.tree].order;
  const LeafReference leaf = leaf_of(entry.from);
  for (std::uint32_t k = 0; k < leaf.size; ++k) enter(order[leaf.block + k], entry.square);
}

void SceneSearch::search_leaf(const Tree& tree, LeafReference leaf) {
  const auto& block = static_cast<const LeafBlock<9>*>(tree.blocks)[leaf.block];
  Planes lo, hi;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t lane = 0; lane < tree_width; ++lane) {
      const float a = block.number[axis][lane], b = block.number[3 + axis][lane],
                  c = block.number[6 + axis][lane], below = a < b ? a : b, above = a > b ? a : b;
      lo[axis][lane] = below < c ? below : c, hi[axis][lane] = above > c ? above : c;
    }
  double squares[tree_width];
  tree.distances(lo, hi, squares);
  for (std::size_t lane = 0; lane < leaf.size; ++lane)
    if (may_be_nearer(squares[lane])) search_triangle(tree, block, lane);
}
void SceneSearch::search_triangle(const Tree& tree, const LeafBlock<9>& block, std::size_t lane) {
  PlacedCorners corners;
  if (!moved_corners(block, lane, tree.instance->transform, corners)) return;
  if (query_.counters != nullptr) ++query_.counters->triangle_tests;
  const PointOfPlaced at = closest_of_placed(point_, corners);
  const std::uint32_t primitive = block.primitive[lane];
  const bool is_before = at.distance_squared < best_.distance_squared ||
                         (at.distance_squared == best_.distance_squared &&
                          std::pair(tree.number, primitive) < std::pair(best_.instance, best_.primitive));
  if (is_before)
    keep({at.distance_squared, position_in_placed(at, corners), static_cast<float>(at.u),
          static_cast<float>(at.v), primitive, tree.instance->geometry, tree.number});
}
void SceneSearch::search_as_it_stands(const Instance& instance, std::uint32_t number, const TreeView& tree) {
  const double square = best_.distance_squared,
               most = std::isfinite(square) ? number_above(std::sqrt(square)) : square;
  const ClosestPoint found = query_.closest_in(tree, given_, most);
  const SceneClosestPoint placed{found.distance_squared, found.point,       found.u, found.v,
                                 found.primitive,        instance.geometry, number};
  if (found && is_nearer(placed, best_)) keep(placed);
}
void SceneSearch::keep(const SceneClosestPoint& found) {
  best_ = found, limit_ = best_.distance_squared * above_roundings;
}

}  // namespace raylanes
