// Ray-triangle kernels on every path against independent code: exact decisions on lattices, the rational
// oracle's classes and bounds elsewhere, the canonical test byte for byte, special values, and array bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "columns.hpp"
#include "generators.hpp"
#include "oracles/exact_triangle.hpp"
#include "reference_tracer.hpp"
#include "supported_paths.hpp"

namespace raylanes::testing {
namespace {

using Results = std::vector<TriangleResult>;
constexpr TriangleResult missed{infinity, 0, 0, 0};

// One of the kernels under test.
struct Variant {
  const Path* path;
  TriangleTest test;
  Grade grade;

  const TriangleKernels& kernels() const {
    return path->table.triangle[static_cast<std::size_t>(test)][static_cast<std::size_t>(grade)];
  }
  std::string name() const {
    return std::string(path->name) + ' ' + std::string(triangle_test_names[static_cast<std::size_t>(test)]) +
           ' ' + std::string(grade_names[static_cast<std::size_t>(grade)]);
  }
};

std::vector<Variant> all_variants() {
  std::vector<Variant> all;
  for (const Path* path : supported_paths())
    for (const TriangleTest test : {TriangleTest::watertight, TriangleTest::moller_trumbore})
      for (const Grade grade : {Grade::reproducible, Grade::fast}) all.push_back({path, test, grade});
  return all;
}

TriangleResult to_result(const Hit& hit) {
  return {hit.t, hit.u, hit.v, hit.primitive == no_primitive ? 0 : hit_flag};
}

// A ray against a triangle by both forms, which must agree.
TriangleResult single(const Variant& variant, const Ray& ray, const TriangleVertices& triangle) {
  const Results a = many_rays(variant.kernels(), {&ray, 1}, {&triangle, 1});
  const Results b = many_triangles(variant.kernels(), {&ray, 1}, {&triangle, 1});
  EXPECT_EQ(a, b) << variant.name() << ": the two forms differ";
  return a[0];
}

bool is_hit(const Variant& variant, const Ray& ray, const TriangleVertices& triangle) {
  return single(variant, ray, triangle).hit != 0;
}

// Rays that are tested against each of some triangles.
struct Scene {
  std::vector<Ray> rays;
  std::vector<TriangleVertices> triangles;

  std::size_t size() const { return rays.size() * triangles.size(); }
  const Ray& ray(std::size_t pair) const { return rays[pair % rays.size()]; }
  const TriangleVertices& triangle(std::size_t pair) const { return triangles[pair / rays.size()]; }
};

// --- Exact decisions on a lattice ------------------------------------------------------------------------

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
  const auto axis = static_cast<std::size_t>(random.integer(0, 2));
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
LatticeTest lattice_test(const Ray& ray, const TriangleVertices& triangle) {
  using Integers = std::array<std::int64_t, 3>;
  const auto minus = [](const float* a, const float* b) {
    Integers r;
    for (std::size_t i = 0; i < 3; ++i)
      r[i] = static_cast<std::int64_t>(a[i]) - static_cast<std::int64_t>(b[i]);
    return r;
  };
  const auto determinant = [](const Integers& a, const Integers& b, const Integers& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  };
  constexpr float zero[3] = {0, 0, 0};
  const Integers d = minus(ray.direction, zero), s = minus(ray.origin, triangle.vertex[0]);
  const Integers e1 = minus(triangle.vertex[1], triangle.vertex[0]);
  const Integers e2 = minus(triangle.vertex[2], triangle.vertex[0]);
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
void trim(Ray& ray, const TriangleVertices& triangle, Random& random) {
  Ray whole = ray;
  whole.tmin = -infinity, whole.tmax = infinity;
  const LatticeTest test = lattice_test(whole, triangle);
  if (!test.hit) return;
  const float at[] = {test.t, std::nextafter(test.t, -infinity), std::nextafter(test.t, infinity)};
  const float end = at[random.integer(0, 2)];
  if (random.chance(0.3)) ray.tmin = end;
  if (random.chance(0.3)) ray.tmax = end;
}

Scene lattice_scene(Random& random) {
  Float3 a = lattice_point(random), b = lattice_point(random), c = lattice_point(random);
  if (random.chance(0.02)) c = a;
  const TriangleVertices triangle = make_triangle(a, b, c);
  Scene scene{{}, corner_orders(triangle)};
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

void scale_scene(Scene& scene, float factor) {
  for (Ray& ray : scene.rays)
    for (int axis = 0; axis < 3; ++axis) ray.origin[axis] *= factor, ray.direction[axis] *= factor;
  for (TriangleVertices& triangle : scene.triangles)
    for (auto& corner : triangle.vertex)
      for (float& x : corner) x *= factor;
}

void expect_all(const Scene& scene, const Results& expected, const Variant& variant) {
  const Results by_triangle = many_rays(variant.kernels(), scene.rays, scene.triangles);
  const Results by_ray = many_triangles(variant.kernels(), scene.rays, scene.triangles);
  for (std::size_t i = 0; i < scene.size(); ++i) {
    ASSERT_EQ(by_triangle[i], by_ray[i]) << variant.name() << " pair " << i << ": the two forms differ";
    ASSERT_EQ(by_ray[i], expected[i]) << variant.name() << " pair " << i << ": hit " << by_ray[i].hit << " t "
                                      << by_ray[i].t << " instead of " << expected[i].t;
  }
}

TEST(TrianglesOnALattice, follow_the_convention_exactly_in_both_grades_and_tests) {
  Random random(11);
  std::size_t hits = 0, edge_hits = 0;
  const std::vector<Variant> variants = all_variants();
  for (int round = 0; round < (quick() ? 20 : 3000); ++round) {
    Scene scene = lattice_scene(random);
    Results expected;
    for (std::size_t i = 0; i < scene.size(); ++i) {
      const LatticeTest test = lattice_test(scene.ray(i), scene.triangle(i));
      expected.push_back(test.hit ? TriangleResult{test.t, test.u, test.v, hit_flag} : missed);
      hits += test.hit;
      edge_hits += test.hit && test.on_edge;
    }
    // Powers of two change no bit of the results.
    const float factors[] = {1.0f, 0x1p30f, 0x1p-30f};
    scale_scene(scene, factors[round % 3]);
    for (const Variant& variant : variants) expect_all(scene, expected, variant);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(hits, 500u);
  EXPECT_GT(edge_hits, hits / 4) << "the lattice has lost its edge cases";
}

// --- Random scenes against the oracles ---------------------------------------------------------------------

enum class Aim { anywhere, edge, corner, off_edge, far, small_and_distant, beside_a_tiny_one, tied_axes };

// 1/u·20u off the edge, in barycentric weight: what a test in floats can resolve at this size.
constexpr double ladder_rung = 16 * 20 * 0x1p-24;

// Two or three components of the direction are equally large, so that the major axis is a matter of
// convention.
Ray ray_with_tied_axes(const TriangleVertices& target, Random& random) {
  const float size = random.number(0.5f, 2);
  Float3 direction, origin;
  for (float& d : direction) d = random.chance(0.5) ? size : -size;
  if (random.chance(0.7)) direction[static_cast<std::size_t>(random.integer(0, 2))] *= random.number(-1, 1);
  const float u = random.number(-0.3f, 1), v = random.number(-0.3f, 1);
  const auto& [a, b, c] = target.vertex;
  for (std::size_t axis = 0; axis < 3; ++axis)
    origin[axis] = a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]) - direction[axis];
  return make_ray(origin, direction);
}

Ray aimed_ray(Aim aim, const Float3& origin, const TriangleVertices& target, Random& random) {
  const double u = random.real(0, 1), v = random.real(0, 1);
  switch (aim) {
    case Aim::tied_axes:
      return ray_with_tied_axes(target, random);
    case Aim::edge:
      return ray_to(origin, target, u, random.chance(0.5) ? 0 : 1 - u);
    case Aim::corner:
      return ray_to(origin, target, random.integer(0, 1), 0);
    case Aim::off_edge:
      return ray_to(origin, target, u, random.chance(0.5) ? ladder_rung : -ladder_rung);
    case Aim::beside_a_tiny_one:
      return ray_to(origin, target, 500 * (u - 0.5), 500 * (v - 0.5));
    default:
      return ray_to(origin, target, 1.6 * u - 0.3, 1.6 * v - 0.3);
  }
}

Scene aimed_scene(Aim aim, Random& random) {
  Scene scene;
  const Float3 centre = aim == Aim::far ? Float3{1e4f, -2e4f, 3e3f} : Float3{0, 0, 0};
  const bool tiny = aim == Aim::small_and_distant || aim == Aim::beside_a_tiny_one;
  for (int i = 0; i < 5; ++i) scene.triangles.push_back(random.triangle(1, centre));
  if (tiny)
    for (TriangleVertices& triangle : scene.triangles)
      triangle = random.triangle(aim == Aim::small_and_distant ? 1e-3f : 1e-5f, random.point(1));
  for (int i = 0; i < 35; ++i) {
    const Float3 origin = random.point(tiny ? 8.0f : 2.0f, centre);
    Ray ray = aimed_ray(aim, origin, scene.triangles[static_cast<std::size_t>(i) % 5], random);
    if (random.chance(0.2))
      for (float& x : ray.direction) x = -x;
    if (random.chance(0.2)) ray.tmin = random.number(-2, 2);
    if (random.chance(0.2)) ray.tmax = random.number(0.5f, 2);
    scene.rays.push_back(ray);
  }
  return scene;
}

struct Judgement {
  oracle::ExactTriangleTest exact;
  oracle::ErrorBounds bounds;
  oracle::Class decision;
};

Judgement judge(const Ray& ray, const TriangleVertices& triangle, oracle::Form form) {
  Judgement judgement{oracle::exact_triangle(ray, triangle), {}, oracle::Class::must_miss};
  judgement.bounds = oracle::error_bounds(ray, triangle, judgement.exact, form);
  judgement.decision = oracle::classify(ray, judgement.exact, judgement.bounds);
  return judgement;
}

bool is_within(float computed, const mpq_class& exact, const std::optional<mpq_class>& bound) {
  return !bound || abs(mpq_class(computed) - exact) <= *bound;
}

// Why the result is wrong, or "".
std::string fault(const TriangleResult& result, const Ray& ray, const Judgement& judgement) {
  if (result.hit == 0) {
    if (judgement.decision == oracle::Class::must_hit) return "missed";
    return result == missed ? "" : "a miss with other values than those of a miss";
  }
  if (result.hit != hit_flag) return "a hit flag that is neither 0 nor all ones";
  if (judgement.decision == oracle::Class::must_miss) return "hit";
  if (!(result.t >= ray.tmin && result.t <= ray.tmax)) return "t outside the segment";
  if (!std::isfinite(result.t) || std::isnan(result.u) || std::isnan(result.v)) return "not a number";
  if (!is_within(result.t, judgement.exact.t, judgement.bounds.t)) return "t beyond its bound";
  if (!is_within(result.u, judgement.exact.u, judgement.bounds.u)) return "u beyond its bound";
  return is_within(result.v, judgement.exact.v, judgement.bounds.v) ? "" : "v beyond its bound";
}

// The share of pairs for which either answer is right.
double check_against_oracle(const Scene& scene, TriangleTest test, const std::vector<Variant>& variants) {
  const oracle::Form form =
      test == TriangleTest::watertight ? oracle::Form::sheared : oracle::Form::moller_trumbore;
  std::vector<Judgement> judgements;
  for (std::size_t i = 0; i < scene.size(); ++i)
    judgements.push_back(judge(scene.ray(i), scene.triangle(i), form));
  std::set<std::string> seen;  // results of equal bits are judged once
  for (const Variant& variant : variants) {
    if (variant.test != test) continue;
    const Results results = many_rays(variant.kernels(), scene.rays, scene.triangles);
    const std::string bytes(reinterpret_cast<const char*>(results.data()),
                            results.size() * sizeof(TriangleResult));
    if (!seen.insert(bytes).second) continue;
    for (std::size_t i = 0; i < scene.size(); ++i)
      EXPECT_EQ(fault(results[i], scene.ray(i), judgements[i]), "") << variant.name() << " pair " << i;
  }
  const auto either = std::count_if(judgements.begin(), judgements.end(),
                                    [](const Judgement& j) { return j.decision == oracle::Class::either; });
  return static_cast<double>(either) / static_cast<double>(scene.size());
}

void check_reproducible(const Scene& scene, const std::vector<Variant>& variants) {
  Results canonical;
  for (std::size_t i = 0; i < scene.size(); ++i)
    canonical.push_back(to_result(canonical_hit(scene.ray(i), scene.triangle(i))));
  const Variant first{&paths().front(), TriangleTest::moller_trumbore, Grade::reproducible};
  const Results plain = many_rays(first.kernels(), scene.rays, scene.triangles);
  for (const Variant& variant : variants) {
    if (variant.grade == Grade::fast) {
      EXPECT_EQ(many_rays(variant.kernels(), scene.rays, scene.triangles),
                many_triangles(variant.kernels(), scene.rays, scene.triangles))
          << variant.name() << ": the two forms differ";
    } else {
      expect_all(scene, variant.test == TriangleTest::watertight ? canonical : plain, variant);
    }
  }
}

// The largest and smallest share of pairs that may go either way: outside, a generator has lost its point.
struct AimCase {
  Aim aim;
  double least_share, most_share;
};

class AimedTriangles : public ::testing::TestWithParam<AimCase> {};

TEST_P(AimedTriangles, are_decided_right_and_alike) {
  Random random(21 + static_cast<std::uint64_t>(GetParam().aim));
  const std::vector<Variant> variants = all_variants();
  const int rounds = quick() ? 2 : 40;
  double share = 0;
  for (int round = 0; round < rounds; ++round) {
    const Scene scene = aimed_scene(GetParam().aim, random);
    check_reproducible(scene, variants);
    for (const TriangleTest test : {TriangleTest::watertight, TriangleTest::moller_trumbore})
      share += check_against_oracle(scene, test, variants) / (2 * rounds);
    if (HasFailure()) return;
  }
  if (quick()) return;
  EXPECT_GE(share, GetParam().least_share);
  EXPECT_LE(share, GetParam().most_share);
}

// A fifth of the pairs are of a ray and the triangle it is aimed at.
INSTANTIATE_TEST_SUITE_P(Aims, AimedTriangles,
                         ::testing::Values(AimCase{Aim::anywhere, 0, 0.001}, AimCase{Aim::edge, 0.1, 0.2},
                                           AimCase{Aim::corner, 0.1, 0.2}, AimCase{Aim::off_edge, 0, 0.05},
                                           AimCase{Aim::far, 0, 0.01},
                                           AimCase{Aim::small_and_distant, 0, 0.02},
                                           AimCase{Aim::beside_a_tiny_one, 0.01, 0.1},
                                           AimCase{Aim::tied_axes, 0, 0.01}));

TEST(WatertightTriangles, have_exact_signs_on_the_sheared_corners) {
  Random random(31);
  const std::vector<Variant> variants = all_variants();
  for (int round = 0; round < (quick() ? 4 : 1500); ++round) {
    for (const Aim aim : {Aim::edge, Aim::corner, Aim::beside_a_tiny_one}) {
      Scene scene = aimed_scene(aim, random);
      for (Ray& ray : scene.rays) ray.tmin = -infinity, ray.tmax = infinity;
      for (const Variant& variant : variants) {
        if (variant.test != TriangleTest::watertight) continue;
        const bool fused = variant.grade == Grade::fast && variant.path->table.has_fma;
        const Results results = many_triangles(variant.kernels(), scene.rays, scene.triangles);
        for (std::size_t i = 0; i < scene.size(); ++i)
          ASSERT_EQ(results[i].hit != 0, axis_passes(shear_triangle(scene.ray(i), scene.triangle(i), fused)))
              << variant.name() << " pair " << i;
      }
    }
  }
}

// --- Named cases
// --------------------------------------------------------------------------------------------

const TriangleVertices floor_triangle = make_triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
const Ray down = make_ray({1, 1, 2}, {0, 0, -1});

TEST(Triangles, values_of_a_plain_hit_and_of_a_miss) {
  for (const Variant& variant : all_variants()) {
    EXPECT_EQ(single(variant, down, floor_triangle), (TriangleResult{2, 0.25f, 0.25f, hit_flag}))
        << variant.name();
    EXPECT_EQ(single(variant, make_ray({3, 3, 2}, {0, 0, -1}), floor_triangle), missed) << variant.name();
  }
}

TEST(Triangles, the_segment_is_closed_at_both_ends) {
  struct Segment {
    float tmin, tmax;
    bool hit;
  };
  const Segment segments[] = {{2, 2, true},
                              {0, 2, true},
                              {2, infinity, true},
                              {0, std::nextafter(2.0f, 0.0f), false},
                              {std::nextafter(2.0f, 3.0f), 9, false},
                              {-infinity, infinity, true},
                              {-infinity, 2, true},
                              {3, 1, false},
                              {infinity, -infinity, false},
                              {infinity, infinity, false},
                              {nan, infinity, false},
                              {0, nan, false},
                              {nan, nan, false}};
  for (const Variant& variant : all_variants())
    for (const Segment& s : segments)
      EXPECT_EQ(is_hit(variant, make_ray({1, 1, 2}, {0, 0, -1}, s.tmin, s.tmax), floor_triangle), s.hit)
          << variant.name() << ' ' << s.tmin << " to " << s.tmax;
}

TEST(Triangles, behind_the_origin_and_at_the_origin) {
  for (const Variant& variant : all_variants()) {
    EXPECT_FALSE(is_hit(variant, make_ray({1, 1, -2}, {0, 0, -1}), floor_triangle)) << variant.name();
    EXPECT_EQ(single(variant, make_ray({1, 1, -2}, {0, 0, -1}, -2), floor_triangle).t, -2) << variant.name();
    for (const TriangleVertices& triangle : corner_orders(floor_triangle)) {
      const TriangleResult result = single(variant, make_ray({1, 1, 0}, {0, 0, -1}), triangle);
      EXPECT_EQ(result.hit, hit_flag) << variant.name();
      EXPECT_FALSE(std::signbit(result.t)) << variant.name() << ": -0 depends on the winding";
    }
    EXPECT_FALSE(is_hit(variant, make_ray({1, 1, 0}, {0, 0, -1}, 1e-30f), floor_triangle)) << variant.name();
  }
}

TEST(Triangles, degenerate_ones_and_rays_in_the_plane_are_missed) {
  const TriangleVertices degenerate[] = {
      make_triangle({0, 0, 0}, {0, 0, 0}, {4, 4, 0}), make_triangle({0, 0, 0}, {2, 2, 0}, {2, 2, 0}),
      make_triangle({2, 2, 0}, {0, 0, 0}, {2, 2, 0}), make_triangle({0, 0, 0}, {1, 1, 0}, {2, 2, 0}),
      make_triangle({1, 1, 0}, {1, 1, 0}, {1, 1, 0})};
  const Ray in_plane[] = {make_ray({-1, 1, 0}, {1, 0, 0}), make_ray({-1, 0, 0}, {1, 0, 0}),
                          make_ray({1, 1, 0}, {1, -1, 0}), make_ray({1, 1, 1}, {1, 0, 0})};
  for (const Variant& variant : all_variants()) {
    for (const TriangleVertices& base : degenerate)
      for (const TriangleVertices& triangle : corner_orders(base))
        EXPECT_EQ(single(variant, down, triangle), missed) << variant.name();
    for (const Ray& ray : in_plane)
      for (const TriangleVertices& triangle : corner_orders(floor_triangle))
        EXPECT_EQ(single(variant, ray, triangle), missed) << variant.name();
  }
}

TEST(Triangles, a_direction_of_zeros_is_a_miss_and_signs_of_zeros_do_not_count) {
  const Ray slanted[] = {make_ray({1, 1, 2}, {0.0f, 0.5f, -1}), make_ray({1, 1, 2}, {-0.0f, 0.5f, -1})};
  const Ray straight[] = {make_ray({1, 1, 2}, {0.0f, -0.0f, -1}), make_ray({1, 1, 2}, {-0.0f, 0.0f, -1})};
  for (const Variant& variant : all_variants()) {
    EXPECT_EQ(single(variant, make_ray({1, 1, 0}, {0, 0, 0}), floor_triangle), missed) << variant.name();
    EXPECT_EQ(single(variant, make_ray({1, 1, 0}, {-0.0f, 0, -0.0f}), floor_triangle), missed)
        << variant.name();
    EXPECT_EQ(single(variant, slanted[0], floor_triangle), single(variant, slanted[1], floor_triangle));
    EXPECT_EQ(single(variant, straight[0], floor_triangle), single(variant, down, floor_triangle));
    EXPECT_EQ(single(variant, straight[1], floor_triangle), single(variant, down, floor_triangle));
  }
}

TEST(Triangles, directions_scale_t_only) {
  Random random(41);
  for (const Variant& variant : all_variants())
    for (int i = 0; i < 40; ++i) {
      const TriangleVertices triangle = random.triangle(1);
      const Ray ray = ray_to(random.point(2), triangle, 0.3, 0.3);
      const TriangleResult unscaled = single(variant, ray, triangle);
      EXPECT_NE(unscaled.hit, 0u) << variant.name();
      for (const int exponent : {-20, 7, 20}) {
        Ray longer = ray;
        for (float& x : longer.direction) x = std::ldexp(x, exponent);
        TriangleResult expected = unscaled;
        expected.t = std::ldexp(unscaled.t, -exponent);
        EXPECT_EQ(single(variant, longer, triangle), expected) << variant.name() << " 2^" << exponent;
      }
    }
}

TEST(Triangles, work_in_scenes_of_any_usable_scale) {
  Random random(42);
  for (const Variant& variant : all_variants())
    for (int exponent = -12; exponent <= 12; ++exponent) {
      const auto scale = static_cast<float>(std::pow(10.0, exponent));
      const TriangleVertices triangle = make_triangle({-scale, -scale, 0}, {scale, -scale, 0}, {0, scale, 0});
      const Float3 origin{random.number(-scale / 4, scale / 4), 0, 2 * scale};
      const TriangleResult result = single(variant, make_ray(origin, {0, 0.6f / 4, -0.8f}), triangle);
      EXPECT_EQ(result.hit, hit_flag) << variant.name() << " 10^" << exponent;
      EXPECT_NEAR(result.t / scale, 2.5, 1e-5) << variant.name() << " 10^" << exponent;
    }
}

// --- Regressions: rays that pass or passed between two triangles (bits from a search) ----------------------

struct SharedEdge {
  Ray ray;
  TriangleVertices left, right;
};

SharedEdge shared_edge(Float3 o, Float3 d, Float3 p, Float3 q, Float3 s, Float3 w) {
  return {make_ray(o, d), make_triangle(p, q, s), make_triangle(q, p, w)};
}

const SharedEdge slips_through_moller_trumbore = shared_edge(
    {0, 0, 0}, {-0x1.2569cp-1f, 0x1.99509ep-2f, 0x1.b64bcap+0f},
    {-0x1.9769dcp-1f, 0x1.70ab2cp-1f, 0x1.93d2d4p+0f}, {0x1.3e1aap-4f, -0x1.12ade8p-1f, 0x1.0d85bep+1f},
    {0x1.dee458p-1f, 0x1.5e3d58p-1f, 0x1.8e7fdp+0f}, {-0x1.80d8b6p-1f, -0x1.10c542p-1f, 0x1.8ef12ap+0f});
const SharedEdge slips_through_contracted_shear =
    shared_edge({-0x1.cp-4f, 0x1.cp-4f, 0x1.ep-3f}, {0x1.4245cp-1f, -0x1.29c144p-2f, 0x1.70f1c2p-1f},
                {-0x1p-6f, -0x1.f8p-1f, 0x1.f6p-1f}, {0x1.cp-2f, -0x1.cp-4f, 0x1.aep-1f},
                {-0x1.2p-3f, 0x1.ep-1f, 0x1.06p+0f}, {0x1.b8p-1f, -0x1.a8p-1f, 0x1.33p+0f});

TEST(KnownLeaks, watertight_closes_them_in_both_grades) {
  for (const Variant& variant : all_variants())
    for (const SharedEdge& edge : {slips_through_moller_trumbore, slips_through_contracted_shear}) {
      const bool hit = is_hit(variant, edge.ray, edge.left) || is_hit(variant, edge.ray, edge.right);
      if (variant.test == TriangleTest::watertight) {
        EXPECT_TRUE(hit) << variant.name();
      }
    }
}

TEST(KnownLeaks, moller_trumbore_without_fma_still_lets_its_ray_through) {
  for (const Variant& variant : all_variants()) {
    if (variant.test != TriangleTest::moller_trumbore || variant.grade != Grade::reproducible) continue;
    const SharedEdge& edge = slips_through_moller_trumbore;
    EXPECT_FALSE(is_hit(variant, edge.ray, edge.left) || is_hit(variant, edge.ray, edge.right))
        << variant.name();
  }
}

TEST(KnownLeaks, an_exact_edge_hit_whose_quotients_sum_to_more_than_one) {
  const TriangleVertices triangle = make_triangle({3, -1, -4}, {3, 4, -3}, {0, -1, 3});
  const Ray ray = make_ray({2, 3, -1}, {2, 1, -4});
  for (const Variant& variant : all_variants())
    if (variant.test == TriangleTest::moller_trumbore) {
      EXPECT_EQ(single(variant, ray, triangle), (TriangleResult{2.0f / 7, 6.0f / 7, 1.0f / 7, hit_flag}))
          << variant.name();
    }
}

// --- Closed meshes
// ------------------------------------------------------------------------------------------

// Points that several triangles share, and those triangles.
struct Target {
  TriangleVertices triangle;  // one of them; the point is on its first edge
  bool is_corner;
  std::vector<TriangleVertices> around;
};

std::vector<Target> shared_points(const Mesh& mesh) {
  std::vector<std::vector<std::size_t>> of_vertex(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t vertex : mesh.triangles[i]) of_vertex[vertex].push_back(i);
  std::vector<Target> targets;
  for (const Index3& corners : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
      std::set<std::size_t> around(of_vertex[a].begin(), of_vertex[a].end());
      around.insert(of_vertex[b].begin(), of_vertex[b].end());
      Target target{triangle_of(mesh.vertices, {a, b, c}), a < b, {}};
      for (const std::size_t i : around)
        target.around.push_back(triangle_of(mesh.vertices, mesh.triangles[i]));
      targets.push_back(target);
    }
  return targets;
}

// Rays from around the middle to a corner, or to points of an edge.
std::vector<Ray> rays_to(const Target& target, const Float3& centre, int count, Random& random) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i)
    rays.push_back(
        ray_to(random.point(0.4f, centre), target.triangle, target.is_corner ? 0 : random.real(0, 1), 0));
  return rays;
}

std::size_t count_leaks(const Variant& variant, const Target& target, RayColumns& rays,
                        TriangleHitColumns& out) {
  std::vector<bool> hit(rays.size());
  for (const TriangleVertices& triangle : target.around) {
    variant.kernels().rays_triangle(rays.arrays(), rays.size(), triangle, out.arrays());
    for (std::size_t i = 0; i < rays.size(); ++i) hit[i] = hit[i] || out[i].hit != 0;
  }
  return static_cast<std::size_t>(std::count(hit.begin(), hit.end(), false));
}

class ClosedMesh : public ::testing::TestWithParam<Float3> {};

TEST_P(ClosedMesh, does_not_leak_where_triangles_meet) {
  const Float3 centre = GetParam();
  const std::vector<Target> targets = shared_points(ellipsoid(quick() ? 1 : 3, centre));
  const std::vector<Variant> variants = all_variants();
  std::vector<std::size_t> leaks(variants.size());
  const int rays_each = quick() ? 9 : 60;  // of 3·1280 targets: 230,400 rays
  Random random(51);
  TriangleHitColumns out(static_cast<std::size_t>(rays_each));
  for (const Target& target : targets) {
    RayColumns rays(rays_to(target, centre, rays_each, random));
    for (std::size_t i = 0; i < variants.size(); ++i)
      if (variants[i].test == TriangleTest::watertight || variants[i].path == &paths().front())
        leaks[i] += count_leaks(variants[i], target, rays, out);
  }
  for (std::size_t i = 0; i < variants.size(); ++i) {
    if (variants[i].test == TriangleTest::watertight) {
      EXPECT_EQ(leaks[i], 0u) << variants[i].name();
    } else if (variants[i].path == &paths().front() && centre[0] == 0) {
      EXPECT_GT(leaks[i], 0u) << variants[i].name() << ": rays that a leaky test stops are aimed at no edge";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Offsets, ClosedMesh,
                         ::testing::Values(Float3{0, 0, 0}, Float3{148376, 1234, -223423}));

// --- Arrays
// -------------------------------------------------------------------------------------------------

Scene mixed_scene(std::size_t rays, std::size_t triangles) {
  Random random(61);
  Scene scene;
  for (std::size_t i = 0; i < triangles; ++i) scene.triangles.push_back(random.triangle(1));
  for (std::size_t i = 0; i < rays; ++i)
    scene.rays.push_back(ray_to(random.point(2), scene.triangles[i % triangles], random.real(-0.2, 1), 0.2));
  return scene;
}

TEST(TriangleArrays, of_any_length_and_alignment_are_as_if_one_by_one) {
  for (const Variant& variant : all_variants()) {
    const auto longest = 2 * static_cast<std::size_t>(variant.path->table.lanes) + 1;
    const Scene scene = mixed_scene(longest, longest);
    Results ray_by_ray, triangle_by_triangle;
    for (std::size_t i = 0; i < longest; ++i) {
      ray_by_ray.push_back(single(variant, scene.rays[i], scene.triangles[0]));
      triangle_by_triangle.push_back(single(variant, scene.rays[0], scene.triangles[i]));
    }
    for (const Place place : {Place::before_guard, Place::after_guard})
      for (std::size_t n = 0; n <= longest; ++n) {
        SCOPED_TRACE(variant.name() + ", n = " + std::to_string(n));
        const std::span rays(scene.rays);
        const std::span triangles(scene.triangles);
        const Results by_triangle = many_rays(variant.kernels(), rays.first(n), triangles.first(1), place);
        const Results by_ray = many_triangles(variant.kernels(), rays.first(1), triangles.first(n), place);
        EXPECT_TRUE(std::equal(by_triangle.begin(), by_triangle.end(), ray_by_ray.begin()));
        EXPECT_TRUE(std::equal(by_ray.begin(), by_ray.end(), triangle_by_triangle.begin()));
      }
  }
}

constexpr float bad_values[] = {nan, infinity, -infinity};

// Input k of 15: origin, direction, corners.
void spoil(Ray& ray, TriangleVertices& triangle, std::size_t k, float value) {
  if (k < 3)
    ray.origin[k] = value;
  else if (k < 6)
    ray.direction[k - 3] = value;
  else
    triangle.vertex[(k - 6) / 3][k % 3] = value;
}

TEST(TriangleArrays, a_bad_number_in_any_input_is_a_miss_and_disturbs_no_other_lane) {
  constexpr std::size_t n = 19;
  for (const Variant& variant : all_variants()) {
    const std::vector<Ray> good_rays(n, down);
    const std::vector<TriangleVertices> good_triangles(n, floor_triangle);
    const TriangleResult good = single(variant, down, floor_triangle);
    for (std::size_t k = 0; k < 15; ++k)
      for (const float value : bad_values) {
        Ray ray = down;
        TriangleVertices triangle = floor_triangle;
        spoil(ray, triangle, k, value);
        EXPECT_EQ(single(variant, ray, triangle), missed)
            << variant.name() << " input " << k << " = " << value;
        const std::size_t lane = (k * 3) % n;
        Results expected(n, good);
        expected[lane] = missed;
        if (k < 6) {
          std::vector<Ray> rays = good_rays;
          rays[lane] = ray;
          EXPECT_EQ(many_rays(variant.kernels(), rays, {&floor_triangle, 1}), expected) << variant.name();
        } else {
          std::vector<TriangleVertices> triangles = good_triangles;
          triangles[lane] = triangle;
          EXPECT_EQ(many_triangles(variant.kernels(), {&down, 1}, triangles), expected) << variant.name();
        }
      }
  }
}

}  // namespace
}  // namespace raylanes::testing
