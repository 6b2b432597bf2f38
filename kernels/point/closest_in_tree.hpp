// The points of a batch through a tree: those that come one after the other and are neighbours together, others alone.
#pragma once

#include "../../dispatch/bits.hpp"
#include "one_point.hpp"
#include "packet_in_tree.hpp"

namespace raylanes {
namespace {

// The boxes of a packet, of whose children all that it comes to are asked for ahead of time: most are visited.
template <class Points>
struct FetchedBoxes {
  const TreeView& tree;
  const typename Points::Triangles& corners;
  const BoxDistance<node_lanes>& boxes;

  std::uint32_t children_hit(const WideNode& node, float limit, float (&distance)[tree_width]) const {
    const std::uint32_t hit = boxes.children_hit(node, limit, distance);
    for (std::uint32_t left = hit; left != 0; left &= left - 1) {
      const TreeReference child = node.child[std::countr_zero(left)];
      const auto* const lines = static_cast<const std::byte*>(
          refers_to_leaf(child) ? Points::begin_of(corners, child) : tree.nodes + child);
      for (std::size_t at = 0; at < sizeof(LeafBlock<9>); at += 64) __builtin_prefetch(lines + at);
    }
    return hit;
  }
};

template <class Points, class Counters>
class PointsInTree {
  using Number = typename Points::Number;
  using Point = PointOf<Number>;
  using Place = typename Points::Place;
  using Packet = typename Points::Packet;
  using Closest = ClosestPointOf<Number>;
  using Batch = PointBatchOf<Number>;

 public:
  PointsInTree(const typename Points::Tree& tree, const Batch& batch, const Counters& counters)
      : points_(tree),
        corners_(points_.triangles()),
        counters_(counters),
        max_distance_(batch.max_distance),
        max_squared_(points_.max_squared(batch.max_distance)),
        widest_squared_(square_of_diagonal(points_.nodes().bounds) * (widest_packet * widest_packet)) {}

  // A packet's answers, and an empty packet. Out of line, as it is long and asked for twice.
  [[gnu::flatten, gnu::noinline]] void answer(Packet& packet, Closest* closest) {
    packet.fill();
    bool is_together = false;
    if constexpr (packet_points > 1)
      is_together =
          !is_first_ && packet.size >= min_together && square_of_diagonal(packet.bounds()) <= widest_squared_;
    Closest found[packet_points];
    if constexpr (packet_points > 1)
      if (is_together) find_together(packet, found);
    if (!is_together)
      for (int i = 0; i < packet.size; ++i) found[i] = this->closest(points_.place_of(packet, i));
    is_first_ = false, found_count_ = 0;
    for (int i = 0; i < packet.size; ++i) {
      closest[packet.index[i]] = found[i];
      if (!found[i]) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) found_[axis][found_count_] = found[i].point[axis];
      ++found_count_;
      if (is_together) before_last_ = last_ = found[i];
    }
    packet.size = 0;
  }

  // A point of the batch: its answer, or its place in the packet.
  void take(const Point& point, std::size_t i, Packet& packet, const Batch& batch) {
    if (!is_sought<Points>(points_.nodes(), point, max_distance_)) {
      batch.closest[i] = {};
      return;
    }
    const Place& place = points_.place_of(point);
    if (points_.is_far(place))
      batch.closest[i] = closest_to_point(points_, place, points_.max_squared(place, max_distance_),
                                          std::numeric_limits<double>::infinity(), counters_);
    else
      points_.add(packet, place, i);
  }

 private:
  // A packet whose box has a diagonal of more than that share of the tree's, or of few points, shares too little; the
  // first one is not bounded: measured, docs/queries.md.
  static constexpr double widest_packet = 0.2;
  static constexpr int min_together = packet_points / 4;

  Closest closest(const Place& point) {
    const Closest found =
        closest_to_point(points_, point, max_squared_, bound_by_before_last(point), counters_);
    if (found) before_last_ = last_, last_ = found;
    return found;
  }

  void find_together(const Packet& packet, Closest (&found)[packet_points]) {
    const Box box = packet.bounds();
    const float scale =
        scale_to_four(largest_magnitude(box.lo, largest_magnitude(box.hi, points_.largest())));
    BoxDistance<node_lanes> boxes = points_.boxes(box, scale);
    const typename Points::PacketUnits units(points_, packet, box, scale);
    NearPacket<Points, Counters> near(packet, units, scale, max_squared_, counters_);
    alignas(64) float limit[packet_points];
    bound_by_packet_before(packet, units, near.tmax, boxes.limit(max_squared_), limit);
    near.tmax.set(limit);
    const FetchedBoxes<Points> fetched{points_.nodes(), corners_, boxes};
    walk_nodes(points_.nodes(), fetched, near, counters_, [&](const WaitingBox& leaf) {
      near.visit(corners_, leaf);
      return false;
    });
    near.answer(corners_, found);
  }

  // For each lane, in units, by all points that the packet before found: as bound_by_before_last, where no coordinate
  // is above 8 and floats round besides.
  void bound_by_packet_before(const Packet& packet, const typename Points::PacketUnits& units,
                              const PacketReach<Points, Counters>& reach, float most,
                              float (&limit)[packet_points]) const {
    using V = Floats<native_lanes>;
    const float room = units.room();
    alignas(64) float found[3][packet_points];
    units.bring(found_, found_count_, found);
    for (int first = 0; first < packet_points; first += native_lanes) {
      V x = reach.at(0, first), y = reach.at(1, first), z = reach.at(2, first), least(most);
      for (int i = 0; i < found_count_; ++i) {
        V a = x - V(found[0][i]), b = y - V(found[1][i]), c = z - V(found[2][i]);
        V square = multiply_add<Grade::fast>(c, c, multiply_add<Grade::fast>(b, b, a * a));
        least = min(multiply_add<Grade::fast>(square, V(1.0f + 0x1p-7f), V(512.0f * room * room)), least);
      }
      select(first_lanes_of(packet, first), least, V(-1.0f)).store(limit + first);
    }
  }
  static FloatMask<native_lanes> first_lanes_of(const Packet& packet, int first) {
    const int left = packet.size > first ? packet.size - first : 0;
    return FloatMask<native_lanes>::from_bits(first_lanes<native_lanes>(static_cast<std::size_t>(left)));
  }

  // A point that was found before lies on a triangle but for its rounding, so the square of its distance to this one,
  // with some room, is a bound: (x + y)² <= (1 + 2^-8)·x² + (1 + 2^8)·y² without a root. Not the last one, for which
  // the processor would have to wait.
  double bound_by_before_last(const Place& point) const {
    if (!before_last_) return std::numeric_limits<double>::infinity();
    const double room = points_.room_of(point);
    double square = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double off = points_.distance_along(point, before_last_.point, axis);
      square += off * off;
    }
    return square * (1.0 + 0x1p-8) + room * room * 257.0;
  }

  Points points_;
  typename Points::Triangles corners_;
  const Counters& counters_;
  double max_distance_, max_squared_, widest_squared_;
  Closest last_, before_last_;
  Number found_[3][packet_points] = {};  // by the packet before
  int found_count_ = 0;
  bool is_first_ = true;
};

template <class Points, class Counters>
[[gnu::flatten, gnu::noinline]] void closest_of_points(const typename Points::Tree& tree,
                                                       const PointBatchOf<typename Points::Number>& batch) {
  TraceBatch counting;
  counting.counters = batch.counters;
  const Counters counters(counting);
  PointsInTree<Points, Counters> points(tree, batch, counters);
  typename Points::Packet packet;
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
    if (!takes_part(batch.active, i)) continue;
    PointOf<typename Points::Number> point;
    __builtin_memcpy(&point, batch.points + i * batch.stride, sizeof point);
    points.take(point, i, packet, batch);
    if (packet.size == packet_points) points.answer(packet, batch.closest);
  }
  if (packet.size > 0) points.answer(packet, batch.closest);
}

}  // namespace
}  // namespace raylanes
