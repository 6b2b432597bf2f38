// A point through a tree: nearest box first. Floats say which triangles may be the nearest, doubles decide among those
// few, together, at the end.
#pragma once

#include "../simd/reduce.hpp"
#include "float_points.hpp"

namespace raylanes {
namespace {

// A child that waits.
struct WaitingChild {
  TreeReference reference;
  float t;  // the square of how far its box is

  static WaitingChild of(const WideNode& node, int child, float t) { return {node.child[child], t}; }
};

// How queries of points go down: the nearest child; the others wait as they come.
template <class Child>
struct NearestChild {
  using Entry = Child;

  static Entry start(TreeReference root) { return {root, 0.0f}; }
  static TreeReference at(const Entry& entry) { return entry.reference; }
  template <class Query>
  static bool is_behind(const Entry& entry, const Query& query) {
    return entry.t > query.box_tmax();
  }
  static Entry descend(Entry*& top, const WideNode& node, std::uint32_t children,
                       const float (&t)[tree_width]) {
    const int first = std::countr_zero(children);
    Entry nearest = Entry::of(node, first, t[first]);
    for (children &= children - 1; children != 0; children &= children - 1) {
      const int child = std::countr_zero(children);
      const Entry other = Entry::of(node, child, t[child]);
      const bool is_nearer = other.t < nearest.t;
      *top++ = is_nearer ? nearest : other;
      nearest = is_nearer ? other : nearest;
    }
    return nearest;
  }
};

// Triangles side by side: no farther than `most`, no nearer than `least`; and the square of their shortest edge.
template <class V>
struct BoundsOfTriangles {
  V least, most, shortest_squared;
};

// In the units of BoxDistance. Points says what kind of tree it is: FloatPoints, or DoublePoints.
template <class Points>
class NearBounds {
  using V = Floats<node_lanes>;

 public:
  NearBounds(const typename Points::Place& point, const BoxDistance<node_lanes>& boxes)
      : before_(point, boxes) {}
  float limit_of_boxes(float tmax) const { return before_.limit_of_boxes(tmax); }
  template <class Rows>
  BoundsOfTriangles<V> bounds(const Rows& rows, int first) const {
    TriangleEdges<V> edges = PointTriangle<V, Grade::fast>::set_up(before_.corners.corner(rows, 0, first),
                                                                   before_.corners.corner(rows, 1, first),
                                                                   before_.corners.corner(rows, 2, first));
    PointOnTriangle<V> h = PointTriangle<V, Grade::fast>::closest(before_.in_units(), edges);
    V error =
        multiply_add<Grade::fast>(h.distance_squared + edges.edges_squared, V(error_of_floats), V(0x1p-78f));
    return {h.distance_squared - error, h.distance_squared + error, edges.shortest_squared};
  }
  const auto& exact() const { return before_.exact; }

 private:
  typename Points::Before before_;
};

// Triangles that may be the nearest: what floats say of them, and the least of what they may be at most. `Bounds` are
// NearBounds, or have what they have.
template <class Points, class Bounds = NearBounds<Points>>
class NearTriangles : public NearestChild<WaitingChild> {
  using Triangles = typename Points::Triangles;

 public:
  static constexpr bool only_decides = false;
  float tmax;  // what is farther than this is not the nearest

  // Some triangle, if any counts, is within `limit`.
  NearTriangles(const Bounds& bounds, float limit, double max_squared)
      : tmax(finite_tmax(limit)), bounds_(bounds), nearest_(max_squared) {}
  float box_tmax() const { return bounds_.limit_of_boxes(tmax); }
  // A register of a leaf's triangles from the one of that number on, `lanes` of them. A single branch, because none is
  // predicted well: values that a vector leaves unchanged are written again, and waiting triangles are packed.
  template <class Rows>
  void take(const Triangles& corners, const Rows& rows, int first, std::uint32_t lanes,
            std::uint32_t triangle) {
    const auto [least, most, shortest_squared] = bounds_.bounds(rows, first);
    FloatMask<node_lanes> valid = FloatMask<node_lanes>::from_bits(lanes);
    if (!any(valid & (least <= V(tmax)))) return;
    tmax = min_lane(select(valid & (most < V(tmax)) & (shortest_squared > V(0.0f)), most, V(tmax)));
    if (count_ > max_waiting - node_lanes) decide(corners);
    FloatMask<node_lanes> waits = valid & (least <= V(tmax));
    compress_store(min_ + count_, waits, as<std::uint32_t>(least));
    count_ += compress_store(triangle_ + count_, waits, Words(triangle) + Words::load(numbers));
  }

  auto answer(const Triangles& corners) {
    decide(corners);
    return nearest_.answer(corners);
  }

 private:
  using V = Floats<node_lanes>;
  using Words = Lanes<std::uint32_t, node_lanes>;
  using Decided = typename Points::Decided;
  static constexpr int decided = Points::decided;
  static constexpr std::uint32_t numbers[tree_width] = {0, 1, 2, 3, 4, 5, 6, 7};
  static constexpr int max_waiting = 64;

  // All that wait and may still be the nearest.
  void decide(const Triangles& corners) {
    std::uint32_t triangle[decided];
    for (int i = 0, ready = 0; i < count_; ++i) {
      if (__builtin_bit_cast(float, min_[i]) <= tmax) triangle[ready++] = triangle_[i];
      if (ready == 0 || (ready < decided && i + 1 < count_)) continue;
      decide(corners, triangle, ready);
      ready = 0;
    }
    count_ = 0;
  }
  void decide(const Triangles& corners, const std::uint32_t (&triangle)[decided], int ready) {
    // By broadcasts: most often there is one triangle, and a load would wait for stores of single lanes.
    Decided corner[9];
    for (int k = 0; k < 9; ++k) corner[k] = Decided(corners.number(k, triangle[0]));
    for (int lane = 1; lane < ready; ++lane) {
      auto at = decltype(corner[0] < corner[0])::from_bits(1u << lane);
      for (int k = 0; k < 9; ++k)
        corner[k] = select(at, Decided(corners.number(k, triangle[lane])), corner[k]);
    }
    keep_nearest(nearest_, bounds_.exact(), corner, first_lanes<decided>(static_cast<std::size_t>(ready)),
                 triangle, corners);
  }

  Bounds bounds_;
  NearestTriangle<typename Points::Number> nearest_;
  int count_ = 0;
  std::uint32_t min_[max_waiting], triangle_[max_waiting];  // the bits of a float: no farther than that
};

}  // namespace
}  // namespace raylanes
