// The box tests under test, and boxes with rays that graze them.
#pragma once

#include "../intervals/interval_answers.hpp"

namespace raylanes::testing {

using BoxVariant = Variant<BoxTest>;
using BoxScene = IntervalScene<Box>;

// In both grades, on every path.
std::vector<BoxVariant> conservative_variants();

// In [-1, 1)³; each extent is zero with the given probability.
Box random_box(Random& random, double flat_share);

// Through a point of an edge or a corner of the box, from about `scale` away; with `sun` along an axis.
Ray grazing_ray(const Box& box, float scale, bool sun, Random& random);

// Ray i grazes box i % boxes. Two boxes of five may be flat.
BoxScene grazing_scene(std::size_t rays, std::size_t boxes, float scale, bool sun, Random& random);

// As many rays as boxes, all of them grazing the first.
BoxScene scene_around_one_box(std::size_t count, Random& random);

}  // namespace raylanes::testing
