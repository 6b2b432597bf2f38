// A tree of doubles as searches for closest points see it. Boxes are in the frame, and floats say which triangles may
// be the nearest. Doubles decide, in units of a power of two in which no square overflows. docs/exact.md, part 7, has
// the bounds.
#pragma once

#include "../exact/pairs.hpp"
#include "../point/float_points.hpp"
#include "double_rays.hpp"

namespace raylanes {
namespace {

// Triangles in units of 1 / scale, a power of two.
struct ScaledTriangles {
  DoubleTriangles triangles;
  double scale;

  double number(int k, std::uint32_t leaf_triangle) const {
    return triangles.number(k, leaf_triangle) * scale;
  }
  std::uint32_t primitive(std::uint32_t leaf_triangle) const { return triangles.primitive(leaf_triangle); }
  // Zeros of either sign are equal; subnormal numbers are what they are.
  bool has_equal_corners(std::uint32_t leaf_triangle) const {
    const auto differ = [&](int i, int j) {
      std::uint64_t bits = 0;
      for (int k = 0; k < 3; ++k) {
        const auto a = std::bit_cast<std::uint64_t>(triangles.number(i + k, leaf_triangle)),
                   b = std::bit_cast<std::uint64_t>(triangles.number(j + k, leaf_triangle));
        bits |= (a | b) << 1 != 0 ? a ^ b : 0;
      }
      return bits != 0;
    };
    return !(differ(0, 3) && differ(3, 6) && differ(6, 0));
  }
  // From these units. Weights may add up to a little more than 1, which must not overflow.
  void to_units_of_mesh(ClosestPointD& closest) const {
    constexpr double most = std::numeric_limits<double>::max();
    const double inverse = 1.0 / scale;
    closest.distance = __builtin_sqrt(closest.distance_squared) * inverse;
    closest.distance_squared = closest.distance_squared * inverse * inverse;
    for (double& x : closest.point) {
      x *= inverse;
      x = x > most ? most : x < -most ? -most : x;
    }
  }
};

class DoublePoints {
  static constexpr int N = node_lanes, half = half_of<N>;

 public:
  using Number = double;
  using Tree = DoubleTreeView;
  using Triangles = ScaledTriangles;
  using Decided = Doubles<half>;
  static constexpr int decided = half;

  // A point in units of 1 / scale, and in the frame. The farthest have units of their own, and come to all leaves.
  struct Place {
    Double3 exact;
    double scale;
    Float3 at;
    bool is_farthest;
  };
  struct Packet : PointPacket {
    double exact[3][packet_points];
  };

  [[gnu::noinline]] explicit DoublePoints(const DoubleTreeView& tree) : tree_(tree) {
    const int low = exponent_of_largest(tree.bounds.lo), high = exponent_of_largest(tree.bounds.hi);
    exponent_ = low > high ? low : high;
    const int power = power_for(exponent_), span = tree.frame.power - power;
    scale_ = power_of_two(power), reach_ = times_power(1.0, exponent_ + 1 + power);
    per_unit_ = power_of_two(span);
    largest_ = largest_magnitude(tree.tree.bounds.lo, largest_magnitude(tree.tree.bounds.hi, 0.5f));
    if (tree.frame.power > 1000) largest_ = static_cast<float>(power_of_two(tree.frame.power - 1000));
  }

  const TreeView& nodes() const { return tree_.tree; }
  float largest() const { return largest_; }
  ScaledTriangles triangles() const { return {DoubleTriangles(tree_), scale_}; }
  ScaledTriangles triangles_for(const Place& point) const { return {DoubleTriangles(tree_), point.scale}; }
  BoxDistance<N> boxes(const Place& point) const {
    return {point.at, point.is_farthest ? 2.0f : largest_, point.is_farthest ? 0x1p-399 : per_unit_};
  }
  BoxDistance<N> boxes(const Box& points, float scale) const { return {points, scale, per_unit_}; }
  double max_squared(double distance) const { return max_squared_in(distance, scale_); }
  static double max_squared(const Place& point, double distance) {
    return max_squared_in(distance, point.scale);
  }

  static bool is_number(const Double3& point) { return is_finite(point); }
  Place place_of(const Double3& point) const {
    Place place{{}, scale_, {}, false};
    bool is_near = true;
    for (std::size_t k = 0; k < 3; ++k) {
      place.exact[k] = point[k] * scale_;
      const double x = place.exact[k] * per_unit_ - tree_.frame.centre[k];
      is_near = is_near && x <= 0x1p60 && x >= -0x1p60;
      place.at[k] = static_cast<float>(x);
    }
    if (!is_near) [[unlikely]]
      return far_place_of(point);
    return place;
  }
  Place place_of(const Packet& packet, int i) const {
    return {{packet.exact[0][i], packet.exact[1][i], packet.exact[2][i]}, scale_, packet.point(i), false};
  }
  // As FloatPoints has them. In the frame the tree has the size 1 to 2, if its own size is not extreme.
  bool is_compared_far(const Place& point) const {
    return !point.is_farthest && tree_.frame.power <= 900 && tree_.frame.power >= -900 &&
           is_distant(point.at, tree_.tree.bounds);
  }
  bool is_far(const Place& point) const { return point.is_farthest || is_compared_far(point); }
  Double3 in_space_of_nodes(const Place& point) const {
    Double3 at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = point.exact[k] * per_unit_ - tree_.frame.centre[k];
    return at;
  }
  double squared_in_space_of_nodes(double squared) const { return squared * per_unit_ * per_unit_; }
  static const Double3& exact_of(const Place& point) { return point.exact; }
  static void add(Packet& packet, const Place& point, std::size_t i) {
    for (std::size_t axis = 0; axis < 3; ++axis) packet.exact[axis][packet.size] = point.exact[axis];
    packet.add(point.at, i);
  }

  struct Rows {
    const double* numbers;
    std::uint32_t lanes;
  };
  static Rows rows_of(const ScaledTriangles& corners, TreeReference leaf) {
    const std::uint32_t first = DoubleTriangles::first_of(leaf_of(leaf));
    return {corners.triangles.numbers(first), DoubleTriangles::lanes(first)};
  }
  static const void* begin_of(const ScaledTriangles& corners, TreeReference leaf) {
    return corners.triangles.halves + leaf_of(leaf).block;
  }
  static std::uint32_t leaf_triangle(TreeReference leaf, int triangle) {
    return DoubleTriangles::first_of(leaf_of(leaf)) + static_cast<std::uint32_t>(triangle);
  }

  // Lanes of a row of corners by a function of doubles, rounded to floats. The lanes of half a leaf are there twice.
  template <class Function>
  static Floats<N> floats_of_row(const Rows& rows, int row, int first, const Function& function) {
    const double* const numbers = rows.numbers + first + static_cast<std::uint32_t>(row) * rows.lanes;
    const int second = N == tree_width ? static_cast<int>(rows.lanes) - half : half;
    return floats_of<N>([&](int at) { return function(Doubles<half>::load(numbers + at)); }, second);
  }
  // The difference from the centre of the frame is rounded once, in doubles.
  Floats<N> less_middle(const Rows& rows, int row, int first, float middle, float scale) const {
    using D = Doubles<half>;
    const D in_frame(power_of_two(tree_.frame.power)), unit(static_cast<double>(scale)),
        centre(tree_.frame.centre[static_cast<std::size_t>(row % 3)]), from(static_cast<double>(middle));
    return floats_of_row(rows, row, first, [&](D x) { return ((x * in_frame - centre) - from) * unit; });
  }

  // Corners less a point, in the units of BoxDistance, rounded to floats.
  struct ScaledCorners {
    Doubles<half> scale;
    Vec3<Doubles<half>> origin;  // in these units

    Vec3<Floats<N>> corner(const Rows& rows, int k, int first) const {
      const auto less = [&](int axis, const Doubles<half>& from) {
        return floats_of_row(rows, 3 * k + axis, first,
                             [&](Doubles<half> x) { return multiply_add<Grade::fast>(x, scale, -from); });
      };
      return {less(0, origin.x), less(1, origin.y), less(2, origin.z)};
    }
  };

  struct Before {
    ScaledCorners corners;
    Vec3<Doubles<half>> exact;
    float least_limit;

    Before(const Place& point, const BoxDistance<N>& boxes)
        : corners{Doubles<half>(point.scale * boxes.unit()), {}},
          exact(doubles_of<half>(point.exact)),
          least_limit(point.is_farthest ? std::numeric_limits<float>::max() : 0.0f) {
      Doubles<half> unit(boxes.unit());
      corners.origin = {exact.x * unit, exact.y * unit, exact.z * unit};
    }
    static Vec3<Floats<N>> in_units() { return {Floats<N>(0.0f), Floats<N>(0.0f), Floats<N>(0.0f)}; }
    float limit_of_boxes(float tmax) const { return tmax > least_limit ? tmax : least_limit; }
  };

  double room_of(const Place&) const { return room_of_found(); }
  double distance_along(const Place& point, const Double3& found, std::size_t axis) const {
    return point.exact[axis] - found[axis] * scale_;
  }

  // Points of a packet less its first one, which is exact but for a rounding to floats.
  class PacketUnits {
   public:
    static constexpr float share_of_square = error_of_floats + 0x1p-14f;
    float least_error;

    PacketUnits(const DoublePoints& points, const Packet& packet, const Box& box, float scale)
        : packet_(packet), scale_(points.scale_), unit_(static_cast<double>(scale) * points.per_unit_) {
      for (std::size_t k = 0; k < 3; ++k) first_[k] = packet.exact[k][0];
      const double widest = square_of_diagonal(box) * static_cast<double>(scale) * static_cast<double>(scale);
      least_error = static_cast<float>(widest * 0x1p-31 + 0x1p-70);
      room_ = static_cast<float>(0x1p-18 + points.room_of_found() * unit_);
    }
    Floats<native_lanes> at(int axis, int first) const {
      return relative(axis, packet_.exact[axis] + first, 1.0);
    }
    ScaledCorners corners() const {
      using D = Doubles<half>;
      return {D(scale_ * unit_), {D(first_[0] * unit_), D(first_[1] * unit_), D(first_[2] * unit_)}};
    }
    double exact(int axis, std::uint32_t i) const { return packet_.exact[axis][i]; }
    void bring(const double (&found)[3][packet_points], int, float (&to)[3][packet_points]) const {
      for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < packet_points; i += native_lanes)
          relative(axis, found[axis] + i, scale_).store(to[axis] + i);
    }
    float room() const { return room_; }

   private:
    // Coordinates in units of `scale`, in the units of boxes.
    Floats<native_lanes> relative(int axis, const double* x, double scale) const {
      using D = Doubles<half_of<native_lanes>>;
      return floats_of<native_lanes>(
          [&](int i) { return (D::load(x + i) * D(scale) - D(first_[axis])) * D(unit_); },
          half_of<native_lanes>);
    }

    const Packet& packet_;
    double scale_, unit_, first_[3];
    float room_;
  };

 private:
  // Coordinates become less than 2^401.
  static int power_for(int exponent) { return 400 - exponent < 1022 ? 400 - exponent : 1022; }
  [[gnu::noinline]] Place far_place_of(const Double3& point) const {
    const int of_point = exponent_of_largest(point);
    Place place{{}, power_of_two(power_for(of_point > exponent_ ? of_point : exponent_)), {}, true};
    for (std::size_t k = 0; k < 3; ++k) place.exact[k] = point[k] * place.scale;
    return place;
  }
  // The largest double that is at most the square of a distance, in units of 1 / scale.
  static double max_squared_in(double distance, double scale) {
    using One = Doubles<1>;
    if (!(distance >= 0.0)) return -1.0;
    const One scaled(distance * scale);
    const Pair<One> square = product_of(scaled, scaled);
    const double high = square.high.raw;
    const bool is_pair = high > 0x1p-900 && high < std::numeric_limits<double>::infinity();
    return is_pair && square.low.raw < 0.0 ? number_below(high) : high;
  }
  // In units of 1 / scale: six roundings of coordinates, and what is flushed from them.
  double room_of_found() const { return reach_ * 0x1p-48 + 0x1p-1020 * scale_; }

  const DoubleTreeView& tree_;
  int exponent_;          // of the largest coordinate
  double scale_, reach_;  // the latter at least that coordinate in units
  double per_unit_;       // a unit of 1 / scale in the frame
  float largest_;
};

}  // namespace
}  // namespace raylanes
