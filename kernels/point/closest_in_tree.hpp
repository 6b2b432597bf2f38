// Points one by one through a tree: nearest box first. Floats say which triangles may be the nearest, doubles decide
// among those few, together, at the end.
#pragma once

#include "../simd/reduce.hpp"
#include "../traverse/single.hpp"
#include "box_distance.hpp"
#include "nearest_triangle.hpp"

namespace raylanes {
namespace {

struct TreeCorners {
  const LeafBlock<9>* blocks;
  float number(int k, std::uint32_t triangle) const {
    return blocks[triangle / tree_width].number[k][triangle % tree_width];
  }
  std::uint32_t primitive(std::uint32_t triangle) const {
    return blocks[triangle / tree_width].primitive[triangle % tree_width];
  }
};

// Triangles that may be the nearest: what floats say of them, and the least of what they may be at most. In the units
// of BoxDistance.
class NearTriangles : public NearestFirst {
 public:
  float tmax;  // what is farther than this is not the nearest

  // Some triangle, if any counts, has at most the distance `near_squared`.
  NearTriangles(const Float3& point, const BoxDistance<node_lanes>& boxes, double most_squared,
                double near_squared)
      : tmax(boxes.limit(near_squared < most_squared ? near_squared : most_squared)),
        point_in_units_{V(point[0]) * boxes.scale(), V(point[1]) * boxes.scale(),
                        V(point[2]) * boxes.scale()},
        scale_(boxes.scale()),
        point_(doubles_of<half_of<node_lanes>>(point)),
        nearest_(most_squared) {}
  float box_tmax() const { return tmax; }
  // The nearest child; the others wait as they come.
  static Entry descend(Entry*& top, const WideNode& node, std::uint32_t children,
                       const float (&t)[tree_width]) {
    const int first = std::countr_zero(children);
    Entry nearest{node.child[first], t[first]};
    for (children &= children - 1; children != 0; children &= children - 1) {
      const int child = std::countr_zero(children);
      const Entry other{node.child[child], t[child]};
      const bool is_nearer = other.t < nearest.t;
      *top++ = is_nearer ? nearest : other;
      nearest = is_nearer ? other : nearest;
    }
    return nearest;
  }

  // A register of a leaf's triangles from the one of that number on, `lanes` of them. One branch alone, as none of them
  // is foretold well: what a register leaves as it was is written again, and what waits is packed.
  void take(const TreeCorners& corners, const LeafBlock<9>& block, int first, std::uint32_t lanes,
            std::uint32_t triangle) {
    const auto vertex = [&](int k) {
      const auto load = [&](int i) { return V::load(&block.number[i][first]) * scale_; };
      return Vec3<V>(load(k), load(k + 1), load(k + 2));
    };
    PointOnTriangle<V> h =
        PointTriangle<V, Grade::fast>::closest(point_in_units_, vertex(0), vertex(3), vertex(6));
    V error =
        multiply_add<Grade::fast>(h.distance_squared + h.edges_squared, V(error_of_floats), V(0x1p-78f));
    V least = h.distance_squared - error, most = h.distance_squared + error;
    FloatMask<node_lanes> counts = FloatMask<node_lanes>::from_bits(lanes);
    if (!any(counts & (least <= V(tmax)))) return;
    tmax = least_lane(select(counts & (most < V(tmax)) & (h.shortest_squared > V(0.0f)), most, V(tmax)));
    if (count_ > most_waiting - node_lanes) decide(corners);
    FloatMask<node_lanes> waits = counts & (least <= V(tmax));
    compress_store(least_ + count_, waits, as<std::uint32_t>(least));
    count_ += compress_store(triangle_ + count_, waits, Words(triangle) + Words::load(numbers));
  }

  ClosestPoint answer(const TreeCorners& corners) {
    decide(corners);
    return nearest_.answer(corners);
  }

 private:
  using V = Floats<node_lanes>;
  using Words = Lanes<std::uint32_t, node_lanes>;
  static constexpr std::uint32_t numbers[tree_width] = {0, 1, 2, 3, 4, 5, 6, 7};
  // Of the squared distance and the sum of squared edges, docs/queries.md.
  static constexpr float error_of_floats = 0x1.2p-16f;
  static constexpr int most_waiting = 64;

  // All that wait and may still be the nearest.
  void decide(const TreeCorners& corners) {
    std::uint32_t triangle[node_lanes];
    for (int i = 0, ready = 0; i < count_; ++i) {
      if (__builtin_bit_cast(float, least_[i]) <= tmax) triangle[ready++] = triangle_[i];
      if (ready == 0 || (ready < node_lanes && i + 1 < count_)) continue;
      decide(corners, triangle, ready);
      ready = 0;
    }
    count_ = 0;
  }
  void decide(const TreeCorners& corners, const std::uint32_t (&triangle)[node_lanes], int ready) {
    alignas(64) float number[9][node_lanes];
    for (int k = 0; k < 9; ++k) V(0.0f).store(number[k]);
    for (int lane = 0; lane < ready; ++lane)
      for (int k = 0; k < 9; ++k) number[k][lane] = corners.number(k, triangle[lane]);
    V corner[9];
    for (int k = 0; k < 9; ++k) corner[k] = V::load(number[k]);
    keep_nearest(nearest_, point_, corner, first_lanes<node_lanes>(static_cast<std::size_t>(ready)), triangle,
                 corners);
  }

  Vec3<V> point_in_units_;
  V scale_;
  Vec3<Doubles<half_of<node_lanes>>> point_;
  NearestTriangle nearest_;
  int count_ = 0;
  std::uint32_t least_[most_waiting], triangle_[most_waiting];  // the bits of a float: no farther than that
};

// Points of a batch one after the other.
template <class Counters>
class PointsInTree {
 public:
  PointsInTree(const TreeView& tree, const PointBatch& batch, const Counters& counters)
      : tree_(tree),
        corners_{static_cast<const LeafBlock<9>*>(tree.blocks)},
        counters_(counters),
        most_squared_(batch.most_squared),
        largest_(largest_magnitude(tree.bounds.lo, largest_magnitude(tree.bounds.hi))) {}

  ClosestPoint closest(const Float3& point) {
    if (tree_.root == empty_reference || !is_finite(point) || !(most_squared_ >= 0.0)) return {};
    BoxDistance<node_lanes> boxes(point, largest_);
    NearTriangles near(point, boxes, most_squared_, bound_by_before_last(point));
    walk_nodes(tree_, boxes, near, counters_, [&](TreeReference leaf) {
      visit(leaf, near);
      return false;
    });
    const ClosestPoint found = near.answer(corners_);
    if (found) before_last_ = last_, last_ = found;
    return found;
  }

 private:
  void visit(TreeReference leaf, NearTriangles& near) const {
    const LeafBlock<9>& block = corners_.blocks[leaf & leaf_block_mask];
    const int size = leaf_size(leaf);
    counters_.leaf();
    for (int first = 0; first < size; first += node_lanes) {
      const std::uint32_t lanes = first_lanes<node_lanes>(static_cast<std::size_t>(size - first));
      counters_.triangles(lanes);
      near.take(corners_, block, first, lanes, leaf_triangle_of(leaf, first));
    }
  }

  // A point that was found before lies on a triangle but for its rounding, so the square of its distance to this one,
  // with some room, is a bound: (x + y)² <= (1 + 2^-8)·x² + (1 + 2^8)·y² without a root. Not the last one, for which
  // the processor would have to wait.
  double bound_by_before_last(const Float3& point) const {
    if (!before_last_) return std::numeric_limits<double>::infinity();
    const double room = static_cast<double>(largest_magnitude(point, largest_)) * 0x1p-20;
    double square = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double off = static_cast<double>(point[axis]) - static_cast<double>(before_last_.point[axis]);
      square += off * off;
    }
    return square * (1.0 + 0x1p-8) + room * room * 257.0;
  }

  const TreeView& tree_;
  TreeCorners corners_;
  const Counters& counters_;
  double most_squared_;
  float largest_;
  ClosestPoint last_, before_last_;
};

template <class Counters>
[[gnu::flatten, gnu::noinline]] void closest_of_points(const TreeView& tree, const PointBatch& batch) {
  TraceBatch counting;
  counting.counters = batch.counters;
  const Counters counters(counting);
  PointsInTree<Counters> points(tree, batch, counters);
  const auto at = [&](std::size_t k) {
    return batch.order != nullptr ? batch.begin + static_cast<std::uint32_t>(batch.order[k - batch.begin])
                                  : k;
  };
  for (std::size_t k = batch.begin; k < batch.end; ++k) {
    constexpr std::size_t ahead = 8;
    if (batch.end - k > ahead) {
      const std::size_t later = at(k + ahead);
      __builtin_prefetch(batch.points + later * batch.stride);
      __builtin_prefetch(batch.closest + later, 1);
    }
    const std::size_t i = at(k);
    if (batch.active != nullptr && (batch.active[i / 8] >> (i % 8) & 1u) == 0) continue;
    Float3 point;
    __builtin_memcpy(&point, batch.points + i * batch.stride, sizeof point);
    batch.closest[i] = points.closest(point);
  }
}

}  // namespace
}  // namespace raylanes
