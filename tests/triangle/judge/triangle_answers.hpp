// Every triangle test on rays and triangles: one result per pair, by all ways to ask at once, which must agree.
#pragma once

#include <raylanes/triangles.hpp>

#include "../../../dispatch/table/rows.hpp"
#include "../../support/float_modes.hpp"
#include "../../support/soa.hpp"
#include "../../support/triangle_scenes.hpp"
#include "../../support/variants.hpp"

namespace raylanes::testing {

using TriangleVariant = Variant<TriangleTest>;
using Results = std::vector<TriangleResult>;

inline constexpr auto all_triangle_tests = [] {
  std::array<TriangleTest, std::size(triangle_tests)> all;
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = triangle_tests[i].test;
  return all;
}();
inline std::string name_of(TriangleTest test) {
  return triangle_tests[static_cast<std::size_t>(test)].name;
}
inline std::size_t floats_of(TriangleTest test) {
  return static_cast<std::size_t>(triangle_tests[static_cast<std::size_t>(test)].floats);
}
inline TriangleOptions options_of(const TriangleVariant& variant, LaneBits active = nullptr) {
  return {.test = variant.test, .grade = variant.grade, .path = variant.path, .active = active};
}

// Tests that decide by three determinants: their decisions are exact where nothing rounds, at any scale.
inline bool is_by_determinants(TriangleTest test) {
  return test != TriangleTest::precomputed && test != TriangleTest::plane_edges &&
         test != TriangleTest::plane_edges_plain;
}
// The same bits by contract.
inline bool is_moller_trumbore(TriangleTest test) {
  return is_by_determinants(test) && test != TriangleTest::watertight && test != TriangleTest::exact;
}

// No ray slips through between two triangles.
inline bool never_leaks(TriangleTest test) {
  return test == TriangleTest::exact || test == TriangleTest::watertight;
}

// The numbers that a test reads of some triangles, array after array, each with its guards.
class GuardedNumbers {
 public:
  GuardedNumbers(const TriangleVariant& variant, std::span<const Triangle> triangles, const float* direction,
                 Place place = Place::unguarded);
  Soa arrays() const { return pointers_.data(); }
  std::size_t size() const { return size_; }
  // The numbers of triangle i, one after the other.
  std::vector<float> one(std::size_t i) const;

 private:
  std::size_t size_;
  FloatColumns values_;
  std::vector<const float*> pointers_;
};

// All rays of triangle 0, all rays of triangle 1 …. One ray and many, yes/no and closest, corners and prepared
// triangles must agree. The closest hit must be the least by (t, index), and nothing may be written outside an output;
// otherwise a test failure is added.
Results answers(const TriangleVariant& variant, std::span<const Ray> rays,
                std::span<const Triangle> triangles);

// The same with the control register in the given mode, which ends with the call.
Results answers(const TriangleVariant& variant, std::span<const Ray> rays,
                std::span<const Triangle> triangles, FloatMode mode);

TriangleResult single(const TriangleVariant& variant, const Ray& ray, const Triangle& triangle);
inline bool is_hit(const TriangleVariant& variant, const Ray& ray, const Triangle& triangle) {
  return single(variant, ray, triangle).hit != 0;
}

// Adds a fatal failure unless the variant's results have the bits of `expected`.
void expect_all(const TriangleScene& scene, const Results& expected, const TriangleVariant& variant);

}  // namespace raylanes::testing
