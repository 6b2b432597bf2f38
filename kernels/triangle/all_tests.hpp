// The list of all triangle tests. A row of a table finds its place by the test's id: the order means nothing.
#pragma once

#include <type_traits>

#include "../exact/exact_test.hpp"
#include "../simd/table_rows.hpp"
#include "moller_trumbore.hpp"
#include "plane_edges.hpp"
#include "precomputed.hpp"
#include "watertight.hpp"

namespace raylanes {
namespace {

using TriangleTests = TestList<Exact, Watertight, MollerTrumbore, MollerTrumboreEdges, Precomputed,
                               Directional, PlaneEdges, PlaneEdgesPlain>;

// The tests of trees, in every mode: thousands of bytes of code for each on each path.
using TreeTests = TestList<Exact, Watertight, MollerTrumbore>;

// One that said wrongly that it reads corners would read past them.
template <template <Grade> class... Test>
constexpr bool say_what_they_read(TestList<Test...>) {
  return ((reads_corners(Test<Grade::fast>::id) == std::is_base_of_v<OfCorners, Test<Grade::fast>>)&&...);
}
static_assert(say_what_they_read(TriangleTests()), "a row of triangle_tests says otherwise");

template <template <Grade> class... Test>
constexpr bool are_those_of_trees(TestList<Test...>) {
  for (const TriangleTestInfo& info : triangle_tests)
    if (info.serves_trees != (static_cast<std::size_t>(info.test) < tree_test_names.size())) return false;
  return tree_test_names.size() == sizeof...(Test) && (serves_trees(Test<Grade::fast>::id) && ...);
}
static_assert(are_those_of_trees(TreeTests()), "a row of triangle_tests says otherwise");

}  // namespace
}  // namespace raylanes
