#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

Double3 mean(const TriangleCorners<double>& corners, double u, double v) {
  Double3 point;
  for (std::size_t k = 0; k < 3; ++k)
    point[k] = (1 - u - v) * corners[0][k] + u * corners[1][k] + v * corners[2][k];
  return point;
}

// Triangles without a common vertex, some of them twice, in a lattice so coarse that many are coplanar.
Mesh lattice_soup(std::uint32_t triangles, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    Triangle triangle;
    for (Float3& corner : triangle.corner)
      for (float& x : corner) x = static_cast<float>(random.integer(-3, 3));
    append(mesh, triangle);
    if (i % 5 == 0) append(mesh, triangle);
  }
  return mesh;
}
Mesh soup(std::uint32_t triangles, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  for (std::uint32_t i = 0; i < triangles; ++i) append(mesh, random.triangle(1.0f));
  return mesh;
}

}  // namespace

DoubleMesh moved(const Mesh& mesh, double factor, const Double3& offset) {
  DoubleMesh result{{}, mesh.triangles};
  for (const Float3& v : mesh.vertices)
    result.vertices.push_back(
        {v[0] * factor + offset[0], v[1] * factor + offset[1], v[2] * factor + offset[2]});
  return result;
}

std::vector<RayD> aimed_rays(const DoubleMesh& mesh, std::size_t count, std::uint64_t seed, double reach) {
  Random random(seed);
  BoxD box{mesh.vertices[0], mesh.vertices[0]};
  for (const Double3& v : mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k)
      box.lo[k] = std::min(box.lo[k], v[k]), box.hi[k] = std::max(box.hi[k], v[k]);
  const auto any_point = [&](double share) {
    Double3 point;
    for (std::size_t k = 0; k < 3; ++k) {
      const double middle = 0.5 * box.lo[k] + 0.5 * box.hi[k], half = 0.5 * box.hi[k] - 0.5 * box.lo[k];
      point[k] = middle + half * random.real(-share, share);
    }
    return point;
  };
  std::vector<RayD> rays;
  while (rays.size() < count) {
    const auto corners = corners_of(mesh, random.index(mesh.triangles.size()));
    const double u = random.real(0, 1);
    const Double3 targets[] = {corners[random.index(3)], mean(corners, u, 0), mean(corners, u, 1 - u),
                               mean(corners, 0.5 * u, 0.25), any_point(1)};
    const Double3 target = targets[rays.size() % 5];
    const bool begins_there = random.chance(0.1);
    const Double3 origin = begins_there ? target
                                        : any_point(random.chance(0.15)  ? 0x1p30
                                                    : random.chance(0.1) ? 0x1p46
                                                                         : reach);
    const Double3 other = begins_there ? any_point(2) : target;
    RayD ray{origin, 0, {}, std::numeric_limits<double>::infinity()};
    for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = other[k] - origin[k];
    const double pick = random.real(0, 1);
    if (pick < 0.1) ray.tmax = 1;
    if (pick > 0.9) ray.tmin = -std::numeric_limits<double>::infinity();
    if (pick > 0.8 && pick < 0.85) ray.tmin = 1;
    if (random.chance(0.1)) ray.direction[random.index(3)] = 0;
    if (random.chance(0.05)) ray.direction[random.index(3)] *= 0x1p-300;
    if (random.chance(0.03))
      for (double& x : ray.direction) x *= 0x1p-850;
    rays.push_back(ray);
  }
  return rays;
}

std::vector<RayD> aimed_rays_from_points(const DoubleMesh& mesh, std::size_t count, std::size_t run,
                                         std::uint64_t seed) {
  std::vector<RayD> rays = aimed_rays(mesh, count, seed);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i / run * run;
    if (i % 61 == 30) continue;  // a stranger
    Double3 from = rays[first].origin;
    if (first / run % 3 == 1) from = mesh.vertices[first % mesh.vertices.size()];
    for (std::size_t k = 0; i != first && k < 3; ++k) {
      if (rays[i].direction[k] != 0) rays[i].direction[k] += rays[i].origin[k] - from[k];
      rays[i].origin[k] = from[k];
    }
    if (i == first) rays[i].origin = from;
  }
  return rays;
}

std::vector<DoubleCase> double_cases(std::size_t rays) {
  const struct {
    const char* name;
    Mesh mesh;
    double factor;
    Double3 offset;
  } cases[] = {
      {"soup", soup(60, 1), 1, {0, 0, 0}},
      {"soup of doubles", soup(60, 2), 1.0 / 3, {0.1, -0.2, 0.3}},
      {"lattice", lattice_soup(60, 3), 1, {0, 0, 0}},
      {"lattice far away", lattice_soup(60, 4), 1, {5e6, -5e6, 2e6}},
      {"closed, far away", double_fan(24, 0.3f), 1e-3, {5e6, 4e5, -5e6}},
      {"millimetres from 1e9", soup(60, 5), 1e-3, {1e9, 1e9, 1e9}},
      {"large", soup(60, 6), 0x1p190, {0, 0, 0}},
      {"largest", lattice_soup(30, 7), 0x1p1020, {0, 0, 0}},
      {"small", soup(60, 8), 0x1p-180, {0, 0, 0}},
      {"smallest", lattice_soup(30, 9), 0x1p-1070, {0, 0, 0}},
      {"of the size of floats' ends", soup(60, 10), 0x1p130, {0, 0, 0}},
  };
  std::vector<DoubleCase> result;
  for (const auto& c : cases) {
    DoubleMesh mesh = moved(c.mesh, c.factor, c.offset);
    std::vector<RayD> aimed = aimed_rays(mesh, rays, result.size());
    result.push_back({c.name, std::move(mesh), std::move(aimed)});
  }
  return result;
}

}  // namespace raylanes::testing
