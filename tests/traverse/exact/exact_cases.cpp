#include "exact_cases.hpp"

#include "../../support/triangle_scenes.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t rays_of_a_case = 48;

// Any ray, within two units of the mesh or far beyond: now and then with an end of its segment at the target.
Ray aimed(Random& random, const Float3& origin, const Triangle& target, double u, double v) {
  Ray ray = ray_to(origin, target, u, v);
  if (random.chance(0.3)) ray.tmin = -infinity;
  if (random.chance(0.2)) (random.chance(0.5) ? ray.tmin : ray.tmax) = 1;
  return ray;
}

// At the corners, the edges and the insides of triangles.
void aim_at_all(ExactCase& c, Random& random, float reach, const Float3& centre) {
  for (std::size_t i = 0; i < rays_of_a_case; ++i) {
    const Triangle t = random.triangle_of(c.mesh);
    const double u = i % 3 == 0 ? 0 : random.real(0, 1), v = i % 4 == 0   ? 0
                                                             : i % 4 == 1 ? 1 - u
                                                                          : random.real(0, 1 - u);
    c.rays.push_back(aimed(random, random.point(reach, centre), t, u, v));
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
void aim_along(ExactCase& c, Random& random, float height = 0) {
  for (std::size_t i = 0; i < rays_of_a_case; ++i) {
    const auto any = [&] { return random.triangle_of(c.mesh); };
    Float3 from = ray_to({0, 0, 0}, any(), random.real(-1, 2), random.real(-1, 2)).direction;
    from[2] += random.number(0, height);
    c.rays.push_back(aimed(random, from, any(), random.real(0, 1), random.real(0, 0.5)));
  }
}

void scale(ExactCase& c, float factor) {
  testing::scale(c.mesh, factor), testing::scale(c.rays, factor);
  for (Ray& ray : c.rays)
    for (float& x : ray.direction) x *= factor;
}

const Float3 far_away{148376, 1234, -223423};
const ExactSet sets[] = {
    {"corners_and_edges",
     [](Random& random) {
       ExactCase c{ellipsoid(0, {0, 0, 0}), {}};
       aim_at_all(c, random, 4, {0, 0, 0});
       return c;
     }},
    {"planes_of_strips",
     [](Random& random) {
       ExactCase c{strip(random, 9, 1, 1), {}};
       aim_along(c, random);
       return c;
     }},
    {"ground_at_a_distance",
     [](Random& random) {
       ExactCase c{strip(random, 9, 1000, 0), {}};
       aim_along(c, random, 1e-3f);
       return c;
     }},
    {"slivers",
     [](Random& random) {
       ExactCase c;
       for (int i = 0; i < 24; ++i) {
         const Float3 a = random.point(1), b = random.point(1);
         const float width = random.magnitude(1e-9, 1e-1);
         Float3 near_b = b;
         for (float& x : near_b) x += random.number(-width, width);
         append(c.mesh, a, b, near_b);
       }
       aim_at_all(c, random, 2, {0, 0, 0});
       return c;
     }},
    {"far_away",
     [](Random& random) {
       ExactCase c{ellipsoid(0, far_away), {}};
       aim_at_all(c, random, 4, far_away);
       return c;
     }},
    // Errors of what lies between the origin and the corners are larger than all others.
    {"seen_from_afar",
     [](Random& random) {
       ExactCase c{ellipsoid(0, {0, 0, 0}), {}};
       aim_at_all(c, random, random.magnitude(100, 1e5), {0, 0, 0});
       return c;
     }},
    {"any_scale",
     [](Random& random) {
       ExactCase c{triangle_soup(17, 0.5f, static_cast<std::uint64_t>(random.integer(0, 1 << 20))), {}};
       aim_at_all(c, random, 2, {0, 0, 0});
       scale(c, std::ldexp(1.0f, random.integer(-100, 100)));
       return c;
     }},
    {"products_that_vanish",
     [](Random& random) {
       ExactCase c{triangle_soup(17, 0.5f, static_cast<std::uint64_t>(random.integer(0, 1 << 20))), {}};
       aim_at_all(c, random, 2, {0, 0, 0});
       scale(c, std::ldexp(1.0f, random.integer(-72, -54)));
       // Directions of which DAZ takes a component or two.
       for (Ray& ray : c.rays)
         if (random.chance(0.3))
           for (float& x : ray.direction) x *= 0x1p-44f;
       return c;
     }},
    // DAZ takes some of them, before directions that packets take.
    {"coordinates_that_vanish",
     [](Random& random) {
       ExactCase c{triangle_soup(17, 0.5f, static_cast<std::uint64_t>(random.integer(0, 1 << 20))), {}};
       aim_at_all(c, random, 1, {0, 0, 0});
       scale(c, std::ldexp(1.0f, random.integer(-125, -117)));
       for (Ray& ray : c.rays)
         for (float& x : ray.direction) x *= 0x1p94f;
       return c;
     }},
    // Beside edges, where bounds of products vanish and the products keep some bits: coordinates' errors turn signs.
    {"products_of_few_bits",
     [](Random& random) {
       ExactCase c{triangle_soup(17, 1.5f, static_cast<std::uint64_t>(random.integer(0, 1 << 20))), {}};
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
       ExactCase c{triangle_soup(17, 0.5f, static_cast<std::uint64_t>(random.integer(0, 1 << 20))), {}};
       for (std::size_t i = 0; i < rays_of_a_case; ++i) {
         const Triangle target = triangle_of(c.mesh.vertices, c.mesh.triangles[i % 17]);
         const double u = random.real(0, 1);
         Float3 origin = ray_to({0, 0, 0}, target, u, i % 2 == 0 ? 0 : 1 - u).direction;
         const auto major = random.index(3);
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
       ExactCase c;
       const auto number = [&] { return std::ldexp(random.number(-1, 1), random.integer(-30, 30)); };
       const auto point = [&] { return Float3{number(), number(), number()}; };
       for (int i = 0; i < 16; ++i) append(c.mesh, Triangle{{point(), point(), point()}});
       for (std::size_t i = 0; i < rays_of_a_case; ++i) {
         const Triangle target = triangle_of(c.mesh.vertices, c.mesh.triangles[i % 16]);
         c.rays.push_back(aimed(random, point(), target, random.real(0, 1), random.real(0, 0.4)));
       }
       return c;
     }},
    {"lattice",
     [](Random& random) {
       ExactCase c{integer_grid(4), grid_rays(4, rays_of_a_case, random)};
       for (Ray& ray : c.rays)
         if (random.chance(0.3)) ray.origin[2] = 0;
       return c;
     }},
    {"duplicates",
     [](Random& random) {
       ExactCase c{strip(random, 5, 1, 1), {}};
       const std::vector<Index3> once = c.mesh.triangles;
       for (int copy = 0; copy < 2; ++copy)
         c.mesh.triangles.insert(c.mesh.triangles.end(), once.begin(), once.end());
       std::reverse(c.mesh.triangles.begin(), c.mesh.triangles.end());
       aim_at_all(c, random, 2, {0, 0, 0});
       return c;
     }},
};

}  // namespace

std::span<const ExactSet> exact_sets() {
  return sets;
}

}  // namespace raylanes::testing
