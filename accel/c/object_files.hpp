// The functions of trees and scenes that have files: behind object_calls.hpp, by its macros.
#include "stream.hpp"

namespace raylanes::c::RAYLANES_NUMBERS {
namespace {

void save_object(const void* object, std::ostream& file) {
  static_cast<const Tree*>(object)->save(file);
}
void load_object(void* object, std::istream& file) {
  *static_cast<Tree*>(object) = Tree::load(file);
}

}  // namespace

extern "C" {

raylanes_status RAYLANES_CALL(raylanes_bvh_save, raylanes_bvhd_save, raylanes_scene_save,
                              raylanes_scene_d_save)(const RAYLANES_HANDLE* handle, void* buffer,
                                                     std::size_t capacity, std::size_t* size) {
  return status_of([&] { save_to_buffer(&object_of(handle), save_object, buffer, capacity, size); });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_save_file, raylanes_bvhd_save_file, raylanes_scene_save_file,
                              raylanes_scene_d_save_file)(const RAYLANES_HANDLE* handle, const char* file) {
  return status_of([&] { save_to_file(&object_of(handle), save_object, file); });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_load, raylanes_bvhd_load, raylanes_scene_load,
                              raylanes_scene_d_load)(RAYLANES_HANDLE** handle, const void* bytes,
                                                     std::size_t size) {
  return status_of([&] {
    make(kind, handle, [&] {
      Tree loaded;
      load_from_buffer(&loaded, load_object, bytes, size);
      return handle_of(std::move(loaded));
    });
  });
}

raylanes_status RAYLANES_CALL(raylanes_bvh_load_file, raylanes_bvhd_load_file, raylanes_scene_load_file,
                              raylanes_scene_d_load_file)(RAYLANES_HANDLE** handle, const char* file) {
  return status_of([&] {
    make(kind, handle, [&] {
      Tree loaded;
      load_from_file(&loaded, load_object, file);
      return handle_of(std::move(loaded));
    });
  });
}

}  // extern "C"
}  // namespace raylanes::c::RAYLANES_NUMBERS
