#include "triangle_answers.hpp"

#include "../../support/same_bytes.hpp"

namespace raylanes::testing {

GuardedNumbers::GuardedNumbers(const TriangleVariant& variant, std::span<const Triangle> triangles,
                               const float* direction, Place place)
    : size_(triangles.size()), values_(floats_of(variant.test), triangles.size(), place) {
  TriangleColumns source(triangles, place);
  const TriangleArrays arrays = source.arrays();
  std::vector<float*> out;
  for (std::size_t k = 0; k < floats_of(variant.test); ++k) out.push_back(values_[k]);
  variant.kernels().prepare(&arrays.corner[0][0], size_, nullptr, direction, out.data());
  EXPECT_TRUE(values_.are_intact()) << variant.name() << ": preparation wrote outside its arrays";
  pointers_.assign(out.begin(), out.end());
}

std::vector<float> GuardedNumbers::one(std::size_t i) const {
  std::vector<float> values;
  for (const float* array : pointers_) values.push_back(array[i]);
  return values;
}

namespace {

// Rays [first, first + count) against each triangle.
void answer_rays(const TriangleVariant& variant, std::span<const Triangle> triangles,
                 std::span<const Ray> rays, std::size_t first, std::size_t all_rays, Results& results) {
  RayColumns columns(rays);
  TriangleHitColumns out(rays.size());
  std::vector<std::uint8_t> bits((rays.size() + 7) / 8);
  for (std::size_t s = 0; s < triangles.size(); ++s) {
    closest_hits(columns.arrays(), triangles[s], out.hits(), options_of(variant));
    hit_mask(columns.arrays(), triangles[s], bits, options_of(variant));
    for (std::size_t r = 0; r < rays.size(); ++r) {
      results[s * all_rays + first + r] = out[r];
      EXPECT_EQ(is_set(bits, r), out[r].hit != 0) << variant.name() << ": any and closest of rays differ";
    }
  }
  EXPECT_TRUE(out.are_intact()) << variant.name() << ": written outside the outputs of rays";
}

void check_nearest(const TriangleVariant& variant, const TriangleArrays& corners,
                   const PreparedTriangles& prepared, const Ray& ray, std::size_t r, std::size_t all_rays,
                   const Results& results) {
  std::vector<std::uint8_t> bits((prepared.size() + 7) / 8), of_prepared(bits.size());
  hit_mask(ray, corners, bits, options_of(variant));
  hit_mask(ray, prepared, of_prepared);
  EXPECT_EQ(bits, of_prepared) << variant.name() << ": corners and prepared triangles differ";
  Hit nearest;
  for (std::size_t s = 0; s < prepared.size(); ++s) {
    const TriangleResult& result = results[s * all_rays + r];
    EXPECT_EQ(is_set(bits, s), result.hit != 0)
        << variant.name() << ": ray " << r << " × triangle " << s << ": any of triangles differs";
    if (result.hit != 0 && result.t < nearest.t)
      nearest = {result.t, result.u, result.v, static_cast<std::uint32_t>(s)};
  }
  const Hit found = closest_hit(ray, corners, options_of(variant)), again = closest_hit(ray, prepared);
  EXPECT_TRUE(same_bytes(found, again)) << variant.name();
  EXPECT_TRUE(same_bytes(found, nearest))
      << variant.name() << ": ray " << r << ": closest is " << found.primitive << " at " << found.t
      << ", should be " << nearest.primitive << " at " << nearest.t;
}

}  // namespace

Results answers(const TriangleVariant& variant, std::span<const Ray> rays,
                std::span<const Triangle> triangles) {
  Results results(rays.size() * triangles.size());
  TriangleColumns corners(triangles);
  if (rays.empty()) return results;
  PreparedTriangles prepared(corners.arrays(), options_of(variant), rays[0].direction);
  const bool directional = variant.test == TriangleTest::directional;
  for (std::size_t r = 0; r < rays.size(); ++r) {
    prepared.prepare(rays[r].direction);
    if (directional) answer_rays(variant, triangles, rays.subspan(r, 1), r, rays.size(), results);
    if (r == 0 && !directional) answer_rays(variant, triangles, rays, 0, rays.size(), results);
    check_nearest(variant, corners.arrays(), prepared, rays[r], r, rays.size(), results);
  }
  return results;
}

Results answers(const TriangleVariant& variant, std::span<const Ray> rays,
                std::span<const Triangle> triangles, FloatMode mode) {
  const FloatModeScope scope(mode);
  return answers(variant, rays, triangles);
}

TriangleResult single(const TriangleVariant& variant, const Ray& ray, const Triangle& triangle) {
  return answers(variant, {&ray, 1}, {&triangle, 1})[0];
}

void expect_all(const TriangleScene& scene, const Results& expected, const TriangleVariant& variant) {
  const Results results = answers(variant, scene.rays, scene.triangles);
  for (std::size_t i = 0; i < scene.size(); ++i)
    ASSERT_EQ(results[i], expected[i]) << variant.name() << " pair " << i << ": hit " << results[i].hit
                                       << " t " << results[i].t << " instead of " << expected[i].t;
}

}  // namespace raylanes::testing
