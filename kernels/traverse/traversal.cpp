// The traversals of one path: compiled once per path with its flags and back end; the table is the only symbol that
// leaves the object.
#include "packet.hpp"
#include "single.hpp"

namespace raylanes {
namespace {

template <TriangleTest test, Grade grade>
constexpr TraversalRow traversal_row() {
  return {closest_single<test, grade>, closest_packet<test, grade>, any_single<test, grade>,
          any_packet<test, grade>};
}

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const TraversalKernels traversal;
constinit const TraversalKernels traversal = {
    {{traversal_row<TriangleTest::watertight, Grade::reproducible>(),
      traversal_row<TriangleTest::watertight, Grade::fast>()},
     {traversal_row<TriangleTest::moller_trumbore, Grade::reproducible>(),
      traversal_row<TriangleTest::moller_trumbore, Grade::fast>()}}};

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes
