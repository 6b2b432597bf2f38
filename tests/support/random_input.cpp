#include "random_input.hpp"

namespace raylanes::testing {

Float3 Random::point(float half, const Float3& centre) {
  Float3 p;
  for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = number(centre[axis] - half, centre[axis] + half);
  return p;
}

Triangle Random::triangle(float half, const Float3& centre) {
  const Float3 a = point(half, centre), b = point(half, centre), c = point(half, centre);
  return make_triangle(a, b, c);
}

Triangle Random::triangle_of(const Mesh& mesh) {
  return testing::triangle_of(mesh.vertices, mesh.triangles[index(mesh.triangles.size())]);
}

float Random::magnitude(double least, double largest) {
  return static_cast<float>(std::exp(real(std::log(least), std::log(largest))));
}

Ray make_ray(const Float3& origin, const Float3& direction, float tmin, float tmax) {
  return {{origin[0], origin[1], origin[2]}, tmin, {direction[0], direction[1], direction[2]}, tmax};
}

Triangle make_triangle(const Float3& a, const Float3& b, const Float3& c) {
  return {{{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, {c[0], c[1], c[2]}}};
}

Triangle triangle_of(std::span<const Float3> vertices, const Index3& triangle) {
  return make_triangle(vertices[triangle[0]], vertices[triangle[1]], vertices[triangle[2]]);
}

Ray ray_to(const Float3& origin, const Triangle& target, double u, double v, double scale) {
  Float3 direction;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double a = target.corner[0][axis], b = target.corner[1][axis], c = target.corner[2][axis];
    const double point = a * (1 - u - v) + b * u + c * v;
    direction[axis] = static_cast<float>((point - static_cast<double>(origin[axis])) * scale);
  }
  return make_ray(origin, direction);
}

Ray ray_below_normal_numbers(Random& random, std::size_t i) {
  const Float3 origin = random.point(2), target = random.point(1);
  const float scale = std::ldexp(1.0f, -random.integer(120, 130));
  Ray ray = make_ray(origin, {});
  for (std::size_t axis = 0; axis < 3; ++axis) ray.direction[axis] = (target[axis] - origin[axis]) * scale;
  if (i % 3 == 0) ray.direction[i / 3 % 3] *= 0x1p-4f;
  return ray;
}

std::vector<Triangle> corner_orders(const Triangle& triangle) {
  std::array<std::size_t, 3> order{0, 1, 2};
  std::vector<Triangle> all;
  do {
    Triangle permuted{};
    for (std::size_t corner = 0; corner < 3; ++corner)
      permuted.corner[corner] = triangle.corner[order[corner]];
    all.push_back(permuted);
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

namespace {

Ray ray_at_mesh(const Mesh& mesh, const Float3& origin, bool at_corner, Random& random) {
  const Triangle target = random.triangle_of(mesh);
  const double scale = random.magnitude(0.1, 10);
  return ray_to(origin, target, at_corner ? 0 : random.real(0, 1), 0, scale);
}

}  // namespace

std::vector<Ray> mixed_rays(const Mesh& mesh, std::size_t count, float reach, const Float3& centre,
                            std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Float3 origin = random.point(reach, centre);
    if (mesh.triangles.empty() || random.chance(0.5))
      rays.push_back(make_ray(origin, random.point(1)));
    else
      rays.push_back(ray_at_mesh(mesh, origin, random.chance(0.5), random));
  }
  return rays;
}

std::vector<Ray> grid_rays(std::uint32_t cells, std::size_t count, Random& random) {
  std::vector<Ray> rays;
  const int last = 2 * static_cast<int>(cells);
  for (std::size_t i = 0; i < count; ++i) {
    const float z = random.chance(0.5) ? 4.0f : -4.0f;
    const Float3 direction{static_cast<float>(random.integer(-1, 1)),
                           static_cast<float>(random.integer(-1, 1)), z > 0 ? -1.0f : 1.0f};
    const auto coordinate = [&](float d) {
      return 0.5f * static_cast<float>(random.integer(0, last)) - 4 * d;
    };
    rays.push_back(make_ray({coordinate(direction[0]), coordinate(direction[1]), z}, direction));
  }
  return rays;
}

}  // namespace raylanes::testing
