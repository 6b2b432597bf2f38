// The points of a batch through a tree: those that come one after the other and are neighbours together, others alone.
#pragma once

#include "../../dispatch/bits.hpp"
#include "one_point.hpp"
#include "packet_in_tree.hpp"

namespace raylanes {
namespace {

template <class Counters>
class PointsInTree {
 public:
  PointsInTree(const TreeView& tree, const PointBatch& batch, const Counters& counters)
      : tree_(tree),
        corners_(tree),
        counters_(counters),
        max_squared_(batch.max_squared),
        largest_(largest_coordinate(tree)),
        widest_squared_(square_of_diagonal(tree.bounds) * (widest_packet * widest_packet)) {}

  // A packet's answers, and an empty packet. Out of line, as it is long and asked for twice.
  [[gnu::flatten, gnu::noinline]] void answer(PointPacket& packet, ClosestPoint* closest) {
    packet.fill();
    bool is_together = false;
    if constexpr (packet_points > 1)
      is_together =
          !is_first_ && packet.size >= min_together && square_of_diagonal(packet.bounds()) <= widest_squared_;
    ClosestPoint found[packet_points];
    if constexpr (packet_points > 1)
      if (is_together) find_together(packet, found);
    if (!is_together)
      for (int i = 0; i < packet.size; ++i) found[i] = this->closest(packet.point(i));
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

  // Whether anything can be close to that point.
  bool is_sought(const Float3& point) const { return raylanes::is_sought(tree_, point, max_squared_); }

 private:
  // A packet whose box has a diagonal of more than that share of the tree's, or of few points, shares too little; the
  // first one is not bounded: measured, docs/queries.md.
  static constexpr double widest_packet = 0.2;
  static constexpr int min_together = packet_points / 4;
  // The most that points found lose if their coordinates are subnormal, also in modes that flush these.
  static constexpr float flushed_from_found = 0x1p-125f;

  ClosestPoint closest(const Float3& point) {
    const ClosestPoint found =
        closest_to_point(tree_, point, largest_, max_squared_, bound_by_before_last(point), counters_);
    if (found) before_last_ = last_, last_ = found;
    return found;
  }

  void find_together(const PointPacket& packet, ClosestPoint (&found)[packet_points]) {
    const Box box = packet.bounds();
    const float scale = scale_to_four(largest_magnitude(box.lo, largest_magnitude(box.hi, largest_)));
    BoxDistance<node_lanes> boxes(box, scale);
    alignas(64) float limit[packet_points];
    bound_by_packet_before(packet, scale, boxes.limit(max_squared_), limit);
    NearPacket<Counters> near(packet, scale, limit, max_squared_, counters_);
    walk_nodes(tree_, boxes, near, counters_, [&](const WaitingBox& leaf) {
      near.visit(corners_, leaf);
      return false;
    });
    near.answer(corners_, found);
  }

  // For each lane, in units, by all points that the packet before found: as bound_by_before_last, where no coordinate
  // is above 4 and floats round besides.
  void bound_by_packet_before(const PointPacket& packet, float scale, float most,
                              float (&limit)[packet_points]) const {
    using V = Floats<native_lanes>;
    const float room = 0x1p-18f + flushed_from_found * scale;
    for (int first = 0; first < packet_points; first += native_lanes) {
      const auto load = [&](int axis) { return V::load(packet.coordinate[axis] + first) * V(scale); };
      V x = load(0), y = load(1), z = load(2), least(most);
      for (int i = 0; i < found_count_; ++i) {
        V a = x - V(found_[0][i] * scale), b = y - V(found_[1][i] * scale), c = z - V(found_[2][i] * scale);
        V square = multiply_add<Grade::fast>(c, c, multiply_add<Grade::fast>(b, b, a * a));
        least = min(multiply_add<Grade::fast>(square, V(1.0f + 0x1p-7f), V(512.0f * room * room)), least);
      }
      select(first_lanes_of(packet, first), least, V(-1.0f)).store(limit + first);
    }
  }
  static FloatMask<native_lanes> first_lanes_of(const PointPacket& packet, int first) {
    const int left = packet.size > first ? packet.size - first : 0;
    return FloatMask<native_lanes>::from_bits(first_lanes<native_lanes>(static_cast<std::size_t>(left)));
  }

  // A point that was found before lies on a triangle but for its rounding, so the square of its distance to this one,
  // with some room, is a bound: (x + y)² <= (1 + 2^-8)·x² + (1 + 2^8)·y² without a root. Not the last one, for which
  // the processor would have to wait.
  double bound_by_before_last(const Float3& point) const {
    if (!before_last_) return std::numeric_limits<double>::infinity();
    const double room =
        static_cast<double>(largest_magnitude(point, largest_)) * 0x1p-20 + double{flushed_from_found};
    double square = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double off = static_cast<double>(point[axis]) - static_cast<double>(before_last_.point[axis]);
      square += off * off;
    }
    return square * (1.0 + 0x1p-8) + room * room * 257.0;
  }

  static double square_of_diagonal(const Box& box) {
    double square = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double off = static_cast<double>(box.hi[axis]) - static_cast<double>(box.lo[axis]);
      square += off * off;
    }
    return square;
  }

  const TreeView& tree_;
  TreeTriangles corners_;
  const Counters& counters_;
  double max_squared_;
  float largest_;
  double widest_squared_;
  ClosestPoint last_, before_last_;
  float found_[3][packet_points];  // by the packet before
  int found_count_ = 0;
  bool is_first_ = true;
};

template <class Counters>
[[gnu::flatten, gnu::noinline]] void closest_of_points(const TreeView& tree, const PointBatch& batch) {
  TraceBatch counting;
  counting.counters = batch.counters;
  const Counters counters(counting);
  PointsInTree<Counters> points(tree, batch, counters);
  PointPacket packet;
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
    Float3 point;
    __builtin_memcpy(&point, batch.points + i * batch.stride, sizeof point);
    if (points.is_sought(point))
      packet.add(point, i);
    else
      batch.closest[i] = {};
    if (packet.size == packet_points) points.answer(packet, batch.closest);
  }
  if (packet.size > 0) points.answer(packet, batch.closest);
}

}  // namespace
}  // namespace raylanes
