// The functions of one kind of tree for points and triangles: behind object_calls.hpp and tree_calls.hpp, by their
// macros.
namespace raylanes::c::RAYLANES_NUMBERS {
namespace {

using CornersOfTriangle = RAYLANES_OPTIONS(Triangle);
static_assert(sizeof(CornersOfTriangle) == 9 * sizeof(Number));

}  // namespace

extern "C" {

raylanes_status RAYLANES_TREE_CALL(raylanes_bvh_corners,
                                   raylanes_bvhd_corners)(const RAYLANES_HANDLE* tree, const void* primitives,
                                                          std::size_t n, std::size_t stride,
                                                          Number* corners) {
  return status_of([&] {
    const Tree& asked = object_of(tree);
    const std::size_t apart = checked_stride("primitives", primitives, n, stride, sizeof(std::uint32_t));
    checked_stride("corners", corners, n, 0, sizeof(CornersOfTriangle));
    require_alignment("corners", corners, alignof(CornersOfTriangle));
    asked.corners({primitives, n, apart}, {reinterpret_cast<CornersOfTriangle*>(corners), n});
  });
}

raylanes_status RAYLANES_TREE_CALL(raylanes_bvh_locate,
                                   raylanes_bvhd_locate)(const RAYLANES_HANDLE* tree, const void* points,
                                                         std::size_t n, std::size_t stride,
                                                         std::uint8_t* locations,
                                                         const raylanes_point_options* options) {
  return status_of([&] {
    object_of(tree).locate(vertices_of("points", points, n, stride),
                           span_of<Location>("locations", locations, n),
                           *PointOptions<LocateOptions>(options));
  });
}

raylanes_status RAYLANES_TREE_CALL(raylanes_bvh_closest_points, raylanes_bvhd_closest_points)(
    const RAYLANES_HANDLE* tree, const void* points, std::size_t n, std::size_t stride,
    RAYLANES_RECORD(closest_point) * closest, const raylanes_point_options* options) {
  return status_of([&] {
    object_of(tree).closest_points(vertices_of("points", points, n, stride),
                                   span_of<ClosestPointOf<Number>>("closest", closest, n),
                                   *PointOptions<RAYLANES_OPTIONS(ClosestPointOptions)>(options));
  });
}

raylanes_status RAYLANES_TREE_CALL(raylanes_bvh_signed_distances,
                                   raylanes_bvhd_signed_distances)(const RAYLANES_HANDLE* tree,
                                                                   const void* points, std::size_t n,
                                                                   std::size_t stride, Number* distances,
                                                                   const raylanes_point_options* options) {
  return status_of([&] {
    object_of(tree).signed_distances(vertices_of("points", points, n, stride),
                                     span_of<Number>("distances", distances, n),
                                     *PointOptions<RAYLANES_OPTIONS(SignedDistanceOptions)>(options));
  });
}

raylanes_status RAYLANES_TREE_CALL(raylanes_bvh_winding_numbers,
                                   raylanes_bvhd_winding_numbers)(const RAYLANES_HANDLE* tree,
                                                                  const void* points, std::size_t n,
                                                                  std::size_t stride, Number* numbers,
                                                                  const raylanes_point_options* options) {
  return status_of([&] {
    object_of(tree).winding_numbers(vertices_of("points", points, n, stride),
                                    span_of<Number>("numbers", numbers, n),
                                    *PointOptions<WindingOptions>(options));
  });
}

}  // extern "C"
}  // namespace raylanes::c::RAYLANES_NUMBERS
