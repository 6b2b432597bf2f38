// Whether two tracers disagree about a ray, and whether rounding excuses it.
#pragma once

#include <raylanes/mesh.hpp>
#include <raylanes/types.hpp>

#include "exact_triangle.hpp"

namespace raylanes::oracle {

// True if one hits and the other misses, or both hit and their t differ by more than 1e-4 of the larger |t|. Different
// primitives at the same t (coincident surfaces, shared edges) are no disagreement. A NaN t is a disagreement.
// Why 1e-4: two tests of one triangle differ in t by up to (B_T + |t|·B_det)/|det| each. That is about 7u·P/|det|
// relative (u = 2^-24, P the permanent of det). So 1e-4 passes every triangle with P/|det| below about 100, seen at up
// to about 89 degrees from its normal. Use explain() for larger differences: it decides by the bounds of the triangle.
bool disagree(const Hit& ours, const Hit& theirs);

enum class Excuse {
  none_needed,          // they do not disagree
  same_depth,           // both hit, and their t differ by no more than the rounding bounds of the two tests
  edge_rounding,        // a triangle only one accepted has an edge within rounding of the ray
  depth_rounding,       // its t is within rounding of tmin or tmax
  degenerate_triangle,  // its det is within rounding of 0: edge-on, degenerate or out of the range of floats
  modes_apart,          // of a test without that promise one mode decides otherwise than another
  ours_wrong,           // exact arithmetic says that our tracer is wrong
  theirs_wrong          // exact arithmetic says that the other is
};

struct Explanation {
  Excuse excuse;
  std::string sentence;  // one line for people: which triangle, who accepted it, why that may be
};

// Judges a disagreement by exact arithmetic on the triangles that the tracers report, each tracer by the bounds of its
// own form. A tracer is wrong if it reports a triangle that it had to miss, or a t outside its bound. It is also wrong
// if it passes over a triangle that it had to hit, even if a box test culled it. Throws std::invalid_argument if a hit
// names a primitive that the mesh does not have.
Explanation explain(const Ray& ray, std::span<const Float3> vertices, std::span<const Index3> triangles,
                    const Hit& ours, Form our_form, const Hit& theirs, Form their_form);

}  // namespace raylanes::oracle
