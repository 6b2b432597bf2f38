#include "answers.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace raylanes::testing {

PreparedTriangles::PreparedTriangles(const FormVariant& variant, std::span<const Triangle> triangles,
                                     const float* direction, Place place)
    : size_(triangles.size()), values_(columns_of(variant.test), triangles.size(), place) {
  TriangleColumns source(triangles);
  std::vector<float*> out;
  for (std::size_t c = 0; c < columns_of(variant.test); ++c) out.push_back(values_[c]);
  prepare_triangles(*variant.path, variant.test, variant.grade, source.arrays(), size_, direction,
                    out.data());
  EXPECT_TRUE(values_.are_intact()) << variant.name() << ": preparation wrote outside its columns";
  pointers_.assign(out.begin(), out.end());
}

std::vector<float> PreparedTriangles::one(std::size_t i) const {
  std::vector<float> values;
  for (const float* column : pointers_) values.push_back(column[i]);
  return values;
}

namespace {

// Rays [first, first + count) against the triangles, whose columns are prepared for them.
void answer_rays(const FormVariant& variant, const PreparedTriangles& prepared, std::span<const Ray> rays,
                 std::size_t first, std::size_t all_rays, std::vector<TriangleResult>& results) {
  RayColumns columns(rays);
  TriangleHitColumns out(rays.size());
  std::vector<std::uint8_t> bits(rays.size() / 8 + 1);
  for (std::size_t s = 0; s < prepared.size(); ++s) {
    const std::vector<float> one = prepared.one(s);
    const TriangleHitArrays to = out.arrays();
    closest_hits(variant.kernels(), Wanted::weights, columns.arrays(), rays.size(), one.data(),
                 {to.t, to.hit, to.u, to.v, {}});
    any_hits(variant.kernels().any_of_rays, columns.arrays(), rays.size(), one.data(), bits.data());
    for (std::size_t r = 0; r < rays.size(); ++r) {
      results[s * all_rays + first + r] = out[r];
      EXPECT_EQ(is_set(bits, r), out[r].hit != 0) << variant.name() << ": any and closest of rays differ";
    }
  }
  EXPECT_TRUE(out.are_intact()) << variant.name() << ": written outside the outputs of rays";
}

void check_nearest(const FormVariant& variant, const PreparedTriangles& prepared, const Ray& ray,
                   std::size_t r, std::size_t all_rays, const std::vector<TriangleResult>& results) {
  std::vector<std::uint8_t> bits(prepared.size() / 8 + 1);
  any_hits(variant.kernels().any_of_triangles, ray, prepared.columns(), columns_of(variant.test),
           prepared.size(), bits.data());
  Hit nearest{std::numeric_limits<float>::infinity(), 0, 0, no_primitive};
  for (std::size_t s = 0; s < prepared.size(); ++s) {
    const TriangleResult& result = results[s * all_rays + r];
    EXPECT_EQ(is_set(bits, s), result.hit != 0)
        << variant.name() << ": ray " << r << " × triangle " << s << ": any of triangles differs";
    if (result.hit != 0 && result.t < nearest.t)
      nearest = {result.t, result.u, result.v, static_cast<std::uint32_t>(s)};
  }
  const Hit found = closest_hit(variant.kernels(), Wanted::weights, ray, prepared.columns(),
                                columns_of(variant.test), prepared.size())
                        .hit;
  EXPECT_EQ(std::memcmp(&found, &nearest, sizeof found), 0)
      << variant.name() << ": ray " << r << ": closest is " << found.primitive << " at " << found.t
      << ", should be " << nearest.primitive << " at " << nearest.t;
}

}  // namespace

std::vector<TriangleResult> answers(const FormVariant& variant, std::span<const Ray> rays,
                                    std::span<const Triangle> triangles) {
  std::vector<TriangleResult> results(rays.size() * triangles.size());
  if (variant.test == TriangleForm::directional) {
    for (std::size_t r = 0; r < rays.size(); ++r) {
      const PreparedTriangles prepared(variant, triangles, rays[r].direction.data());
      answer_rays(variant, prepared, rays.subspan(r, 1), r, rays.size(), results);
      check_nearest(variant, prepared, rays[r], r, rays.size(), results);
    }
    return results;
  }
  const PreparedTriangles prepared(variant, triangles, nullptr);
  answer_rays(variant, prepared, rays, 0, rays.size(), results);
  for (std::size_t r = 0; r < rays.size(); ++r)
    check_nearest(variant, prepared, rays[r], r, rays.size(), results);
  return results;
}

std::vector<TriangleResult> answers(const FormVariant& variant, std::span<const Ray> rays,
                                    std::span<const Triangle> triangles, FloatMode mode) {
  const FloatModeScope scope(mode);
  return answers(variant, rays, triangles);
}

}  // namespace raylanes::testing
