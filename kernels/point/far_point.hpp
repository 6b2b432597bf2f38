// A point far from a tree: squares of distances differ by less than they are rounded, so they are compared without what
// all have in common. With q and P the coordinates of a place and of the point from the middle of the tree,
//   |P − q|² − |P|² = q · (q − 2P).
// docs/queries.md derives the bounds.
#pragma once

#include "near_triangles.hpp"

namespace raylanes {
namespace {

// Units are of a power of two in which the tree reaches from −1 to 1 along each axis. A number is that of the formula
// over 2M, plus 4: from 0 to 8, and off by error_ at most. M is the least power of two above the point's coordinates.
class FarPoint {
  using V = Floats<node_lanes>;

 public:
  // All in the space of nodes.
  FarPoint(const Double3& point, const Box& bounds, double max_squared) {
    float extent = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      const float along = bounds.hi[k] - bounds.lo[k];
      extent = along > extent ? along : extent;
    }
    scale_ = 0.25f * scale_to_four(extent);  // the extent becomes 1/2 to 1
    double p[3], largest = 0.0, square = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const float middle = 0.5f * bounds.lo[k] + 0.5f * bounds.hi[k];
      p[k] = (point[k] - static_cast<double>(middle)) * static_cast<double>(scale_);
      const double size = p[k] < 0.0 ? -p[k] : p[k];
      largest = size > largest ? size : largest, square += p[k] * p[k];
      middle_[k] = middle, point_[k] = V(static_cast<float>(p[k]));
    }
    double most = 2.0;
    while (most <= largest) most *= 2.0;
    for (std::size_t k = 0; k < 3; ++k) share_[k] = V(static_cast<float>(p[k] / most));
    half_inverse_ = static_cast<float>(0.5 / most);
    error_ = static_cast<float>(0x1p-18 + 0x1p-42 * most);
    const double squared_scale = static_cast<double>(scale_) * static_cast<double>(scale_),
                 limit = (max_squared * squared_scale - square) * (0.5 / most) + 4.0;
    limit_ = limit < 0x1p4 ? static_cast<float>(limit) + error_ : 0x1p4f;
  }
  // For walk_fused and walk_nodes, as BoxDistance has them: of the nearest place of each box; infinite for empty slots.
  V entries(const WideNode& node) const { return at(node, 0); }
  static V exits(const WideNode&, V limit) { return limit; }
  std::uint32_t children_hit(const WideNode& node, float limit, float (&entry)[tree_width]) const {
    std::uint32_t hit = 0;
    for (int first = 0; first < tree_width; first += node_lanes) {
      V number = at(node, first);
      number.store(entry + first);
      hit |= bits(number <= V(limit)) << first;
    }
    return hit & node.occupied;
  }

  // Some triangle, if any counts, is within this.
  float limit() const { return limit_; }

  // Bounds of triangles: no place of one is below its least corner by more than a quarter of the squares of its edges
  // over 2M.
  template <class Points, class Rows>
  BoundsOfTriangles<V> bounds(const Points& points, const Rows& rows, int first) const {
    const auto corner = [&](int k) {
      const auto number = [&](int axis) {
        return points.less_middle(rows, 3 * k + axis, first, middle_[axis], scale_);
      };
      return Vec3<V>(number(0), number(1), number(2));
    };
    Vec3<V> a = corner(0), b = corner(1), c = corner(2);
    const auto square = [](const Vec3<V>& from, const Vec3<V>& to) {
      const Vec3<V> d = to - from;
      return Arithmetic<Grade::fast>::dot(d, d);
    };
    V ab = square(a, b), ac = square(a, c), bc = square(b, c);
    V nearest = min(min(number_of(a), number_of(b)), number_of(c));
    V below = multiply_add<Grade::fast>((ab + ac) + bc, V(0.25f * half_inverse_), V(error_));
    return {nearest - below, nearest + V(error_), min(min(ab, ac), bc)};
  }

 private:
  V in_units(V x, std::size_t axis) const { return (x - V(middle_[axis])) * V(scale_); }
  V term(V q, std::size_t axis) const {
    return q * multiply_add<Grade::fast>(q, V(half_inverse_), -share_[axis]);
  }
  V number_of(const Vec3<V>& q) const { return ((term(q.x, 0) + term(q.y, 1)) + term(q.z, 2)) + V(4.0f); }
  V at(const WideNode& node, int first) const {
    const auto nearest = [&](std::size_t axis) {
      V lo = in_units(V::load(node.lo[axis] + first), axis),
        hi = in_units(V::load(node.hi[axis] + first), axis);
      return term(min(max(point_[axis], lo), hi), axis);
    };
    return max(((nearest(0) + nearest(1)) + nearest(2)) + V(4.0f - 0x1p-18f), V(0.0f));
  }

  float middle_[3];
  V point_[3], share_[3];  // the point in units, and over M
  float scale_, half_inverse_, error_, limit_;
};

// As NearBounds.
template <class Points>
class FarBounds {
 public:
  FarBounds(const Points& points, const FarPoint& far, const typename Points::Place& point)
      : points_(points), far_(far), exact_(doubles_of<half_of<node_lanes>>(Points::exact_of(point))) {}
  static float limit_of_boxes(float tmax) { return tmax; }
  template <class Rows>
  auto bounds(const Rows& rows, int first) const {
    return far_.bounds(points_, rows, first);
  }
  const auto& exact() const { return exact_; }

 private:
  const Points& points_;
  const FarPoint& far_;
  Vec3<Doubles<half_of<node_lanes>>> exact_;
};

}  // namespace
}  // namespace raylanes
