// Every box form on rays and boxes: one result per pair, by all loops at once, which must agree; and boxes
// with rays that graze them.
#pragma once

#include <span>
#include <vector>

#include "../dispatch/intersect.hpp"
#include "columns.hpp"
#include "float_modes.hpp"
#include "generators.hpp"
#include "variants.hpp"

namespace raylanes::testing {

using BoxVariant = Variant<BoxTest>;

// [lo hi] as the loops take them.
std::vector<const float*> columns_of(BoxColumns& boxes);

// All rays of box 0, all rays of box 1 …. Adds a test failure where loops disagree or write outside.
std::vector<BoxResult> answers(const BoxVariant& variant, std::span<const Ray> rays,
                               std::span<const Box> boxes, Place place = Place::unguarded);
std::vector<BoxResult> answers(const BoxVariant& variant, std::span<const Ray> rays,
                               std::span<const Box> boxes, FloatMode mode);

// In [-1, 1)³; each extent is zero with the given probability.
Box random_box(Random& random, double flat_share);

// Through a point of an edge or a corner of the box, from about `scale` away; with `sun` along an axis.
Ray grazing_ray(const Box& box, float scale, bool sun, Random& random);

}  // namespace raylanes::testing
