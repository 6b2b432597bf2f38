// Whether a ray hits a triangle, and where, in exact arithmetic on the floats. Slow (a fifth of a microsecond; seven
// times that where the exponents lie far apart), for what floats and doubles leave undecided.
#pragma once

namespace raylanes::detail {

struct ExactHit {
  bool hit = false;
  float t = 0.0f, u = 0.0f, v = 0.0f;  // rounded once, to nearest
};

// det != 0, no two weights of opposite sign, tmin <= t <= tmax; tmin and tmax are finite. Components in any order, the
// same for all vectors: the sign of the order cancels. A corner that is not finite is a miss. Baseline code, the one
// function that paths call outside their objects.
ExactHit decide_exactly(const float (&origin)[3], const float (&direction)[3], const float (&corners)[9],
                        float tmin, float tmax);

}  // namespace raylanes::detail
