// The list of all triangle tests. A row of a table finds its place by the test's id: the order means nothing.
#pragma once

#include <type_traits>

#include "../exact/exact_test.hpp"
#include "../table_rows.hpp"
#include "moller_trumbore.hpp"
#include "plane_edges.hpp"
#include "precomputed.hpp"
#include "watertight.hpp"

namespace raylanes {
namespace {

using TriangleTests = TestList<Exact, Watertight, MollerTrumbore, MollerTrumboreEdges, Precomputed,
                               Directional, PlaneEdges, PlaneEdgesPlain>;

// The tests of trees: `directional` serves rays of one direction, and streams of others are faster
// (docs/intersections.md).
using TreeTests = TestList<Exact, Watertight, MollerTrumbore, MollerTrumboreEdges, Precomputed, PlaneEdges,
                           PlaneEdgesPlain>;

// Packets, streams and walks of planes have code of thousands of bytes a test, so only the tests that gain most
// by them are offered.
using BatchTests = TestList<Exact, Watertight, MollerTrumbore>;

// One that said wrongly that it reads corners would read past them.
template <template <Grade> class... Test>
constexpr bool say_what_they_read(TestList<Test...>) {
  return ((reads_corners(Test<Grade::fast>::id) == std::is_base_of_v<OfCorners, Test<Grade::fast>>)&&...);
}
static_assert(say_what_they_read(TriangleTests()), "a row of triangle_tests says otherwise");

template <template <Grade> class... Test>
constexpr std::size_t count_in_batches(TestList<Test...>) {
  return ((is_in_batches<Test<Grade::fast>> ? std::size_t{1} : 0) + ...);
}
static_assert(count_in_batches(BatchTests()) == 3 && count_in_batches(TriangleTests()) == 3,
              "tests say otherwise");

}  // namespace
}  // namespace raylanes
