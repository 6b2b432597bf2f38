// One interface for all builders of k-d trees, which have names.
#pragma once

#include <raylanes/kdtree.hpp>

#include "../../layout/kd_cells.hpp"
#include "../builder_table.hpp"

namespace raylanes {

// The root's cell is the box around the references, of which there is at least one. No more than max_kd_depth planes
// above a leaf; by sah no more blocks than blocks_allowed; the same for any number of threads, byte for byte. The
// memory of the result stays held.
using KdBuild = KdCells (*)(BuildInput input);

KdCells build_kd_midpoint(BuildInput input);
KdCells build_kd_sah(BuildInput input);

// A third as many as there are triangles: two and a half times what they fill once.
constexpr std::uint32_t blocks_allowed(std::size_t triangles) {
  return static_cast<std::uint32_t>(triangles / 3 + 1);
}

struct KdBuilderInfo {
  KdBuilder builder;
  KdBuild build;
};
inline constexpr KdBuilderInfo kd_builders[] = {
    {KdBuilder::midpoint, build_kd_midpoint},
    {KdBuilder::sah, build_kd_sah},
};

}  // namespace raylanes
