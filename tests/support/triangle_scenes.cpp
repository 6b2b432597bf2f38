#include "triangle_scenes.hpp"

namespace raylanes::testing {

void TriangleScene::scale(float factor) {
  for (Ray& each : rays)
    for (int axis = 0; axis < 3; ++axis) each.origin[axis] *= factor, each.direction[axis] *= factor;
  for (Triangle& each : triangles)
    for (auto& corner : each.corner)
      for (float& x : corner) x *= factor;
}

namespace {

// In barycentric weight: 16 times what a test in floats can resolve at the size of these triangles.
constexpr double step_off_edge = 16 * 20 * 0x1p-24;

// The major axis is a matter of convention.
Ray ray_with_tied_axes(const Triangle& target, Random& random) {
  const float size = random.number(0.5f, 2);
  Float3 direction, origin;
  for (float& d : direction) d = random.chance(0.5) ? size : -size;
  if (random.chance(0.7)) direction[random.index(3)] *= random.number(-1, 1);
  const float u = random.number(-0.3f, 1), v = random.number(-0.3f, 1);
  const auto& [a, b, c] = target.corner;
  for (std::size_t axis = 0; axis < 3; ++axis)
    origin[axis] = a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]) - direction[axis];
  return make_ray(origin, direction);
}

Ray aimed_ray(Aim aim, const Float3& origin, const Triangle& target, Random& random) {
  const double u = random.real(0, 1), v = random.real(0, 1);
  switch (aim) {
    case Aim::tied_axes:
      return ray_with_tied_axes(target, random);
    case Aim::edge:
      return ray_to(origin, target, u, random.chance(0.5) ? 0 : 1 - u);
    case Aim::corner:
      return ray_to(origin, target, random.integer(0, 1), 0);
    case Aim::off_edge:
      return ray_to(origin, target, u, random.chance(0.5) ? step_off_edge : -step_off_edge);
    case Aim::beside_a_tiny_one:
      return ray_to(origin, target, 500 * (u - 0.5), 500 * (v - 0.5));
    default:
      return ray_to(origin, target, 1.6 * u - 0.3, 1.6 * v - 0.3);
  }
}

}  // namespace

TriangleScene aimed_scene(Aim aim, std::size_t rays, std::size_t triangles, Random& random) {
  TriangleScene scene;
  const Float3 centre = aim == Aim::far ? Float3{1e4f, -2e4f, 3e3f} : Float3{0, 0, 0};
  const bool tiny = aim == Aim::small_and_distant || aim == Aim::beside_a_tiny_one;
  for (std::size_t i = 0; i < triangles; ++i)
    scene.triangles.push_back(
        tiny ? random.triangle(aim == Aim::small_and_distant ? 1e-3f : 1e-5f, random.point(1))
             : random.triangle(1, centre));
  for (std::size_t i = 0; i < rays; ++i) {
    const Float3 origin = random.point(tiny ? 8.0f : 2.0f, centre);
    Ray ray = aimed_ray(aim, origin, scene.triangles[i % triangles], random);
    if (random.chance(0.2))
      for (float& x : ray.direction) x = -x;
    if (random.chance(0.2)) ray.tmin = random.number(-2, 2);
    if (random.chance(0.2)) ray.tmax = random.number(0.5f, 2);
    scene.rays.push_back(ray);
  }
  return scene;
}

TriangleScene scene_for_all_widths(Aim aim, Random& random) {
  TriangleScene scene = aimed_scene(aim, 19, 19, random);
  scene.triangles.back() = scene.triangles.front();
  return scene;
}

}  // namespace raylanes::testing
