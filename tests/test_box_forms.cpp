// All box forms on every path: the conservative one against the table's, the plain one within rounding of
// exact slabs, the directional one without a false miss and with false hits only where its padding reaches.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../dispatch/intersect.hpp"
#include "columns.hpp"
#include "float_modes.hpp"
#include "generators.hpp"
#include "oracles/exact_box.hpp"
#include "supported_paths.hpp"

namespace raylanes::testing {
namespace {

using oracle::exact_interval;
using oracle::ExactInterval;
using Results = std::vector<BoxResult>;
constexpr BoxResult missed{infinity, -infinity, 0};

struct Variant {
  const Path* path;
  BoxTest test;
  Grade grade;
  const BoxLoops& loops() const {
    return path->intersections.box[static_cast<std::size_t>(test)][static_cast<std::size_t>(grade)];
  }
  std::string name() const {
    return std::string(path->name) + ' ' + std::string(box_test_names[static_cast<std::size_t>(test)]) + ' ' +
           std::string(grade_names[static_cast<std::size_t>(grade)]);
  }
};

std::vector<Variant> all_variants() {
  std::vector<Variant> all;
  for (const Path* path : supported_paths())
    for (std::size_t test = 0; test < box_test_names.size(); ++test)
      for (const Grade grade : {Grade::reproducible, Grade::fast})
        all.push_back({path, static_cast<BoxTest>(test), grade});
  return all;
}

std::vector<const float*> columns_of(BoxColumns& boxes) {
  const BoxArrays a = boxes.arrays();
  return {a.lo[0], a.lo[1], a.lo[2], a.hi[0], a.hi[1], a.hi[2]};
}

bool bit(const std::vector<std::uint8_t>& bits, std::size_t i) {
  return (bits[i / 8] >> (i % 8) & 1u) != 0;
}

// All rays of box 0, all rays of box 1 …, by all four loops, which must agree.
Results answers(const Variant& variant, std::span<const Ray> rays, std::span<const Box> boxes,
                Place place = Place::unguarded) {
  RayColumns ray_columns(rays, place);
  BoxColumns box_columns(boxes, place);
  const std::vector<const float*> columns = columns_of(box_columns);
  Results results(rays.size() * boxes.size());
  std::vector<std::uint8_t> bits(std::max(rays.size(), boxes.size()) / 8 + 1);
  BoxHitColumns of_rays(rays.size(), place), of_boxes(boxes.size(), place);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    intervals(variant.loops(), ray_columns.arrays(), rays.size(), boxes[b].lo, of_rays.arrays());
    any_hits(variant.loops().any_of_rays, ray_columns.arrays(), rays.size(), boxes[b].lo, bits.data());
    for (std::size_t r = 0; r < rays.size(); ++r) {
      results[b * rays.size() + r] = of_rays[r];
      EXPECT_EQ(bit(bits, r), of_rays[r].hit != 0) << variant.name() << ": any of rays, ray " << r;
    }
  }
  for (std::size_t r = 0; r < rays.size(); ++r) {
    intervals(variant.loops(), rays[r], columns.data(), boxes.size(), of_boxes.arrays());
    any_hits(variant.loops().any_of_boxes, rays[r], columns.data(), 6, boxes.size(), bits.data());
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      EXPECT_EQ(of_boxes[b], results[b * rays.size() + r]) << variant.name() << ": the two forms differ";
      EXPECT_EQ(bit(bits, b), of_boxes[b].hit != 0) << variant.name() << ": any of boxes, box " << b;
    }
  }
  EXPECT_TRUE(of_rays.are_intact() && of_boxes.are_intact()) << variant.name();
  return results;
}

// Rays against a box as wide as rounding and padding may take it to be: 32u·(|o| + |bound|) on each axis,
// which contains 8u·|o| and the relative widening of t, and the slack along axes without a direction.
Box enlarged(const Box& box, const Ray& ray) {
  Box wide = box;
  for (int axis = 0; axis < 3; ++axis) {
    const float o = std::abs(ray.origin[axis]);
    const float pad_lo = 32 * 0x1p-24f * (o + std::abs(box.lo[axis])) + 0x1p-50f;
    const float pad_hi = 32 * 0x1p-24f * (o + std::abs(box.hi[axis])) + 0x1p-50f;
    if (std::isfinite(box.lo[axis])) wide.lo[axis] -= pad_lo;
    if (std::isfinite(box.hi[axis])) wide.hi[axis] += pad_hi;
  }
  return wide;
}

Box shrunk(const Box& box, const Ray& ray) {
  Box narrow = box;
  for (int axis = 0; axis < 3; ++axis) {
    const float o = std::abs(ray.origin[axis]);
    narrow.lo[axis] += 32 * 0x1p-24f * (o + std::abs(box.lo[axis]));
    narrow.hi[axis] -= 32 * 0x1p-24f * (o + std::abs(box.hi[axis]));
  }
  return narrow;
}

struct Counts {
  std::size_t hits = 0, false_hits = 0, false_misses = 0;
};

Counts check(const Variant& variant, const std::vector<Ray>& rays, const std::vector<Box>& boxes) {
  const Results results = answers(variant, rays, boxes);
  Counts counts;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Ray& ray = rays[i % rays.size()];
    const Box& box = boxes[i / rays.size()];
    const bool hit = results[i].hit != 0, exactly = exact_interval(ray, box).hit;
    counts.hits += exactly;
    counts.false_hits += hit && !exactly;
    counts.false_misses += !hit && exactly;
    if (hit && !exactly) {
      EXPECT_TRUE(exact_interval(ray, enlarged(box, ray)).hit) << variant.name() << ": false hit";
    }
    if (!hit && exactly) {
      EXPECT_EQ(variant.test, BoxTest::plain) << variant.name() << ": false miss";
      EXPECT_FALSE(exact_interval(ray, shrunk(box, ray)).hit)
          << variant.name() << ": false miss, not grazing";
    }
    if (!hit) {
      EXPECT_EQ(results[i], missed) << variant.name();
    }
  }
  return counts;
}

Box random_box(Random& random, double flat_share) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const float a = random.number(-1, 1), b = random.chance(flat_share) ? a : random.number(-1, 1);
    box.lo[axis] = std::min(a, b), box.hi[axis] = std::max(a, b);
  }
  return box;
}

// Through a point of an edge or a corner of the box, from about `scale` away; with `sun` along an axis.
Ray grazing_ray(const Box& box, float scale, bool sun, Random& random) {
  Float3 origin = random.point(2 * scale), direction;
  const int free_axis = random.integer(0, 3);
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    const double lo = box.lo[axis], hi = box.hi[axis];
    const double target = axis == free_axis ? random.real(lo, hi) : (random.chance(0.5) ? lo : hi);
    if (sun && axis != free_axis % 3) {
      origin[k] = random.chance(0.2) ? random.number(-2, 2) : static_cast<float>(target);
      direction[k] = random.chance(0.5) ? 0.0f : -0.0f;
    } else {
      direction[k] = static_cast<float>((target - static_cast<double>(origin[k])) / scale);
      if (direction[k] == 0) direction[k] = 1;
    }
  }
  return make_ray(origin, direction);
}

TEST(BoxForms, decide_grazing_rays_as_their_contracts_say) {
  for (const float scale : {1.0f, 10.0f, 1e3f, 1e5f})
    for (const bool sun : {false, true})
      for (const Variant& variant : all_variants()) {
        Random random(201);
        Counts total;
        for (int round = 0; round < (quick() ? 1 : 12); ++round) {
          std::vector<Box> boxes;
          for (int i = 0; i < 5; ++i) boxes.push_back(random_box(random, i < 2 ? 0.4 : 0));
          std::vector<Ray> rays;
          for (std::size_t i = 0; i < 45; ++i) rays.push_back(grazing_ray(boxes[i % 5], scale, sun, random));
          const Counts counts = check(variant, rays, boxes);
          total.hits += counts.hits, total.false_misses += counts.false_misses;
          if (HasFailure()) return;
        }
        EXPECT_GT(total.hits, quick() ? 1u : 50u) << "the rays are aimed badly";
      }
}

// The plain form must be seen to miss: else the conservative one's widening would not be tested.
TEST(BoxForms, plain_slabs_miss_what_conservative_ones_keep) {
  const Ray rays[] = {make_ray({-2, -1.5f, 0}, {0.644531f, 0.708984f, 0}),
                      make_ray({-1.25f, -0.75f, 0}, {0.587891f, 0.0839844f, 0})};
  const Box boxes[] = {{{-2, -0.125f, -1}, {-0.75f, 1, 1}}, {{-1, -0.625f, -1}, {-0.375f, 0, 1}}};
  for (const Variant& variant : all_variants())
    for (std::size_t i = 0; i < 2; ++i) {
      const bool hit = answers(variant, {&rays[i], 1}, {&boxes[i], 1})[0].hit != 0;
      if (variant.test != BoxTest::plain) {
        EXPECT_TRUE(hit) << variant.name() << ' ' << i;
      } else if (i == 0) {
        EXPECT_FALSE(hit) << variant.name() << ' ' << i;
      }
    }
}

TEST(BoxForms, conservative_ones_equal_the_table) {
  Random random(202);
  for (int round = 0; round < (quick() ? 1 : 10); ++round) {
    std::vector<Box> boxes;
    std::vector<Ray> rays;
    for (int i = 0; i < 21; ++i) boxes.push_back(random_box(random, 0.2));
    for (std::size_t i = 0; i < 21; ++i) {
      Ray ray = grazing_ray(boxes[i], 2, i % 3 == 0, random);
      if (random.chance(0.3)) ray.tmin = random.number(0, 3);
      if (random.chance(0.3)) ray.tmax = random.number(0, 3);
      rays.push_back(ray);
    }
    for (const Variant& variant : all_variants())
      if (variant.test == BoxTest::conservative) {
        ASSERT_EQ(answers(variant, rays, boxes), many_rays(variant.path->table.box, rays, boxes))
            << variant.name();
      }
  }
}

// --- Place × direction on one axis, with states of the other two

constexpr float places[] = {-2, -1, 0.5f, 1, 2};
constexpr float speeds[] = {1,      -1,      0.0f,     -0.0f,     0x1p-149f, -0x1p-149f,
                            1e-30f, -1e-30f, infinity, -infinity, nan};
struct OtherAxis {
  float origin, direction;
};
constexpr OtherAxis others[] = {{0.25f, 1}, {0, -0.0f}, {-3, 1}, {3, 0.0f}, {1, -0.0f}, {-1, 0.0f}};

// A direction below 2^-126 answers as zero does, or as it is; the directional form takes any below 2^-96 so.
// On a face of the box it may answer for a box larger by its padding.
void check_table_ray(const Variant& variant, const Ray& ray, FloatMode mode) {
  const Box box{{-1, -1, -1}, {1, 1, 1}};
  Ray still = ray, flushed = ray;
  for (float& d : still.direction)
    if (std::abs(d) < 0x1p-95f) d = 0;
  for (float& d : flushed.direction)
    if (std::abs(d) < 0x1p-126f) d = 0;
  const BoxResult result = answers(variant, {&ray, 1}, {&box, 1})[0];
  const bool hit = result.hit != 0;
  const bool exactly = exact_interval(ray, box).hit, stands = exact_interval(still, box).hit;
  const bool padded = variant.test == BoxTest::directional && exact_interval(still, enlarged(box, ray)).hit;
  const bool must_hit = exact_interval(mode == FloatMode::flush ? flushed : ray, box).hit;
  const bool allowed = hit ? exactly || stands || padded : !must_hit;
  EXPECT_TRUE(allowed) << variant.name() << (hit ? " hits o " : " misses o ") << ray.origin[0] << ' '
                       << ray.origin[1] << ' ' << ray.origin[2] << " d " << ray.direction[0] << ' '
                       << ray.direction[1] << ' ' << ray.direction[2];
}

TEST(BoxForms, every_place_and_direction_of_one_axis) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    SCOPED_TRACE(name_of(mode));
    for (const Variant& variant : all_variants())
      for (int axis = 0; axis < 3; ++axis)
        for (const OtherAxis& next : others)
          for (const OtherAxis& last : others)
            for (const float place : places)
              for (const float speed : speeds) {
                // The contract wants one component of at least FLT_MIN.
                if (next.direction == 0 && last.direction == 0 && speed != 0 && std::abs(speed) < 0x1p-126f)
                  continue;
                Ray ray = make_ray({0, 0, 0}, {0, 0, 0});
                const int b = (axis + 1) % 3, c = (axis + 2) % 3;
                ray.origin[axis] = place, ray.direction[axis] = speed;
                ray.origin[b] = next.origin, ray.direction[b] = next.direction;
                ray.origin[c] = last.origin, ray.direction[c] = last.direction;
                check_table_ray(variant, ray, mode);
              }
  }
}

// --- Named cases

struct NamedCase {
  const char* name;
  Ray ray;
  Box box;
  bool hit;
};
constexpr Box unit_box{{-1, -1, -1}, {1, 1, 1}};
constexpr float most = 0x1.fffffep127f;
const NamedCase named_cases[] = {
    {"through", make_ray({0, 0, 5}, {0, 0, -1}), unit_box, true},
    {"beside", make_ray({3, 0, 5}, {0, 0, -1}), unit_box, false},
    {"beside on y", make_ray({0, 3, 5}, {0, 0, -1}), unit_box, false},
    {"beside, aslant", make_ray({5, 0, 0}, {-1, 1, 0}), unit_box, false},
    {"from inside", make_ray({0, 0, 0}, {0, 0, -1}), unit_box, true},
    {"behind", make_ray({0, 0, 5}, {0, 0, 1}), unit_box, false},
    {"tmin inside", make_ray({0, 0, 5}, {0, 0, -1}, 5), unit_box, true},
    {"tmin behind the box", make_ray({0, 0, 5}, {0, 0, -1}, 6.5f), unit_box, false},
    {"tmax before the box", make_ray({0, 0, 5}, {0, 0, -1}, 0, 3.5f), unit_box, false},
    {"tmax at the entry", make_ray({0, 0, 5}, {0, 0, -1}, 0, 4), unit_box, true},
    {"tmin at the exit", make_ray({0, 0, 5}, {0, 0, -1}, 6), unit_box, true},
    {"a flat box", make_ray({0, 0, 5}, {0.1f, 0, -1}), {{-1, -1, 0}, {1, 1, 0}}, true},
    {"in the plane of a flat box", make_ray({-3, 0, 0}, {1, 0, 0}), {{-1, -1, 0}, {1, 1, 0}}, true},
    {"a point", make_ray({-1, -2, -3}, {1, 2, 3}), {{1, 2, 3}, {1, 2, 3}}, true},
    {"past a point", make_ray({-1, -2, -3}, {1, 2, 3}), {{1, 2, 4}, {1, 2, 4}}, false},
    {"the empty box",
     make_ray({0, 0, 0}, {1, 1, 1}),
     {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}},
     false},
    {"inverted on x", make_ray({0, 0, 0}, {1, 1, 1}), {{1, -1, -1}, {-1, 1, 1}}, false},
    {"inverted on z, ray along z", make_ray({0, 0, 0}, {0, 0, 1}), {{-1, -1, 1}, {1, 1, -1}}, false},
    {"inverted on x, ray along z", make_ray({0, 0, 0}, {0, 0, 1}), {{1, -1, -1}, {-1, 1, 1}}, false},
    {"the infinite box",
     make_ray({5, 6, 7}, {1, 0, -1}),
     {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}},
     true},
    {"half-infinite, inwards", make_ray({-5, 0, 0}, {1, 0, 0}), {{0, -1, -1}, {infinity, 1, 1}}, true},
    {"half-infinite, outwards", make_ray({-5, 0, 0}, {-1, 0, 0}), {{0, -1, -1}, {infinity, 1, 1}}, false},
    {"the largest numbers", make_ray({-most, 0, 0}, {1, 0, 0}), {{most, -1, -1}, {most, 1, 1}}, true},
    {"still in a box of a denormal",
     make_ray({0, 0, 5}, {0, 0, -1}),
     {{-1e-20f, 0, -1}, {1e-20f, 0, 1}},
     true},
    {"no direction", make_ray({0, 0, 0}, {0, -0.0f, 0}), unit_box, false},
    {"tmin NaN", make_ray({0, 0, 5}, {0, 0, -1}, nan), unit_box, false},
    {"tmax NaN", make_ray({0, 0, 5}, {0, 0, -1}, 0, nan), unit_box, false},
    {"tmin > tmax", make_ray({0, 0, 5}, {0, 0, -1}, 5.5f, 5), unit_box, false},
};

TEST(BoxForms, named_cases_in_both_float_modes) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    for (const Variant& variant : all_variants())
      for (const NamedCase& c : named_cases) {
        // The directional form wants t below 2^40 beside an axis without direction.
        if (variant.test == BoxTest::directional && c.box.lo[0] == most) continue;
        EXPECT_EQ(answers(variant, {&c.ray, 1}, {&c.box, 1})[0].hit, c.hit ? hit_flag : 0)
            << variant.name() << ' ' << name_of(mode) << ": " << c.name;
      }
  }
}

TEST(BoxForms, a_nan_anywhere_is_a_miss_and_disturbs_no_other_lane) {
  // Along each axis, so that each gets to be the last, which is checked by the order of operands alone.
  for (const Variant& variant : all_variants())
    for (int along = 0; along < 3; ++along)
      for (std::size_t k = 0; k < 14; ++k)
        for (const float bad : {nan, -nan}) {
          Ray ray = make_ray({0.1f, 0.2f, 0.3f}, {0.1f, -0.2f, 0.15f});
          ray.direction[along] = 1;
          std::vector<Ray> rays(3, ray);
          std::vector<Box> boxes(3, unit_box);
          if (k < 6)
            (k < 3 ? rays[1].origin : rays[1].direction)[k % 3] = bad;
          else if (k < 12)
            (k < 9 ? boxes[1].lo : boxes[1].hi)[k % 3] = bad;
          else
            (k == 12 ? rays[1].tmin : rays[1].tmax) = bad;
          const Results results = answers(variant, rays, boxes);
          for (std::size_t i = 0; i < 9; ++i) {
            const bool spoiled = k < 6 || k >= 12 ? i % 3 == 1 : i / 3 == 1;
            ASSERT_EQ(results[i].hit, spoiled ? 0 : hit_flag) << variant.name() << " input " << k;
          }
        }
}

TEST(BoxForms, of_any_count_and_with_inactive_lanes) {
  Random random(203);
  std::vector<Box> boxes;
  std::vector<Ray> rays;
  for (int i = 0; i < 35; ++i) {
    boxes.push_back(random_box(random, 0.1));
    rays.push_back(grazing_ray(boxes[0], 2, false, random));
  }
  for (const Variant& variant : all_variants()) {
    const Results whole = answers(variant, rays, boxes);
    for (const Place place : {Place::before_guard, Place::after_guard})
      for (const std::size_t n : {1u, 3u, 5u, 7u, 8u, 9u, 15u, 16u, 17u, 33u}) {
        const Results part = answers(variant, std::span(rays).first(n), std::span(boxes).first(n), place);
        for (std::size_t i = 0; i < n * n; ++i)
          ASSERT_EQ(part[i], whole[i / n * 35 + i % n]) << variant.name();
      }
    const std::uint8_t active[5] = {0x35, 0xff, 0xff, 0x00, 0x02};
    std::vector<Box> spoiled = boxes;
    for (std::size_t i = 0; i < 35; ++i)
      if ((active[i / 8] >> (i % 8) & 1) == 0) spoiled[i] = {{nan, nan, nan}, {nan, nan, nan}};
    BoxColumns columns(spoiled);
    BoxHitColumns out(35);
    const BoxResult before = out[0];
    intervals(variant.loops(), rays[0], columns_of(columns).data(), 35, out.arrays(), active);
    for (std::size_t i = 0; i < 35; ++i)
      ASSERT_EQ(out[i], (active[i / 8] >> (i % 8) & 1) != 0 ? whole[i * 35] : before) << variant.name();
  }
}

}  // namespace
}  // namespace raylanes::testing
