// The functions of trees and scenes that have files: behind object_calls.hpp, by its macros.
#include <fstream>
#include <istream>
#include <ostream>

#include "stream.hpp"

namespace raylanes::c::RAYLANES_NUMBERS {
extern "C" {

raylanes_status RAYLANES_CALL(raylanes_bvh_save, raylanes_bvhd_save, raylanes_scene_save,
                              raylanes_scene_d_save)(const RAYLANES_HANDLE* handle, void* buffer,
                                                     std::size_t capacity, std::size_t* size) {
  return status_of([&] {
    require_pointer("size", size);
    checked_stride("buffer", buffer, capacity, 1, 1);
    BufferOutput output(buffer, capacity);
    std::ostream stream(&output);
    object_of(handle).save(stream);
    *size = output.size();
    if (*size > capacity) throw SmallBuffer{capacity, *size};
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_save_file, raylanes_bvhd_save_file, raylanes_scene_save_file,
                              raylanes_scene_d_save_file)(const RAYLANES_HANDLE* handle, const char* file) {
  return status_of([&] {
    const Tree& saved = object_of(handle);
    with_file<std::ofstream>(file, [&](std::ostream& stream) { saved.save(stream); });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_load, raylanes_bvhd_load, raylanes_scene_load,
                              raylanes_scene_d_load)(RAYLANES_HANDLE** handle, const void* bytes,
                                                     std::size_t size) {
  return status_of([&] {
    make(kind, handle, [&] {
      checked_stride("bytes", bytes, size, 1, 1);
      BufferInput input(bytes, size);
      std::istream stream(&input);
      return handle_of(Tree::load(stream));
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_load_file, raylanes_bvhd_load_file, raylanes_scene_load_file,
                              raylanes_scene_d_load_file)(RAYLANES_HANDLE** handle, const char* file) {
  return status_of([&] {
    make(kind, handle, [&] {
      return with_file<std::ifstream>(file,
                                      [](std::istream& stream) { return handle_of(Tree::load(stream)); });
    });
  });
}

}  // extern "C"
}  // namespace raylanes::c::RAYLANES_NUMBERS
