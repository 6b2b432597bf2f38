#include "interval_answers.hpp"

namespace raylanes::testing {

namespace {

// By contract, yes or no of one ray and many boxes: its largest |direction| is a normal number, or nothing is hit.
bool may_be_asked_any(const Ray& ray) {
  float largest = 0;
  for (const float d : ray.direction) largest = std::max(largest, std::abs(d));
  return std::fpclassify(largest) != FP_SUBNORMAL;
}

}  // namespace

template <class Test>
std::vector<IntervalResult> answers(const Variant<Test>& variant, std::span<const Ray> rays,
                                    std::span<const PrimitiveOf<Test>> primitives, Place place) {
  RayColumns ray_columns(rays, place);
  Columns<PrimitiveOf<Test>> columns(primitives, place);
  const IntervalRow row = interval_row(variant.kernels());
  std::vector<IntervalResult> results(rays.size() * primitives.size());
  IntervalColumns of_rays(rays.size(), place), any_ray(rays.size(), place),
      of_primitives(primitives.size(), place), any_primitive(primitives.size(), place);
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const auto numbers = numbers_of(primitives[p]);
    row.of_rays(ray_columns.arrays(), numbers.data(), nullptr, of_rays.bits(), of_rays.from(), of_rays.to());
    row.any_of_rays(ray_columns.arrays(), numbers.data(), nullptr, any_ray.bits());
    for (std::size_t r = 0; r < rays.size(); ++r) {
      results[p * rays.size() + r] = of_rays[r];
      EXPECT_EQ(any_ray.is_hit(r), of_rays.is_hit(r)) << variant.name() << ": any, ray " << r;
    }
  }
  for (std::size_t r = 0; r < rays.size(); ++r) {
    row.of_primitives(rays[r], columns.soa(), primitives.size(), nullptr, of_primitives.bits(),
                      of_primitives.from(), of_primitives.to());
    row.any_of_primitives(rays[r], columns.soa(), primitives.size(), nullptr, any_primitive.bits());
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      EXPECT_EQ(of_primitives[p], results[p * rays.size() + r])
          << variant.name() << ": the two shapes differ";
      if (!may_be_asked_any(rays[r])) continue;
      EXPECT_EQ(any_primitive.is_hit(p), of_primitives.is_hit(p))
          << variant.name() << ": any, primitive " << p;
    }
  }
  for (IntervalColumns* out : {&of_rays, &of_primitives, &any_ray, &any_primitive})
    EXPECT_TRUE(out->are_intact()) << variant.name();
  return results;
}

template std::vector<IntervalResult> answers(const Variant<BoxTest>&, std::span<const Ray>,
                                             std::span<const Box>, Place);
template std::vector<IntervalResult> answers(const Variant<SphereTest>&, std::span<const Ray>,
                                             std::span<const oracle::Sphere>, Place);

}  // namespace raylanes::testing
