// A test of the tables under test: on which path, in which grade.
#pragma once

#include <raylanes/boxes.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

#include "../../dispatch/table/boxes.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/spheres.hpp"
#include "../../dispatch/table/triangles.hpp"
#include "testing.hpp"
#include "supported_paths.hpp"

namespace raylanes::testing {

// The names of each kind of test, and where a path keeps its kernels.
template <class Info, std::size_t count>
constexpr std::array<std::string_view, count> names_in_table(const Info (&infos)[count]) {
  std::array<std::string_view, count> names;
  for (std::size_t i = 0; i < count; ++i) names[i] = infos[i].name;
  return names;
}
inline constexpr auto triangle_names = names_in_table(triangle_tests);
inline constexpr auto box_names = names_in_table(box_tests);
inline constexpr auto sphere_names = names_in_table(sphere_tests);
inline const auto& names_of(TriangleTest) {
  return triangle_names;
}
inline const auto& names_of(BoxTest) {
  return box_names;
}
inline const auto& names_of(SphereTest) {
  return sphere_names;
}
inline const auto& kernels_of(const Path& path, TriangleTest) {
  return kernels_of(path).triangles.row;
}
inline const auto& kernels_of(const Path& path, BoxTest) {
  return kernels_of(path).boxes.row;
}
inline const auto& kernels_of(const Path& path, SphereTest) {
  return kernels_of(path).spheres.row;
}

inline constexpr Grade grades[] = {Grade::reproducible, Grade::fast};

template <class Test>
struct Variant {
  const Path* path;
  Test test;
  Grade grade;

  const auto& kernels() const {
    return kernels_of(*path, test)[static_cast<std::size_t>(test)][static_cast<std::size_t>(grade)];
  }
  // Whether it multiplies and adds in one rounding.
  bool is_fused() const { return grade == Grade::fast && path->has_fma(); }
  std::string name() const {
    return std::string(path->name) + ' ' + std::string(names_of(test)[static_cast<std::size_t>(test)]) + ' ' +
           std::string(grade_names[static_cast<std::size_t>(grade)]);
  }
};

// Every test of a kind on every path that this machine supports, in both grades.
template <class Test>
std::vector<Variant<Test>> all_variants() {
  std::vector<Variant<Test>> all;
  for (const Path* path : supported_paths())
    for (std::size_t test = 0; test < names_of(Test{}).size(); ++test)
      for (const Grade grade : grades) all.push_back({path, static_cast<Test>(test), grade});
  return all;
}

}  // namespace raylanes::testing
