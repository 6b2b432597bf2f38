#include "valid_parts.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "../mesh/bounding_boxes.hpp"

namespace raylanes {

void refuse(const char* what, std::size_t number, const char* why) {
  throw std::runtime_error(std::string("tree: ") + what + ' ' + std::to_string(number) + ' ' + why);
}

bool is_box(float lo, float hi) {
  return std::isfinite(lo) && std::isfinite(hi) && lo <= hi;
}

void validate_bounds(const Box& bounds, bool is_empty) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!is_empty && !is_box(bounds.lo[axis], bounds.hi[axis])) refuse("bounds along axis", axis, "are none");
  if (is_empty && (bounds.lo != empty_box.lo || bounds.hi != empty_box.hi))
    refuse("bounds of", 0, "triangles are not empty");
}

void validate_block(const Leaves& corners, std::size_t index, std::size_t size, std::size_t mesh_triangles) {
  const LeafBlock<9>& block = static_cast<const LeafBlock<9>*>(corners.blocks())[index];
  for (std::size_t lane = 0; lane < tree_width; ++lane) {
    const bool is_used = lane < size;
    if (is_used ? block.primitive[lane] >= mesh_triangles : block.primitive[lane] != no_primitive)
      refuse("block", index, "has a triangle that the mesh has not");
    for (const auto& row : block.number)
      if (!(is_used ? std::isfinite(row[lane]) : std::isnan(row[lane])))
        refuse("block", index, "has a corner that is none");
  }
}

}  // namespace raylanes
