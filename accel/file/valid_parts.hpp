// Validation of any tree that comes from a file.
#pragma once

#include "../layout/leaves.hpp"

namespace raylanes {

// Throws std::runtime_error, which names the offender.
[[noreturn]] void refuse(const char* what, std::size_t number, const char* why);

// Whether both are finite, and not inverted.
bool is_box(float lo, float hi);

// Refuses bounds that are none; of an empty tree, those that are some.
void validate_bounds(const Box& bounds, bool is_empty);

// Refuses a block unless its first `size` lanes have finite corners and a triangle of the mesh, the others NaN and
// no_primitive.
void validate_block(const Leaves& corners, std::size_t index, std::size_t size, std::size_t mesh_triangles);

}  // namespace raylanes
