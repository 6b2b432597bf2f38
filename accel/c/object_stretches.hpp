// The function of trees and scenes that have stretches: behind object_calls.hpp, by its macros.
#include <raylanes/stretches.hpp>

namespace raylanes::c::RAYLANES_NUMBERS {
extern "C" {

raylanes_status RAYLANES_CALL(raylanes_bvh_stretches, raylanes_bvhd_stretches, raylanes_scene_stretches,
                              raylanes_scene_d_stretches)(const RAYLANES_HANDLE* handle, const void* rays,
                                                          std::size_t n, std::size_t stride,
                                                          raylanes_lists** lists,
                                                          const raylanes_ray_options* options) {
  return status_of([&] {
    make("lists", lists, [&] {
      return lists_of(
          stretches(object_of(handle), rays_of(rays, n, stride), ListBy(options, n).unfiltered()));
    });
  });
}

}  // extern "C"
}  // namespace raylanes::c::RAYLANES_NUMBERS
