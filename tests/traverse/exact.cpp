// The exact test where floats are hardest, against rational numbers: over arrays and in trees, on every path, in both
// grades and every mode, with and without FTZ and DAZ. The first failure is all that is printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "../../bench/oracles/exact_hit.hpp"
#include "../support/float_modes.hpp"
#include "../support/soa.hpp"
#include "../support/supported_paths.hpp"
#include "../support/triangle_scenes.hpp"
#include "traced.hpp"

namespace raylanes::testing {
namespace {

struct Case {
  Mesh mesh;
  std::vector<Ray> rays;
};
constexpr std::size_t rays_of_a_case = 48;

// Any ray, within two units of the mesh or far beyond: now and then with an end of its segment at the target.
Ray aimed(Random& random, const Float3& origin, const Triangle& target, double u, double v) {
  Ray ray = ray_to(origin, target, u, v);
  if (random.chance(0.3)) ray.tmin = -infinity;
  if (random.chance(0.2)) (random.chance(0.5) ? ray.tmin : ray.tmax) = 1;
  return ray;
}

// At the corners, the edges and the insides of triangles.
void aim_at_all(Case& c, Random& random, float reach, const Float3& centre) {
  for (std::size_t i = 0; i < rays_of_a_case; ++i) {
    const auto t = static_cast<std::size_t>(random.integer(0, static_cast<int>(c.mesh.triangles.size()) - 1));
    const double u = i % 3 == 0 ? 0 : random.real(0, 1), v = i % 4 == 0   ? 0
                                                             : i % 4 == 1 ? 1 - u
                                                                          : random.real(0, 1 - u);
    c.rays.push_back(
        aimed(random, random.point(reach, centre), triangle_of(c.mesh.vertices, c.mesh.triangles[t]), u, v));
  }
}

// A flat strip with random cells, in a plane that no axis knows; `slope` 0 is the ground.
Mesh strip(Random& random, int cells, double size, double slope) {
  Mesh mesh;
  const double a = slope == 0 ? 0 : random.real(-1, 1), b = slope == 0 ? 0 : random.real(-1, 1);
  for (int i = 0; i <= cells; ++i)
    for (const double y : {0.0, random.real(0.2, 1)}) {
      const double x = i + random.real(-0.3, 0.3);
      mesh.vertices.push_back({static_cast<float>(size * x), static_cast<float>(size * y),
                               static_cast<float>(size * (a * x + b * y))});
    }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(2 * cells); ++i)
    mesh.triangles.push_back(i % 2 == 0 ? Index3{i, i + 1, i + 2} : Index3{i, i + 2, i + 1});
  return mesh;
}

// From one point of the plane, or as high above it, to another, as closely as floats can.
void aim_along(Case& c, Random& random, float height = 0) {
  for (std::size_t i = 0; i < rays_of_a_case; ++i) {
    const auto any = [&] {
      const auto t =
          static_cast<std::size_t>(random.integer(0, static_cast<int>(c.mesh.triangles.size()) - 1));
      return triangle_of(c.mesh.vertices, c.mesh.triangles[t]);
    };
    Float3 from = ray_to({0, 0, 0}, any(), random.real(-1, 2), random.real(-1, 2)).direction;
    from[2] += random.number(0, height);
    c.rays.push_back(aimed(random, from, any(), random.real(0, 1), random.real(0, 0.5)));
  }
}

void scale(Case& c, float factor) {
  for (Float3& vertex : c.mesh.vertices)
    for (float& x : vertex) x *= factor;
  for (Ray& ray : c.rays)
    for (std::size_t axis = 0; axis < 3; ++axis) ray.origin[axis] *= factor, ray.direction[axis] *= factor;
}

using Make = Case (*)(Random&);
struct Set {
  const char* name;
  Make make;
};
const Float3 far_away{148376, 1234, -223423};
const Set sets[] = {
    {"corners_and_edges",
     [](Random& random) {
       Case c{ellipsoid(0, {0, 0, 0}), {}};
       aim_at_all(c, random, 4, {0, 0, 0});
       return c;
     }},
    {"planes_of_strips",
     [](Random& random) {
       Case c{strip(random, 9, 1, 1), {}};
       aim_along(c, random);
       return c;
     }},
    {"ground_at_a_distance",
     [](Random& random) {
       Case c{strip(random, 9, 1000, 0), {}};
       aim_along(c, random, 1e-3f);
       return c;
     }},
    {"slivers",
     [](Random& random) {
       Case c;
       for (std::uint32_t i = 0; i < 24; ++i) {
         const Float3 a = random.point(1), b = random.point(1);
         const float width = random.magnitude(1e-9, 1e-1);
         Float3 near_b = b;
         for (float& x : near_b) x += random.number(-width, width);
         for (const Float3& p : {a, b, near_b}) c.mesh.vertices.push_back(p);
         c.mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
       }
       aim_at_all(c, random, 2, {0, 0, 0});
       return c;
     }},
    {"far_away",
     [](Random& random) {
       Case c{ellipsoid(0, far_away), {}};
       aim_at_all(c, random, 4, far_away);
       return c;
     }},
    {"any_scale",
     [](Random& random) {
       Case c{triangle_soup(17, 0.5f, static_cast<std::uint64_t>(random.integer(0, 1 << 20))), {}};
       aim_at_all(c, random, 2, {0, 0, 0});
       scale(c, std::ldexp(1.0f, random.integer(-100, 100)));
       return c;
     }},
    {"products_that_vanish",
     [](Random& random) {
       Case c{triangle_soup(17, 0.5f, static_cast<std::uint64_t>(random.integer(0, 1 << 20))), {}};
       aim_at_all(c, random, 2, {0, 0, 0});
       scale(c, std::ldexp(1.0f, random.integer(-72, -54)));
       // Directions of which DAZ takes a component or two.
       for (Ray& ray : c.rays)
         if (random.chance(0.3))
           for (float& x : ray.direction) x *= 0x1p-44f;
       return c;
     }},
    // Beside edges, where bounds of products vanish and the products keep some bits: coordinates' errors turn signs.
    {"products_of_few_bits",
     [](Random& random) {
       Case c{triangle_soup(17, 1.5f, static_cast<std::uint64_t>(random.integer(0, 1 << 20))), {}};
       for (std::size_t i = 0; i < 4 * rays_of_a_case; ++i) {
         const Triangle target = triangle_of(c.mesh.vertices, c.mesh.triangles[i % 17]);
         const double u = random.real(0, 1);
         c.rays.push_back(aimed(random, random.point(4), target, i % 2 == 0 ? 0 : u, 1 - u));
       }
       scale(c, std::ldexp(1.0f, random.integer(-69, -66)));
       return c;
     }},
    // DAZ takes a component that moves the ray across an edge, and not the major one.
    {"components_that_vanish",
     [](Random& random) {
       Case c{triangle_soup(17, 0.5f, static_cast<std::uint64_t>(random.integer(0, 1 << 20))), {}};
       for (std::size_t i = 0; i < rays_of_a_case; ++i) {
         const Triangle target = triangle_of(c.mesh.vertices, c.mesh.triangles[i % 17]);
         const double u = random.real(0, 1);
         Float3 origin = ray_to({0, 0, 0}, target, u, i % 2 == 0 ? 0 : 1 - u).direction;
         const auto major = static_cast<std::size_t>(random.integer(0, 2));
         for (std::size_t axis = 0; axis < 3; ++axis)
           origin[axis] += axis == major ? random.number(0.5f, 2) : random.number(-0x1p-6f, 0x1p-6f);
         Ray ray = aimed(random, origin, target, u, i % 2 == 0 ? 0 : 1 - u);
         const float factor = std::ldexp(1.0f, random.integer(-124, -112));
         for (float& x : ray.direction) x *= factor;
         if (ray.tmin > 0 || ray.tmax < infinity) ray.tmin = -infinity, ray.tmax = infinity;
         c.rays.push_back(ray);
       }
       return c;
     }},
    {"scales_together",
     [](Random& random) {
       Case c;
       const auto number = [&] { return std::ldexp(random.number(-1, 1), random.integer(-30, 30)); };
       const auto point = [&] { return Float3{number(), number(), number()}; };
       for (std::uint32_t i = 0; i < 16; ++i) {
         for (int corner = 0; corner < 3; ++corner) c.mesh.vertices.push_back(point());
         c.mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
       }
       for (std::size_t i = 0; i < rays_of_a_case; ++i) {
         const Triangle target = triangle_of(c.mesh.vertices, c.mesh.triangles[i % 16]);
         c.rays.push_back(aimed(random, point(), target, random.real(0, 1), random.real(0, 0.4)));
       }
       return c;
     }},
    {"lattice",
     [](Random& random) {
       Case c{integer_grid(4), grid_rays(4, rays_of_a_case, random)};
       for (Ray& ray : c.rays)
         if (random.chance(0.3)) ray.origin[2] = 0;
       return c;
     }},
    {"duplicates",
     [](Random& random) {
       Case c{strip(random, 5, 1, 1), {}};
       const std::vector<Index3> once = c.mesh.triangles;
       for (int copy = 0; copy < 2; ++copy)
         c.mesh.triangles.insert(c.mesh.triangles.end(), once.begin(), once.end());
       std::reverse(c.mesh.triangles.begin(), c.mesh.triangles.end());
       aim_at_all(c, random, 2, {0, 0, 0});
       return c;
     }},
};

// Both array shapes on one path: bytes of `expected`, per triangle and of all.
void expect_arrays(const Case& c, const std::vector<std::vector<Hit>>& of_triangle,
                   const std::vector<Hit>& nearest, const TriangleOptions& options, FloatMode mode) {
  std::vector<Triangle> triangles;
  for (const Index3& index : c.mesh.triangles) triangles.push_back(triangle_of(c.mesh.vertices, index));
  TriangleColumns columns(triangles);
  RayColumns rays{std::span<const Ray>(c.rays)};
  TriangleHitColumns out(rays.size());
  std::vector<std::uint8_t> bits((rays.size() + 7) / 8);
  const FloatModeScope scope(mode);
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    closest_hits(rays.arrays(), triangles[k], out.hits(), options);
    any_hits(rays.arrays(), triangles[k], bits, options);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit& hit = of_triangle[k][i];
      const TriangleResult result{hit.t, hit.u, hit.v, hit ? hit_flag : 0};
      ASSERT_EQ(out[i], result) << "rays on " << options.path->name << ' ' << name_of(mode) << " triangle "
                                << k << " ray " << i << " t " << out[i].t << " for " << hit.t;
      ASSERT_EQ(is_set(bits, i), !!hit)
          << "yes or no on " << options.path->name << " triangle " << k << " ray " << i;
    }
  }
  bits.assign((triangles.size() + 7) / 8, 0);
  for (std::size_t i = 0; i < c.rays.size(); ++i) {
    const Hit hit = closest_hit(c.rays[i], columns.arrays(), options);
    ASSERT_EQ(std::memcmp(&hit, &nearest[i], sizeof hit), 0)
        << "triangles on " << options.path->name << " ray " << i;
    any_hits(c.rays[i], columns.arrays(), bits, options);
    for (std::size_t k = 0; k < triangles.size(); ++k)
      ASSERT_EQ(is_set(bits, k), !!of_triangle[k][i])
          << "triangles, yes or no on " << options.path->name << " ray " << i;
  }
}

// Rays that one packet takes: every twelfth with neighbours a few units in the last place beside it.
std::vector<Ray> in_packets(const std::vector<Ray>& rays, Random& random) {
  constexpr int widest = 16;
  std::vector<Ray> packets;
  for (std::size_t i = 0; i < rays.size(); i += 12)
    for (int k = 0; k < widest; ++k) {
      Ray ray = rays[i];
      for (float& x : ray.direction)
        for (int step = random.integer(0, k % 4); step > 0 && x != 0; --step) x = std::nextafter(x, 2 * x);
      packets.push_back(ray);
    }
  return packets;
}

class ExactDecisions : public ::testing::TestWithParam<Set> {};

TEST_P(ExactDecisions, are_those_of_rational_numbers) {
  Random random(2026);
  std::size_t hits = 0;
  const int rounds = std::getenv("RAYLANES_EXHAUSTIVE") != nullptr ? 24'000 : quick() ? 4 : 240;
  for (int round = 0; round < rounds; ++round) {
    const Case c = GetParam().make(random);
    std::vector<std::vector<Hit>> of_triangle;
    for (const Index3& index : c.mesh.triangles)
      of_triangle.push_back(oracle::exact_hits(c.mesh.vertices, std::span(&index, 1), c.rays));
    const std::vector<Hit> nearest = oracle::exact_hits(c.mesh.vertices, c.mesh.triangles, c.rays);
    hits += static_cast<std::size_t>(
        std::count_if(nearest.begin(), nearest.end(), [](const Hit& h) { return !!h; }));
    const Bvh bvh(c.mesh);
    if (round % 4 == 0) {
      const std::vector<Ray> packets = in_packets(c.rays, random);
      expect_hits(bvh, packets, oracle::exact_hits(c.mesh.vertices, c.mesh.triangles, packets), {});
    }
    for (const Grade grade : {Grade::reproducible, Grade::fast}) {
      for (const Path* path : supported_paths())
        for (const FloatMode mode : float_modes)
          expect_arrays(c, of_triangle, nearest, {.grade = grade, .path = path}, mode);
      expect_hits(bvh, c.rays, nearest, {.grade = grade});
      const FloatModeScope scope(FloatMode::flush);
      expect_hits(bvh, c.rays, nearest, {.grade = grade});
    }
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
  EXPECT_GT(hits, static_cast<std::size_t>(rounds) * 4) << "the rays are aimed badly";
}

INSTANTIATE_TEST_SUITE_P(Sets, ExactDecisions, ::testing::ValuesIn(sets),
                         [](const auto& set) { return std::string(set.param.name); });

// The wall that showed that rounded decisions depend on the tree: nine triangles of a tilted strip, and a ray nearly in
// its plane that hits the inside of triangle 5.
TEST(ExactDecisions, find_the_triangle_of_the_wall) {
  const Mesh wall{
      {{0x1.333334p-1f, -0x1.03bbc2p+0f, -0x1.64b3cp-5f},
       {0x1p+0f, -0x1.03bbc2p+0f, -0x1.64b3cp-5f},
       {0x1p+0f, -0x1.3ca2f8p+0f, -0x1.811fa2p-2f},
       {0x1.333334p-1f, -0x1.95a918p-1f, 0x1.27f2b2p-2f},
       {0x1p+0f, -0x1.95a918p-1f, 0x1.27f2b2p-2f},
       {0x1.333334p-1f, -0x1.23daacp-1f, 0x1.3e3deep-1f},
       {0x1p+0f, -0x1.23daacp-1f, 0x1.3e3deep-1f},
       {0x1.333334p-1f, -0x1.64187cp-2f, 0x1.e88282p-1f},
       {0x1p+0f, -0x1.64187cp-2f, 0x1.e88282p-1f},
       {0x1.333334p-1f, -0x1.00f746p-3f, 0x1.49638cp+0f},
       {0x1p+0f, -0x1.00f746p-3f, 0x1.49638cp+0f}},
      {{0, 1, 2}, {0, 3, 1}, {3, 4, 1}, {3, 5, 4}, {5, 6, 4}, {5, 7, 6}, {7, 8, 6}, {7, 9, 8}, {9, 10, 8}}};
  const Ray ray = make_ray({0x1.7459c8p-1f, -0x1.720ce8p-2f, 0x1.de122p-1f},
                           {-0x1.69b856p-1f, -0x1.92b85p-2f, -0x1.2d4234p-1f});
  const Bvh bvh(wall);
  for (const Grade grade : {Grade::reproducible, Grade::fast})
    for (const TraceOptions& options : ways_to_trace({.grade = grade})) {
      const Hit hit = bvh.closest(ray, options);
      EXPECT_EQ(hit.primitive, 5u) << name_of(options);
      EXPECT_EQ(hit.t, 0.0806634164f) << name_of(options);
    }
}

// t is a mean of two corners' depths, halfway between two floats, but for a third corner whose weight is 2^-60.
TEST(ExactDecisions, round_once_beside_halfway) {
  constexpr float ulp = 0x1p-23f;
  for (const bool above : {false, true})
    for (const float first : {1 + ulp, 1 + 2 * ulp, -1 - ulp, -1 - 2 * ulp}) {
      const Ray ray = make_ray({0, 0, 0}, {0, 0, 1}, -infinity, infinity);
      const float second = first + ulp;
      const Mesh mesh{{{-1, 0x1p-60f, first}, {1, 0x1p-60f, second}, {0, -1, above ? 3.0f : -3.0f}},
                      {{0, 1, 2}}};
      const std::vector<Hit> hits = oracle::exact_hits(mesh.vertices, mesh.triangles, std::span(&ray, 1));
      ASSERT_EQ(hits[0].t, above ? second : first);
      expect_hits(Bvh(mesh), std::span(&ray, 1), hits, {});
      for (const Path* path : supported_paths())
        expect_arrays({mesh, {ray}}, {hits}, hits, {.path = path}, FloatMode::ieee);
    }
}

// A component whose reciprocal is infinite moves a ray yet, if it goes far enough: out of a box that it starts beside.
TEST(ExactDecisions, find_what_tiny_components_reach) {
  constexpr float side = 0x1p-41f, far = 0x1p100f;
  Mesh mesh;
  for (std::uint32_t i = 0; i < 20; ++i) {
    const float y = 4.0f * static_cast<float>(i);
    for (const Float3& corner : {Float3{side, y - 1, far}, Float3{side, y + 1, far}, Float3{1, y, far}})
      mesh.vertices.push_back(corner);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const std::vector<Ray> rays{make_ray({0, 0, 0}, {0x1p-140f, 0, 1}), make_ray({0, 8, 0}, {0x1p-142f, 0, 1})};
  const std::vector<Hit> hits = oracle::exact_hits(mesh.vertices, mesh.triangles, rays);
  ASSERT_EQ(hits[0].primitive, 0u);
  ASSERT_FALSE(hits[1]);
  expect_hits(Bvh(mesh), rays, hits, {});
}

}  // namespace
}  // namespace raylanes::testing
