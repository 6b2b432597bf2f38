#include "box_answers.hpp"

namespace raylanes::testing {

std::vector<BoxVariant> conservative_variants() {
  std::vector<BoxVariant> variants = all_variants<BoxTest>();
  std::erase_if(variants, [](const BoxVariant& variant) { return variant.test != BoxTest::conservative; });
  return variants;
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
  for (std::size_t i = 0; i < boxes; ++i) scene.primitives.push_back(random_box(random, i % 5 < 2 ? 0.4 : 0));
  for (std::size_t i = 0; i < rays; ++i)
    scene.rays.push_back(grazing_ray(scene.primitives[i % boxes], scale, sun, random));
  return scene;
}

BoxScene scene_around_one_box(std::size_t count, Random& random) {
  BoxScene scene;
  for (std::size_t i = 0; i < count; ++i) {
    scene.primitives.push_back(random_box(random, 0.1));
    scene.rays.push_back(grazing_ray(scene.primitives[0], 2, false, random));
  }
  return scene;
}

}  // namespace raylanes::testing
