// Ray-box kernels on every path against exact rational slabs.
//
// The bound. A computed distance (b - o)·(1/d) rounds three times, so it is t(1 + e), |e| <= γ3 = 3u + O(u²),
// u = 2^-24. The far one has one rounding more in the widened reciprocal and the factor 1 + 6u: it is
// t(1 + 6u)(1 + e'), |e'| <= γ4. Minimum and maximum do not round. So with exact entry <= exit, both >= 0:
//   computed entry <= entry(1 + γ3) <= exit(1 + 6u)(1 - γ4) + O(u²)·exit … <= computed exit up to O(u²);
// the O(u²) lies in favour of the far side because u·t is the least step between floats, and the rational
// oracle below sees to it. A box is reported wrongly only if
//   entry(1 - γ3) <= exit(1 + 6u)(1 + γ4), that is if entry - exit <= (3 + 6 + 4)u·exit + O(u²) < 14u·exit.
// The values: |entry - exact| <= 4u·|exact|, and exact <= exit <= exact·(1 + 12u) where exact >= 0. This
// holds where nothing under- or overflows: for 2^-126 <= |d| <= 2^126 or d = 0, and normal or zero t.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "columns.hpp"
#include "generators.hpp"
#include "oracles/exact_box.hpp"
#include "supported_paths.hpp"

namespace raylanes::testing {
namespace {

using Results = std::vector<BoxResult>;
using oracle::exact_interval;
using oracle::ExactInterval;
using oracle::Extended;
constexpr BoxResult missed{infinity, -infinity, 0};

const mpq_class unit_roundoff(0x1p-24);

bool within_rounding(const ExactInterval& exact) {
  if (exact.entry.infinite != 0 || exact.exit.infinite != 0) return false;
  return exact.entry.finite - exact.exit.finite <= 14 * unit_roundoff * abs(exact.exit.finite);
}

bool is_entry(float entry, const Extended& exact) {
  if (exact.infinite != 0 || std::isinf(entry))
    return !(Extended(entry) < exact) && !(exact < Extended(entry));
  return abs(mpq_class(entry) - exact.finite) <= 4 * unit_roundoff * abs(exact.finite);
}

bool is_exit(float exit, const Extended& exact) {
  if (exact.infinite != 0 || std::isinf(exit)) return !(Extended(exit) < exact) && !(exact < Extended(exit));
  const mpq_class excess = mpq_class(exit) - exact.finite;
  return excess >= 0 && excess <= 12 * unit_roundoff * abs(exact.finite);
}

// Why the result is wrong for a ray with tmin >= 0, or "".
std::string fault(const BoxResult& result, const ExactInterval& exact) {
  if (result.hit == 0) {
    if (exact.hit) return "missed";
    return result == missed ? "" : "a miss with other values than those of a miss";
  }
  if (result.hit != hit_flag) return "a hit flag that is neither 0 nor all ones";
  if (!exact.hit) return within_rounding(exact) ? "" : "hit";
  if (!is_entry(result.entry, exact.entry)) return "entry beyond its bound";
  return is_exit(result.exit, exact.exit) ? "" : "exit beyond its bound";
}

// Every ray against every box on every path, in both forms: all bits alike, and right by the oracle. Returns
// the number of exact hits and of false ones.
struct Counts {
  std::size_t hits = 0, false_hits = 0;
};
Counts check(const std::vector<Ray>& rays, const std::vector<Box>& boxes) {
  const Results results = many_rays(paths().front().table.box, rays, boxes);
  for (const Path* path : supported_paths()) {
    EXPECT_EQ(many_rays(path->table.box, rays, boxes), results) << path->name << " rays x box";
    EXPECT_EQ(many_boxes(path->table.box, rays, boxes), results) << path->name << " ray x boxes";
  }
  Counts counts;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Ray& ray = rays[i % rays.size()];
    const Box& box = boxes[i / rays.size()];
    const ExactInterval exact = exact_interval(ray, box);
    counts.hits += exact.hit;
    counts.false_hits += !exact.hit && results[i].hit != 0;
    EXPECT_EQ(fault(results[i], exact), "")
        << "ray " << i % rays.size() << " o " << ray.origin[0] << ' ' << ray.origin[1] << ' ' << ray.origin[2]
        << " d " << ray.direction[0] << ' ' << ray.direction[1] << ' ' << ray.direction[2] << " box "
        << i / rays.size();
  }
  return counts;
}

// --- Random boxes, aimed at
// ----------------------------------------------------------------------------------

Box random_box(Random& random, double flat_share) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const float a = random.number(-1, 1), b = random.chance(flat_share) ? a : random.number(-1, 1);
    box.lo[axis] = std::min(a, b), box.hi[axis] = std::max(a, b);
  }
  return box;
}

// A ray from about `scale` away through a point of an edge, or through a corner.
Ray grazing_ray(const Box& box, float scale, Random& random) {
  const Float3 origin = random.point(2 * scale);
  const int free_axis = random.integer(0, 3);  // 3: none, a corner
  Float3 direction;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = box.lo[axis], hi = box.hi[axis];
    const double target = axis == free_axis ? random.real(lo, hi) : (random.chance(0.5) ? lo : hi);
    const auto k = static_cast<std::size_t>(axis);
    direction[k] = static_cast<float>((target - static_cast<double>(origin[k])) / scale);
  }
  return make_ray(origin, direction);
}

class BoxesFarAway : public ::testing::TestWithParam<float> {};

TEST_P(BoxesFarAway, are_never_missed_by_rays_that_graze_them) {
  Random random(3);
  Counts total;
  for (int round = 0; round < (quick() ? 4 : 400); ++round) {
    std::vector<Box> boxes;
    for (int i = 0; i < 5; ++i) boxes.push_back(random_box(random, i < 2 ? 0.4 : 0));
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < 50; ++i) rays.push_back(grazing_ray(boxes[i % 5], GetParam(), random));
    const Counts counts = check(rays, boxes);
    total.hits += counts.hits, total.false_hits += counts.false_hits;
    if (HasFailure()) return;
  }
  EXPECT_GT(total.hits, quick() ? 20u : 1000u) << "the rays are aimed badly";
}

INSTANTIATE_TEST_SUITE_P(Scales, BoxesFarAway,
                         ::testing::Values(1e0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f, 1e7f));

TEST(Boxes, anywhere_are_hit_exactly) {
  Random random(4);
  std::vector<Box> boxes;
  std::vector<Ray> rays;
  for (int i = 0; i < (quick() ? 20 : 60); ++i) boxes.push_back(random_box(random, 0.1));
  for (int i = 0; i < 100; ++i) {
    Ray ray = make_ray(random.point(2), random.point(1));
    if (random.chance(0.3)) ray.direction[random.integer(0, 2)] = random.chance(0.5) ? 0.0f : -0.0f;
    if (random.chance(0.3)) ray.tmin = random.number(0, 3);
    if (random.chance(0.3)) ray.tmax = random.number(0, 3);
    rays.push_back(ray);
  }
  const Counts counts = check(rays, boxes);
  EXPECT_GT(counts.hits, 10u);
  EXPECT_EQ(counts.false_hits, 0u) << "random rays graze nothing";
}

// --- The table of one axis
// -----------------------------------------------------------------------------------

// The box [-1, 1] of an axis; below, on, inside, on, above it.
constexpr float places[] = {-2, -1, 0.5f, 1, 2};
constexpr float speeds[] = {1,      -1,      0.0f,      -0.0f,    0x1p-149f, -0x1p-149f,
                            1e-30f, -1e-30f, 0x1p-126f, infinity, -infinity, nan};

struct OtherAxis {
  float origin, direction;
};
// Inside and still, crossing, outside and moving in, outside and still, on a face and still.
constexpr OtherAxis others[] = {{0, 0.0f}, {0, -0.0f}, {0.25f, 1}, {-3, 1},
                                {3, 0.0f}, {1, -0.0f}, {-1, 0.0f}};

std::vector<Ray> table_rays(int axis, const OtherAxis& next, const OtherAxis& last) {
  std::vector<Ray> rays;
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  for (const float place : places)
    for (const float speed : speeds) {
      Ray ray = make_ray({0, 0, 0}, {0, 0, 0});
      ray.origin[axis] = place, ray.direction[axis] = speed;
      ray.origin[b] = next.origin, ray.direction[b] = next.direction;
      ray.origin[c] = last.origin, ray.direction[c] = last.direction;
      rays.push_back(ray);
    }
  return rays;
}

// A component below 2^-126 may have an infinite reciprocal. The test may then answer for a component of zero,
// which moves the ray by less than 2^-126·t, but must not miss what the exact ray meets.
std::string tiny_direction_fault(const BoxResult& result, const Ray& ray, const Box& box) {
  Ray flushed = ray;
  for (float& d : flushed.direction)
    if (std::abs(d) < 0x1p-126f) d = 0;
  const bool hit = result.hit != 0, exactly = exact_interval(ray, box).hit;
  if (exactly && !hit) return "missed";
  return hit == exactly || hit == exact_interval(flushed, box).hit ? "" : "hit";
}

bool has_tiny_direction(const Ray& ray) {
  return std::any_of(ray.direction, ray.direction + 3,
                     [](float d) { return d != 0 && std::abs(d) < 0x1p-126f; });
}

TEST(BoxTable, every_place_and_direction_of_one_axis) {
  const Box box{{-1, -1, -1}, {1, 1, 1}};
  std::size_t hits = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const OtherAxis& next : others)
      for (const OtherAxis& last : others)
        for (const Ray& ray : table_rays(axis, next, last)) {
          const ExactInterval exact = exact_interval(ray, box);
          hits += exact.hit;
          for (const Path* path : supported_paths()) {
            const BoxResult result = many_rays(path->table.box, {&ray, 1}, {&box, 1})[0];
            ASSERT_EQ(result, many_boxes(path->table.box, {&ray, 1}, {&box, 1})[0]) << path->name;
            const std::string wrong =
                has_tiny_direction(ray) ? tiny_direction_fault(result, ray, box) : fault(result, exact);
            ASSERT_EQ(wrong, "") << path->name << " axis " << axis << " o " << ray.origin[axis] << " d "
                                 << ray.direction[axis] << " others " << next.origin << ' ' << next.direction
                                 << ' ' << last.origin << ' ' << last.direction;
          }
        }
  EXPECT_GT(hits, 500u);
}

// --- Named cases
// ---------------------------------------------------------------------------------------------

const Box unit_box{{-1, -1, -1}, {1, 1, 1}};

struct NamedCase {
  const char* name;
  Ray ray;
  Box box;
  bool hit;
};

const NamedCase named_cases[] = {
    {"through a flat box", make_ray({0, 0, 2}, {0, 0, -1}), {{-1, -1, 0}, {1, 1, 0}}, true},
    {"in the plane of a flat box", make_ray({-2, 0, 0}, {1, 0, 0}), {{-1, -1, 0}, {1, 1, 0}}, true},
    {"beside the plane of a flat box", make_ray({-2, 0, 1}, {1, 0, 0}), {{-1, -1, 0}, {1, 1, 0}}, false},
    {"through a box that is a line", make_ray({0, 1, 2}, {0, 0, -1}), {{-1, 1, 0}, {1, 1, 0}}, true},
    {"along a box that is a line", make_ray({-2, 1, 0}, {1, 0, 0}), {{-1, 1, 0}, {1, 1, 0}}, true},
    {"through a point", make_ray({-1, -2, -3}, {1, 2, 3}), {{1, 2, 3}, {1, 2, 3}}, true},
    {"past a point", make_ray({-1, -2, -3}, {1, 2, 3}), {{1, 2, 4}, {1, 2, 4}}, false},
    {"from a point box", make_ray({1, 2, 3}, {1, 0, 0}), {{1, 2, 3}, {1, 2, 3}}, true},
    {"through a corner", make_ray({-3, 1, 1}, {1, 0, 0}), unit_box, true},
    {"through a corner aslant", make_ray({3, -1, -1}, {-2, 2, 2}), unit_box, true},
    {"past a corner aslant", make_ray({3, -0.5f, -1}, {-2, 2, 2}, 0), {{-1, -1, -1}, {1, 1, 0.5f}}, false},
    {"along an edge", make_ray({1, 1, -5}, {0, -0.0f, 1}), unit_box, true},
    {"the empty box",
     make_ray({0, 0, 0}, {1, 1, 1}),
     {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}},
     false},
    {"a box inverted on x", make_ray({0, 0, 0}, {1, 1, 1}), {{1, -1, -1}, {-1, 1, 1}}, false},
    {"a box inverted on z, ray along x", make_ray({0, 0, 0}, {1, 0, 0}), {{-1, -1, 1}, {1, 1, -1}}, false},
    {"the infinite box",
     make_ray({5, 6, 7}, {1, 0, -1}),
     {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}},
     true},
    {"a half-infinite box, inwards", make_ray({-5, 0, 0}, {1, 0, 0}), {{0, -1, -1}, {infinity, 1, 1}}, true},
    {"a half-infinite box, outwards",
     make_ray({-5, 0, 0}, {-1, 0, 0}),
     {{0, -1, -1}, {infinity, 1, 1}},
     false},
    {"an infinite slab, still in it",
     make_ray({0, 0, 5}, {0, 0, -1}),
     {{-infinity, -infinity, -1}, {infinity, infinity, 1}},
     true},
    {"behind", make_ray({0, 0, 5}, {0, 0, 1}), unit_box, false},
    {"tmin inside", make_ray({0, 0, 5}, {0, 0, -1}, 5), unit_box, true},
    {"tmax before the box", make_ray({0, 0, 5}, {0, 0, -1}, 0, 3.5f), unit_box, false},
    {"tmax at the entry", make_ray({0, 0, 5}, {0, 0, -1}, 0, 4), unit_box, true},
    {"tmin at the entry", make_ray({0, 0, 5}, {0, 0, -1}, 4), unit_box, true},
    {"tmin at the exit", make_ray({0, 0, 5}, {0, 0, -1}, 6), unit_box, true},
    {"tmin behind the box", make_ray({0, 0, 5}, {0, 0, -1}, 6.5f), unit_box, false},
    {"tmin > tmax in the box", make_ray({0, 0, 5}, {0, 0, -1}, 5.5f, 5), unit_box, false},
    {"tmin is NaN", make_ray({0, 0, 5}, {0, 0, -1}, nan), unit_box, false},
    {"tmax is NaN", make_ray({0, 0, 5}, {0, 0, -1}, 0, nan), unit_box, false},
    {"no direction", make_ray({0, 0, 0}, {0, -0.0f, 0}), unit_box, false},
    {"the largest numbers",
     make_ray({-0x1.fffffep127f, 0, 0}, {1, 0, 0}),
     {{0x1.fffffep127f, -1, -1}, {0x1.fffffep127f, 1, 1}},
     true},
};

TEST(Boxes, named_cases) {
  for (const Path* path : supported_paths())
    for (const NamedCase& c : named_cases) {
      const BoxResult result = many_rays(path->table.box, {&c.ray, 1}, {&c.box, 1})[0];
      EXPECT_EQ(result.hit, c.hit ? hit_flag : 0) << path->name << ": " << c.name;
      EXPECT_EQ(result, many_boxes(path->table.box, {&c.ray, 1}, {&c.box, 1})[0])
          << path->name << ": " << c.name;
      EXPECT_EQ(exact_interval(c.ray, c.box).hit, c.hit) << "the oracle: " << c.name;
      if (!c.hit) {
        EXPECT_EQ(result, missed) << path->name << ": " << c.name;
      }
    }
}

TEST(Boxes, entry_and_exit_are_clipped_to_the_segment) {
  const Ray whole = make_ray({0, 0, 5}, {0, 0, -1}), part = make_ray({0, 0, 5}, {0, 0, -1}, 4.5f, 5.5f);
  for (const Path* path : supported_paths()) {
    const BoxResult all = many_rays(path->table.box, {&whole, 1}, {&unit_box, 1})[0];
    EXPECT_EQ(all.entry, 4) << path->name;
    EXPECT_GE(all.exit, 6) << path->name;
    EXPECT_LE(all.exit, 6 * (1 + 12 * 0x1p-24)) << path->name;
    EXPECT_EQ(many_rays(path->table.box, {&part, 1}, {&unit_box, 1})[0], (BoxResult{4.5f, 5.5f, hit_flag}));
  }
}

// Rays that the plain slab test, without widening, misses; found by search.
TEST(Boxes, corners_that_rounding_would_miss) {
  const Ray rays[] = {make_ray({-2, -1.5f, 0}, {0.644531f, 0.708984f, 0}),
                      make_ray({-1.25f, -0.75f, 0}, {0.587891f, 0.0839844f, 0})};
  const Box boxes[] = {{{-2, -0.125f, -1}, {-0.75f, 1, 1}}, {{-1, -0.625f, -1}, {-0.375f, 0, 1}}};
  for (std::size_t i = 0; i < 2; ++i) check({rays[i]}, {boxes[i]});
}

// --- Arrays
// --------------------------------------------------------------------------------------------------

TEST(BoxArrays, of_any_length_and_alignment_are_as_if_one_by_one) {
  Random random(5);
  std::vector<Ray> rays;
  std::vector<Box> boxes;
  for (int i = 0; i < 33; ++i) {
    boxes.push_back(random_box(random, 0.1));
    rays.push_back(grazing_ray(boxes[0], 2, random));
  }
  for (const Path* path : supported_paths()) {
    const BoxKernels& kernels = path->table.box;
    Results by_ray, by_box;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      by_ray.push_back(many_rays(kernels, {&rays[i], 1}, {&boxes[0], 1})[0]);
      by_box.push_back(many_boxes(kernels, {&rays[0], 1}, {&boxes[i], 1})[0]);
    }
    for (std::size_t n = 0; n <= 2 * static_cast<std::size_t>(path->table.lanes) + 1; ++n)
      for (const Place place : {Place::before_guard, Place::after_guard}) {
        SCOPED_TRACE(std::string(path->name) + ", n = " + std::to_string(n));
        const Results a = many_rays(kernels, std::span(rays).first(n), {&boxes[0], 1}, place);
        const Results b = many_boxes(kernels, {&rays[0], 1}, std::span(boxes).first(n), place);
        EXPECT_TRUE(std::equal(a.begin(), a.end(), by_ray.begin()));
        EXPECT_TRUE(std::equal(b.begin(), b.end(), by_box.begin()));
      }
  }
}

// Input k of 12: origin, direction, lo, hi.
void spoil(Ray& ray, Box& box, std::size_t k, float value) {
  float* const inputs[] = {ray.origin, ray.direction, box.lo, box.hi};
  inputs[k / 3][k % 3] = value;
}

TEST(BoxArrays, a_nan_in_any_input_is_a_miss_and_disturbs_no_other_lane) {
  constexpr std::size_t n = 19;
  const Ray good_ray = make_ray({0.5f, 0.25f, 5}, {0, 0.125f, -1});
  for (const Path* path : supported_paths()) {
    const BoxResult good = many_rays(path->table.box, {&good_ray, 1}, {&unit_box, 1})[0];
    ASSERT_NE(good.hit, 0u);
    for (std::size_t k = 0; k < 12; ++k) {
      const std::size_t lane = (k * 7) % n;
      std::vector<Ray> rays(n, good_ray);
      std::vector<Box> boxes(n, unit_box);
      spoil(rays[lane], boxes[lane], k, nan);
      Results expected(n, good);
      expected[lane] = missed;
      SCOPED_TRACE(std::string(path->name) + ", input " + std::to_string(k));
      if (k < 6) {
        EXPECT_EQ(many_rays(path->table.box, rays, {&unit_box, 1}), expected);
        EXPECT_EQ(many_boxes(path->table.box, {&rays[lane], 1}, boxes), Results(n, missed));
      } else {
        EXPECT_EQ(many_boxes(path->table.box, {&good_ray, 1}, boxes), expected);
        EXPECT_EQ(many_rays(path->table.box, rays, {&boxes[lane], 1}), Results(n, missed));
      }
    }
  }
}

TEST(BoxArrays, an_infinite_ray_is_a_miss) {
  for (const Path* path : supported_paths())
    for (std::size_t k = 0; k < 6; ++k)
      for (const float value : {infinity, -infinity}) {
        Ray ray = make_ray({0.5f, 0.25f, 5}, {0, 0.125f, -1});
        Box box{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
        spoil(ray, box, k, value);
        EXPECT_EQ(many_rays(path->table.box, {&ray, 1}, {&box, 1})[0], missed)
            << path->name << " input " << k;
      }
}

}  // namespace
}  // namespace raylanes::testing
