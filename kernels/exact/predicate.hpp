// Whether a ray hits or crosses a triangle, and where, in exact arithmetic on the floats or doubles given. For what a
// screen leaves undecided, because it is slow: a fifth of a microsecond; seven times that if exponents of floats lie
// far apart, 200 times that if exponents of doubles do.
#pragma once

namespace raylanes::detail {

template <class T>
struct ExactHit {
  bool hit = false;
  T t = 0, u = 0, v = 0;  // rounded once, to nearest
};

// det != 0, no two weights of opposite sign, tmin <= t <= tmax; tmin and tmax are finite. Components in any order, the
// same for all vectors: the sign of the order cancels. A corner that is not finite is a miss. Baseline code: the
// functions here are all that paths call outside their objects.
template <class T>
ExactHit<T> decide_exactly(const T (&origin)[3], const T (&direction)[3], const T (&corners)[9], T tmin,
                           T tmax);

// The relation of a ray to a triangle if each passage through a surface counts once: docs/crossings.md.
struct ExactCrossing {
  int side =
      0;  // 1 along the normal (v1 - v0) × (v2 - v0), -1 against it; 0: no crossing, or not from tmin to tmax
  bool is_at_origin = false;  // the plane of the triangle holds the origin: a crossing is at t = 0
  bool holds_origin = false;  // and so does the triangle
  unsigned zero_weights =
      0;  // of a crossing: bit k if the ray passes through the line of the edge opposite corner k
};

// Components as they are stored: which one is moved how far matters, and so does their order for the sign. A direction
// in the plane of the triangle, or through an edge, is moved by (e, e², e³), e positive and smaller than any number
// (Edelsbrunner, Mücke 1990). A triangle without an area is not crossed, and holds nothing.
template <class T>
ExactCrossing cross_exactly(const T (&origin)[3], const T (&direction)[3], const T (&corners)[9], T tmin,
                            T tmax);

// The sign of d · (v1 − v0) × (v2 − v0): -1 if the ray comes to the front of the triangle, 1 if to its back, 0 if along
// its plane, or if the triangle is not finite. Components as they are stored, as cross_exactly() takes them.
template <class T>
int side_exactly(const T (&direction)[3], const T (&corners)[9]);

}  // namespace raylanes::detail
