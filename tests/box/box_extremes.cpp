// All box tests at the extremes: every place and direction of one axis, named cases, bad numbers.
#include "box_answers.hpp"
#include "box_cases.hpp"
#include "box_judge.hpp"

namespace raylanes::testing {
namespace {

using oracle::exact_interval;
using oracle::ExactInterval;
using Results = std::vector<IntervalResult>;

// A component below 2^-126 may have an infinite reciprocal. The test may then answer for a component of zero,
// which moves the ray by less than 2^-126·t, but must not miss what the exact ray meets.
std::string tiny_direction_fault(const IntervalResult& result, const Ray& ray, const Box& box) {
  Ray flushed = ray;
  for (float& d : flushed.direction)
    if (std::abs(d) < 0x1p-126f) d = 0;
  const bool hit = result.hit != 0, exactly = exact_interval(ray, box).hit;
  if (exactly && !hit) return "missed";
  return hit == exactly || hit == exact_interval(flushed, box).hit ? "" : "hit";
}

bool has_tiny_direction(const Ray& ray) {
  return std::any_of(ray.direction.begin(), ray.direction.end(),
                     [](float d) { return d != 0 && std::abs(d) < 0x1p-126f; });
}

// The allowed results for a ray and unit_box. A direction below 2^-126 answers as zero does, or as it is; the
// directional test takes any below 2^-96 so, and on a face it may answer for a box larger by its padding.
struct TableAnswer {
  bool may_hit, may_hit_padded, must_hit, must_hit_flushed;
};

Ray without_directions_below(float least, Ray ray) {
  for (float& d : ray.direction)
    if (std::abs(d) < least) d = 0;
  return ray;
}

TableAnswer table_answer(const Ray& ray) {
  const Ray still = without_directions_below(0x1p-95f, ray);
  const bool exactly = exact_interval(ray, unit_box).hit;
  const bool may_hit = exactly || exact_interval(still, unit_box).hit;
  return {may_hit, may_hit || exact_interval(still, enlarged(unit_box, ray)).hit, exactly,
          exact_interval(without_directions_below(0x1p-126f, ray), unit_box).hit};
}

// The rays of one axis that have a component of at least FLT_MIN, as the contract wants, or no direction.
std::vector<Ray> usable_rays(int axis, const AxisState& next, const AxisState& last) {
  std::vector<Ray> rays = rays_of_one_axis(axis, next, last);
  const bool still = next.direction == 0 && last.direction == 0;
  std::erase_if(rays, [&](const Ray& ray) {
    const float d = ray.direction[axis];
    return still && d != 0 && std::abs(d) < 0x1p-126f;
  });
  return rays;
}

void check_table(const std::vector<Ray>& rays) {
  std::vector<TableAnswer> allowed;
  for (const Ray& ray : rays) allowed.push_back(table_answer(ray));
  for (const BoxVariant& variant : all_variants<BoxTest>())
    for (const FloatMode mode : float_modes) {
      const auto results = answers(variant, rays, {&unit_box, 1}, mode);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const TableAnswer& a = allowed[i];
        const bool may = variant.test == BoxTest::directional ? a.may_hit_padded : a.may_hit;
        const bool must = mode == FloatMode::flush ? a.must_hit_flushed : a.must_hit;
        const bool hit = results[i].hit != 0;
        ASSERT_TRUE(hit ? may : !must)
            << variant.name() << ' ' << name_of(mode) << (hit ? " hits o " : " misses o ")
            << rays[i].origin[0] << ' ' << rays[i].origin[1] << ' ' << rays[i].origin[2] << " d "
            << rays[i].direction[0] << ' ' << rays[i].direction[1] << ' ' << rays[i].direction[2];
      }
    }
}

TEST(BoxExtremes, every_place_and_direction_of_one_axis) {
  for (int axis = 0; axis < 3; ++axis)
    for (const AxisState& next : axis_states)
      for (const AxisState& last : axis_states) {
        check_table(usable_rays(axis, next, last));
        if (HasFatalFailure()) return;
      }
}

TEST(ConservativeBoxes, every_place_and_direction_of_one_axis) {
  const Box& box = unit_box;
  const std::vector<BoxVariant> variants = conservative_variants();
  std::size_t hits = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const AxisState& next : axis_states)
      for (const AxisState& last : axis_states)
        for (const Ray& ray : rays_of_one_axis(axis, next, last)) {
          const ExactInterval exact = exact_interval(ray, box);
          hits += exact.hit;
          const std::string wrong = [&] {
            const Results first = answers(variants[0], {&ray, 1}, {&box, 1});
            for (const BoxVariant& variant : variants)
              if (answers(variant, {&ray, 1}, {&box, 1}) != first) return variant.name() + " differs";
            return has_tiny_direction(ray) ? tiny_direction_fault(first[0], ray, box)
                                           : fault(first[0], exact);
          }();
          ASSERT_EQ(wrong, "") << "axis " << axis << " o " << ray.origin[axis] << " d " << ray.direction[axis]
                               << " others " << next.origin << ' ' << next.direction << ' ' << last.origin
                               << ' ' << last.direction;
        }
  EXPECT_GT(hits, 500u);
}

TEST(BoxExtremes, named_cases) {
  for (const FloatMode mode : float_modes) {
    const FloatModeScope scope(mode);
    for (const BoxVariant& variant : all_variants<BoxTest>())
      for (const BoxCase& c : box_cases()) {
        if (variant.test == BoxTest::directional && c.far) continue;
        const IntervalResult result = answers(variant, {&c.ray, 1}, {&c.box, 1})[0];
        EXPECT_EQ(exact_interval(c.ray, c.box).hit, c.hit) << "the oracle: " << c.name;
        EXPECT_EQ(result.hit, c.hit ? hit_flag : 0)
            << variant.name() << ' ' << name_of(mode) << ": " << c.name;
        if (!c.hit) {
          EXPECT_EQ(result, interval_missed) << variant.name() << ' ' << name_of(mode) << ": " << c.name;
        }
      }
  }
}

TEST(ConservativeBoxes, entry_and_exit_are_clipped_to_the_segment) {
  const Ray whole = make_ray({0, 0, 5}, {0, 0, -1}), part = make_ray({0, 0, 5}, {0, 0, -1}, 4.5f, 5.5f);
  for (const BoxVariant& variant : conservative_variants()) {
    const IntervalResult all = answers(variant, {&whole, 1}, {&unit_box, 1})[0];
    EXPECT_EQ(all.from, 4) << variant.name();
    EXPECT_GE(all.to, 6) << variant.name();
    EXPECT_LE(all.to, 6 * (1 + 12 * 0x1p-24)) << variant.name();
    EXPECT_EQ(answers(variant, {&part, 1}, {&unit_box, 1})[0], (IntervalResult{4.5f, 5.5f, hit_flag}))
        << variant.name();
  }
}

// Input k of 14: origin, direction, lo, hi, tmin, tmax.
void spoil(Ray& ray, Box& box, std::size_t k, float value) {
  Float3* const inputs[] = {&ray.origin, &ray.direction, &box.lo, &box.hi};
  if (k < 12)
    (*inputs[k / 3])[k % 3] = value;
  else
    (k == 12 ? ray.tmin : ray.tmax) = value;
}

TEST(BoxExtremes, an_infinite_ray_misses_even_the_infinite_box) {
  const Box everything{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  for (const BoxVariant& variant : all_variants<BoxTest>())
    for (std::size_t k = 0; k < 6; ++k)
      for (const float value : {infinity, -infinity}) {
        Ray ray = make_ray({0.5f, 0.25f, 5}, {0, 0.125f, -1});
        Box box = everything;
        spoil(ray, box, k, value);
        EXPECT_EQ(answers(variant, {&ray, 1}, {&box, 1})[0], interval_missed)
            << variant.name() << " input " << k;
      }
}

// Boxes and ends of segments may be infinite; origins and directions may not.
TEST(BoxExtremes, a_bad_number_anywhere_is_a_miss_and_disturbs_no_other_lane) {
  for (const FloatMode mode : float_modes)
    for (const BoxVariant& variant : all_variants<BoxTest>())
      // Along each axis, so that each gets to be the last, which is checked by the order of operands alone.
      for (int along = 0; along < 3; ++along)
        for (std::size_t k = 0; k < 14; ++k)
          for (const float bad : {nan, -nan, infinity, -infinity}) {
            if (k >= 6 && std::isinf(bad)) continue;
            Ray ray = make_ray({0.1f, 0.2f, 0.3f}, {0.1f, -0.2f, 0.15f});
            ray.direction[along] = 1;
            constexpr std::size_t n = 19;
            const std::size_t at = 7 * k % n;
            std::vector<Ray> rays(n, ray);
            std::vector<Box> boxes(n, unit_box);
            spoil(rays[at], boxes[at], k, bad);
            // One ray over all boxes and all rays over one, the spoiled one and another.
            const bool of_ray = k < 6 || k >= 12;
            if (of_ray)
              boxes.resize(1);
            else
              rays.resize(1);
            const auto results = answers(variant, rays, boxes, mode);
            for (std::size_t i = 0; i < n; ++i) {
              const bool spoiled = i == at;
              ASSERT_EQ(results[i].hit, spoiled ? 0 : hit_flag)
                  << variant.name() << ' ' << name_of(mode) << " input " << k << " = " << bad;
            }
          }
}

}  // namespace
}  // namespace raylanes::testing
