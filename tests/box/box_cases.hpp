// Rays and boxes with a name and a known answer, and every place and direction of one axis.
#pragma once

#include <raylanes/types.hpp>

#include "../support/testing.hpp"

namespace raylanes::testing {

inline constexpr Box unit_box{{-1, -1, -1}, {1, 1, 1}};

struct BoxCase {
  const char* name;
  Ray ray;
  Box box;
  bool hit;
  bool far = false;  // beyond what the directional test asks of t beside an axis without direction
};
std::span<const BoxCase> box_cases();

// The place and the motion of unit_box on the other two axes: inside and still, crossing, outside and moving in,
// outside and still, on a face and still.
struct AxisState {
  float origin, direction;
};
inline constexpr AxisState axis_states[] = {{0, 0.0f}, {0, -0.0f}, {0.25f, 1}, {-3, 1},
                                            {3, 0.0f}, {1, -0.0f}, {-1, 0.0f}};

// On `axis`, below, on, inside, on and above unit_box, with each kind of direction, NaN and infinite among
// them; the next axis and the last in the given states.
std::vector<Ray> rays_of_one_axis(int axis, const AxisState& next, const AxisState& last);

}  // namespace raylanes::testing
