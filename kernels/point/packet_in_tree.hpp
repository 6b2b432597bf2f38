// Neighbours together through a tree. The box around them is tested against the boxes of a node. Then each point is
// tested against the box of a leaf, in lanes, and near points against the leaf's triangles, which are set up once.
#pragma once

#include "near_triangles.hpp"

namespace raylanes {
namespace {

// A child that waits, and where its box is: the first of its six planes, each of which is a row of the node on from
// the one before.
struct WaitingBox {
  TreeReference reference;
  float t;
  const float* planes = nullptr;  // null: the root, which everything is near

  static WaitingBox of(const WideNode& node, int child, float t) {
    return {node.child[child], t, planes_of(node, child)};
  }
  operator TreeReference() const { return reference; }
};

// The points of a packet, and how far for each the nearest triangle is at most, in the units of BoxDistance.
template <class Points, class Counters>
class PacketReach {
 public:
  using V = Floats<native_lanes>;
  static constexpr int registers = packet_points / native_lanes;

  PacketReach(const typename Points::Packet& packet, const typename Points::PacketUnits& units, float scale,
              const Counters& counters)
      : scale_(scale), all_(first_lanes<32>(static_cast<std::size_t>(packet.size))), counters_(counters) {
    for (int axis = 0; axis < 3; ++axis)
      for (int r = 0; r < registers; ++r) {
        V x = V::load(packet.coordinate[axis] + r * native_lanes) * V(scale);
        V pad = multiply_add<Grade::reproducible>(abs(x), V(0x1p-22f), V(0x1p-44f));
        units.at(axis, r * native_lanes).store(at_[axis] + r * native_lanes);
        above_[axis][r] = x + pad, below_[axis][r] = x - pad;
      }
  }

  V at(int axis, int first) const { return V::load(at_[axis] + first); }
  float at_lane(int axis, int lane) const { return at_[axis][lane]; }
  float most() const { return max_; }  // of all

  void store(float (&limit)[packet_points]) const {
    for (int r = 0; r < registers; ++r) limit_[r].store(limit + r * native_lanes);
  }
  // limit: for each lane, in units, what some triangle is within, if any counts; negative where there is no point.
  void set(const float (&limit)[packet_points]) {
    for (int r = 0; r < registers; ++r) limit_[r] = V::load(limit + r * native_lanes);
    V most = limit_[0];
    for (int r = 1; r < registers; ++r) most = max(most, limit_[r]);
    max_ = largest_lane(most);
  }

  // The points that a box is near to, as BoxDistance has it of each alone.
  std::uint32_t points_near(const float* planes) const {
    if (planes == nullptr) return all_;
    counters_.boxes(all_, registers);
    std::uint32_t near = 0;
    for (int r = 0; r < registers; ++r) {
      const auto off = [&](int axis) {
        V lo(planes[plane_at(axis, false)] * scale_), hi(planes[plane_at(axis, true)] * scale_);
        return max(max(lo - above_[axis][r], below_[axis][r] - hi), V(0.0f));
      };
      V x = off(0), y = off(1), z = off(2);
      V square = multiply_add<Grade::fast>(z, z, multiply_add<Grade::fast>(y, y, x * x));
      near |= bits(square <= limit_[r]) << (r * native_lanes);
    }
    return near;
  }

 private:
  float scale_, max_ = 0.0f;
  std::uint32_t all_;
  const Counters& counters_;
  alignas(64) float at_[3][packet_points];
  V above_[3][registers], below_[3][registers], limit_[registers];
};

// The results of floats for triangles and points, pair by pair.
template <class Points, class Counters>
class NearPacket : public NearestChild<WaitingBox> {
  using Triangles = typename Points::Triangles;
  using Number = typename Points::Number;

 public:
  PacketReach<Points, Counters> tmax;

  // Its reach is to be set.
  NearPacket(const typename Points::Packet& packet, const typename Points::PacketUnits& units, float scale,
             double max_squared, const Counters& counters)
      : tmax(packet, units, scale, counters), size_(packet.size), units_(units), counters_(counters) {
    for (int i = 0; i < size_; ++i) nearest_[i] = NearestTriangle<Number>(max_squared);
  }
  float box_tmax() const { return tmax.most(); }
  static const Entry& at(const Entry& entry) { return entry; }  // visits need the box
  // Leaves are looked at when they are visited, which has to know which points are near.
  static bool is_behind(const Entry& entry, const NearPacket& query) {
    return entry.t > query.tmax.most() ||
           (!refers_to_leaf(entry.reference) && query.tmax.points_near(entry.planes) == 0);
  }

  void visit(const Triangles& corners, const Entry& entry) {
    const std::uint32_t points = tmax.points_near(entry.planes);
    if (points == 0) return;
    const TreeReference leaf = entry.reference;
    counters_.leaf();
    if (count_ > max_waiting - tree_width * packet_points) make_room(corners);
    alignas(64) float limit[packet_points];
    tmax.store(limit);
    const auto& rows = Points::rows_of(corners, leaf);
    for (int first = 0; first < leaf_size(leaf); first += node_lanes)
      take(rows, first, first_lanes<node_lanes>(static_cast<std::size_t>(leaf_size(leaf) - first)),
           Points::leaf_triangle(leaf, first), points, limit);
    tmax.set(limit);
  }

  // closest[i] is the packet's point i.
  void answer(const Triangles& corners, ClosestPointOf<Number> (&closest)[packet_points]) {
    decide(corners);
    for (int i = 0; i < size_; ++i) closest[i] = nearest_[i].answer(corners);
  }

 private:
  using T = Floats<node_lanes>;
  using Words = Lanes<std::uint32_t, node_lanes>;
  using Test = PointTriangle<T, Grade::fast, ByReciprocal<T>>;
  static constexpr std::uint32_t numbers[tree_width] = {0, 1, 2, 3, 4, 5, 6, 7};
  static constexpr int max_waiting = 1024;

  // A register of a leaf's triangles, `lanes` of them, against some points. Waiting pairs are packed, without a branch.
  template <class Rows>
  void take(const Rows& rows, int first, std::uint32_t lanes, std::uint32_t triangle, std::uint32_t points,
            float (&limit)[packet_points]) {
    const auto in_units = units_.corners();
    TriangleEdges<T> edges = Test::set_up(in_units.corner(rows, 0, first), in_units.corner(rows, 1, first),
                                          in_units.corner(rows, 2, first));
    T error = multiply_add<Grade::fast>(edges.edges_squared, T(error_of_floats), T(units_.least_error)),
      infinity(std::numeric_limits<float>::infinity());
    auto valid = FloatMask<node_lanes>::from_bits(lanes);
    T below = select(valid, error, -infinity),
      above = select(valid & (edges.shortest_squared > T(0.0f)), error, infinity);
    Words names = Words(triangle) + Words::load(numbers);
    int count = count_;
    for (; points != 0; points &= points - 1) {
      const int i = std::countr_zero(points);
      counters_.triangles(lanes);
      Vec3<T> point{T(tmax.at_lane(0, i)), T(tmax.at_lane(1, i)), T(tmax.at_lane(2, i))};
      T square = Test::closest(point, edges).distance_squared;
      T least = multiply_add<Grade::fast>(square, T(1.0f - units_.share_of_square), -below),
        most = multiply_add<Grade::fast>(square, T(1.0f + units_.share_of_square), above);
      limit[i] = min_lane(min(most, T(limit[i])));
      FloatMask<node_lanes> waits = least <= T(limit[i]);
      as<float>(Words(static_cast<std::uint32_t>(i))).store(reinterpret_cast<float*>(point_ + count));
      compress_store(min_ + count, waits, as<std::uint32_t>(least));
      count += compress_store(triangle_ + count, waits, names);
    }
    count_ = count;
  }

  void drop_what_is_farther() {
    alignas(64) float limit[packet_points];
    tmax.store(limit);
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      min_[kept] = min_[i], triangle_[kept] = triangle_[i], point_[kept] = point_[i];
      kept += __builtin_bit_cast(float, min_[i]) <= limit[point_[i]] ? 1 : 0;
    }
    count_ = kept;
  }
  [[gnu::noinline]] void make_room(const Triangles& corners) {
    drop_what_is_farther();
    if (count_ > max_waiting / 2) decide(corners);
  }
  [[gnu::flatten, gnu::noinline]] void decide(const Triangles& corners) {
    drop_what_is_farther();
    constexpr int N = half_of<native_lanes>;
    for (int first = 0; first < count_; first += N) {
      const int size = count_ - first < N ? count_ - first : N;
      alignas(64) double number[12][N];
      for (auto& row : number) Doubles<N>(0.0).store(row);
      for (int j = 0; j < size; ++j) {
        const std::uint32_t triangle = triangle_[first + j], point = point_[first + j];
        for (int k = 0; k < 9; ++k) number[k][j] = static_cast<double>(corners.number(k, triangle));
        for (int k = 0; k < 3; ++k) number[9 + k][j] = units_.exact(k, point);
      }
      keep_pairs<N>(nearest_, number, size, point_ + first, triangle_ + first, corners);
    }
    count_ = 0;
  }

  int size_;
  typename Points::PacketUnits units_;
  const Counters& counters_;
  NearestTriangle<Number> nearest_[packet_points];
  int count_ = 0;
  // Who waits: the bits of a float, no farther than that; the triangle; the point.
  std::uint32_t min_[max_waiting], triangle_[max_waiting], point_[max_waiting];
};

}  // namespace
}  // namespace raylanes
