// All triangle forms on every path: those that must equal the table's kernels bit for bit, the others against
// exact arithmetic with a bound, the extremes, any count, active masks, and what must not change results.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "float_modes.hpp"
#include "generators.hpp"
#include "oracles/exact_triangle.hpp"
#include "supported_paths.hpp"
#include "triangle_answers.hpp"

namespace raylanes::testing {
namespace {

using Results = std::vector<TriangleResult>;
constexpr TriangleResult missed{infinity, 0, 0, 0};

struct Scene {
  std::vector<Ray> rays;
  std::vector<TriangleVertices> triangles;
};

enum class Aim { anywhere, edge, corner, ladder, far };
constexpr Aim aims[] = {Aim::anywhere, Aim::edge, Aim::corner, Aim::ladder, Aim::far};

// 19 rays and 19 triangles, so that every width has a rest; the last triangle is the first again, so that the
// nearest hit has an equal.
Scene scene_of(Aim aim, Random& random) {
  Scene scene;
  const Float3 centre = aim == Aim::far ? Float3{1e4f, -2e4f, 3e3f} : Float3{0, 0, 0};
  for (int i = 0; i < 18; ++i) scene.triangles.push_back(random.triangle(1, centre));
  scene.triangles.push_back(scene.triangles.front());
  for (std::size_t i = 0; i < 19; ++i) {
    const TriangleVertices& target = scene.triangles[i];
    const Float3 origin = random.point(2, centre);
    const double u = random.real(0, 1), rung = random.integer(1, 100) * 20 * 0x1p-24;
    Ray ray = aim == Aim::edge     ? ray_to(origin, target, u, random.chance(0.5) ? 0 : 1 - u)
              : aim == Aim::corner ? ray_to(origin, target, random.integer(0, 1), 0)
              : aim == Aim::ladder ? ray_to(origin, target, u, random.chance(0.5) ? rung : -rung)
                                   : ray_to(origin, target, u, random.real(-0.3, 0.6));
    if (random.chance(0.2)) ray.tmin = random.number(-2, 2);
    if (random.chance(0.3)) ray.tmax = random.number(0.5f, 2);
    if (random.chance(0.2))
      for (float& x : ray.direction) x = -x;
    scene.rays.push_back(ray);
  }
  return scene;
}

// Integers, where nothing rounds: half of the rays meet an edge exactly.
Scene integer_scene(Random& random) {
  const auto point = [&] {
    Float3 p;
    for (float& x : p) x = static_cast<float>(random.integer(-3, 3));
    return p;
  };
  Scene scene;
  for (int i = 0; i < 17; ++i) scene.triangles.push_back(make_triangle(point(), point(), point()));
  for (int i = 0; i < 17; ++i) {
    Float3 d = point();
    d[static_cast<std::size_t>(random.integer(0, 2))] = random.chance(0.5) ? 4.0f : -4.0f;
    scene.rays.push_back(make_ray(point(), d, random.chance(0.5) ? 0.0f : -infinity));
  }
  return scene;
}

// The kernels of the table that a form must equal, if there are any.
const TriangleKernels* twin_of(const FormVariant& variant) {
  const bool watertight = variant.form == TriangleForm::watertight;
  const bool moller_trumbore = variant.form == TriangleForm::moller_trumbore ||
                               variant.form == TriangleForm::moller_trumbore_edges ||
                               variant.form == TriangleForm::directional;
  if (!watertight && !moller_trumbore) return nullptr;
  return &variant.path->table.triangle[watertight ? 0 : 1][variant.grade_index()];
}

void check_against_twin(const Scene& scene) {
  for (const FormVariant& variant : all_forms())
    if (const TriangleKernels* twin = twin_of(variant)) {
      ASSERT_EQ(answers(variant, scene.rays, scene.triangles), many_rays(*twin, scene.rays, scene.triangles))
          << variant.name();
    }
}

TEST(TriangleForms, equal_the_kernels_of_the_table_bit_for_bit) {
  Random random(101);
  for (int round = 0; round < (quick() ? 1 : 12); ++round) {
    for (const Aim aim : aims) check_against_twin(scene_of(aim, random));
    check_against_twin(integer_scene(random));
    if (HasFailure()) return;
  }
}

TEST(TriangleForms, have_the_same_bits_on_every_path_in_the_reproducible_grade) {
  Random random(102);
  for (int round = 0; round < (quick() ? 1 : 8); ++round)
    for (const Aim aim : aims) {
      const Scene scene = scene_of(aim, random);
      std::map<TriangleForm, Results> first;
      for (const FormVariant& variant : all_forms()) {
        if (variant.grade != Grade::reproducible) continue;
        const Results results = answers(variant, scene.rays, scene.triangles);
        const auto [kept, is_new] = first.emplace(variant.form, results);
        ASSERT_TRUE(is_new || kept->second == results) << variant.name();
      }
    }
}

// --- Against exact arithmetic

using Double3 = std::array<double, 3>;

Double3 minus(const float* a, const float* b) {
  return {double(a[0]) - b[0], double(a[1]) - b[1], double(a[2]) - b[2]};
}
Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Double3& a, const Double3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double length(const Double3& a) {
  return std::sqrt(dot(a, a));
}

struct Bound {
  double t, weight;
};

// How far t and the weights of a plane-based form may be off, in double, with u = 2^-24 and factors for the
// roundings counted generously (each sum of three products: at most 6u of the product of the lengths).
//   t = n·x / n·d: 16u·(|n||x| + |t||n||d|)/|n·d|, x the numbers in the numerator: s = v0 − o for the
//   precomputed form, v0 and o apart for plane_edges. The cross products of the edges in n and the weights
//   count with their permanent, |e1||e2|.
//   The point is off by u·(what it is added from) and by |d| times the error of t; a weight by that over the
//   height of the triangle, whose inverse is at most the length of the longest row a, b.
Bound bound_of(TriangleForm form, const Ray& ray, const TriangleVertices& triangle, double t) {
  const double u = 0x1p-24;
  const Double3 e1 = minus(triangle.vertex[1], triangle.vertex[0]);
  const Double3 e2 = minus(triangle.vertex[2], triangle.vertex[0]);
  const Double3 e3 = minus(triangle.vertex[2], triangle.vertex[1]);
  const Double3 s = minus(triangle.vertex[0], ray.origin);
  const float zero[3] = {0, 0, 0};
  const Double3 d = minus(ray.direction, zero), o = minus(ray.origin, zero),
                v0 = minus(triangle.vertex[0], zero);
  const double n_d = std::fabs(dot(cross(e1, e2), d)), edges = length(e1) * length(e2);
  const double longest = std::max({length(e1), length(e2), length(e3)});
  const double area = length(cross(e1, e2));
  const bool local = form == TriangleForm::precomputed;
  const double from = local ? length(s) : length(o) + length(v0) + longest;
  const double t_error = 16 * u * edges * (from + std::fabs(t) * length(d)) / n_d;
  const double point_error = length(d) * t_error + 4 * u * (from + std::fabs(t) * length(d));
  // The rows' or cross products' own roundings, on vectors within reach of the triangle.
  const double own = 16 * u * longest * longest * edges / (area * area) * longest;
  return {t_error, (point_error * longest * edges / area + own * edges) / area + 16 * u};
}

// Wrong answers outside the bound; counts the pairs within it.
void check_against_exact(const FormVariant& variant, const Scene& scene, std::size_t& ambiguous,
                         std::size_t& hits) {
  const Results results = answers(variant, scene.rays, scene.triangles);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Ray& ray = scene.rays[i % scene.rays.size()];
    const TriangleVertices& triangle = scene.triangles[i / scene.rays.size()];
    const oracle::ExactTriangleTest exact = oracle::exact_triangle(ray, triangle);
    if (exact.det == 0) {
      EXPECT_EQ(results[i], missed) << variant.name();
      continue;
    }
    const double t = exact.t.get_d(), u = exact.u.get_d(), v = exact.v.get_d();
    const Bound bound = bound_of(variant.form, ray, triangle, t);
    const double margin = std::min({u, v, 1 - u - v});
    const bool in_segment = t - bound.t >= ray.tmin && t + bound.t <= ray.tmax;
    const bool out_of_segment = t + bound.t < ray.tmin || t - bound.t > ray.tmax;
    const bool must_hit = margin > bound.weight && in_segment;
    const bool must_miss = margin < -bound.weight || out_of_segment;
    ambiguous += !must_hit && !must_miss;
    hits += must_hit;
    ASSERT_FALSE(must_hit && results[i].hit == 0) << variant.name() << " misses, margin " << margin;
    ASSERT_FALSE(must_miss && results[i].hit != 0) << variant.name() << " hits, margin " << margin;
    if (results[i].hit == 0) continue;
    ASSERT_NEAR(results[i].t, t, bound.t + 0x1p-149) << variant.name();
    ASSERT_NEAR(results[i].u, u, bound.weight) << variant.name();
    ASSERT_NEAR(results[i].v, v, bound.weight) << variant.name();
  }
}

// The share of pairs that may go either way, asserted so that no generator drifts into vacuity: a 19th of the
// pairs are of a ray and the triangle it is aimed at.
TEST(TriangleForms, on_planes_are_right_outside_their_bound) {
  for (const TriangleForm form :
       {TriangleForm::plane_edges_plain, TriangleForm::plane_edges, TriangleForm::precomputed})
    for (const Aim aim : aims) {
      Random random(103 + static_cast<std::uint64_t>(aim));
      std::size_t ambiguous = 0, hits = 0, pairs = 0;
      for (int round = 0; round < (quick() ? 1 : 15); ++round) {
        const Scene scene = scene_of(aim, random);
        for (const FormVariant& variant : all_forms()) {
          if (variant.form != form) continue;
          check_against_exact(variant, scene, ambiguous, hits);
          pairs += scene.rays.size() * scene.triangles.size();
          if (HasFailure()) return;
        }
      }
      if (quick()) continue;
      const double share = static_cast<double>(ambiguous) / static_cast<double>(pairs);
      // plane_edges loses the far scene: its n·p − n·o cancels what the distance from the origin put in.
      const bool far_plane = aim == Aim::far && form != TriangleForm::precomputed;
      EXPECT_LE(share, far_plane                                ? 0.6
                       : aim == Aim::edge || aim == Aim::corner ? 0.12
                                                                : 0.06)
          << triangle_form_names[static_cast<std::size_t>(form)] << " aim " << static_cast<int>(aim);
      if (aim == Aim::edge || aim == Aim::corner) {
        EXPECT_GE(share, 0.02);
      }
      EXPECT_GT(hits, far_plane ? 0u : pairs / 50);
    }
}

// --- The extremes

struct NamedCase {
  const char* name;
  Ray ray;
  TriangleVertices triangle;
  enum Answer { miss, hit, no_nan } answer;  // no_nan: out of range, either, but never a NaN in a hit
  float t;                                   // of a hit
};

const TriangleVertices floor_triangle = make_triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
constexpr float largest = 0x1.fffffep127f, least = 0x1p-149f;

const NamedCase named_cases[] = {
    {"inside", make_ray({1, 1, 2}, {0, 0, -1}), floor_triangle, NamedCase::hit, 2},
    {"from below", make_ray({1, 1, -2}, {0, 0, 1}), floor_triangle, NamedCase::hit, 2},
    {"outside across the first edge", make_ray({1, -1, 2}, {0, 0, -1}), floor_triangle, NamedCase::miss, 0},
    {"outside across the second edge", make_ray({3, 3, 2}, {0, 0, -1}), floor_triangle, NamedCase::miss, 0},
    {"outside across the third edge", make_ray({-1, 1, 2}, {0, 0, -1}), floor_triangle, NamedCase::miss, 0},
    {"beyond a corner", make_ray({-1, -1, 2}, {0, 0, -1}), floor_triangle, NamedCase::miss, 0},
    {"aslant", make_ray({-1, -1, 2}, {1, 1, -1}), floor_triangle, NamedCase::hit, 2},
    {"aslant past it", make_ray({-1, -1, 2}, {-1, 1, -1}), floor_triangle, NamedCase::miss, 0},
    {"a long direction", make_ray({1, 1, 2}, {0, 0, -16}), floor_triangle, NamedCase::hit, 0.125f},
    {"a short direction", make_ray({1, 1, 2}, {0, 0, -0x1p-10f}), floor_triangle, NamedCase::hit, 2048},
    {"minus zeros", make_ray({1, 1, 2}, {-0.0f, -0.0f, -1}), floor_triangle, NamedCase::hit, 2},
    {"one zero", make_ray({1, 0, 2}, {0, 0.5f, -1}), floor_triangle, NamedCase::hit, 2},
    {"behind", make_ray({1, 1, 2}, {0, 0, 1}), floor_triangle, NamedCase::miss, 0},
    {"behind, but within the segment", make_ray({1, 1, 2}, {0, 0, 1}, -3), floor_triangle, NamedCase::hit,
     -2},
    {"t = tmin", make_ray({1, 1, 2}, {0, 0, -1}, 2), floor_triangle, NamedCase::hit, 2},
    {"t = tmax", make_ray({1, 1, 2}, {0, 0, -1}, 0, 2), floor_triangle, NamedCase::hit, 2},
    {"tmin above t", make_ray({1, 1, 2}, {0, 0, -1}, 0x1.000002p1f), floor_triangle, NamedCase::miss, 0},
    {"tmax below t", make_ray({1, 1, 2}, {0, 0, -1}, 0, 0x1.fffffep0f), floor_triangle, NamedCase::miss, 0},
    {"on the plane, tmin 0", make_ray({1, 1, 0}, {0, 0, -1}), floor_triangle, NamedCase::hit, 0},
    {"on the plane, tmin > 0", make_ray({1, 1, 0}, {0, 0, -1}, 1e-30f), floor_triangle, NamedCase::miss, 0},
    {"tmin = -inf", make_ray({1, 1, 2}, {0, 0, 1}, -infinity), floor_triangle, NamedCase::hit, -2},
    {"tmin > tmax", make_ray({1, 1, 2}, {0, 0, -1}, 3, 1), floor_triangle, NamedCase::miss, 0},
    {"tmin NaN", make_ray({1, 1, 2}, {0, 0, -1}, nan), floor_triangle, NamedCase::miss, 0},
    {"tmax NaN", make_ray({1, 1, 2}, {0, 0, -1}, 0, nan), floor_triangle, NamedCase::miss, 0},
    {"in the plane, crossing", make_ray({-1, 1, 0}, {1, 0, 0}), floor_triangle, NamedCase::miss, 0},
    {"in the plane, along an edge", make_ray({-1, 0, 0}, {1, 0, 0}), floor_triangle, NamedCase::miss, 0},
    {"parallel to the plane", make_ray({-1, 1, 1}, {1, 0, 0}), floor_triangle, NamedCase::miss, 0},
    {"direction 0", make_ray({1, 1, 0}, {0, -0.0f, 0}), floor_triangle, NamedCase::miss, 0},
    {"two equal corners", make_ray({1, 1, 2}, {0, 0, -1}), make_triangle({0, 0, 0}, {4, 4, 0}, {4, 4, 0}),
     NamedCase::miss, 0},
    {"collinear", make_ray({1, 1, 2}, {0, 0, -1}), make_triangle({0, 0, 0}, {1, 1, 0}, {4, 4, 0}),
     NamedCase::miss, 0},
    {"a point", make_ray({1, 1, 2}, {0, 0, -1}), make_triangle({1, 1, 0}, {1, 1, 0}, {1, 1, 0}),
     NamedCase::miss, 0},
    {"small scene", make_ray({0x1p-40f, 0x1p-40f, 0x1p-39f}, {0, 0, -1}),
     make_triangle({0, 0, 0}, {0x1p-38f, 0, 0}, {0, 0x1p-38f, 0}), NamedCase::hit, 0x1p-39f},
    {"large scene", make_ray({0x1p38f, 0x1p38f, 0x1p39f}, {0, 0, -1}),
     make_triangle({0, 0, 0}, {0x1p40f, 0, 0}, {0, 0x1p40f, 0}), NamedCase::hit, 0x1p39f},
    {"|d| = 1e-30", make_ray({1, 1, 2}, {0, 0, -1e-30f}), floor_triangle, NamedCase::no_nan, 0},
    {"|d| = 1e18", make_ray({1, 1, 2}, {0, 0, -1e18f}), floor_triangle, NamedCase::no_nan, 0},
    {"|d| the largest", make_ray({1, 1, 2}, {0, 0, -largest}), floor_triangle, NamedCase::no_nan, 0},
    {"|d| the least", make_ray({1, 1, 2}, {0, 0, -least}), floor_triangle, NamedCase::no_nan, 0},
    {"a far triangle of the largest numbers", make_ray({1, 1, 2}, {0, 0, -1}),
     make_triangle({-largest, -largest, 0}, {largest, 0, 0}, {0, largest, 0}), NamedCase::no_nan, 0},
    {"the least triangle", make_ray({0, 0, 1}, {0, 0, -1}),
     make_triangle({0, 0, 0}, {least, 0, 0}, {0, least, 0}), NamedCase::no_nan, 0},
};

void check_case(const FormVariant& variant, const NamedCase& c, const TriangleVertices& triangle) {
  const TriangleResult result = answers(variant, {&c.ray, 1}, {&triangle, 1})[0];
  if (c.answer == NamedCase::miss) {
    EXPECT_EQ(result, missed) << variant.name() << ": " << c.name;
  } else if (c.answer == NamedCase::hit) {
    EXPECT_EQ(result.hit, hit_flag) << variant.name() << ": " << c.name;
    EXPECT_FLOAT_EQ(result.t, c.t) << variant.name() << ": " << c.name;
    EXPECT_FALSE(std::signbit(result.t) && result.t == 0) << variant.name() << ": " << c.name;
  } else if (result.hit != 0) {
    EXPECT_FALSE(std::isnan(result.t)) << variant.name() << ": " << c.name;
  }
}

TEST(TriangleExtremes, named_cases_in_all_corner_orders_and_float_modes) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    SCOPED_TRACE(name_of(mode));
    for (const FormVariant& variant : all_forms())
      for (const NamedCase& c : named_cases)
        for (const TriangleVertices& triangle : corner_orders(c.triangle)) check_case(variant, c, triangle);
  }
}

// A determinant that underflows to zero with all weights, where t would be infinite. The sheared test has no
// such determinant: it sees the hit, at a t that overflows.
TEST(TriangleExtremes, a_determinant_that_underflows_is_a_miss) {
  const Ray ray = make_ray({0.0625f, 0.0625f, 2}, {0, 0, -least});
  const TriangleVertices triangle = make_triangle({0, 0, 0}, {0.25f, 0, 0}, {0, 0.25f, 0});
  for (const FormVariant& variant : all_forms())
    for (const TriangleVertices& t : corner_orders(triangle))
      if (variant.form != TriangleForm::watertight) {
        EXPECT_EQ(answers(variant, {&ray, 1}, {&t, 1})[0], missed) << variant.name();
      }
}

// Edges and corners of a triangle with integer coordinates: closed, so a hit, for the forms that decide on
// exact numbers there; precomputed rows are thirds and sevenths.
TEST(TriangleExtremes, exact_edges_and_corners_are_hit) {
  const TriangleVertices triangle = floor_triangle;
  const double weights[][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0, 0.5}, {0.5, 0.5}, {0.25, 0.75}};
  for (const FormVariant& variant : all_forms()) {
    if (variant.form == TriangleForm::precomputed) continue;
    for (const auto& w : weights)
      for (const TriangleVertices& t : corner_orders(triangle)) {
        const Ray ray = ray_to({1, 2, 8}, triangle, w[0], w[1], 0.125);
        EXPECT_EQ(answers(variant, {&ray, 1}, {&t, 1})[0].hit, hit_flag) << variant.name();
      }
  }
}

TEST(TriangleExtremes, a_bad_number_in_any_input_is_a_miss_and_disturbs_no_other_lane) {
  const Ray down = make_ray({1, 1, 2}, {0, 0, -1});
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    for (const FormVariant& variant : all_forms())
      for (std::size_t k = 0; k < 15; ++k)
        for (const float bad : {nan, -nan, infinity, -infinity}) {
          std::vector<Ray> rays(3, down);
          std::vector<TriangleVertices> triangles(3, floor_triangle);
          if (k < 6)
            (k < 3 ? rays[1].origin : rays[1].direction)[k % 3] = bad;
          else
            triangles[1].vertex[(k - 6) / 3][k % 3] = bad;
          const Results results = answers(variant, rays, triangles);
          for (std::size_t i = 0; i < results.size(); ++i) {
            const bool spoiled = k < 6 ? i % 3 == 1 : i / 3 == 1;
            ASSERT_EQ(results[i].hit, spoiled ? 0 : hit_flag) << variant.name() << " input " << k;
          }
        }
  }
}

// --- What must not change results

TEST(TriangleForms, scaling_mirrors_and_shuffles_change_no_bit) {
  Random random(105);
  for (int round = 0; round < (quick() ? 1 : 5); ++round) {
    const Scene scene = scene_of(aims[round], random);
    Scene scaled = scene, mirrored = scene, shuffled = scene;
    for (Ray& ray : scaled.rays)
      for (int axis = 0; axis < 3; ++axis) ray.origin[axis] *= 0x1p20f, ray.direction[axis] *= 0x1p20f;
    for (TriangleVertices& triangle : scaled.triangles)
      for (auto& corner : triangle.vertex)
        for (float& x : corner) x *= 0x1p20f;
    const int flipped = round % 3;
    for (Ray& ray : mirrored.rays)
      ray.origin[flipped] = -ray.origin[flipped], ray.direction[flipped] = -ray.direction[flipped];
    for (TriangleVertices& triangle : mirrored.triangles)
      for (auto& corner : triangle.vertex) corner[flipped] = -corner[flipped];
    std::reverse(shuffled.rays.begin(), shuffled.rays.end());
    std::reverse(shuffled.triangles.begin(), shuffled.triangles.end());
    for (const FormVariant& variant : all_forms()) {
      const Results results = answers(variant, scene.rays, scene.triangles);
      // Kahan's determinant is not symmetric in its two products: which of them is rounded changes with a
      // mirror, by less than its bound.
      const bool kahan = variant.form == TriangleForm::watertight && variant.grade == Grade::fast;
      const bool fused = variant.grade == Grade::fast && variant.path->table.has_fma;
      ASSERT_EQ(answers(variant, scaled.rays, scaled.triangles), results) << variant.name() << " scaled";
      if (!(kahan && fused)) {
        ASSERT_EQ(answers(variant, mirrored.rays, mirrored.triangles), results)
            << variant.name() << " mirrored";
      }
      Results back = answers(variant, shuffled.rays, shuffled.triangles);
      std::reverse(back.begin(), back.end());
      ASSERT_EQ(back, results) << variant.name() << " shuffled";
    }
  }
}

// Only fused arithmetic misses this one: the grades differ where NUMERICS says they may.
TEST(TriangleForms, keep_a_hit_that_fused_arithmetic_loses) {
  const Ray ray = make_ray({0x1.6p-3f, 0, 0x1.cp-3f}, {0x1.f24224p-3f, 0x1.20d156p-2f, 0x1.db2812p-1f});
  const TriangleVertices triangle =
      make_triangle({0x1.18p-1f, 0x1.cp-3f, 0x1.2fp+0f}, {-0x1.8p-5f, 0x1.3p-1f, 0x1.36p+0f},
                    {-0x1.8p-1f, 0x1.2p-3f, 0x1.9p-1f});
  for (const FormVariant& variant : all_forms())
    if (variant.grade == Grade::reproducible && variant.form == TriangleForm::moller_trumbore) {
      EXPECT_EQ(answers(variant, {&ray, 1}, {&triangle, 1})[0].hit, hit_flag) << variant.name();
    }
}

// Equal hits on both sides of a register's end: the first of them is in the last lane of any width.
TEST(TriangleForms, keep_the_first_of_equal_hits) {
  const Ray ray = make_ray({1, 1, 2}, {0, 0, -1});
  std::vector<TriangleVertices> triangles(32, make_triangle({9, 9, 0}, {8, 9, 0}, {9, 8, 0}));
  triangles[15] = triangles[16] = floor_triangle;
  for (const FormVariant& variant : all_forms()) {
    const PreparedTriangles prepared(variant, triangles, ray.direction);
    for (const Wanted wanted : {Wanted::distance, Wanted::weights})
      EXPECT_EQ(
          closest_hit(variant.loops(), wanted, ray, prepared.columns(), variant.columns(), 32).hit.primitive,
          15u)
          << variant.name();
  }
}

// --- Counts, masks, and what is wanted

TEST(TriangleForms, of_any_count_and_alignment_stay_within_their_arrays) {
  Random random(106);
  const Scene scene = scene_of(Aim::anywhere, random);
  for (const FormVariant& variant : all_forms()) {
    if (variant.form == TriangleForm::directional) continue;
    const Results whole = answers(variant, scene.rays, scene.triangles);
    for (const Place place : {Place::before_guard, Place::after_guard})
      for (std::size_t n = 0; n <= scene.rays.size(); ++n) {
        const PreparedTriangles prepared(variant, std::span(scene.triangles).first(n), nullptr, place);
        GuardedArray<std::uint8_t> bits(n / 8 + 1, place);
        std::fill_n(bits.data(), bits.size(), std::uint8_t{0xff});
        any_hits(variant.loops().any_of_triangles, scene.rays[0], prepared.columns(), variant.columns(), n,
                 bits.data());
        for (std::size_t i = 0; i < bits.size() * 8; ++i) {
          const bool expected = i >= n || whole[i * scene.rays.size()].hit != 0;
          ASSERT_EQ((bits[i / 8] >> (i % 8) & 1) != 0, expected) << variant.name() << " n " << n;
        }
        ASSERT_TRUE(bits.is_intact()) << variant.name() << " n " << n;
        RayColumns rays(std::span(scene.rays).first(n), place);
        TriangleHitColumns out(n, place);
        const PreparedTriangles target(variant, std::span(scene.triangles).first(1), nullptr);
        const TriangleHitArrays to = out.arrays();
        closest_hits(variant.loops(), Wanted::weights, rays.arrays(), n, target.one(0).data(),
                     {to.t, to.hit, to.u, to.v, {}});
        for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(out[i], whole[i]) << variant.name() << " n " << n;
        ASSERT_TRUE(out.are_intact()) << variant.name() << " n " << n;
      }
  }
}

TEST(TriangleForms, leave_the_outputs_of_inactive_lanes_untouched) {
  Random random(107);
  for (const FormVariant& variant : all_forms()) {
    if (variant.form == TriangleForm::directional) continue;
    Scene scene = scene_of(Aim::anywhere, random);
    for (Ray& ray : scene.rays) ray.tmin = -infinity;
    const Results whole = answers(variant, scene.rays, scene.triangles);
    std::uint8_t active[3] = {};
    for (std::size_t i = 0; i < 19; ++i)
      if (random.chance(0.5)) active[i / 8] = static_cast<std::uint8_t>(active[i / 8] | 1u << (i % 8));
    const auto is_active = [&](std::size_t i) { return (active[i / 8] >> (i % 8) & 1) != 0; };
    std::vector<Ray> spoiled_rays = scene.rays;
    std::vector<TriangleVertices> spoiled = scene.triangles;
    for (std::size_t i = 0; i < 19; ++i)
      if (!is_active(i)) {
        spoiled_rays[i] = make_ray({nan, nan, nan}, {nan, nan, nan}, nan, nan);
        spoiled[i] = make_triangle({nan, nan, nan}, {nan, nan, nan}, {nan, nan, nan});
      }
    const PreparedTriangles prepared(variant, spoiled, nullptr);
    std::uint8_t bits[3] = {0x5a, 0xa5, 0x5a};
    any_hits(variant.loops().any_of_triangles, scene.rays[0], prepared.columns(), variant.columns(), 19, bits,
             active);
    RayColumns rays(spoiled_rays);
    TriangleHitColumns out(19);
    const TriangleResult before = out[0];
    const TriangleHitArrays to = out.arrays();
    const PreparedTriangles target(variant, std::span(scene.triangles).first(1), nullptr);
    closest_hits(variant.loops(), Wanted::weights, rays.arrays(), 19, target.one(0).data(),
                 {to.t, to.hit, to.u, to.v, {}}, active);
    for (std::size_t i = 0; i < 19; ++i) {
      const std::uint8_t old[3] = {0x5a, 0xa5, 0x5a};
      const bool untouched = (old[i / 8] >> (i % 8) & 1) != 0;
      const bool hit = whole[i * 19].hit != 0;
      ASSERT_EQ((bits[i / 8] >> (i % 8) & 1) != 0, is_active(i) ? hit : untouched) << variant.name();
      ASSERT_EQ(out[i], is_active(i) ? whole[i] : before) << variant.name();
    }
    Hit nearest{infinity, 0, 0, no_primitive};
    for (std::uint32_t i = 0; i < 19; ++i)
      if (is_active(i) && whole[i * 19].hit != 0 && whole[i * 19].t < nearest.t)
        nearest = {whole[i * 19].t, whole[i * 19].u, whole[i * 19].v, i};
    const Hit found = closest_hit(variant.loops(), Wanted::weights, scene.rays[0], prepared.columns(),
                                  variant.columns(), 19, active)
                          .hit;
    EXPECT_EQ(std::memcmp(&found, &nearest, sizeof found), 0) << variant.name();
  }
}

TEST(TriangleForms, compute_what_is_wanted_and_nothing_else) {
  const Ray ray = make_ray({1, 1, 2}, {0, 0, -1});
  const TriangleVertices triangles[2] = {make_triangle({0, 4, 1}, {4, 0, 1}, {0, 0, 1}), floor_triangle};
  for (const FormVariant& variant : all_forms()) {
    const PreparedTriangles prepared(variant, triangles, ray.direction);
    for (const Wanted wanted : {Wanted::distance, Wanted::weights, Wanted::weights_and_normal}) {
      const NearestHit found =
          closest_hit(variant.loops(), wanted, ray, prepared.columns(), variant.columns(), 2);
      EXPECT_EQ(found.hit.primitive, 0u) << variant.name();
      EXPECT_EQ(found.hit.t, 1) << variant.name();
      const bool weights = wanted != Wanted::distance, normal = wanted == Wanted::weights_and_normal;
      EXPECT_FLOAT_EQ(found.hit.u, weights ? 0.25f : 0) << variant.name();
      EXPECT_FLOAT_EQ(found.hit.v, weights ? 0.5f : 0) << variant.name();
      EXPECT_EQ(found.normal[0], 0) << variant.name();
      EXPECT_EQ(found.normal[2], normal ? -16 : 0) << variant.name();
      RayColumns rays({&ray, 1});
      float t, u, v, n[3];
      std::uint32_t hit;
      closest_hits(variant.loops(), Wanted::weights_and_normal, rays.arrays(), 1, prepared.one(1).data(),
                   {&t, &hit, &u, &v, {&n[0], &n[1], &n[2]}});
      EXPECT_EQ(n[2], 16) << variant.name();
      EXPECT_EQ(t, 2) << variant.name();
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
