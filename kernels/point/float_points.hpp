// A tree of floats as searches for closest points see it: points, corners and boxes have the same numbers.
#pragma once

#include "../exact/tree_triangles.hpp"
#include "../traverse/single.hpp"
#include "box_distance.hpp"
#include "nearest_triangle.hpp"

namespace raylanes {
namespace {

// By how much floats are off at most: of the squared distance and the sum of squared edges, docs/queries.md.
inline constexpr float error_of_floats = 0x1.2p-16f;

// Two registers: fewer share too little, more take more boxes. One lane has nothing to share.
inline constexpr int packet_points = native_lanes == 1 ? 1 : 2 * native_lanes;

// Points that go together, by the coordinates that nodes see.
struct PointPacket {
  int size = 0;
  alignas(64) float coordinate[3][packet_points];
  std::size_t index[packet_points];  // in the batch

  Float3 point(int i) const { return {coordinate[0][i], coordinate[1][i], coordinate[2][i]}; }
  void add(const Float3& p, std::size_t i) {
    for (std::size_t axis = 0; axis < 3; ++axis) coordinate[axis][size] = p[axis];
    index[size++] = i;
  }
  // Lanes without a point are where the first one is.
  void fill() {
    for (int i = size; i < packet_points; ++i)
      for (auto& x : coordinate) x[i] = x[0];
  }
  // Around a packet that is filled.
  Box bounds() const {
    Box box{point(0), point(0)};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const float x : coordinate[axis]) {
        box.lo[axis] = x < box.lo[axis] ? x : box.lo[axis];
        box.hi[axis] = x > box.hi[axis] ? x : box.hi[axis];
      }
    return box;
  }
};

inline double square_of_diagonal(const Box& box) {
  double square = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double off = static_cast<double>(box.hi[axis]) - static_cast<double>(box.lo[axis]);
    square += off * off;
  }
  return square;
}

// Whether a point is so far from a tree that FarPoint tells triangles apart that squares of distances do not, up to
// where doubles do.
inline bool is_distant(const Float3& point, const Box& bounds) {
  float distance = 0.0f, extent = 0.0f;
  for (std::size_t k = 0; k < 3; ++k) {
    const float lo = bounds.lo[k], hi = bounds.hi[k];
    extent = hi - lo > extent ? hi - lo : extent;
    distance = lo - point[k] > distance ? lo - point[k] : point[k] - hi > distance ? point[k] - hi : distance;
  }
  return distance >= 0x1p6f * extent && distance <= 0x1p40f * extent && extent >= 0x1p-60f &&
         extent <= 0x1p60f;
}

class FloatPoints {
 public:
  using Number = float;
  using Tree = TreeView;
  using Place = Float3;  // what a search knows of its point
  using Packet = PointPacket;
  using Triangles = TreeTriangles;
  using Decided = Floats<node_lanes>;  // the triangles that are decided together
  static constexpr int decided = node_lanes;

  explicit FloatPoints(const TreeView& tree)
      : tree_(tree), largest_(largest_magnitude(tree.bounds.lo, largest_magnitude(tree.bounds.hi))) {}

  const TreeView& nodes() const { return tree_; }
  float largest() const { return largest_; }
  TreeTriangles triangles() const { return TreeTriangles(tree_); }
  TreeTriangles triangles_for(const Place&) const { return triangles(); }
  BoxDistance<node_lanes> boxes(const Place& point) const { return {point, largest_}; }
  BoxDistance<node_lanes> boxes(const Box& points, float scale) const { return {points, scale}; }
  static double max_squared(double distance) { return distance >= 0.0 ? distance * distance : -1.0; }
  static double max_squared(const Place&, double distance) { return max_squared(distance); }
  static bool is_number(const Float3& point) { return is_finite(point); }
  static const Place& place_of(const Float3& point) { return point; }
  static Place place_of(const PointPacket& packet, int i) { return packet.point(i); }
  // Whether a point has FarPoint, and whether it goes alone.
  bool is_compared_far(const Place& point) const { return is_distant(point, tree_.bounds); }
  bool is_far(const Place& point) const { return is_compared_far(point); }
  static Double3 in_space_of_nodes(const Place& point) {
    return {static_cast<double>(point[0]), static_cast<double>(point[1]), static_cast<double>(point[2])};
  }
  static double squared_in_space_of_nodes(double squared) { return squared; }
  static const Place& exact_of(const Place& point) { return point; }
  static void add(PointPacket& packet, const Place& point, std::size_t i) { packet.add(point, i); }

  static const LeafBlock<9>& rows_of(const TreeTriangles& triangles, TreeReference leaf) {
    return triangles.blocks[leaf_of(leaf).block];
  }
  static const void* begin_of(const TreeTriangles& triangles, TreeReference leaf) {
    return triangles.blocks + leaf_of(leaf).block;
  }
  static std::uint32_t leaf_triangle(TreeReference leaf, int triangle) {
    return leaf_triangle_of(leaf, triangle);
  }

  // A row of corners in units from the middle of the tree.
  static Floats<node_lanes> less_middle(const LeafBlock<9>& rows, int row, int first, float middle,
                                        float scale) {
    using V = Floats<node_lanes>;
    return (V::load(&rows.number[row][first]) - V(middle)) * V(scale);
  }

  // Corners in the units of BoxDistance.
  struct ScaledCorners {
    using V = Floats<node_lanes>;
    V scale;

    Vec3<V> corner(const LeafBlock<9>& rows, int k, int first) const {
      const auto load = [&](int i) { return V::load(&rows.number[i][first]) * scale; };
      return Vec3<V>(load(3 * k), load(3 * k + 1), load(3 * k + 2));
    }
  };

  // A point before the triangles of leaves.
  struct Before {
    using V = Floats<node_lanes>;
    Vec3<V> scaled;
    ScaledCorners corners;
    Vec3<Doubles<half_of<node_lanes>>> exact;

    Before(const Place& point, const BoxDistance<node_lanes>& boxes)
        : scaled{V(point[0]) * boxes.scale(), V(point[1]) * boxes.scale(), V(point[2]) * boxes.scale()},
          corners{boxes.scale()},
          exact(doubles_of<half_of<node_lanes>>(point)) {}
    const Vec3<V>& in_units() const { return scaled; }
    static float limit_of_boxes(float tmax) { return tmax; }
  };

  // The most that a point that was found is off, in the place of a point or in the units of a packet; the most that it
  // loses if its coordinates are subnormal, also in modes that flush these, is 2^-125.
  double room_of(const Place& point) const {
    return static_cast<double>(largest_magnitude(point, largest_)) * 0x1p-20 + double{flushed_from_found};
  }
  static double distance_along(const Place& point, const Float3& found, std::size_t axis) {
    return static_cast<double>(point[axis]) - static_cast<double>(found[axis]);
  }

  // Points of a packet before triangles, and before those that the packet before found.
  class PacketUnits {
   public:
    using V = Floats<native_lanes>;
    static constexpr float share_of_square = error_of_floats, least_error = 0x1p-78f;

    PacketUnits(const FloatPoints&, const PointPacket& packet, const Box&, float scale)
        : packet_(packet), scale_(scale) {}
    V at(int axis, int first) const { return V::load(packet_.coordinate[axis] + first) * V(scale_); }
    ScaledCorners corners() const { return {Floats<node_lanes>(scale_)}; }
    double exact(int axis, std::uint32_t i) const { return static_cast<double>(packet_.coordinate[axis][i]); }
    // Points that were found, at least `count` of them.
    void bring(const float (&found)[3][packet_points], int count, float (&to)[3][packet_points]) const {
      for (int i = 0; i < count; ++i)
        for (int axis = 0; axis < 3; ++axis) to[axis][i] = found[axis][i] * scale_;
    }
    float room() const { return 0x1p-18f + flushed_from_found * scale_; }

   private:
    const PointPacket& packet_;
    float scale_;
  };

 private:
  static constexpr float flushed_from_found = 0x1p-125f;

  const TreeView& tree_;
  float largest_;
};

}  // namespace
}  // namespace raylanes
