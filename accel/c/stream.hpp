// Trees and scenes to the caller's memory and files, and back.
#pragma once

#include <iosfwd>

#include "../standard.hpp"

namespace raylanes::c {

// How an object is saved, and how it becomes the one that was.
using Save = void (*)(const void* object, std::ostream& file);
using Load = void (*)(void* object, std::istream& file);

// Sets *size to how many bytes the object has. Throws SmallBuffer if there is less room; the buffer has the first ones
// then.
void save_to_buffer(const void* object, Save save, void* buffer, std::size_t capacity, std::size_t* size);
void load_from_buffer(void* object, Load load, const void* bytes, std::size_t size);
// A file, whose name is UTF-8 on every system. Throw std::runtime_error that names the file and the cause.
void save_to_file(const void* object, Save save, const char* file);
void load_from_file(void* object, Load load, const char* file);

}  // namespace raylanes::c
