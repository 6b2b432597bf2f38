// One text becomes many: compiled once per path, with that path's flags and back end. All else in the object
// is local to it; the table is the only symbol that leaves.
#include "simd/arrays.hpp"
#include "roots/root_table.hpp"
#include "traverse/packet.hpp"
#include "traverse/single.hpp"

namespace raylanes {
namespace {

template <TriangleTest test, Grade grade>
constexpr TriangleKernels triangle_kernels() {
  return {rays_triangle_array<test, grade>, ray_triangles_array<test, grade>, closest_single<test, grade>,
          closest_packet<test, grade>,      any_single<test, grade>,          any_packet<test, grade>};
}

}  // namespace

namespace detail {

#define RAYLANES_JOIN(a, b) a##b
#define RAYLANES_TABLE_OF(path) RAYLANES_JOIN(path, _table)

// Rows in the order of TriangleTest and Grade.
extern constinit const KernelTable RAYLANES_TABLE_OF(RAYLANES_PATH_NAME);
constinit const KernelTable RAYLANES_TABLE_OF(RAYLANES_PATH_NAME) = {
    square_root_kernels(),
    {{triangle_kernels<TriangleTest::watertight, Grade::reproducible>(),
      triangle_kernels<TriangleTest::watertight, Grade::fast>()},
     {triangle_kernels<TriangleTest::moller_trumbore, Grade::reproducible>(),
      triangle_kernels<TriangleTest::moller_trumbore, Grade::fast>()}},
    {rays_box_array, ray_boxes_array},
    native_lanes,
    has_fma};

}  // namespace detail
}  // namespace raylanes
