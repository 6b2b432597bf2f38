// Every triangle form on rays and triangles: one result per pair, by all loops at once, which must agree.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "../dispatch/intersect.hpp"
#include "columns.hpp"

namespace raylanes::testing {

// One form under test.
struct FormVariant {
  const Path* path;
  TriangleForm form;
  Grade grade;

  std::size_t form_index() const { return static_cast<std::size_t>(form); }
  std::size_t grade_index() const { return static_cast<std::size_t>(grade); }
  std::size_t columns() const { return triangle_form_columns[form_index()]; }
  const TriangleLoops& loops() const { return path->intersections.triangle[form_index()][grade_index()]; }
  std::string name() const {
    return std::string(path->name) + ' ' + std::string(triangle_form_names[form_index()]) + ' ' +
           std::string(grade_names[grade_index()]);
  }
};

std::vector<FormVariant> all_forms();

// Prepared columns of some triangles.
class PreparedTriangles {
 public:
  PreparedTriangles(const FormVariant& variant, std::span<const TriangleVertices> triangles,
                    const float* direction, Place place = Place::unguarded);
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
                                    std::span<const TriangleVertices> triangles);

}  // namespace raylanes::testing
