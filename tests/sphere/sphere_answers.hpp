// The sphere tests under test, what is asked of spheres alone, and the scenes that they are tested with.
#pragma once

#include "../intervals/interval_answers.hpp"

namespace raylanes::testing {

using oracle::Sphere;
using SphereVariant = Variant<SphereTest>;
using SphereScene = IntervalScene<Sphere>;

inline Sphere ball(const Float3& centre, float radius) {
  return {{centre[0], centre[1], centre[2], signed_square(radius)}};
}

// Whether the line that the ray is part of meets each sphere, in the same order.
std::vector<bool> line_answers(const Path& path, Grade grade, std::span<const Ray> rays,
                               std::span<const Sphere> spheres, FloatMode mode = FloatMode::ieee);

// The nearest of the spheres.
Hit closest_answer(const SphereVariant& variant, const Ray& ray, std::span<const Sphere> spheres);

// Nine spheres, three rays for each from up to `distance` radii away, which pass within 1.2 radii of the
// centre.
SphereScene sphere_scene(double distance, Random& random);

}  // namespace raylanes::testing
