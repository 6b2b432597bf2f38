// The traversals of one path: compiled once per path with its flags and back end; the table is the only symbol that
// leaves the object.
#include "../simd/arrays.hpp"
#include "packet.hpp"
#include "single.hpp"

namespace raylanes {
namespace {

template <TriangleTest test, Grade grade>
constexpr TriangleKernels triangle_kernels() {
  return {rays_triangle_array<test, grade>, ray_triangles_array<test, grade>, closest_single<test, grade>,
          closest_packet<test, grade>,      any_single<test, grade>,          any_packet<test, grade>};
}

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const TraversalKernels traversal;
constinit const TraversalKernels traversal = {
    {{triangle_kernels<TriangleTest::watertight, Grade::reproducible>(),
      triangle_kernels<TriangleTest::watertight, Grade::fast>()},
     {triangle_kernels<TriangleTest::moller_trumbore, Grade::reproducible>(),
      triangle_kernels<TriangleTest::moller_trumbore, Grade::fast>()}},
    {rays_box_array, ray_boxes_array}};

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes
