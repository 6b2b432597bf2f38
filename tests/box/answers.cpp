#include "answers.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace raylanes::testing {

std::vector<BoxVariant> conservative_variants() {
  std::vector<BoxVariant> variants = all_variants<BoxTest>();
  std::erase_if(variants, [](const BoxVariant& variant) { return variant.test != BoxTest::conservative; });
  return variants;
}

std::vector<const float*> columns_of(BoxColumns& boxes) {
  const BoxArrays a = boxes.arrays();
  return {a.lo[0], a.lo[1], a.lo[2], a.hi[0], a.hi[1], a.hi[2]};
}

std::vector<BoxResult> intervals_alone(const BoxVariant& variant, std::span<const Ray> rays,
                                       std::span<const Box> boxes, Place place) {
  RayColumns ray_columns(rays, place);
  BoxColumns box_columns(boxes, place);
  const BoxRow& row = variant.kernels();
  std::vector<BoxResult> results(rays.size() * boxes.size());
  IntervalColumns of_rays(rays.size(), place), of_boxes(boxes.size(), place);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    row.intervals_of_rays(ray_columns.arrays(), boxes[b].lo.data(), nullptr, of_rays.bits(), of_rays.from(),
                          of_rays.to());
    for (std::size_t r = 0; r < rays.size(); ++r) results[b * rays.size() + r] = of_rays[r];
  }
  for (std::size_t r = 0; r < rays.size(); ++r) {
    row.intervals_of_boxes(rays[r], columns_of(box_columns).data(), boxes.size(), nullptr, of_boxes.bits(),
                           of_boxes.from(), of_boxes.to());
    for (std::size_t b = 0; b < boxes.size(); ++b)
      EXPECT_EQ(of_boxes[b], results[b * rays.size() + r]) << variant.name() << ": the two shapes differ";
  }
  EXPECT_TRUE(of_rays.are_intact() && of_boxes.are_intact()) << variant.name();
  return results;
}

std::vector<BoxResult> answers(const BoxVariant& variant, std::span<const Ray> rays,
                               std::span<const Box> boxes, Place place) {
  const std::vector<BoxResult> results = intervals_alone(variant, rays, boxes, place);
  RayColumns ray_columns(rays, place);
  BoxColumns box_columns(boxes, place);
  IntervalColumns of_rays(rays.size(), place), of_boxes(boxes.size(), place);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    variant.kernels().any_of_rays(ray_columns.arrays(), boxes[b].lo.data(), nullptr, of_rays.bits());
    for (std::size_t r = 0; r < rays.size(); ++r)
      EXPECT_EQ(of_rays.is_hit(r), results[b * rays.size() + r].hit != 0)
          << variant.name() << ": any, ray " << r;
  }
  for (std::size_t r = 0; r < rays.size(); ++r) {
    variant.kernels().any_of_boxes(rays[r], columns_of(box_columns).data(), boxes.size(), nullptr,
                                   of_boxes.bits());
    for (std::size_t b = 0; b < boxes.size(); ++b)
      EXPECT_EQ(of_boxes.is_hit(b), results[b * rays.size() + r].hit != 0)
          << variant.name() << ": any, box " << b;
  }
  EXPECT_TRUE(of_rays.are_intact() && of_boxes.are_intact()) << variant.name();
  return results;
}

std::vector<BoxResult> answers(const BoxVariant& variant, std::span<const Ray> rays,
                               std::span<const Box> boxes, FloatMode mode) {
  const FloatModeScope scope(mode);
  return answers(variant, rays, boxes);
}

Box random_box(Random& random, double flat_share) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const float a = random.number(-1, 1), b = random.chance(flat_share) ? a : random.number(-1, 1);
    box.lo[axis] = std::min(a, b), box.hi[axis] = std::max(a, b);
  }
  return box;
}

Ray grazing_ray(const Box& box, float scale, bool sun, Random& random) {
  Float3 origin = random.point(2 * scale), direction;
  const int free_axis = random.integer(0, 3);
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    const double lo = box.lo[axis], hi = box.hi[axis];
    const double target = axis == free_axis ? random.real(lo, hi) : (random.chance(0.5) ? lo : hi);
    if (sun && axis != free_axis % 3) {
      origin[k] = random.chance(0.2) ? random.number(-2, 2) : static_cast<float>(target);
      direction[k] = random.chance(0.5) ? 0.0f : -0.0f;
    } else {
      direction[k] = static_cast<float>((target - static_cast<double>(origin[k])) / scale);
      if (direction[k] == 0) direction[k] = 1;
    }
  }
  return make_ray(origin, direction);
}

BoxScene grazing_scene(std::size_t rays, std::size_t boxes, float scale, bool sun, Random& random) {
  BoxScene scene;
  for (std::size_t i = 0; i < boxes; ++i) scene.boxes.push_back(random_box(random, i % 5 < 2 ? 0.4 : 0));
  for (std::size_t i = 0; i < rays; ++i)
    scene.rays.push_back(grazing_ray(scene.boxes[i % boxes], scale, sun, random));
  return scene;
}

BoxScene scene_around_one_box(std::size_t count, Random& random) {
  BoxScene scene;
  for (std::size_t i = 0; i < count; ++i) {
    scene.boxes.push_back(random_box(random, 0.1));
    scene.rays.push_back(grazing_ray(scene.boxes[0], 2, false, random));
  }
  return scene;
}

}  // namespace raylanes::testing
