// How far it is out of a solid: a ball five million metres from the origin, in floats and in doubles.
#include <limits>

#include "common.hpp"

using namespace example;

// The next exit of a solid from the triangle where the ray came in, no farther than `limit`; a miss if there is none.
// An edge that the ray only touches is no exit. Cells that share faces need the exits of docs/crossings.md, because
// particles may enter a cell that their ray only touches.
template <class Tree, class Ray, class Hit, class T>
auto ray_fire(const Tree& solid, Ray ray, const Hit& here, T limit) {
  ray.tmax = limit;
  return solid.closest_crossing(ray, {.facing = raylanes::Facing::back, .skip = here});
}

// One picture: how thick the ball is along each ray, seen from above.
template <class Tree, class Ray, class T>
void add_picture(const Tree& solid, T far, std::size_t size, std::vector<std::vector<float>>& rows) {
  constexpr T infinity = std::numeric_limits<T>::infinity();
  for (std::size_t y = 0; y < size; ++y)
    for (std::size_t x = 0; x < size; ++x) {
      const auto at = [&](std::size_t pixel) { return (T(2.4) * T(pixel) + T(1.2)) / T(size) - T(1.2); };
      Ray ray;
      ray.origin = {far + at(x), far - at(y), 2}, ray.direction = {T(0.02), T(0.03), -1};
      const auto into = solid.closest_crossing(ray, {.facing = raylanes::Facing::front});
      if (!into) {
        rows[y].push_back(1);
        continue;
      }
      // On from there, but not through the triangle that the ray came in by.
      ray.tmin = into.t;
      const auto out = ray_fire(solid, ray, into, infinity);
      rows[y].push_back(out ? 0.9f - 0.4f * static_cast<float>(out.t - into.t) : 0.0f);
    }
}

int main(int, char** arguments) {
  raylanes::Mesh ball;
  append_ball(ball, {}, 1, 0.2f, 24);
  constexpr double far = 5e6;
  std::vector<raylanes::Double3> corners;
  std::vector<Float3> rounded;
  for (const auto& [x, y, z] : ball.vertices) {
    const double east = far + static_cast<double>(x), north = far + static_cast<double>(y);
    corners.push_back({east, north, static_cast<double>(z)});
    rounded.push_back({static_cast<float>(east), static_cast<float>(north), z});
  }
  constexpr std::size_t size = 400;
  std::vector<std::vector<float>> rows(size);
  add_picture<raylanes::Bvh, raylanes::Ray>(raylanes::Bvh(rounded, ball.triangles), 5e6f, size, rows);
  add_picture<raylanes::BvhD, raylanes::RayD>(raylanes::BvhD(corners, ball.triangles), far, size, rows);
  std::vector<float> levels;
  for (const std::vector<float>& row : rows) levels.insert(levels.end(), row.begin(), row.end());
  levels = in_colour(levels);
  write_text(levels, 2 * size, 12, 12, 3, "floats");
  write_text(levels, 2 * size, size + 12, 12, 3, "doubles");
  write_png(std::string(arguments[1]) + "/ray_fire.png", 2 * size, levels, 3);
}
