// Histories of particles within a solid, aimed at its corners and edges, where they turn: none is lost and none stays
// where it is, if each leg begins at a point that locate() finds inside, as docs/crossings.md says.
#include <raylanes/doubles.hpp>
#include <raylanes/numbers.hpp>

#include "../doubles/double_cases.hpp"
#include "../support/level.hpp"
#include "../support/meshes.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {
namespace {

// A cube with a pyramid taken out of the middle of its side up z, with the tip in the middle of the cube.
Mesh dented_cube() {
  Mesh mesh = cube(-2, 2);
  std::erase_if(mesh.triangles, [&](const Index3& t) {
    return std::ranges::all_of(t, [&](std::uint32_t i) { return mesh.vertices[i][2] == 2; });
  });
  const Float3 outer[] = {{-2, -2, 2}, {2, -2, 2}, {2, 2, 2}, {-2, 2, 2}},
               inner[] = {{-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    append(mesh, make_triangle(outer[k], outer[next], inner[next]));
    append(mesh, make_triangle(outer[k], inner[next], inner[k]));
    append(mesh, make_triangle(inner[k], inner[next], {0, 0, 0}));
  }
  return mesh;
}

template <class T>
struct Particles {
  using Tree = std::conditional_t<std::is_same_v<T, float>, Bvh, BvhD>;
  using Point = PointOf<T>;

  std::vector<Point> corners;
  Tree tree;
  std::vector<Point> at;     // each inside
  std::vector<int> at_rest;  // how many legs in a row had no length
  std::size_t lost = 0, stuck = 0, legs = 0, turned_back = 0;

  Particles(const Mesh& mesh, std::size_t count) {
    for (const auto& [x, y, z] : mesh.vertices) corners.push_back({T(x), T(y), T(z)});
    tree = Tree(corners, mesh.triangles);
    at.assign(count, Point{T(1), T(0.5), T(-1)}), at_rest.assign(count, 0);
  }

  static Point point_on(const RayOf<T>& ray, T t) {
    Point p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = ray.origin[k] + t * ray.direction[k];
    return p;
  }

  // To a corner, a point of an edge, or anywhere.
  RayOf<T> ray_from(const Point& from, Random& random) const {
    RayOf<T> ray;
    ray.origin = from;
    const Point& a = corners[random.index(corners.size())];
    const Point& b = corners[random.index(corners.size())];
    const int kind = random.integer(0, 3);
    const T s = T(random.number(0, 1));
    for (std::size_t k = 0; k < 3; ++k)
      ray.direction[k] = kind == 0  ? a[k] - from[k]
                         : kind < 3 ? a[k] + s * (b[k] - a[k]) - from[k]
                                    : T(random.number(-1, 1));
    return ray;
  }

  // Each particle flies to the surface, and turns there.
  void fly(Random& random) {
    std::vector<RayOf<T>> rays;
    for (const Point& from : at) rays.push_back(ray_from(from, random));
    std::vector<HitOf<T>> exits(rays.size());
    tree.closest_crossing(rays, exits, {.facing = Facing::back});
    // The last points of the legs that are inside: steps back, each twice as long as the one before.
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (rays[i].direction == Point{}) continue;
      ++legs;
      if (exits[i])
        left.push_back(i);
      else
        ++lost;
    }
    std::vector<Point> ends(rays.size());
    for (T step = 0; !left.empty(); step = step == 0 ? std::numeric_limits<T>::epsilon() : 2 * step) {
      std::vector<Point> tried;
      for (const std::size_t i : left)
        tried.push_back(step < 1 ? point_on(rays[i], exits[i].t * (1 - step)) : at[i]);
      std::vector<Location> where(tried.size());
      tree.locate(tried, where);
      std::vector<std::size_t> outside;
      for (std::size_t k = 0; k < left.size(); ++k) {
        if (where[k] != Location::inside) {
          outside.push_back(left[k]);
          continue;
        }
        const std::size_t i = left[k];
        at_rest[i] = tried[k] == at[i] ? at_rest[i] + 1 : 0;
        stuck += at_rest[i] == 60 ? 1 : 0;  // more than half of directions may go out at once
        at[i] = tried[k];
      }
      if (step == 0) turned_back += outside.size();
      left = outside;
    }
  }
};

template <class T>
class Histories : public ::testing::Test {};
using Numbers = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Histories, Numbers);

TYPED_TEST(Histories, lose_and_hold_no_particle) {
  for (const Mesh& mesh : {dented_cube(), ellipsoid(2, {0, 0, 0}, {2, 1.5f, 1.7f})}) {
    Particles<TypeParam> particles(mesh, by_level(5000));
    Random random(241);
    for (int leg = 0; leg < 100; ++leg) particles.fly(random);
    EXPECT_EQ(particles.lost, 0u);
    EXPECT_EQ(particles.stuck, 0u);
    EXPECT_GT(particles.turned_back, particles.legs / 10);
  }
}

}  // namespace
}  // namespace raylanes::testing
