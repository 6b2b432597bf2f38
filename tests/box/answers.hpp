// Every box test on rays and boxes: one result per pair, by all kernels at once, which must agree; and boxes
// with rays that graze them.
#pragma once

#include <span>
#include <vector>

#include <raylanes/intersect.hpp>

#include "../support/float_modes.hpp"
#include "../support/random_input.hpp"
#include "../support/soa.hpp"
#include "../support/variants.hpp"

namespace raylanes::testing {

using BoxVariant = Variant<BoxTest>;

// In both grades, on every path.
std::vector<BoxVariant> conservative_variants();

// [lo hi] as the kernels take them.
std::vector<const float*> columns_of(BoxColumns& boxes);

// All rays of box 0, all rays of box 1 …, by the intervals of both shapes, which must agree. Adds a test failure where
// they do not, or write outside.
std::vector<BoxResult> intervals_alone(const BoxVariant& variant, std::span<const Ray> rays,
                                       std::span<const Box> boxes, Place place = Place::unguarded);

// The same, and yes or no by both shapes, which must agree with them.
std::vector<BoxResult> answers(const BoxVariant& variant, std::span<const Ray> rays,
                               std::span<const Box> boxes, Place place = Place::unguarded);
std::vector<BoxResult> answers(const BoxVariant& variant, std::span<const Ray> rays,
                               std::span<const Box> boxes, FloatMode mode);

// In [-1, 1)³; each extent is zero with the given probability.
Box random_box(Random& random, double flat_share);

// Through a point of an edge or a corner of the box, from about `scale` away; with `sun` along an axis.
Ray grazing_ray(const Box& box, float scale, bool sun, Random& random);

struct BoxScene {
  std::vector<Ray> rays;
  std::vector<Box> boxes;
  std::size_t size() const { return rays.size() * boxes.size(); }
  const Ray& ray(std::size_t pair) const { return rays[pair % rays.size()]; }
  const Box& box(std::size_t pair) const { return boxes[pair / rays.size()]; }
};

// Ray i grazes box i % boxes. Two boxes of five may be flat.
BoxScene grazing_scene(std::size_t rays, std::size_t boxes, float scale, bool sun, Random& random);

// As many rays as boxes, all of them grazing the first.
BoxScene scene_around_one_box(std::size_t count, Random& random);

}  // namespace raylanes::testing
