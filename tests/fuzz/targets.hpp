// The fuzz targets. Each makes of any bytes one call of the library, checks what it may check of the answer,
// and returns 0; it calls `fail` where an answer is wrong. Two callers: driver.cpp, which makes the bytes
// itself from a seed, and libFuzzer.
#pragma once

#include "../support/testing.hpp"

// Rays of any bits through trees over meshes of any finite ones.
int fuzz_trace(const std::uint8_t* data, std::size_t size);
// Lists of hits, crossings, locations and next hits.
int fuzz_queries(const std::uint8_t* data, std::size_t size);
// Trees of doubles.
int fuzz_doubles(const std::uint8_t* data, std::size_t size);
// Scenes of parts in any places.
int fuzz_scenes(const std::uint8_t* data, std::size_t size);
// Scenes of doubles in any places.
int fuzz_scenes_of_doubles(const std::uint8_t* data, std::size_t size);
// Triangles, boxes and spheres: a ray against many, many rays against one.
int fuzz_arrays(const std::uint8_t* data, std::size_t size);
// Roots and reciprocals of floats and doubles.
int fuzz_roots(const std::uint8_t* data, std::size_t size);
// The C interface with any arguments.
int fuzz_c_calls(const std::uint8_t* data, std::size_t size);
// Embree's interface over raylanes.
int fuzz_embree(const std::uint8_t* data, std::size_t size);
// Readers of mesh files on files that were damaged.
int fuzz_readers(const std::uint8_t* data, std::size_t size);
// Trees that were saved, damaged and loaded, and trees that were refitted.
int fuzz_trees(const std::uint8_t* data, std::size_t size);

namespace raylanes::testing {

// Prints what went wrong and aborts.
[[noreturn]] void fail(const std::string& what);

}  // namespace raylanes::testing
