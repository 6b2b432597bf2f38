// Rays of doubles against integers, where nothing rounds: a million rays aimed at corners, edges and planes of meshes
// on a lattice, which is moved and scaled so that doubles still have it.
#include "../support/level.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

using Integer = std::int64_t;
using Point = std::array<Integer, 3>;

Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Point operator*(Integer factor, const Point& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}
Integer determinant(const Point& a, const Point& b, const Point& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// From `begin` to `end` quarters of the direction.
struct LatticeRay {
  Point origin, direction;
  Integer begin, end;
};
struct LatticeMesh {
  std::vector<Point> corners;
  std::vector<Index3> triangles;
};

// t in directions. Determinants are below 2^46, so that doubles have both parts of each quotient.
HitD lattice_hit(const LatticeRay& ray, const LatticeMesh& mesh, std::uint32_t triangle) {
  const auto& [i, j, k] = mesh.triangles[triangle];
  const Point a = mesh.corners[i] - ray.origin, b = mesh.corners[j] - ray.origin,
              c = mesh.corners[k] - ray.origin;
  const Integer of_a = determinant(ray.direction, b, c), of_b = determinant(ray.direction, c, a),
                of_c = determinant(ray.direction, a, b), det = of_a + of_b + of_c,
                depth = determinant(a, b, c);
  const Integer sign = det < 0 ? -1 : 1;
  if (det == 0 || sign * of_a < 0 || sign * of_b < 0 || sign * of_c < 0) return {};
  if (4 * sign * depth < ray.begin * sign * det || 4 * sign * depth > ray.end * sign * det) return {};
  const auto over_det = [&](Integer x) { return static_cast<double>(x) / static_cast<double>(det) + 0.0; };
  return {over_det(depth), over_det(of_b), over_det(of_c), triangle, 0};
}
HitD nearest_lattice_hit(const LatticeRay& ray, const LatticeMesh& mesh) {
  HitD best;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (const HitD hit = lattice_hit(ray, mesh, i); hit && (!best || hit.t < best.t)) best = hit;
  return best;
}

Point lattice_point(Random& random, int reach) {
  Point p;
  for (Integer& x : p) x = random.integer(-reach, reach);
  return p;
}
// A third of the triangles lie in a plane across an axis.
LatticeMesh lattice_mesh(Random& random, int reach) {
  LatticeMesh mesh;
  for (int i = 0; i < 16; ++i) mesh.corners.push_back(lattice_point(random, reach));
  for (std::size_t i = 0; i < 5; ++i) mesh.corners[i][2] = 1;
  while (mesh.triangles.size() < 24) {
    const auto corner = [&](int most) { return static_cast<std::uint32_t>(random.integer(0, most)); };
    const int most = random.chance(0.33) ? 4 : 15;
    const Index3 t{corner(most), corner(most), corner(most)};
    const Point &a = mesh.corners[t[0]], &b = mesh.corners[t[1]], &c = mesh.corners[t[2]];
    if (a != b && b != c && c != a) mesh.triangles.push_back(t);
  }
  return mesh;
}
// Towards a corner, a point of an edge in quarters, or a corner from the plane of the first ones; some end at a corner.
LatticeRay lattice_ray(Random& random, const LatticeMesh& mesh, int reach) {
  const Index3& t = mesh.triangles[random.index(24)];
  const Point &a = mesh.corners[t[0]], &b = mesh.corners[t[1]];
  LatticeRay ray{lattice_point(random, 2 * reach), {}, 0, 1 << 20};
  if (random.chance(0.1)) ray.origin[2] = 1;
  if (random.chance(0.05)) ray.origin = a;
  const Integer share = random.integer(0, 4);
  ray.direction = (4 - share) * a + share * b - 4 * ray.origin;
  if (random.chance(0.1)) ray.direction = lattice_point(random, reach);
  if (random.chance(0.1)) ray.direction[random.index(3)] = 0;
  if (random.chance(0.2)) ray.end = random.integer(1, 8);
  if (random.chance(0.2)) ray.begin = random.integer(-4, 4);
  return ray;
}

// The lattice in doubles: coordinates (x + offset)·2^power, directions x·2^other.
struct Embedding {
  double offset;
  int power, other;

  Double3 point(const Point& p) const {
    Double3 q;
    for (std::size_t k = 0; k < 3; ++k) q[k] = std::ldexp(static_cast<double>(p[k]) + offset, power);
    return q;
  }
  RayD ray(const LatticeRay& r) const {
    RayD to{point(r.origin), t(static_cast<double>(r.begin) / 4), {}, t(static_cast<double>(r.end) / 4)};
    for (std::size_t k = 0; k < 3; ++k)
      to.direction[k] = std::ldexp(static_cast<double>(r.direction[k]), other);
    return to;
  }
  double t(double t) const { return std::ldexp(t, power - other); }
};
constexpr Embedding embeddings[] = {{0, 0, 0},          {5e6, -10, -10},     {-0x1.8p38, 0, 3},
                                    {0x1p36, 300, 290}, {3, -900, -600},     {0x1.5p39, 20, -400},
                                    {0, -1074, -1000},  {0x1p30, 900, 1000}, {1e9, -40, 0}};

void check_mesh(std::uint64_t seed, std::size_t count, const Path& path) {
  Random random(seed);
  const int reach = seed % 3 == 0 ? 4 : seed % 3 == 1 ? 60 : 2000;
  const LatticeMesh mesh = lattice_mesh(random, reach);
  const Embedding& as = embeddings[seed % std::size(embeddings)];
  std::vector<Double3> corners;
  for (const Point& corner : mesh.corners) corners.push_back(as.point(corner));
  const BvhD tree(corners, mesh.triangles);
  std::vector<RayD> rays;
  std::vector<HitD> known;
  while (rays.size() < count) {
    const LatticeRay ray = lattice_ray(random, mesh, reach);
    if (ray.direction == Point{}) continue;
    rays.push_back(as.ray(ray)), known.push_back(nearest_lattice_hit(ray, mesh));
    known.back().t = as.t(known.back().t);
  }
  std::vector<HitD> hits(count);
  tree.closest(rays, hits, {.path = &path});
  std::vector<std::uint8_t> occluded(count);
  tree.occluded(rays, occluded, {.path = &path});
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_TRUE(same_bytes(hits[i], known[i]))
        << "seed " << seed << " ray " << i << ": " << hits[i].t << ' ' << hits[i].primitive << ", not "
        << known[i].t << ' ' << known[i].primitive;
    ASSERT_EQ(occluded[i] != 0, static_cast<bool>(known[i])) << "seed " << seed << " ray " << i;
  }
  for (std::size_t i = 0; i < count; i += 7) {
    ASSERT_TRUE(same_bytes(tree.closest(rays[i], {.path = &path}), known[i]))
        << "seed " << seed << " ray " << i;
    ASSERT_EQ(tree.occluded(rays[i], {.path = &path}), static_cast<bool>(known[i]));
  }
}

// Each mesh on one path, all paths in turn; rays as streams and as single ones.
TEST(IntegerRays, of_doubles_are_decided_as_integers_decide) {
  const auto count = by_level<std::size_t>(500, 2500, 10000);
  const std::uint64_t meshes = quick() ? 36 : exhaustive() ? 10000 : 100;
  const std::vector<const Path*> paths = paths_with_own_queries();
  for (std::uint64_t seed = 0; seed < meshes && !HasFatalFailure(); ++seed)
    check_mesh(seed, count, *paths[seed % paths.size()]);
}

}  // namespace
}  // namespace raylanes::testing
