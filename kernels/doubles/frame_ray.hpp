// A ray of doubles in the frame of a tree, as the nodes there want it: in floats, rounded, with what that moves it by.
#pragma once

#include "../../dispatch/bits.hpp"
#include "../traverse/node_test.hpp"
#include "double_rays.hpp"

namespace raylanes {
namespace {

class FrameRay {
 public:
  Ray ray;
  float more = 0.0f;  // nodes are widened by this, too

  // From `begin` on, which is not before the ray's own.
  FrameRay(const TreeFrame& frame, const RayD& world, double begin) {
    const int exponent = exponent_of_largest(world.direction);
    power_ = frame.power + exponent;
    Double3 origin = frame.of(world.origin), direction;
    for (std::size_t k = 0; k < 3; ++k) direction[k] = times_power(world.direction[k], -exponent);
    double farthest = largest_of(origin), of_moves = 0.0;
    if (farthest > reach_of_frame) [[unlikely]] {
      if (farthest >= 0x1p48) {
        // Too far away to say which boxes it meets.
        ray.direction = {nan, nan, nan}, ray.tmin = -largest_t, ray.tmax = largest_t;
        return;
      }
      of_moves = farthest * 0x1p-50;
      move_to_tree(origin, direction);
      farthest = largest_of(origin);
    }
    more = static_cast<float>(farthest * (1.01 * 0x1p-24) + (of_moves + 0x1p-119));
    for (std::size_t k = 0; k < 3; ++k) {
      ray.origin[k] = static_cast<float>(origin[k]);
      ray.direction[k] = component(direction[k]);
    }
    const float from = rounded_down(t_in_frame(-number_above(-begin)));
    ray.tmin = (world.tmin >= 0.0 || skipped_ > 0.0) && !(from > 0.0f) ? 0.0f : from;
    ray.tmax = end_of(finite_tmax(world.tmax));
  }

  // At least the distance in the frame that rounds to t: the next double matters where t is subnormal, and rounded by
  // more than floats are. Nothing is clipped where it is not known.
  float end_of(double t) const {
    return ray.direction[0] == ray.direction[0] ? rounded_up(t_in_frame(number_above(t))) : largest_t;
  }

 private:
  static constexpr double reach_of_frame = 16.0;
  static constexpr float nan = std::numeric_limits<float>::quiet_NaN();

  double t_in_frame(double t) const { return times_power(t, power_) - skipped_; }
  // Not zero, unless the number is.
  static float component(double x) {
    constexpr float least = 0x1p-126f;
    if (size_bits(x) == 0 || !(x < static_cast<double>(least)) || !(x > -static_cast<double>(least)))
      return static_cast<float>(x);
    return x < 0.0 ? -least : least;
  }
  // To eight units before the point that is closest to the centre: the tree lies within four around it.
  void move_to_tree(Double3& origin, const Double3& direction) {
    double product = 0.0, square = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      product += origin[k] * direction[k], square += direction[k] * direction[k];
    const double length = __builtin_sqrt(square), by = -product / square - 8.0 / length;
    if (!(by > 0.0)) return;
    skipped_ = by;
    for (std::size_t k = 0; k < 3; ++k) origin[k] += by * direction[k];
  }

  int power_ = 0;
  double skipped_ = 0.0;
};

}  // namespace
}  // namespace raylanes
