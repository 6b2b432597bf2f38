// The functions that trees and scenes share for points: behind object_calls.hpp, by its macros and
//   RAYLANES_CLOSEST       a closest point of C: raylanes_closest_point
// The namespace also has the types AnyClosestPoint, ClosestOptions and DistanceOptions.

namespace raylanes::c::RAYLANES_NUMBERS {
extern "C" {

raylanes_status RAYLANES_CALL(raylanes_bvh_locate, raylanes_bvhd_locate, raylanes_scene_locate,
                              raylanes_scene_d_locate)(const RAYLANES_HANDLE* handle, const void* points,
                                                       std::size_t n, std::size_t stride,
                                                       std::uint8_t* locations,
                                                       const raylanes_point_options* options) {
  return status_of([&] {
    object_of(handle).locate(vertices_of("points", points, n, stride),
                             span_of<Location>("locations", locations, n),
                             *PointOptions<LocateOptions>(options));
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_closest_points, raylanes_bvhd_closest_points,
                              raylanes_scene_closest_points,
                              raylanes_scene_d_closest_points)(const RAYLANES_HANDLE* handle,
                                                               const void* points, std::size_t n,
                                                               std::size_t stride, RAYLANES_CLOSEST* closest,
                                                               const raylanes_point_options* options) {
  return status_of([&] {
    object_of(handle).closest_points(vertices_of("points", points, n, stride),
                                     span_of<AnyClosestPoint>("closest", closest, n),
                                     *PointOptions<ClosestOptions>(options));
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_signed_distances, raylanes_bvhd_signed_distances,
                              raylanes_scene_signed_distances,
                              raylanes_scene_d_signed_distances)(const RAYLANES_HANDLE* handle,
                                                                 const void* points, std::size_t n,
                                                                 std::size_t stride, Number* distances,
                                                                 const raylanes_point_options* options) {
  return status_of([&] {
    object_of(handle).signed_distances(vertices_of("points", points, n, stride),
                                       span_of<Number>("distances", distances, n),
                                       *PointOptions<DistanceOptions>(options));
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_winding_numbers, raylanes_bvhd_winding_numbers,
                              raylanes_scene_winding_numbers,
                              raylanes_scene_d_winding_numbers)(const RAYLANES_HANDLE* handle,
                                                                const void* points, std::size_t n,
                                                                std::size_t stride, Number* numbers,
                                                                const raylanes_point_options* options) {
  return status_of([&] {
    object_of(handle).winding_numbers(vertices_of("points", points, n, stride),
                                      span_of<Number>("numbers", numbers, n),
                                      *PointOptions<WindingOptions>(options));
  });
}

}  // extern "C"
}  // namespace raylanes::c::RAYLANES_NUMBERS
