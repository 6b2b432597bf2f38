#include "sphere_answers.hpp"

#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/spheres.hpp"

namespace raylanes::testing {

std::vector<bool> line_answers(const Path& path, Grade grade, std::span<const Ray> rays,
                               std::span<const Sphere> spheres, FloatMode mode) {
  const FloatModeScope scope(mode);
  const SphereColumns columns(spheres);
  std::vector<std::uint8_t> bits(spheres.size() / 8 + 1);
  std::vector<bool> results(rays.size() * spheres.size());
  for (std::size_t r = 0; r < rays.size(); ++r) {
    kernels_of(path).spheres.line_of_spheres[static_cast<std::size_t>(grade)](
        rays[r], columns.soa(), spheres.size(), nullptr, bits.data());
    for (std::size_t s = 0; s < spheres.size(); ++s) results[s * rays.size() + r] = is_set(bits, s);
  }
  return results;
}

Hit closest_answer(const SphereVariant& variant, const Ray& ray, std::span<const Sphere> spheres) {
  const SphereColumns columns(spheres);
  Hit nearest;
  variant.kernels().closest_of_spheres(ray, columns.soa(), spheres.size(), nullptr, nearest);
  return nearest;
}

SphereScene sphere_scene(double distance, Random& random) {
  SphereScene scene;
  for (int i = 0; i < 9; ++i) {
    const Float3 centre = random.point(3);
    const float radius = random.number(0.5f, 2);
    scene.primitives.push_back(ball(centre, radius));
    for (int k = 0; k < 3; ++k) {
      const Float3 away = random.point(1), side = random.point(1.2f);
      Float3 origin, direction;
      const float length = random.number(0.1f, 2);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        origin[axis] = static_cast<float>(static_cast<double>(centre[axis]) +
                                          distance * static_cast<double>(radius * away[axis]));
        direction[axis] = (centre[axis] + radius * side[axis] - origin[axis]) * length;
      }
      Ray ray = make_ray(origin, direction);
      if (random.chance(0.2)) ray.tmax = random.number(0, 2);
      if (random.chance(0.2)) ray.tmin = random.number(0, 2);
      scene.rays.push_back(ray);
    }
  }
  return scene;
}

}  // namespace raylanes::testing
