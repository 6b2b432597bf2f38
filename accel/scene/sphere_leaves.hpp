// Spheres in the order of a tree's leaves.
#pragma once

#include <raylanes/sphere_tree.hpp>

#include "../../dispatch/table/kernel_table.hpp"
#include "visits.hpp"

namespace raylanes {

struct SphereLeaves {
  BoxTree boxes;
  std::vector<float> row[4];  // centre and signed_square of the radius
  std::vector<float> radius;  // as given, for files

  std::size_t bytes() const { return boxes.bytes() + 5 * row[0].size() * sizeof(float); }
};

// As trace_boxes.
void trace_spheres(const SphereLeaves& spheres, const KernelTable& kernels, const BoxedBatch& batch);

}  // namespace raylanes
