#include "answers.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace raylanes::testing {

SphereColumns::SphereColumns(std::span<const Sphere> spheres, Place place)
    : values_(4, spheres.size(), place) {
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t i = 0; i < spheres.size(); ++i) values_[c][i] = spheres[i].value[c];
    pointers_[c] = values_[c];
  }
}

std::vector<SphereResult> answers(const SphereVariant& variant, std::span<const Ray> rays,
                                  std::span<const Sphere> spheres, Place place) {
  RayColumns ray_columns(rays, place);
  const SphereColumns sphere_columns(spheres, place);
  std::vector<SphereResult> results(rays.size() * spheres.size());
  const std::size_t most = std::max(rays.size(), spheres.size());
  BoxHitColumns out(most, place);  // two floats and a flag, too
  const BoxHitArrays to = out.arrays();
  std::vector<std::uint8_t> bits(most / 8 + 1);
  for (std::size_t s = 0; s < spheres.size(); ++s) {
    distances(variant.kernels(), ray_columns.arrays(), rays.size(), spheres[s].value,
              {to.entry, to.exit, to.hit});
    any_hits(variant.kernels().any_of_rays, ray_columns.arrays(), rays.size(), spheres[s].value, bits.data());
    for (std::size_t r = 0; r < rays.size(); ++r) {
      results[s * rays.size() + r] = {out[r].entry, out[r].exit, out[r].hit};
      EXPECT_EQ(is_set(bits, r), out[r].hit != 0) << variant.name() << ": any of rays";
    }
  }
  for (std::size_t r = 0; r < rays.size(); ++r) {
    distances(variant.kernels(), rays[r], sphere_columns.columns(), spheres.size(),
              {to.entry, to.exit, to.hit});
    any_hits(variant.kernels().any_of_spheres, rays[r], sphere_columns.columns(), 4, spheres.size(),
             bits.data());
    for (std::size_t s = 0; s < spheres.size(); ++s) {
      EXPECT_EQ((SphereResult{out[s].entry, out[s].exit, out[s].hit}), results[s * rays.size() + r])
          << variant.name() << ": the two forms differ";
      EXPECT_EQ(is_set(bits, s), out[s].hit != 0) << variant.name() << ": any of spheres";
    }
  }
  EXPECT_TRUE(out.are_intact()) << variant.name();
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
    any_hits(path.kernels.spheres.line_of_spheres[static_cast<std::size_t>(grade)], rays[r],
             columns.columns(), 4, spheres.size(), bits.data());
    for (std::size_t s = 0; s < spheres.size(); ++s) results[s * rays.size() + r] = is_set(bits, s);
  }
  return results;
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
