// Every triangle form on rays and triangles: one result per pair, by all loops at once, which must agree.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <raylanes/intersect.hpp>

#include "../support/float_modes.hpp"
#include "../support/soa.hpp"
#include "../support/variants.hpp"

namespace raylanes::testing {

using FormVariant = Variant<TriangleForm>;

inline constexpr TriangleForm all_triangle_forms[] = {
    TriangleForm::plane_edges_plain, TriangleForm::plane_edges,
    TriangleForm::moller_trumbore,   TriangleForm::moller_trumbore_edges,
    TriangleForm::watertight,        TriangleForm::precomputed,
    TriangleForm::directional};
inline std::string name_of(TriangleForm form) {
  return std::string(triangle_form_names[static_cast<std::size_t>(form)]);
}

inline std::size_t columns_of(TriangleForm form) {
  return triangle_form_columns[static_cast<std::size_t>(form)];
}

// Prepared columns of some triangles.
class PreparedTriangles {
 public:
  PreparedTriangles(const FormVariant& variant, std::span<const Triangle> triangles, const float* direction,
                    Place place = Place::unguarded);
  Columns columns() const { return pointers_.data(); }
  std::size_t size() const { return size_; }
  // The columns of triangle i as consecutive numbers.
  std::vector<float> one(std::size_t i) const;

 private:
  std::size_t size_;
  FloatColumns values_;
  std::vector<const float*> pointers_;
};

// All rays of triangle 0, all rays of triangle 1 …, as many_rays orders them. Adds a test failure where the
// loops for one ray and for many, yes/no and closest, disagree, where the closest hit is not the least by
// (t, index), or where an output is written outside.
std::vector<TriangleResult> answers(const FormVariant& variant, std::span<const Ray> rays,
                                    std::span<const Triangle> triangles);

// The same with the control register in the given mode, which ends with the call.
std::vector<TriangleResult> answers(const FormVariant& variant, std::span<const Ray> rays,
                                    std::span<const Triangle> triangles, FloatMode mode);

}  // namespace raylanes::testing
