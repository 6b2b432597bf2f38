// Rays, triangles and meshes for tests: seeded, the same on every machine.
#pragma once

#include <raylanes/mesh.hpp>
#include <raylanes/types.hpp>

#include "../../bench/support/scenes/splitmix.hpp"
#include "meshes.hpp"

namespace raylanes::testing {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// Random numbers from a seed. Ranges are closed for integers and half open (up to rounding) for floats.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}

  double real(double lo, double hi) { return lo + (hi - lo) * bits_.uniform(); }
  float number(float lo, float hi) { return static_cast<float>(real(lo, hi)); }
  int integer(int lo, int hi) { return lo + static_cast<int>(bits_.uniform() * (hi - lo + 1)); }
  bool chance(double probability) { return bits_.uniform() < probability; }
  // Each coordinate in [centre - half, centre + half).
  Float3 point(float half, const Float3& centre = {0, 0, 0});
  Triangle triangle(float half, const Float3& centre = {0, 0, 0});
  // A triangle of the mesh, and the index of one of `count` elements.
  Triangle triangle_of(const Mesh& mesh);
  std::size_t index(std::size_t count) {
    return static_cast<std::size_t>(integer(0, static_cast<int>(count) - 1));
  }
  // Uniform in a logarithmic scale.
  float magnitude(double least, double largest);

 private:
  bench::SplitMix bits_;
};

Ray make_ray(const Float3& origin, const Float3& direction, float tmin = 0, float tmax = infinity);
Triangle make_triangle(const Float3& a, const Float3& b, const Float3& c);
inline constexpr Triangle floor_triangle{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
Triangle triangle_of(std::span<const Float3> vertices, const Index3& triangle);

// Multiplies all origins.
inline void scale(std::vector<Ray>& rays, float by) {
  for (Ray& ray : rays)
    for (float& x : ray.origin) x *= by;
}

// A ray from `origin` whose line passes the point with weights 1-u-v, u, v of the corners as closely as a
// float direction can: the point is never rounded. It is reached at t = 1 / scale.
Ray ray_to(const Float3& origin, const Triangle& target, double u, double v, double scale = 1);

// A ray whose direction is below the normal numbers, from within 2 of the origin to within 1; of each third one
// component by 16 more.
Ray ray_below_normal_numbers(Random& random, std::size_t i);

// The triangle with its corners in each of the six orders, the given one first.
std::vector<Triangle> corner_orders(const Triangle& triangle);

// `count` rays from points of the cube [-reach, reach)³ around `centre`; half go anywhere, a quarter to a
// corner of a random triangle and a quarter to a point of its edge. An empty mesh gets rays anywhere only.
std::vector<Ray> mixed_rays(const Mesh& mesh, std::size_t count, float reach, const Float3& centre,
                            std::uint64_t seed);

// `count` rays from lattice points above and below that grid, straight and aslant, through its corners and
// edges.
std::vector<Ray> grid_rays(std::uint32_t cells, std::size_t count, Random& random);

// Masks of active elements, n of them: all, none, each second one, all but the first, the last one alone, and some at
// random. Memory behind the last element is set.
inline std::vector<std::vector<std::uint8_t>> masks_for(std::size_t n, Random& random) {
  const std::size_t bytes = (n + 7) / 8;
  std::vector<std::vector<std::uint8_t>> masks;
  for (const int pattern : {0xff, 0x00, 0x55, 0xff, 0x00, -1, -1}) {
    std::vector<std::uint8_t> mask;
    for (std::size_t i = 0; i < bytes; ++i)
      mask.push_back(static_cast<std::uint8_t>(pattern < 0 ? random.integer(0, 255) : pattern));
    if (n > 0 && masks.size() == 3) mask[0] = 0xfe;
    if (n > 0 && masks.size() == 4) mask[(n - 1) / 8] = static_cast<std::uint8_t>(1u << (n - 1) % 8);
    if (n > 0)
      for (std::size_t i = n; i < 8 * bytes; ++i)
        mask.back() = static_cast<std::uint8_t>(mask.back() | 1u << i % 8);
    masks.push_back(mask);
  }
  return masks;
}

}  // namespace raylanes::testing
