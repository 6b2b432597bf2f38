// Trees over boxes with primitives of the caller's, and over spheres: primitives, rays, and what batches must find.
#pragma once

#include <raylanes/paths.hpp>

#include "../../bench/support/scenes/vector3.hpp"
#include "../support/same_bytes.hpp"
#include "expect_scene.hpp"

namespace raylanes::testing {

// Triangles by a test in doubles that is the same wherever it is inlined.
struct UserTriangles {
  std::vector<Triangle> triangles;

  bool operator()(std::uint32_t primitive, const Ray& ray, Hit& hit) const {
    using namespace bench;  // vectors of doubles
    const auto& [a, b, c] = triangles[primitive].corner;
    const Double3 v0 = to_double(a), e1 = subtract(to_double(b), v0), e2 = subtract(to_double(c), v0),
                  s = subtract(to_double(ray.origin), v0), d = to_double(ray.direction), p = cross(d, e2),
                  q = cross(s, e1);
    const double det = dot(e1, p);
    hit.t = static_cast<float>(dot(e2, q) / det);
    hit.u = static_cast<float>(dot(s, p) / det), hit.v = static_cast<float>(dot(d, q) / det);
    return hit.u >= 0 && hit.v >= 0 && hit.u + hit.v <= 1 && hit.t >= ray.tmin && hit.t <= ray.tmax;
  }
  std::vector<Box> boxes() const {
    std::vector<Box> boxes;
    for (const Triangle& t : triangles) {
      Box box{t.corner[0], t.corner[0]};
      for (const Float3& corner : t.corner)
        for (std::size_t k = 0; k < 3; ++k)
          box.lo[k] = std::min(box.lo[k], corner[k]), box.hi[k] = std::max(box.hi[k], corner[k]);
      boxes.push_back(box);
    }
    return boxes;
  }
  Hit closest(const Ray& ray) const {
    Hit best;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      Hit hit;
      if (!(*this)(i, ray, hit)) continue;
      hit.primitive = i;
      if (is_nearer(hit, best)) best = hit;
    }
    return best;
  }
};

inline UserTriangles soup(std::size_t count, std::uint64_t seed) {
  const Mesh mesh = triangle_soup(count, 0.2f, seed);
  UserTriangles user;
  for (const Index3& t : mesh.triangles) user.triangles.push_back(triangle_of(mesh.vertices, t));
  return user;
}

inline std::vector<Sphere> random_spheres(std::size_t count, Random& random) {
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < count; ++i) spheres.push_back({random.point(1), random.magnitude(1e-3, 0.3)});
  const float odd[] = {nan, infinity, -1.0f, 3e38f, 0.0f, 1e-30f};
  for (const float radius : odd) spheres.push_back({random.point(1), radius});
  spheres.push_back({{nan, 0, 0}, 1}), spheres.push_back({{infinity, 0, 0}, 1});
  spheres.push_back(spheres[0]);  // the first wins
  return spheres;
}
struct SphereRows {
  std::vector<float> row[4];
  explicit SphereRows(const std::vector<Sphere>& spheres) {
    for (const Sphere& sphere : spheres) {
      for (std::size_t k = 0; k < 3; ++k) row[k].push_back(sphere.centre[k]);
      row[3].push_back(signed_square(sphere.radius));
    }
  }
  Hit closest(const Ray& ray) const {
    return closest_hit(
        ray, SphereArrays{{row[0].data(), row[1].data(), row[2].data()}, row[3].data(), row[0].size()},
        {.path = &paths().front()});
  }
};

// closest_of(ray) is what batches are to return.
template <class Tree, class ClosestOf, class... Test>
void expect_batches(const Tree& tree, const std::vector<Ray>& rays, const ClosestOf& closest_of,
                    Test&&... test) {
  std::vector<Hit> expected;
  for (const Ray& ray : rays) expected.push_back(closest_of(ray));
  for (const Path* path : supported_paths())
    for (const std::size_t size : {rays.size(), std::size_t{3}, std::size_t{0}}) {
      const std::span<const Ray> some = std::span(rays).first(size);
      std::vector<Hit> hits(size, Hit{1, 2, 3, 4});
      std::vector<std::uint8_t> occluded(size, 7);
      tree.closest(some, hits, test..., {.path = path, .threads = 2});
      tree.occluded(some, occluded, test..., {.path = path});
      for (std::size_t i = 0; i < size; ++i) {
        ASSERT_TRUE(same_bytes(hits[i], expected[i]))
            << path->name << ", ray " << i << ": t " << hits[i].t << ", not " << expected[i].t << ", of "
            << hits[i].primitive << ", not " << expected[i].primitive;
        ASSERT_EQ(occluded[i], expected[i] ? 1 : 0) << path->name << ", ray " << i;
      }
    }
}

inline std::vector<Ray> rays_around(std::size_t count, float reach, std::uint64_t seed) {
  std::vector<Ray> rays = mixed_rays({}, count, reach, {0, 0, 0}, seed);
  Random random(seed);
  for (std::size_t i = 0; i < count; ++i) {
    const Float3 to = random.point(1);
    if (i % 4 != 0)
      for (std::size_t k = 0; k < 3; ++k) rays[i].direction[k] = to[k] - rays[i].origin[k];
    if (i % 5 == 0) rays[i].tmin = -0.5f;
    if (i % 7 == 0) rays[i].tmax = 1.0f;
  }
  return rays;
}

// Most of them from one point, in any directions, some of which packets do not take; others before, between and behind.
inline std::vector<Ray> rays_from_a_point(std::size_t count, float reach, std::uint64_t seed) {
  std::vector<Ray> rays = rays_around(count, reach, seed);
  const Float3 from = Random(seed + 1).point(reach);
  for (std::size_t i = count / 8; i < count * 7 / 8; ++i) {
    if (i == count / 2) i += count / 16;
    const Float3 old = rays[i].origin;
    for (std::size_t k = 0; k < 3; ++k)
      rays[i].direction[k] += i % 4 != 0 ? old[k] - from[k] : 0.0f, rays[i].origin[k] = from[k];
  }
  return rays;
}

}  // namespace raylanes::testing
