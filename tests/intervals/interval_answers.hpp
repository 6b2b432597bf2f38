// Boxes and spheres are asked alike: whether a ray meets them, and where it enters and leaves. Their tests share
// one result per pair, by all kernels at once, which must agree.
#pragma once

#include <raylanes/boxes.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

#include "../../bench/support/oracles/exact_sphere.hpp"
#include "../../dispatch/table/boxes.hpp"
#include "../../dispatch/table/spheres.hpp"
#include "../support/float_modes.hpp"
#include "../support/random_input.hpp"
#include "../support/soa.hpp"
#include "../support/variants.hpp"

namespace raylanes::testing {

// The four kernels of a row, by one name for both.
struct IntervalRow {
  decltype(BoxRow::any_of_boxes) any_of_primitives;
  decltype(BoxRow::any_of_rays) any_of_rays;
  decltype(BoxRow::intervals_of_boxes) of_primitives;
  decltype(BoxRow::intervals_of_rays) of_rays;
};
inline IntervalRow interval_row(const BoxRow& row) {
  return {row.any_of_boxes, row.any_of_rays, row.intervals_of_boxes, row.intervals_of_rays};
}
inline IntervalRow interval_row(const SphereRow& row) {
  return {row.any_of_spheres, row.any_of_rays, row.distances_of_spheres, row.distances_of_rays};
}

// The rays and primitives of a test.
template <class Test>
struct PrimitiveOfTest;
template <>
struct PrimitiveOfTest<BoxTest> {
  using type = Box;
};
template <>
struct PrimitiveOfTest<SphereTest> {
  using type = oracle::Sphere;
};
template <class Test>
using PrimitiveOf = typename PrimitiveOfTest<Test>::type;

// All rays of primitive 0, all rays of primitive 1 …. Adds a test failure where the shapes, or yes/no and intervals,
// disagree on what the contracts cover, and where an output is written outside.
template <class Test>
std::vector<IntervalResult> answers(const Variant<Test>& variant, std::span<const Ray> rays,
                                    std::span<const PrimitiveOf<Test>> primitives,
                                    Place place = Place::unguarded);
template <class Test>
std::vector<IntervalResult> answers(const Variant<Test>& variant, std::span<const Ray> rays,
                                    std::span<const PrimitiveOf<Test>> primitives, FloatMode mode) {
  const FloatModeScope scope(mode);
  return answers(variant, rays, primitives);
}

// Rays that are tested against each of some primitives; pairs are numbered as results are.
template <class Primitive>
struct IntervalScene {
  std::vector<Ray> rays;
  std::vector<Primitive> primitives;
  std::size_t size() const { return rays.size() * primitives.size(); }
  const Ray& ray(std::size_t pair) const { return rays[pair % rays.size()]; }
  const Primitive& primitive(std::size_t pair) const { return primitives[pair / rays.size()]; }
};

}  // namespace raylanes::testing
