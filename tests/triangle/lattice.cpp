// Tests by determinants on integers, where nothing rounds: the documented convention, to the bit.
#include "../../bench/support/oracles/exact_triangle.hpp"
#include "../support/random_input.hpp"
#include "judge/triangle_answers.hpp"

namespace raylanes::testing {
namespace {

// Coordinates to 7, a major direction that is a power of two up to 8 and minor ones no larger: sheared
// coordinates have 3 binary digits behind the point and 5 before, so each number in either test, the last sum
// of T included, has at most 24 digits. Nothing rounds, with or without FMA, before the final divisions.
constexpr int lattice = 7;

Float3 lattice_point(Random& random) {
  Float3 p;
  for (float& x : p) x = static_cast<float>(random.integer(-lattice, lattice));
  return p;
}

Float3 lattice_direction(Random& random) {
  const int major = 1 << random.integer(0, 3);
  const auto axis = random.index(3);
  Float3 d;
  for (float& x : d) x = static_cast<float>(random.integer(-major, major));
  d[axis] = static_cast<float>(random.chance(0.5) ? major : -major);
  return d;
}

struct LatticeTest {
  bool hit = false, on_edge = false;
  float t = 0, u = 0, v = 0;
};

// Integers throughout. det, U, V and T as Möller and Trumbore define them; closed edges, det != 0.
LatticeTest lattice_test(const Ray& ray, const Triangle& triangle) {
  using Integers = std::array<std::int64_t, 3>;
  const auto minus = [](const Float3& a, const Float3& b) {
    Integers r;
    for (std::size_t i = 0; i < 3; ++i)
      r[i] = static_cast<std::int64_t>(a[i]) - static_cast<std::int64_t>(b[i]);
    return r;
  };
  const auto determinant = [](const Integers& a, const Integers& b, const Integers& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  };
  constexpr Float3 zero{};
  const Integers d = minus(ray.direction, zero), s = minus(ray.origin, triangle.corner[0]);
  const Integers e1 = minus(triangle.corner[1], triangle.corner[0]);
  const Integers e2 = minus(triangle.corner[2], triangle.corner[0]);
  std::int64_t det = determinant(e1, d, e2), u = determinant(s, d, e2), v = determinant(d, s, e1);
  std::int64_t t = determinant(e2, s, e1);
  if (det < 0) det = -det, u = -u, v = -v, t = -t;
  LatticeTest result;
  if (det == 0 || u < 0 || v < 0 || u + v > det) return result;
  const auto divided = [&](std::int64_t x) { return static_cast<float>(x) / static_cast<float>(det); };
  result = {true, u == 0 || v == 0 || u + v == det, divided(t), divided(u), divided(v)};
  result.hit = result.t >= ray.tmin && result.t <= ray.tmax;
  return result;
}

// Puts an end of the segment at the triangle or next to it, now and then.
void trim(Ray& ray, const Triangle& triangle, Random& random) {
  Ray whole = ray;
  whole.tmin = -infinity, whole.tmax = infinity;
  const LatticeTest test = lattice_test(whole, triangle);
  if (!test.hit) return;
  const float at[] = {test.t, std::nextafter(test.t, -infinity), std::nextafter(test.t, infinity)};
  const float end = at[random.integer(0, 2)];
  if (random.chance(0.3)) ray.tmin = end;
  if (random.chance(0.3)) ray.tmax = end;
}

TriangleScene lattice_scene(Random& random) {
  Float3 a = lattice_point(random), b = lattice_point(random), c = lattice_point(random);
  if (random.chance(0.02)) c = a;
  const Triangle triangle = make_triangle(a, b, c);
  TriangleScene scene{{}, corner_orders(triangle)};
  for (int i = 0; i < 40; ++i) {
    Float3 origin = lattice_point(random);
    const Float3 direction = lattice_direction(random);
    // Half the rays pass a corner: a lattice point some steps before it.
    if (random.chance(0.5)) {
      const float back = static_cast<float>(random.integer(0, 2));
      Float3 start = a;
      for (std::size_t axis = 0; axis < 3; ++axis) start[axis] -= back * direction[axis];
      if (std::all_of(start.begin(), start.end(), [](float x) { return std::abs(x) <= lattice; }))
        origin = start;
    }
    Ray ray = make_ray(origin, direction);
    trim(ray, triangle, random);
    scene.rays.push_back(ray);
  }
  return scene;
}

TEST(TrianglesOnALattice, follow_the_convention_exactly_in_both_grades_and_tests) {
  Random random(11);
  std::size_t hits = 0, edge_hits = 0;
  const std::vector<TriangleVariant> variants = all_variants<TriangleTest>();
  for (int round = 0; round < by_level(20, 600, 3000); ++round) {
    TriangleScene scene = lattice_scene(random);
    Results expected, exactly;  // the same, but where t rounds to an end of the segment
    for (std::size_t i = 0; i < scene.size(); ++i) {
      const LatticeTest test = lattice_test(scene.ray(i), scene.triangle(i));
      expected.push_back(test.hit ? TriangleResult{test.t, test.u, test.v, hit_flag} : triangle_missed);
      const bool at_an_end = test.hit && (test.t == scene.ray(i).tmin || test.t == scene.ray(i).tmax);
      const bool misses = at_an_end && !oracle::exact_triangle(scene.ray(i), scene.triangle(i)).hit;
      exactly.push_back(misses ? triangle_missed : expected.back());
      hits += test.hit;
      edge_hits += test.hit && test.on_edge;
    }
    // Powers of two change no bit of the results.
    const float factors[] = {1.0f, 0x1p30f, 0x1p-30f};
    scene.scale(factors[round % 3]);
    for (const TriangleVariant& variant : variants) {
      if (!is_by_determinants(variant.test)) continue;
      // Numbers are prepared again for each of these rays: slow, and the same source as from corners.
      if (reads_corners(variant.test) || round % 10 == 0)
        expect_all(scene, variant.test == TriangleTest::exact ? exactly : expected, variant);
    }
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(hits, 500u);
  EXPECT_GT(edge_hits, hits / 4) << "the lattice has lost its edge cases";
}

}  // namespace
}  // namespace raylanes::testing
