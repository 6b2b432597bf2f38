// A ray of doubles in the frame of a tree, as the nodes there want it: in floats, rounded, with what that moves it by.
#pragma once

#include "../../dispatch/bits.hpp"
#include "../exact/pairs.hpp"
#include "../traverse/node_test.hpp"
#include "double_rays.hpp"
#if defined(__AVX2__) && defined(__FMA__)
#include "../traverse/fused/fused_ray.hpp"
#endif

namespace raylanes {
namespace {

class FrameRay {
 public:
  Ray ray;
  float more = 0.0f;  // nodes are widened by this, too
  double begin;       // finite
  bool may_hit = false;

  // From `from` on, which is not before the ray's own begin.
  FrameRay(const DoubleTreeView& tree, const RayD& world, double from) : begin(finite_tmin(from)) {
    if (tree.tree.root == empty_reference || !(begin <= finite_tmax(world.tmax))) return;
#if defined(__AVX2__) && defined(__FMA__)
    may_hit = take_usual(tree.frame, world);
    if (may_hit) [[likely]]
      return;
#endif
    may_hit = is_valid(world);
    if (may_hit) take_any(tree.frame, world);
  }

  // The ray is valid. A component of the direction is zero only if it is zero in the world.
  [[gnu::noinline]] void take_any(const TreeFrame& frame, const RayD& world) {
    const int exponent = exponent_of_largest(world.direction);
    power_ = frame.power + exponent;
    Double3 origin = frame.of(world.origin), direction;
    for (std::size_t k = 0; k < 3; ++k) direction[k] = times_power(world.direction[k], -exponent);
    double farthest = largest_of(origin), of_moves = 0.0;
    const bool is_small = frame.power <= most_power && frame.power >= -most_power && exponent <= most_power &&
                          exponent >= -most_power;
    if (is_small && farthest <= reach_of_frame && world.tmin >= 0.0) scale_ = power_of_two(power_);
    if (farthest > reach_of_frame) [[unlikely]] {
      if (farthest >= 0x1p48) {
        // Too far away to say which boxes it meets.
        ray.direction = {nan, nan, nan}, ray.tmin = -largest_t, ray.tmax = largest_t;
        return;
      }
      of_moves = farthest * 0x1p-100;
      move_to_tree(frame, world, origin, direction);
      farthest = largest_of(origin);
    }
    more = static_cast<float>(farthest * of_rounding + (of_moves + min_widening));
    for (std::size_t k = 0; k < 3; ++k) {
      ray.origin[k] = static_cast<float>(origin[k]);
      ray.direction[k] = component(direction[k]);
    }
    const float start = rounded_down(t_in_frame(-number_above(-begin)));
    ray.tmin = (world.tmin >= 0.0 || skipped_ > 0.0) && !(start > 0.0f) ? 0.0f : start;
    ray.tmax = end_of(finite_tmax(world.tmax));
  }

  // Whether the ray begins near the tree, at its origin or behind it, and no product overflows or is flushed to less
  // than min_widening.
  bool is_usual() const {
    return scale_ > 0.0;
  }
  // At least the distance in the frame that rounds to t. Nothing is clipped where it is not known.
  float end_of(double t) const {
    return is_usual() ? rounded_up(t * scale_) : end_of_any(t);
  }

 private:
  static constexpr double reach_of_frame = 16.0, of_rounding = 1.01 * 0x1p-24, min_widening = 0x1p-119;
  static constexpr int most_power = 400;
  static constexpr float nan = std::numeric_limits<float>::quiet_NaN();

#if defined(__AVX2__) && defined(__FMA__)
  // The same at once of a usual ray. False, with nothing set, for other rays.
  bool take_usual(const TreeFrame& frame, const RayD& world) {
    using V = Lanes<double, 4>;
    using Words = Lanes<std::uint64_t, 4>;
    constexpr std::uint64_t exponent_bits = 0x7ff0000000000000ull, twice_one = 0x7fe0000000000000ull;
    if (!(world.tmin >= 0.0) || frame.power > most_power || frame.power < -most_power) return false;
    // tmin is behind the origin, tmax behind the direction, the power behind the centre.
    const auto* const numbers = reinterpret_cast<const double*>(&world);
    V o = V::load(numbers), d = V::load(numbers + 4), size = abs(d), largest = largest_of_three(size);
    const double scale = power_of_two(frame.power);
    V origin = o * V(scale) - V::load(reinterpret_cast<const double*>(&frame)), farthest = abs(origin);
    auto is_usual = (size <= V(0x1p400)) & (largest >= V(0x1p-400)) & (farthest <= V(reach_of_frame));
    if ((bits(is_usual) & 7u) != 7u) return false;
    Words exponent = as<std::uint64_t>(largest) & Words(exponent_bits);
    V direction = d * as<double>(Words(twice_one) - exponent);
    scale_ = scale * first_lane(as<double>(exponent));
    more = static_cast<float>(first_lane(largest_of_three(farthest)) * of_rounding + min_widening);
    const float start = rounded_down(begin * scale_);
    auto* const to = reinterpret_cast<float*>(&ray);
    blend<8>(to_four_floats(origin), Floats<4>(start > 0.0f ? start : 0.0f)).store(to);
    blend<8>(to_four_floats(direction), Floats<4>(end_of(finite_tmax(world.tmax)))).store(to + 4);
    return true;
  }
#endif

  // The next double matters where t is subnormal, or where the ray was moved, and is rounded by more than floats are.
  [[gnu::noinline]] float end_of_any(double t) const {
    return ray.direction[0] == ray.direction[0] ? rounded_up(t_in_frame(number_above(t))) : largest_t;
  }
  double t_in_frame(double t) const {
    return times_power(t, power_) - skipped_;
  }
  // Not zero, unless the number is.
  static float component(double x) {
    constexpr float least = 0x1p-126f;
    if (size_bits(x) == 0 || !(x < static_cast<double>(least)) || !(x > -static_cast<double>(least)))
      return static_cast<float>(x);
    return x < 0.0 ? -least : least;
  }
  // To eight units before the point that is closest to the centre: the tree lies within four around it.
  void move_to_tree(const TreeFrame& frame, const RayD& world, Double3& origin, const Double3& direction) {
    using One = Doubles<1>;
    double product = 0.0, square = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      product += origin[k] * direction[k], square += direction[k] * direction[k];
    const double length = __builtin_sqrt(square), by = -product / square - 8.0 / length;
    if (!(by > 0.0)) return;
    skipped_ = by;
    for (std::size_t k = 0; k < 3; ++k) {
      Pair<One> from = sum_of(One(times_power(world.origin[k], frame.power)), One(-frame.centre[k]));
      Pair<One> moved = from + product_of(One(by), One(direction[k]));
      origin[k] = (moved.high + moved.low).raw;
    }
  }

  int power_ = 0;
  double skipped_ = 0.0;
  double scale_ = 0.0;  // of distances of usual rays
};

}  // namespace
}  // namespace raylanes
