// Sphere tests on every path: decisions against rational arithmetic, distances in 256 bits, lattices,
// the extremes.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "../dispatch/intersect.hpp"
#include "columns.hpp"
#include "float_modes.hpp"
#include "generators.hpp"
#include "oracles/exact_sphere.hpp"
#include "supported_paths.hpp"

namespace raylanes::testing {
namespace {

using oracle::exact_sphere;
using oracle::ExactSphere;
using oracle::Sphere;

struct Result {
  float near, far;
  std::uint32_t hit;
  friend bool operator==(const Result& a, const Result& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
};
using Results = std::vector<Result>;
constexpr Result missed{infinity, -infinity, 0};

struct Variant {
  const Path* path;
  SphereTest test;
  Grade grade;
  const SphereLoops& loops() const {
    return path->intersections.sphere[static_cast<std::size_t>(test)][static_cast<std::size_t>(grade)];
  }
  std::string name() const {
    return std::string(path->name) + ' ' + std::string(sphere_test_names[static_cast<std::size_t>(test)]) +
           ' ' + std::string(grade_names[static_cast<std::size_t>(grade)]);
  }
};

std::vector<Variant> all_variants() {
  std::vector<Variant> all;
  for (const Path* path : supported_paths())
    for (const SphereTest test : {SphereTest::perpendicular, SphereTest::textbook})
      for (const Grade grade : {Grade::reproducible, Grade::fast}) all.push_back({path, test, grade});
  return all;
}

Sphere ball(const Float3& centre, float radius) {
  return {{centre[0], centre[1], centre[2], signed_square(radius)}};
}

class SphereColumns {
 public:
  explicit SphereColumns(std::span<const Sphere> spheres, Place place = Place::unguarded)
      : values_(4, spheres.size(), place) {
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t i = 0; i < spheres.size(); ++i) values_[c][i] = spheres[i].value[c];
      pointers_[c] = values_[c];
    }
  }
  Columns columns() const { return pointers_; }

 private:
  FloatColumns values_;
  const float* pointers_[4];
};

bool bit(const std::vector<std::uint8_t>& bits, std::size_t i) {
  return (bits[i / 8] >> (i % 8) & 1u) != 0;
}

// All rays of sphere 0, all rays of sphere 1 …, by all four loops, which must agree.
Results answers(const Variant& variant, std::span<const Ray> rays, std::span<const Sphere> spheres,
                Place place = Place::unguarded) {
  RayColumns ray_columns(rays, place);
  const SphereColumns sphere_columns(spheres, place);
  Results results(rays.size() * spheres.size());
  const std::size_t most = std::max(rays.size(), spheres.size());
  BoxHitColumns out(most, place);  // two floats and a flag, too
  const BoxHitArrays to = out.arrays();
  std::vector<std::uint8_t> bits(most / 8 + 1);
  for (std::size_t s = 0; s < spheres.size(); ++s) {
    distances(variant.loops(), ray_columns.arrays(), rays.size(), spheres[s].value,
              {to.entry, to.exit, to.hit});
    any_hits(variant.loops().any_of_rays, ray_columns.arrays(), rays.size(), spheres[s].value, bits.data());
    for (std::size_t r = 0; r < rays.size(); ++r) {
      results[s * rays.size() + r] = {out[r].entry, out[r].exit, out[r].hit};
      EXPECT_EQ(bit(bits, r), out[r].hit != 0) << variant.name() << ": any of rays";
    }
  }
  for (std::size_t r = 0; r < rays.size(); ++r) {
    distances(variant.loops(), rays[r], sphere_columns.columns(), spheres.size(),
              {to.entry, to.exit, to.hit});
    any_hits(variant.loops().any_of_spheres, rays[r], sphere_columns.columns(), 4, spheres.size(),
             bits.data());
    for (std::size_t s = 0; s < spheres.size(); ++s) {
      EXPECT_EQ((Result{out[s].entry, out[s].exit, out[s].hit}), results[s * rays.size() + r])
          << variant.name() << ": the two forms differ";
      EXPECT_EQ(bit(bits, s), out[s].hit != 0) << variant.name() << ": any of spheres";
    }
  }
  EXPECT_TRUE(out.are_intact()) << variant.name();
  return results;
}

bool line_hits(const Path& path, Grade grade, const Ray& ray, const Sphere& sphere) {
  std::uint8_t bits = 0;
  const SphereColumns columns({&sphere, 1});
  any_hits(path.intersections.line_of_spheres[static_cast<std::size_t>(grade)], ray, columns.columns(), 4, 1,
           &bits);
  return (bits & 1) != 0;
}

// --- Distance over radius from 1 to 10^5

struct Scene {
  std::vector<Ray> rays;
  std::vector<Sphere> spheres;
};

Scene scene_at(double distance, Random& random) {
  Scene scene;
  for (int i = 0; i < 9; ++i) {
    const Float3 centre = random.point(3);
    const float radius = random.number(0.5f, 2);
    scene.spheres.push_back(ball(centre, radius));
    for (int k = 0; k < 3; ++k) {
      const Float3 away = random.point(1), side = random.point(1.2f);
      Float3 origin, direction;
      const float length = random.number(0.1f, 2);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        origin[axis] = static_cast<float>(static_cast<double>(centre[axis]) +
                                          distance * static_cast<double>(radius * away[axis]));
        direction[axis] = (centre[axis] + radius * side[axis] - origin[axis]) * length;
      }
      Ray ray = make_ray(origin, direction);
      if (random.chance(0.2)) ray.tmax = random.number(0, 2);
      if (random.chance(0.2)) ray.tmin = random.number(0, 2);
      scene.rays.push_back(ray);
    }
  }
  return scene;
}

struct Counts {
  std::size_t pairs = 0, hits = 0, wrong = 0, near_tangent = 0;
  double worst_ulp = 0;
};

double ulp(float x) {
  return std::nextafter(std::abs(x), infinity) - std::abs(x);
}

// Wrong decisions only within the bound of the contract, distances within 16 ULP of (D + r)/|d|.
void judge(const Variant& variant, const Scene& scene, Counts& counts) {
  const Results results = answers(variant, scene.rays, scene.spheres);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Ray& ray = scene.rays[i % scene.rays.size()];
    const Sphere& sphere = scene.spheres[i / scene.rays.size()];
    const ExactSphere exact = exact_sphere(ray, sphere);
    const bool hit = results[i].hit != 0;
    const bool clear =
        std::abs(exact.free) >
        64 * 0x1p-24 * exact.distance *
            std::max(exact.radius, std::sqrt(std::max(0.0, exact.radius * exact.radius - exact.free)));
    ++counts.pairs;
    counts.hits += exact.hit;
    counts.near_tangent += !clear;
    counts.wrong += hit != exact.hit;
    if (variant.test == SphereTest::perpendicular && clear) {
      ASSERT_EQ(hit, exact.hit) << variant.name() << " D/r " << exact.distance / exact.radius << " free "
                                << exact.free;
    }
    if (!hit || !exact.hit) {
      ASSERT_TRUE(hit || results[i] == missed) << variant.name();
      continue;
    }
    ASSERT_LE(results[i].near, results[i].far) << variant.name();
    if (exact.line_free < 0.01 * exact.radius * exact.radius) continue;
    const double unit = ulp(static_cast<float>((exact.distance + exact.radius) / exact.speed));
    const double error =
        std::max(std::abs(results[i].near - exact.near), std::abs(results[i].far - exact.far)) / unit;
    counts.worst_ulp = std::max(counts.worst_ulp, error);
    if (variant.test == SphereTest::perpendicular) {
      ASSERT_LE(error, 16) << variant.name() << " D/r " << exact.distance / exact.radius;
    }
  }
}

TEST(Spheres, perpendicular_is_right_outside_its_bound_at_any_distance) {
  for (const double distance : {1.0, 1e1, 1e2, 1e3, 1e4, 1e5})
    for (const Variant& variant : all_variants()) {
      Random random(301);
      Counts counts;
      for (int round = 0; round < (quick() ? 1 : 15); ++round) {
        judge(variant, scene_at(distance, random), counts);
        if (HasFatalFailure()) return;
      }
      if (quick()) continue;
      EXPECT_GT(counts.hits, counts.pairs / 30);
      // What the bound leaves open: next to nothing up to 10^3, a few percent at 10^5.
      EXPECT_LE(static_cast<double>(counts.near_tangent),
                static_cast<double>(counts.pairs) * (distance < 5e3 ? 0.02 : 0.5))
          << distance;
      // The textbook form is there to be seen failing.
      if (variant.test == SphereTest::textbook && distance >= 1e4) {
        EXPECT_GT(counts.wrong, counts.pairs / 50) << variant.name();
      }
    }
}

TEST(Spheres, have_the_same_bits_on_every_path_in_the_reproducible_grade) {
  Random random(302);
  for (int round = 0; round < (quick() ? 1 : 6); ++round) {
    const Scene scene = scene_at(std::pow(10.0, round), random);
    std::map<SphereTest, Results> first;
    for (const Variant& variant : all_variants()) {
      if (variant.grade != Grade::reproducible) continue;
      const Results results = answers(variant, scene.rays, scene.spheres);
      const auto [kept, is_new] = first.emplace(variant.test, results);
      ASSERT_TRUE(is_new || kept->second == results) << variant.name();
    }
  }
}

TEST(Spheres, lines_are_decided_within_the_same_bound) {
  for (const double distance : {1.0, 1e2, 1e4})
    for (const Path* path : supported_paths())
      for (const Grade grade : {Grade::reproducible, Grade::fast}) {
        Random random(303);
        const Scene scene = scene_at(distance, random);
        for (const Sphere& sphere : scene.spheres)
          for (Ray ray : scene.rays) {
            ray.tmin = -infinity, ray.tmax = infinity;
            const ExactSphere exact = exact_sphere(ray, sphere);
            const double off = std::sqrt(std::max(0.0, exact.radius * exact.radius - exact.free));
            if (std::abs(exact.free) <= 64 * 0x1p-24 * exact.distance * std::max(exact.radius, off)) continue;
            ASSERT_EQ(line_hits(*path, grade, ray, sphere), exact.hit) << path->name << ' ' << distance;
          }
      }
}

// --- Huge balls close by: the ground of a planet

TEST(Spheres, huge_ones_keep_their_distances) {
  Random random(304);
  for (const float radius : {1e3f, 1e5f, 1e6f})
    for (int i = 0; i < 50; ++i) {
      const Sphere sphere = ball({0, 0, -radius}, radius);
      const Ray ray = make_ray({random.number(-1, 1), random.number(-1, 1), random.number(0.5f, 2)},
                               {random.number(-1, 1), random.number(-1, 1), -1});
      const ExactSphere exact = exact_sphere(ray, sphere);
      for (const Variant& variant : all_variants()) {
        if (variant.test != SphereTest::perpendicular) continue;
        const Result result = answers(variant, {&ray, 1}, {&sphere, 1})[0];
        ASSERT_EQ(result.hit, hit_flag) << variant.name();
        // centre − origin is rounded once in float for the middle of the chord, a relative error of t.
        ASSERT_NEAR(result.near, exact.near, 1e-5 * exact.near) << variant.name() << " radius " << radius;
        ASSERT_NEAR(result.far, exact.far, 1e-6 * exact.far) << variant.name() << " radius " << radius;
      }
    }
}

// --- Named cases

struct NamedCase {
  const char* name;
  Ray ray;
  Sphere sphere;
  bool hit;
  float near, far;
};

const Sphere unit = ball({0, 0, 0}, 1);
const NamedCase named_cases[] = {
    {"through the centre", make_ray({0, 0, 5}, {0, 0, -1}), unit, true, 4, 6},
    {"a chord of a triangle 3-4-5", make_ray({3, 0, 10}, {0, 0, -1}), ball({0, 0, 0}, 5), true, 6, 14},
    {"a chord along y", make_ray({0, 10, 4}, {0, -1, 0}), ball({0, 0, 0}, 5), true, 7, 13},
    {"a chord along x", make_ray({-10, 4, 0}, {1, 0, 0}), ball({0, 0, 0}, 5), true, 7, 13},
    {"tangent", make_ray({5, 0, 10}, {0, 0, -1}), ball({0, 0, 0}, 5), true, 10, 10},
    {"tangent aslant in a plane", make_ray({3, 4, 7}, {0, 0, -2}), ball({0, 0, 0}, 5), true, 3.5f, 3.5f},
    {"tangent at the origin", make_ray({5, 0, 0}, {0, 0, -1}), ball({0, 0, 0}, 5), true, 0, 0},
    {"just outside", make_ray({0x1.400002p2f, 0, 10}, {0, 0, -1}), ball({0, 0, 0}, 5), false, 0, 0},
    {"just outside on y", make_ray({0, 0x1.400002p2f, 10}, {0, 0, -1}), ball({0, 0, 0}, 5), false, 0, 0},
    {"just outside on z", make_ray({10, 0, 0x1.400002p2f}, {-1, 0, 0}), ball({0, 0, 0}, 5), false, 0, 0},
    {"a long direction", make_ray({0, 0, 5}, {0, 0, -0x1p20f}), unit, true, 0x1p-18f, 0x1.8p-18f},
    {"a short direction", make_ray({0, 0, 5}, {0, 0, -0x1p-100f}), unit, true, 0x1p102f, 0x1.8p102f},
    {"from the centre", make_ray({0, 0, 0}, {0, 0, 2}), unit, true, -0.5f, 0.5f},
    {"from inside", make_ray({0, 0, 0.5f}, {0, 0, 1}), unit, true, -1.5f, 0.5f},
    {"from the surface, outwards", make_ray({0, 0, 1}, {0, 0, 1}), unit, true, -2, 0},
    {"from the surface, inwards", make_ray({0, 0, 1}, {0, 0, -1}), unit, true, 0, 2},
    {"behind", make_ray({0, 0, 5}, {0, 0, 1}), unit, false, 0, 0},
    {"behind, but within the segment", make_ray({0, 0, 5}, {0, 0, 1}, -5), unit, true, -6, -4},
    {"tmax before it", make_ray({0, 0, 5}, {0, 0, -1}, 0, 3.5f), unit, false, 0, 0},
    {"tmax at it", make_ray({0, 0, 5}, {0, 0, -1}, 0, 4), unit, true, 4, 6},
    {"tmin behind it", make_ray({0, 0, 5}, {0, 0, -1}, 6.5f), unit, false, 0, 0},
    {"tmin at its end", make_ray({0, 0, 5}, {0, 0, -1}, 6), unit, true, 4, 6},
    {"a segment inside", make_ray({0, 0, 0}, {0, 0, 1}, -0.25f, 0.25f), unit, true, -1, 1},
    {"a point hit exactly", make_ray({-1, -2, -3}, {1, 2, 3}), ball({0, 0, 0}, 0), true, 1, 1},
    {"a point passed", make_ray({-1, -2, -3}, {1, 2, 3}), ball({0, 0, 1}, 0), false, 0, 0},
    {"a negative radius", make_ray({0, 0, 5}, {0, 0, -1}), ball({0, 0, 0}, -1), false, 0, 0},
    {"a radius of FLT_MIN is a point", make_ray({1e-3f, 0, 5}, {0, 0, -1}), ball({0, 0, 0}, 0x1p-126f), false,
     0, 0},
    {"a radius of 1e18", make_ray({0, 0, 2e18f}, {0, 0, -1}), ball({0, 0, 0}, 0x1p59f), true, 2e18f - 0x1p59f,
     2e18f + 0x1p59f},
    {"all of space", make_ray({0, 0, 5}, {0, 0, -1}), ball({0, 0, 0}, 1e30f), true, -infinity, infinity},
    {"direction 0", make_ray({0, 0, 0}, {0, -0.0f, 0}), unit, false, 0, 0},
    {"tmin > tmax", make_ray({0, 0, 5}, {0, 0, -1}, 5.5f, 4.5f), unit, false, 0, 0},
    {"tmin NaN", make_ray({0, 0, 5}, {0, 0, -1}, nan), unit, false, 0, 0},
    {"tmax NaN", make_ray({0, 0, 5}, {0, 0, -1}, 0, nan), unit, false, 0, 0},
};

TEST(Spheres, named_cases_in_both_float_modes) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    for (const Variant& variant : all_variants()) {
      if (variant.test != SphereTest::perpendicular) continue;
      for (const NamedCase& c : named_cases) {
        const Result result = answers(variant, {&c.ray, 1}, {&c.sphere, 1})[0];
        SCOPED_TRACE(variant.name() + ' ' + name_of(mode) + ": " + c.name);
        EXPECT_EQ(result.hit, c.hit ? hit_flag : 0);
        if (!c.hit) {
          EXPECT_EQ(result, missed);
          continue;
        }
        EXPECT_FLOAT_EQ(result.near, c.near);
        EXPECT_FLOAT_EQ(result.far, c.far);
      }
    }
  }
}

TEST(Spheres, lines_meet_balls_behind_and_ahead) {
  for (const Path* path : supported_paths())
    for (const Grade grade : {Grade::reproducible, Grade::fast}) {
      EXPECT_TRUE(line_hits(*path, grade, make_ray({0, 0, 5}, {0, 0, 1}), unit)) << path->name;
      EXPECT_TRUE(line_hits(*path, grade, make_ray({5, 0, 10}, {0, 0, 1}), ball({0, 0, 0}, 5))) << path->name;
      EXPECT_TRUE(line_hits(*path, grade, make_ray({0, 5, 10}, {0, 0, 1}), ball({0, 0, 0}, 5))) << path->name;
      EXPECT_FALSE(line_hits(*path, grade, make_ray({0, 5.01f, 10}, {0, 0, 1}), ball({0, 0, 0}, 5)));
      EXPECT_FALSE(line_hits(*path, grade, make_ray({5.01f, 0, 10}, {0, 0, 1}), ball({0, 0, 0}, 5)));
      EXPECT_FALSE(line_hits(*path, grade, make_ray({0, 0, 5}, {0, 0, 0}), unit)) << path->name;
      EXPECT_FALSE(line_hits(*path, grade, make_ray({0, 0, 5}, {0, 0, 1}), ball({nan, 0, 0}, 1)))
          << path->name;
      EXPECT_FALSE(line_hits(*path, grade, make_ray({0, 0, 5}, {0, 0, 1}), {{0, 0, 0, nan}})) << path->name;
      EXPECT_FALSE(line_hits(*path, grade, make_ray({0, 0, 5}, {0, 0, 1}), {{0, 0, 0, -nan}})) << path->name;
      EXPECT_FALSE(line_hits(*path, grade, make_ray({0, 0, 5}, {0, 0, 1}), {{infinity, 0, 0, 1}}))
          << path->name;
    }
}

TEST(Spheres, scales_and_directions_by_powers_of_two_change_no_bit) {
  Random random(305);
  const Scene scene = scene_at(10, random);
  Scene longer = scene;
  for (Ray& ray : longer.rays) {
    for (float& x : ray.direction) x *= 0x1p60f;
    ray.tmin *= 0x1p-60f, ray.tmax *= 0x1p-60f;
  }
  for (const Variant& variant : all_variants()) {
    Results results = answers(variant, scene.rays, scene.spheres);
    for (Result& r : results)
      if (r.hit != 0) r.near *= 0x1p-60f, r.far *= 0x1p-60f;
    ASSERT_EQ(answers(variant, longer.rays, longer.spheres), results) << variant.name();
  }
}

TEST(Spheres, a_nan_anywhere_is_a_miss_and_disturbs_no_other_lane) {
  for (const Variant& variant : all_variants())
    for (std::size_t k = 0; k < 12; ++k)
      for (const float bad : {nan, -nan, infinity}) {
        std::vector<Ray> rays(3, make_ray({0.1f, 0.2f, 5}, {0, 0.01f, -1}));
        std::vector<Sphere> spheres(3, unit);
        if (k >= 9 && bad == infinity) continue;  // radius and ends of the segment may be infinite
        if (k < 6)
          (k < 3 ? rays[1].origin : rays[1].direction)[k % 3] = bad;
        else if (k < 10)
          spheres[1].value[k - 6] = bad;
        else
          (k == 10 ? rays[1].tmin : rays[1].tmax) = bad;
        const Results results = answers(variant, rays, spheres);
        for (std::size_t i = 0; i < 9; ++i) {
          const bool spoiled = k >= 6 && k < 10 ? i / 3 == 1 : i % 3 == 1;
          ASSERT_EQ(results[i].hit, spoiled ? 0 : hit_flag) << variant.name() << " input " << k << " " << bad;
        }
      }
}

TEST(Spheres, of_any_count_and_with_inactive_lanes) {
  Random random(306);
  const Scene scene = scene_at(3, random);
  for (const Variant& variant : all_variants()) {
    const Results whole = answers(variant, scene.rays, scene.spheres);
    const std::size_t all = scene.rays.size();
    for (const Place place : {Place::before_guard, Place::after_guard})
      for (const std::size_t n : {1u, 3u, 5u, 8u, 9u}) {
        const Results part =
            answers(variant, std::span(scene.rays).first(2 * n), std::span(scene.spheres).first(n), place);
        for (std::size_t i = 0; i < part.size(); ++i)
          ASSERT_EQ(part[i], whole[i / (2 * n) * all + i % (2 * n)]) << variant.name();
      }
    const std::uint8_t active[4] = {0x35, 0xff, 0xff, 0x02};
    RayColumns rays(scene.rays);
    BoxHitColumns out(all);
    const BoxResult before = out[0];
    const BoxHitArrays to = out.arrays();
    distances(variant.loops(), rays.arrays(), all, scene.spheres[0].value, {to.entry, to.exit, to.hit},
              active);
    for (std::size_t i = 0; i < all; ++i) {
      const bool is_active = (active[i / 8] >> (i % 8) & 1) != 0;
      const BoxResult expected = is_active ? BoxResult{whole[i].near, whole[i].far, whole[i].hit} : before;
      ASSERT_EQ(out[i], expected) << variant.name();
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
