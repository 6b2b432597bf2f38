#include "answers.hpp"

#include <gtest/gtest.h>

namespace raylanes::testing {

SphereResult result_of(IntervalColumns& columns, std::size_t i) {
  const BoxResult r = columns[i];
  return {r.entry, r.exit, r.hit};
}

SphereColumns::SphereColumns(std::span<const Sphere> spheres, Place place)
    : size_(spheres.size()), values_(4, spheres.size(), place) {
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t i = 0; i < spheres.size(); ++i) values_[c][i] = spheres[i].value[c];
    pointers_[c] = values_[c];
  }
}

std::vector<SphereResult> answers(const SphereVariant& variant, std::span<const Ray> rays,
                                  std::span<const Sphere> spheres, Place place) {
  RayColumns ray_columns(rays, place);
  const SphereColumns sphere_columns(spheres, place);
  const SphereRow& row = variant.kernels();
  std::vector<SphereResult> results(rays.size() * spheres.size());
  IntervalColumns of_rays(rays.size(), place), of_spheres(spheres.size(), place), any_ray(rays.size(), place),
      any_sphere(spheres.size(), place);
  for (std::size_t s = 0; s < spheres.size(); ++s) {
    row.distances_of_rays(ray_columns.arrays(), spheres[s].value, nullptr, of_rays.bits(), of_rays.from(),
                          of_rays.to());
    row.any_of_rays(ray_columns.arrays(), spheres[s].value, nullptr, any_ray.bits());
    for (std::size_t r = 0; r < rays.size(); ++r) {
      results[s * rays.size() + r] = result_of(of_rays, r);
      EXPECT_EQ(any_ray.is_hit(r), of_rays.is_hit(r)) << variant.name() << ": any of rays";
    }
  }
  for (std::size_t r = 0; r < rays.size(); ++r) {
    row.distances_of_spheres(rays[r], sphere_columns.columns(), spheres.size(), nullptr, of_spheres.bits(),
                             of_spheres.from(), of_spheres.to());
    row.any_of_spheres(rays[r], sphere_columns.columns(), spheres.size(), nullptr, any_sphere.bits());
    for (std::size_t s = 0; s < spheres.size(); ++s) {
      EXPECT_EQ(result_of(of_spheres, s), results[s * rays.size() + r])
          << variant.name() << ": the two shapes differ";
      EXPECT_EQ(any_sphere.is_hit(s), of_spheres.is_hit(s)) << variant.name() << ": any of spheres";
    }
  }
  for (IntervalColumns* out : {&of_rays, &of_spheres, &any_ray, &any_sphere})
    EXPECT_TRUE(out->are_intact()) << variant.name();
  return results;
}

std::vector<SphereResult> answers(const SphereVariant& variant, std::span<const Ray> rays,
                                  std::span<const Sphere> spheres, FloatMode mode) {
  const FloatModeScope scope(mode);
  return answers(variant, rays, spheres);
}

std::vector<bool> line_answers(const Path& path, Grade grade, std::span<const Ray> rays,
                               std::span<const Sphere> spheres, FloatMode mode) {
  const FloatModeScope scope(mode);
  const SphereColumns columns(spheres);
  std::vector<std::uint8_t> bits(spheres.size() / 8 + 1);
  std::vector<bool> results(rays.size() * spheres.size());
  for (std::size_t r = 0; r < rays.size(); ++r) {
    path.kernels.spheres.line_of_spheres[static_cast<std::size_t>(grade)](
        rays[r], columns.columns(), spheres.size(), nullptr, bits.data());
    for (std::size_t s = 0; s < spheres.size(); ++s) results[s * rays.size() + r] = is_set(bits, s);
  }
  return results;
}

Hit closest_answer(const SphereVariant& variant, const Ray& ray, std::span<const Sphere> spheres) {
  const SphereColumns columns(spheres);
  Hit nearest;
  variant.kernels().closest_of_spheres(ray, columns.columns(), spheres.size(), nullptr, nearest);
  return nearest;
}

SphereScene sphere_scene(double distance, Random& random) {
  SphereScene scene;
  for (int i = 0; i < 9; ++i) {
    const Float3 centre = random.point(3);
    const float radius = random.number(0.5f, 2);
    scene.spheres.push_back(ball(centre, radius));
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
